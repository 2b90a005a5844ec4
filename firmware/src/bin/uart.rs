//! The image that flies over UART 0, by interrupts.
#![no_std]
#![no_main]

use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{entry, exception};
use firmware::tasks::{self, StepSide};
use firmware::{board, protection, uart};
use mpp_node::Pace;

/// Greatest number of bytes that one run of the step takes.
const BYTES_PER_RUN: usize = 2048;

/// The flight image's step never waits for a plan. An image that is compared with the host does.
const PACE: Pace = if cfg!(feature = "lockstep") {
    Pace::Lockstep
} else {
    Pace::RealTime
};

/// Number of lost bytes that the step has reported.
static REPORTED: AtomicU32 = AtomicU32::new(0);

#[entry]
fn main() -> ! {
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        protection::start(&mut peripherals.MPU);
        // SAFETY: no interrupt is enabled yet.
        unsafe {
            tasks::set_up(PACE);
            tasks::step_side().announce(uart::send);
        }
        board::set_priorities(&mut peripherals);
        board::start_watchdog();
        board::start_ticking(&mut peripherals);
        uart::start();
    }
    planner_thread()
}

#[unsafe(no_mangle)]
extern "C" fn planner_thread() -> ! {
    // SAFETY: only `main` calls this function, and the restart after it has dropped the thread.
    unsafe { tasks::plan(SCB::set_pendst, || board::sleep_unless(tasks::has_order)) }
}

/// The interrupt of the step. It comes every 10 ms, after the last byte of a frame, and after an answer of
/// the planner.
#[exception]
fn SysTick() {
    // SAFETY: this is the step's interrupt.
    let side = unsafe { tasks::step_side() };
    side.collect(uart::send);
    run_link(side);
    if board::tick_passed() {
        side.watch_planner(uart::send);
        board::feed_watchdog();
    }
    uart::kick();
}

fn run_link(side: &mut StepSide) {
    let lost = uart::lost();
    let unreported = lost.wrapping_sub(REPORTED.load(Ordering::Relaxed));
    // The step reports only if there is room, because the count would be lost with a lost report.
    if unreported > 0 && uart::has_room() {
        REPORTED.store(lost, Ordering::Relaxed);
        side.bytes_lost(unreported, uart::send);
    }
    for _ in 0..BYTES_PER_RUN {
        if side.waits() {
            return;
        }
        let Some(byte) = uart::receive() else {
            return;
        };
        side.receive(byte, uart::send);
    }
}

#[exception]
unsafe fn DefaultHandler(irqn: i16) {
    uart::interrupt(irqn);
}
