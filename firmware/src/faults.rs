//! Faults that tests of the emulated image switch on, by changing these words in the image file.
//! As built they do nothing.

/// No tick.
const NEVER: u32 = u32::MAX;

/// The planner hangs in the first slice after this tick was stepped, once a boot.
#[unsafe(no_mangle)]
static FAULT_PLANNER_HANGS_AFTER: u32 = NEVER;

/// The step hangs after this tick, until the watchdog resets the core.
#[unsafe(no_mangle)]
static FAULT_STEP_HANGS_AFTER: u32 = NEVER;

fn read(word: &'static u32) -> u32 {
    // SAFETY: a reference. Volatile, because the image may have been changed.
    unsafe { core::ptr::read_volatile(word) }
}

/// Whether the planner is to hang after this tick.
#[must_use]
pub fn planner_hangs(clock: u32) -> bool {
    let after = read(&FAULT_PLANNER_HANGS_AFTER);
    after != NEVER && clock >= after
}

/// Whether the step is to hang after this tick.
#[must_use]
pub fn step_hangs(clock: u32) -> bool {
    let after = read(&FAULT_STEP_HANGS_AFTER);
    after != NEVER && clock == after
}
