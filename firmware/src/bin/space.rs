//! The image of the planner in space, over two FIFOs by semihosting, in lockstep.
//!
//! One thread makes the step and then all slices that it granted, so the order of all work is fixed and no interrupt comes. The
//! memory of the planner is more than an STM32H743 has: the image shows bits and costs, and flies no aircraft.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::host::{self, Host};
use firmware::mark::{self, Region};
use firmware::owned::{self, Owned};
use firmware::{board, image, protection, report};
use mpp_core::planner::space::SpaceStage;
use mpp_node::{SpaceNode, SpaceSlice};

#[unsafe(link_section = ".psram")]
static NODE: Owned<SpaceNode> = Owned::uninit();
// SAFETY: this is a constant, and the compiler checks it.
const _: SpaceNode = unsafe { owned::zeros() };

#[entry]
fn main() -> ! {
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        protection::start(&mut peripherals.MPU, &board::SPACE_REGIONS);
    }
    board::start_timer();
    // SAFETY: no interrupt is enabled, so there is one user. Zeros are a valid node, as the constant proves.
    let (node, host) = unsafe {
        NODE.write_zeros();
        host::open();
        (NODE.get(), host::get())
    };
    node.reset();
    if !image::is_whole() {
        report::finish(0);
    }
    // The harness ends the loop.
    while host.has_bytes() || host.read() {
        while let Some(byte) = host.next() {
            take(node, byte, host);
            while let Some(slice) = node.slice() {
                advance(node, slice);
            }
        }
    }
    report::finish(0)
}

fn take(node: &mut SpaceNode, byte: u8, host: &Host) {
    let before = node.last_tick();
    mark::begin();
    node.take(byte, &mut |bytes| host.send(bytes));
    mark::end(if node.last_tick() != before {
        Region::Step
    } else if byte == 0 {
        Region::Frame
    } else {
        Region::Byte
    });
}

/// Does a slice. A cycle goes from its sweep to its last slice.
fn advance(node: &mut SpaceNode, slice: SpaceSlice) {
    if slice == SpaceSlice::Map {
        mark::begin();
        mark::end(Region::Order);
    }
    mark::begin();
    node.advance();
    mark::end(match slice {
        SpaceSlice::Map => Region::Map,
        SpaceSlice::Planner(stage) => match stage {
            SpaceStage::Field => Region::Remember,
            SpaceStage::Lattice => Region::Lattice,
            SpaceStage::Candidate => Region::Corridor,
            SpaceStage::Program => Region::Linearise,
            SpaceStage::Solve => Region::Program,
            SpaceStage::Refine => Region::Improve,
        },
    });
    let last = matches!(slice, SpaceSlice::Planner(SpaceStage::Refine));
    if last && node.slice() != Some(slice) {
        mark::begin();
        mark::end(Region::Answer);
    }
}

// The restart of the other images refers to it; nothing restarts here.
#[unsafe(no_mangle)]
extern "C" fn planner_thread() -> ! {
    report::finish(0)
}
