//! What the image itself measures, written to the file `report` at the end of a flight.

use crate::board::TICK;
use crate::host;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m_semihosting::debug;

/// Counts of the free-running timer at the last tick.
static LAST: AtomicU32 = AtomicU32::new(0);
static TICKS: AtomicU32 = AtomicU32::new(0);
static MISSED: AtomicU32 = AtomicU32::new(0);
/// Longest and shortest time between two ticks [counts].
static LONGEST: AtomicU32 = AtomicU32::new(0);
static SHORTEST: AtomicU32 = AtomicU32::new(u32::MAX);

/// Notes a tick of the timer at a time [counts].
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

/// Bytes of the stack that no longer hold the paint of the start-up code.
fn stack_used() -> u32 {
    const PAINT: u32 = 0xCCCC_CCCC;
    unsafe extern "C" {
        static _stack_start: u32;
        static _stack_end: u32;
    }
    let (top, mut word) = (&raw const _stack_start, &raw const _stack_end);
    // SAFETY: all of it is memory, and what is below the stack pointer is not in use.
    while word < top && unsafe { word.read_volatile() } == PAINT {
        word = word.wrapping_add(1);
    }
    (top as u32).saturating_sub(word as u32)
}
