//! Registers of the board, an MPS2 with the image AN500.

use cortex_m::Peripherals;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;

/// Of the processor's clock and of the timers [Hz].
const CLOCK: u32 = 25_000_000;
/// Counts in 10 ms.
pub const TICK: u32 = CLOCK / 100;

/// CMSDK timer 0, which counts down freely.
const TIMER: *mut u32 = 0x4000_0000 as *mut u32;
/// CMSDK watchdog.
const WATCHDOG: *mut u32 = 0x4000_8000 as *mut u32;
/// Counts that the watchdog waits: 50 ms, then an interrupt, and after 50 ms more the reset.
const PATIENCE: u32 = 5 * TICK;
const UNLOCK: u32 = 0x1ACC_E551;

/// Priorities: UART (the reset value, 0) above the step above the restart.
pub fn set_priorities(peripherals: &mut Peripherals) {
    // SAFETY: nothing relies on masking by priority.
    unsafe {
        peripherals.SCB.set_priority(SystemHandler::SysTick, 1 << 5);
        peripherals.SCB.set_priority(SystemHandler::PendSV, 7 << 5);
    }
}

/// Lets SysTick fire at 100 Hz.
pub fn start_ticking(peripherals: &mut Peripherals) {
    let systick = &mut peripherals.SYST;
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(TICK - 1);
    systick.clear_current();
    systick.enable_interrupt();
    systick.enable_counter();
}

/// Whether SysTick's counter has come round since the last call.
#[must_use]
pub fn tick_passed() -> bool {
    const CONTROL: *const u32 = 0xE000_E010 as *const u32;
    // SAFETY: reading it clears the flag, which nobody else reads.
    unsafe { CONTROL.read_volatile() & (1 << 16) != 0 }
}

/// Starts the free-running timer.
pub fn start_timer() {
    // SAFETY: the timer is used here only: reload and value, then enable.
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

/// Starts the watchdog: whoever does not feed it for 100 ms is reset.
pub fn start_watchdog() {
    // SAFETY: the watchdog is used here only: unlock, load, interrupt and reset.
    unsafe {
        WATCHDOG.add(0xC00 / 4).write_volatile(UNLOCK);
        WATCHDOG.write_volatile(PATIENCE);
        WATCHDOG.add(2).write_volatile(0b11);
    }
}

/// Feeds the watchdog.
pub fn feed_watchdog() {
    // SAFETY: clears the interrupt and reloads.
    unsafe { WATCHDOG.add(3).write_volatile(1) };
}

/// Sleeps until an interrupt, unless one came since `ready` was last looked at.
pub fn sleep_unless(ready: impl FnOnce() -> bool) {
    cortex_m::interrupt::disable();
    if !ready() {
        // Wakes although the interrupt is masked.
        cortex_m::asm::wfi();
    }
    // SAFETY: they were enabled before.
    unsafe { cortex_m::interrupt::enable() };
}
