//! Faults that tests of the emulated image switch on, by changing these words in the image file.
//! As built they do nothing.

use crate::uart;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// No tick.
const NEVER: u32 = u32::MAX;

/// The planner hangs in the first slice after this tick was stepped, once a boot.
#[unsafe(no_mangle)]
static FAULT_PLANNER_HANGS_AFTER: u32 = NEVER;

/// The step hangs after this tick, before it answers, until the watchdog resets the core; once.
#[unsafe(no_mangle)]
static FAULT_STEP_HANGS_AFTER: u32 = NEVER;

/// If set, planners wait with their set-up, and so the step with the bytes of the link, until some of
/// those are lost.
#[unsafe(no_mangle)]
static FAULT_SET_UP_AWAITS_LOSS: u32 = NEVER;

/// Instructions by which the first slice of each cycle is longer.
#[unsafe(no_mangle)]
static FAULT_SLICE_LONGER_BY: u32 = 0;

/// Whether the planner has hung since the start.
static PLANNER_HUNG: AtomicBool = AtomicBool::new(false);
/// Whether the step has hung: this memory survives the reset.
#[unsafe(link_section = ".uninit.faults")]
static STEP_HUNG: AtomicU32 = AtomicU32::new(0);
const YES: u32 = 0x5EED_F00D;

fn read(word: &'static u32) -> u32 {
    // SAFETY: a reference. Volatile, because the image may have been changed.
    unsafe { core::ptr::read_volatile(word) }
}

/// Hangs the planner if this tick is the one.
pub fn planner(clock: u32) {
    let after = read(&FAULT_PLANNER_HANGS_AFTER);
    if after != NEVER && clock >= after && !PLANNER_HUNG.swap(true, Ordering::Relaxed) {
        hang();
    }
}

/// Goes on with a slice if it is to be longer.
pub fn slice() {
    // One instruction a cycle, as it is emulated.
    cortex_m::asm::delay(read(&FAULT_SLICE_LONGER_BY));
}

/// Waits for lost bytes if it is to; `alive` is called meanwhile.
pub fn set_up(alive: impl Fn()) {
    while read(&FAULT_SET_UP_AWAITS_LOSS) != NEVER && uart::lost() == 0 {
        alive();
    }
}

/// Hangs the step if this tick is the one.
pub fn step(clock: u32) {
    let after = read(&FAULT_STEP_HANGS_AFTER);
    if after != NEVER && clock == after && STEP_HUNG.swap(YES, Ordering::Relaxed) != YES {
        hang();
    }
}

fn hang() -> ! {
    loop {
        cortex_m::asm::nop();
    }
}
