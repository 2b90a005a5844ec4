//! The image for the board Nucleo-H743ZI. It flies over the serial line of the board's debugger. Nobody has run it
//! on a board yet: docs/nucleo.md says what is proven.
#![no_std]
#![no_main]

mod board;
mod line;

use cortex_m::peripheral::SCB;
use cortex_m_rt::{entry, exception};
use firmware::serial::{self, PACE};
use firmware::{processor, protection, tasks};

#[entry]
fn main() -> ! {
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        board::start(&mut peripherals);
        board::note_watchdog();
        line::set_up();
        protection::start(&mut peripherals.MPU, &board::REGIONS);
        // SAFETY: no interrupt is enabled yet.
        unsafe {
            tasks::set_up(PACE);
            tasks::step_side().announce(serial::send);
        }
        processor::set_priorities(&mut peripherals);
        board::start_watchdog();
        processor::start_ticking(&mut peripherals, board::TICK);
        line::start();
    }
    planner_thread()
}

#[unsafe(no_mangle)]
extern "C" fn planner_thread() -> ! {
    // SAFETY: only `main` calls this function, and the restart after it has dropped the thread.
    unsafe {
        tasks::plan(SCB::set_pendst, || {
            processor::sleep_unless(tasks::has_order)
        })
    }
}

/// The interrupt of the step. It comes every 10 ms, after the last byte of a frame, and after an answer of
/// the planner.
#[exception]
fn SysTick() {
    // SAFETY: this is the step's interrupt.
    unsafe {
        serial::step(board::feed_watchdog, line::kick);
    }
}

#[exception]
unsafe fn DefaultHandler(number: i16) {
    line::interrupt(number);
}
