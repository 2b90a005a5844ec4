//! Registers of the board. The board is an MPS2 with the image AN500.

use crate::protection::Region;

/// Frequency of the processor and of the timers \[Hz\].
const CLOCK: u32 = 25_000_000;
/// Number of counts in 10 ms.
pub const TICK: u32 = CLOCK / 100;

/// Address of the CMSDK timer 0, which counts down freely.
const TIMER: *mut u32 = 0x4000_0000 as *mut u32;
/// Address of the CMSDK watchdog.
const WATCHDOG: *mut u32 = 0x4000_8000 as *mut u32;
/// Number of counts in half of the watchdog's time. After 100 ms it raises an exception, which records the
/// place and resets the core. Should that fail, it resets the core itself after 100 ms more.
const PATIENCE: u32 = 10 * TICK;
const UNLOCK: u32 = 0x1ACC_E551;

/// What the image may use: the regions of `memory.x`, and the board's timer, UART and watchdog.
pub const REGIONS: [Region; 4] = [
    Region::code(0, 21),
    Region::data(0x2000_0000, 17),
    Region::data(0x6000_0000, 19),
    Region::device(0x4000_0000, 16),
];

/// What the image of the planner in space may use: the SRAM behind AXI too.
pub const SPACE_REGIONS: [Region; 4] = {
    let [code, near, _, device] = REGIONS;
    [code, near, Region::data(0x6000_0000, 20), device]
};

/// Starts the free-running timer.
pub fn start_timer() {
    // SAFETY: only this module uses the timer. The code writes reload and value, then enables it.
    unsafe {
        TIMER.add(2).write_volatile(u32::MAX);
        TIMER.add(1).write_volatile(u32::MAX);
        TIMER.write_volatile(1);
    }
}

/// Counts since the timer was started, modulo 2^32.
#[must_use]
pub fn now() -> u32 {
    // SAFETY: reading has no effect.
    u32::MAX.wrapping_sub(unsafe { TIMER.add(1).read_volatile() })
}

/// Starts the watchdog. It resets the core if the core does not feed it for 100 ms.
pub fn start_watchdog() {
    // SAFETY: only this module uses the watchdog. The code unlocks it, loads its time, and enables
    // interrupt and reset.
    unsafe {
        WATCHDOG.add(0xC00 / 4).write_volatile(UNLOCK);
        WATCHDOG.write_volatile(PATIENCE);
        WATCHDOG.add(2).write_volatile(0b11);
    }
}

/// Feeds the watchdog.
pub fn feed_watchdog() {
    // SAFETY: the write only clears the interrupt and reloads the time.
    unsafe { WATCHDOG.add(3).write_volatile(1) };
}
