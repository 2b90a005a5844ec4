//! The measurements of the image itself. It writes them to the file `report` at the end of a flight.

use crate::board::TICK;
use crate::host;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m_semihosting::debug;

/// Time of the last tick \[counts of the free-running timer\].
static LAST: AtomicU32 = AtomicU32::new(0);
static TICKS: AtomicU32 = AtomicU32::new(0);
static MISSED: AtomicU32 = AtomicU32::new(0);
/// Longest time between two ticks \[counts\].
static LONGEST: AtomicU32 = AtomicU32::new(0);
/// Shortest time between two ticks \[counts\].
static SHORTEST: AtomicU32 = AtomicU32::new(u32::MAX);

/// Records a tick of the timer at the time `now` \[counts\].
pub fn tick(now: u32) {
    let since = now.wrapping_sub(LAST.swap(now, Ordering::Relaxed));
    if TICKS.fetch_add(1, Ordering::Relaxed) > 0 {
        LONGEST.fetch_max(since, Ordering::Relaxed);
        SHORTEST.fetch_min(since, Ordering::Relaxed);
        if since > TICK + TICK / 2 {
            MISSED.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// Writes the report and ends the emulation.
pub fn finish(restarts: u32) -> ! {
    host::write_file(
        c"report",
        &[
            stack_used(),
            TICKS.load(Ordering::Relaxed),
            MISSED.load(Ordering::Relaxed),
            LONGEST.load(Ordering::Relaxed),
            SHORTEST.load(Ordering::Relaxed),
            restarts,
        ],
    );
    loop {
        debug::exit(debug::EXIT_SUCCESS);
    }
}

/// Number of bytes of the stack that no longer hold the pattern that the start-up code wrote.
fn stack_used() -> u32 {
    const PAINT: u32 = 0xCCCC_CCCC;
    unsafe extern "C" {
        static _stack_start: u32;
        static _stack_end: u32;
    }
    let (top, mut word) = (&raw const _stack_start, &raw const _stack_end);
    // SAFETY: the whole range is memory, and no code uses the part below the stack pointer.
    while word < top && unsafe { word.read_volatile() } == PAINT {
        word = word.wrapping_add(1);
    }
    (top as u32).saturating_sub(word as u32)
}
