//! Faults for tests of the emulated image, behind the feature `faults`: the flight image has none. A test
//! switches a fault on by a change of its word in the image file. Without such a change the faults have no
//! effect.

use crate::ring;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Value for a fault that is switched off.
const NEVER: u32 = u32::MAX;

/// Tick after whose step the planner hangs, in its next slice. It hangs once in each boot.
#[unsafe(no_mangle)]
static FAULT_PLANNER_HANGS_AFTER: u32 = NEVER;

/// Tick in whose step the core hangs, before its answer is sent, until the watchdog resets the core. It
/// hangs once.
#[unsafe(no_mangle)]
static FAULT_STEP_HANGS_AFTER: u32 = NEVER;

/// If this word is changed, the planner delays its set-up until bytes of the link are lost. They get lost,
/// because the step takes no bytes while it waits for the set-up.
#[unsafe(no_mangle)]
static FAULT_SET_UP_AWAITS_LOSS: u32 = NEVER;

/// Number of additional instructions in the first slice of each cycle.
#[unsafe(no_mangle)]
static FAULT_SLICE_LONGER_BY: u32 = 0;

/// Tick from which on the planner traps after each slice.
#[unsafe(no_mangle)]
static FAULT_PLANNER_TRAPS_AFTER: u32 = NEVER;

/// Tick after whose step the step traps. It traps once.
#[unsafe(no_mangle)]
static FAULT_STEP_TRAPS_AFTER: u32 = NEVER;

/// The way in which a task traps. 0: an instruction that does not exist; 1: the stack overflows; 2: a write
/// to a constant; 3: execution from RAM.
#[unsafe(no_mangle)]
static FAULT_TRAP: u32 = 0;

/// Whether the planner has hung since the start.
static PLANNER_HUNG: AtomicBool = AtomicBool::new(false);
/// Whether the step has hung or trapped. This memory survives the reset.
#[unsafe(link_section = ".uninit.faults")]
static STEP_HUNG: AtomicU32 = AtomicU32::new(0);
const YES: u32 = 0x5EED_F00D;

fn read(word: &'static u32) -> u32 {
    // SAFETY: a reference is valid to read. The read is volatile, because a test may have changed the
    // image.
    unsafe { core::ptr::read_volatile(word) }
}

/// Hangs the planner if its fault is due at this tick.
pub fn planner(clock: u32) {
    let after = read(&FAULT_PLANNER_HANGS_AFTER);
    if after != NEVER && clock >= after && !PLANNER_HUNG.swap(true, Ordering::Relaxed) {
        hang();
    }
    let after = read(&FAULT_PLANNER_TRAPS_AFTER);
    if after != NEVER && clock >= after {
        trap();
    }
}

/// Makes a slice longer if the fault is switched on.
pub fn slice() {
    // The emulator takes one cycle for each instruction.
    cortex_m::asm::delay(read(&FAULT_SLICE_LONGER_BY));
}

/// Waits for lost bytes if the fault is switched on. It calls `alive` meanwhile.
pub fn set_up(alive: impl Fn()) {
    while read(&FAULT_SET_UP_AWAITS_LOSS) != NEVER && ring::lost() == 0 {
        alive();
    }
}

/// Hangs the step if its fault is due at this tick.
pub fn step(clock: u32) {
    let after = read(&FAULT_STEP_HANGS_AFTER);
    if after != NEVER && clock == after && STEP_HUNG.swap(YES, Ordering::Relaxed) != YES {
        hang();
    }
    let after = read(&FAULT_STEP_TRAPS_AFTER);
    if after != NEVER && clock == after && STEP_HUNG.swap(YES, Ordering::Relaxed) != YES {
        trap();
    }
}

fn trap() -> ! {
    let data = STEP_HUNG.as_ptr();
    // SAFETY: each of these traps, and the handler drops or resets everything that runs.
    unsafe {
        match read(&FAULT_TRAP) {
            0 => core::arch::asm!("udf #0", options(noreturn)),
            1 => core::arch::asm!("1: push {{r0-r7}}", "b 1b", options(noreturn)),
            2 => (&raw const FAULT_TRAP).cast_mut().write_volatile(0),
            _ => core::arch::asm!("bx {}", in(reg) data as u32 | 1, options(noreturn)),
        }
    }
    // No trap came: a flight whose planner hangs shows it.
    hang()
}

fn hang() -> ! {
    loop {
        cortex_m::asm::nop();
    }
}
