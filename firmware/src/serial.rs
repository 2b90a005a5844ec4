//! The link over a serial line by interrupts, with a ring of fixed size in each direction.

use crate::mark::{self, Region};
use crate::processor;
use crate::ring::{HALF, PLACES, Ring, lost};
use crate::tasks::{self, StepSide};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::SCB;
use mpp_node::Pace;

/// The flight image's step never waits for a plan. An image that is compared with the host does.
pub const PACE: Pace = if cfg!(feature = "lockstep") {
    Pace::Lockstep
} else {
    Pace::RealTime
};

/// The last byte of a frame.
const DELIMITER: u8 = 0;
/// Greatest number of bytes that one run of the step takes.
const BYTES_PER_RUN: usize = 2048;

/// The registers of a board's serial line.
pub trait Line {
    /// Takes note of what raised the interrupt.
    fn acknowledge();
    /// Takes the oldest byte that has come.
    fn take() -> Option<u8>;
    /// Whether the line takes another byte to send.
    fn has_room() -> bool;
    /// Gives the line a byte to send. It has room.
    fn put(byte: u8);
    /// Says whether the line shall interrupt when it has room again.
    fn await_room(wanted: bool);
}

static RECEIVED: Ring = Ring::new();
static TO_SEND: Ring = Ring::new();
/// Number of lost bytes that the step has reported.
static REPORTED: AtomicU32 = AtomicU32::new(0);

/// Puts bytes into the ring; the line's interrupt sends them. Only the step may call this function.
// Not inlined, because each message would hold a copy.
#[inline(never)]
pub fn send(bytes: &[u8]) {
    TO_SEND.push(bytes);
}

/// The interrupt of the step: answers of the planner, received bytes, and each 10 ms the watch of the planner and the
/// watchdog. `kick` makes the line send.
///
/// # Safety
/// Only the step's interrupt may call this function.
pub unsafe fn step(feed_watchdog: impl FnOnce(), kick: impl FnOnce()) {
    // SAFETY: this is the step's interrupt, as the caller promises.
    let side = unsafe { tasks::step_side() };
    side.collect(send);
    run(side);
    if processor::tick_passed() {
        side.watch_planner(send);
        feed_watchdog();
    }
    kick();
}

/// Gives the received bytes to the step.
fn run(side: &mut StepSide) {
    let lost = lost();
    let unreported = lost.wrapping_sub(REPORTED.load(Ordering::Relaxed));
    // The step reports only if there is room, because the count would be lost with a lost report.
    if unreported > 0 && TO_SEND.len() <= HALF {
        REPORTED.store(lost, Ordering::Relaxed);
        side.bytes_lost(unreported, send);
    }
    for _ in 0..BYTES_PER_RUN {
        if side.waits() {
            return;
        }
        let Some(byte) = RECEIVED.pop() else {
            return;
        };
        side.receive(byte, send);
    }
}

/// Defines the program of an image that flies over a serial line. `$board` and `$line` are the modules of both;
/// `$prepare` prepares them before anything else runs.
#[macro_export]
macro_rules! serial_image {
    ($board:ident, $line:ident, $prepare:expr) => {
        #[cortex_m_rt::entry]
        fn main() -> ! {
            if let Some(mut peripherals) = cortex_m::Peripherals::take() {
                ($prepare)(&mut peripherals);
                $crate::protection::start(&mut peripherals.MPU, &$board::REGIONS);
                // SAFETY: no interrupt is enabled yet.
                unsafe {
                    $crate::tasks::set_up($crate::serial::PACE);
                    $crate::tasks::step_side().announce($crate::serial::send);
                }
                $crate::processor::set_priorities(&mut peripherals);
                $board::start_watchdog();
                $crate::processor::start_ticking(&mut peripherals, $board::TICK);
                $line::start();
            }
            planner_thread()
        }

        #[unsafe(no_mangle)]
        extern "C" fn planner_thread() -> ! {
            // SAFETY: only `main` calls this function, and the restart after it has dropped the thread.
            unsafe {
                $crate::tasks::plan(cortex_m::peripheral::SCB::set_pendst, || {
                    $crate::processor::sleep_unless($crate::tasks::has_order)
                })
            }
        }

        /// The interrupt of the step. It comes every 10 ms, after the last byte of a frame, and after an answer of
        /// the planner.
        #[cortex_m_rt::exception]
        fn SysTick() {
            // SAFETY: this is the step's interrupt.
            unsafe {
                $crate::serial::step($board::feed_watchdog, $line::kick);
            }
        }

        #[cortex_m_rt::exception]
        unsafe fn DefaultHandler(number: i16) {
            $line::interrupt(number);
        }
    };
}

/// Handles the interrupt of the line.
pub fn interrupt<L: Line>() {
    mark::begin();
    L::acknowledge();
    // A ring holds no more than this. A line with more bytes interrupts again.
    for _ in 0..PLACES {
        let Some(byte) = L::take() else {
            break;
        };
        RECEIVED.push(&[byte]);
        // The step must also take bytes in time if no delimiter comes.
        if byte == DELIMITER || RECEIVED.len() == HALF {
            SCB::set_pendst();
        }
    }
    for _ in 0..PLACES {
        if !L::has_room() {
            break;
        }
        let Some(byte) = TO_SEND.pop() else {
            break;
        };
        L::put(byte);
    }
    L::await_room(TO_SEND.len() > 0);
    mark::end(Region::Uart);
}
