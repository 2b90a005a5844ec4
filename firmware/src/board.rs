//! Registers of the board. The board is an MPS2 with the image AN500.

use cortex_m::Peripherals;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;

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

/// Sets the priorities: the UART (at the reset value, 0) is above the step, and the step is above the
/// restart.
pub fn set_priorities(peripherals: &mut Peripherals) {
    // SAFETY: no code relies on masking by priority.
    unsafe {
        peripherals.SCB.set_priority(SystemHandler::SysTick, 1 << 5);
        peripherals.SCB.set_priority(SystemHandler::PendSV, 7 << 5);
    }
}

/// Starts SysTick at 100 Hz.
pub fn start_ticking(peripherals: &mut Peripherals) {
    let systick = &mut peripherals.SYST;
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(TICK - 1);
    systick.clear_current();
    systick.enable_interrupt();
    systick.enable_counter();
}

/// Whether the counter of SysTick has wrapped around since the last call.
#[must_use]
pub fn tick_passed() -> bool {
    const CONTROL: *const u32 = 0xE000_E010 as *const u32;
    // SAFETY: reading the register clears the flag, and no other code reads this flag.
    unsafe { CONTROL.read_volatile() & (1 << 16) != 0 }
}

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

/// Sleeps until an interrupt, unless `ready` returns true. An interrupt between the call of `ready` and
/// the sleep also ends the sleep.
pub fn sleep_unless(ready: impl FnOnce() -> bool) {
    cortex_m::interrupt::disable();
    if !ready() {
        // A pending interrupt ends the sleep although interrupts are masked.
        cortex_m::asm::wfi();
    }
    // SAFETY: interrupts were enabled before.
    unsafe { cortex_m::interrupt::enable() };
}
