//! The image of the planner in space, over two FIFOs by semihosting, in lockstep.
//!
//! One thread makes the step and then all slices that it granted, so the order of all work is fixed and no interrupt comes. Task,
//! map and planner lie in the memories of an STM32H743.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::host::{self, Host};
use firmware::mark::{self, Region};
use firmware::owned::{self, Owned};
use firmware::{board, image, protection, report};
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::{SpacePlanner, SpaceStage};
use mpp_node::{SpaceMemory, SpaceSlice, SpaceTask};

static TASK: Owned<SpaceTask> = Owned::uninit();
#[unsafe(link_section = ".axisram")]
static PLANNER: Owned<SpacePlanner> = Owned::uninit();
#[unsafe(link_section = ".sram")]
static MAP: Owned<VoxelGrid> = Owned::uninit();
// SAFETY: these are constants, and the compiler checks them.
const _: (SpaceTask, SpacePlanner, VoxelGrid) =
    unsafe { (owned::zeros(), owned::zeros(), owned::zeros()) };

#[entry]
fn main() -> ! {
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        protection::start(&mut peripherals.MPU, &board::SPACE_REGIONS);
    }
    board::start_timer();
    // SAFETY: no interrupt is enabled, so there is one user. Zeros are valid values, as the constant proves.
    let (task, mut memory, host) = unsafe {
        TASK.write_zeros();
        PLANNER.write_zeros();
        MAP.write_zeros();
        host::open();
        let (map, planner) = (MAP.get(), PLANNER.get());
        (TASK.get(), SpaceMemory { map, planner }, host::get())
    };
    task.reset(&mut memory);
    if !image::is_whole() {
        report::finish(0);
    }
    // The harness ends the loop.
    while host.has_bytes() || host.read() {
        while let Some(byte) = host.next() {
            take(task, byte, &mut memory, host);
            while let Some(slice) = task.slice(memory.planner) {
                advance(task, slice, &mut memory);
            }
        }
    }
    report::finish(0)
}

fn take(task: &mut SpaceTask, byte: u8, memory: &mut SpaceMemory<'_>, host: &Host) {
    let before = task.last_tick();
    mark::begin();
    task.take(byte, memory, &mut |bytes| host.send(bytes));
    mark::end(if task.last_tick() != before {
        Region::Step
    } else if byte == 0 {
        Region::Frame
    } else {
        Region::Byte
    });
}

/// Does a slice. A cycle goes from its sweep to its last slice.
fn advance(task: &mut SpaceTask, slice: SpaceSlice, memory: &mut SpaceMemory<'_>) {
    if slice == SpaceSlice::Sweep {
        mark::begin();
        mark::end(Region::Order);
    }
    mark::begin();
    task.advance(memory);
    mark::end(match slice {
        SpaceSlice::Sweep | SpaceSlice::Map => Region::Map,
        SpaceSlice::Planner(stage) => match stage {
            SpaceStage::Field => Region::Remember,
            SpaceStage::Lattice => Region::Lattice,
            SpaceStage::Candidate => Region::Corridor,
            SpaceStage::Program => Region::Linearise,
            SpaceStage::Solve => Region::Program,
            SpaceStage::Refine | SpaceStage::WayOut => Region::Improve,
        },
    });
    let last = matches!(slice, SpaceSlice::Planner(SpaceStage::WayOut));
    if last && task.slice(memory.planner) != Some(slice) {
        mark::begin();
        mark::end(Region::Answer);
    }
}

// The restart of the other images refers to it; nothing restarts here.
#[unsafe(no_mangle)]
extern "C" fn planner_thread() -> ! {
    report::finish(0)
}
