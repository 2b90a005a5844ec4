//! The flight core on a bare Cortex-M7: QEMU's mps2-an500, and in the folder `nucleo` a board that one can buy.
//!
//! ```text
//! priority   what runs                                    owns
//! -          traps and the watchdog: restart              the record of faults
//! 0 highest  UART interrupts: bytes to and from rings     -
//! 1          SysTick: the 100 Hz step                     the step task, the link
//! 2 lowest   PendSV: restarts the planner's thread        -
//! thread     the planner, slice by slice; sleeps          the plan task
//! ```
//!
//! The tasks share only atomic counters, and mailboxes with one producer and one consumer. Therefore no
//! task masks the interrupt of the step, except for a short check before the thread sleeps. A plan goes to
//! the step as a value, and the step takes it over at a tick boundary.
//!
//! There are two programs for the emulated board. `uart` flies over a serial line, with timer, watchdog and restart of a stuck
//! planner. `fifo` flies over semihosting, for campaigns and measurements. The image that flies is `uart`
//! without any feature; `Cargo.toml` says what the features add for tests and comparisons.
#![no_std]

pub mod board;
#[cfg_attr(not(feature = "faults"), path = "no_faults.rs")]
pub mod faults;
pub mod host;
pub mod image;
mod mailbox;
pub mod mark;
pub mod owned;
pub mod panic_gate;
pub mod processor;
pub mod protection;
pub mod report;
pub mod restart;
mod ring;
pub mod serial;
pub mod tasks;
pub mod trap;
pub mod uart;
