//! What every Cortex-M7 has: priorities, SysTick, sleep.

use cortex_m::Peripherals;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;

/// Sets the priorities: the UART (at the reset value, 0) is above the step, and the step is above the
/// restart.
pub fn set_priorities(peripherals: &mut Peripherals) {
    // SAFETY: no code relies on masking by priority.
    unsafe {
        peripherals.SCB.set_priority(SystemHandler::SysTick, 1 << 5);
        peripherals.SCB.set_priority(SystemHandler::PendSV, 7 << 5);
    }
}

/// Starts SysTick at 100 Hz. `tick` is the number of the processor's cycles in 10 ms.
pub fn start_ticking(peripherals: &mut Peripherals, tick: u32) {
    let systick = &mut peripherals.SYST;
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(tick.saturating_sub(1));
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
