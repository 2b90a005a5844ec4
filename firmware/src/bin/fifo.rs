//! The image that flies over two FIFOs by semihosting. It runs in lockstep for campaigns and measurements,
//! or at 100 Hz by the timer if the command line ends with `timer`.
//!
//! In lockstep the thread requests the step whenever the planner waits, so the order of all work is fixed.
//! With the timer the step comes every 10 ms at any point of the planner's work. The time stands still
//! while the emulator waits for the harness, as if the sensors answered at once.
#![no_std]
#![no_main]

use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{entry, exception};
use firmware::host::{self, Host};
use firmware::{board, processor, protection, report, tasks};
use mpp_node::Pace;

static TIMED: AtomicBool = AtomicBool::new(false);

#[entry]
fn main() -> ! {
    let timed = host::command_line_ends_with(b"timer");
    TIMED.store(timed, Ordering::Relaxed);
    let pace = if timed {
        Pace::RealTime
    } else {
        Pace::Lockstep
    };
    if let Some(mut peripherals) = cortex_m::Peripherals::take() {
        protection::start(&mut peripherals.MPU, &board::REGIONS);
        // SAFETY: no interrupt is enabled yet.
        unsafe {
            tasks::set_up(pace);
            host::open();
            let host = host::get();
            tasks::step_side().announce(|bytes| host.send(bytes));
        }
        processor::set_priorities(&mut peripherals);
        board::start_timer();
        if timed {
            board::start_watchdog();
            processor::start_ticking(&mut peripherals, board::TICK);
        }
    }
    planner_thread()
}

#[unsafe(no_mangle)]
extern "C" fn planner_thread() -> ! {
    // SAFETY: only `main` calls this function, and the restart after it has dropped the thread.
    unsafe {
        if TIMED.load(Ordering::Relaxed) {
            // The thread does not sleep, because the emulator's time is exact only while instructions run.
            tasks::plan(|| {}, || {})
        } else {
            tasks::plan(SCB::set_pendst, SCB::set_pendst)
        }
    }
}

/// The interrupt of the step.
#[exception]
fn SysTick() {
    // SAFETY: this is the step's interrupt.
    let (side, host) = unsafe { (tasks::step_side(), host::get()) };
    let timed = TIMED.load(Ordering::Relaxed);
    if timed {
        report::tick(board::now());
    }
    let before = side.last_tick();
    side.collect(|bytes| host.send(bytes));
    // With the timer the loop reads until it has made one tick of the flight. In lockstep it reads once.
    while !side.waits() && side.last_tick() == before {
        if !take_bytes(host) {
            report::finish(side.restarts);
        }
        while !side.waits()
            && let Some(byte) = host.next()
        {
            side.receive(byte, |bytes| host.send(bytes));
        }
        if !timed {
            break;
        }
    }
    if timed {
        side.watch_planner(|bytes| host.send(bytes));
        board::feed_watchdog();
    }
}

/// Makes sure that there are bytes to take. Returns false at the end of the flight.
fn take_bytes(host: &mut Host) -> bool {
    host.has_bytes() || host.read()
}

#[exception]
unsafe fn DefaultHandler(_: i16) {}
