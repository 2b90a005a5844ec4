//! The flight core on a bare Cortex-M7 (QEMU's mps2-an500).
//!
//! ```text
//! priority   what runs                                    owns
//! 0 highest  UART interrupts: bytes to and from rings     -
//! 1          SysTick: the 100 Hz step                     the step task, the link
//! 2 lowest   PendSV: restarts the planner's thread        -
//! thread     the planner, slice by slice; sleeps          the plan task
//! ```
//!
//! The tasks share nothing but mailboxes of one producer and one consumer and atomic counters, so
//! nothing masks the step out, but for the look round of a thread that is about to sleep. A plan goes
//! to the step as a value; the step takes it over at a tick boundary.
//!
//! Two images: `uart`, which flies over a serial line with timer, watchdog and restart of a stuck
//! planner; `fifo`, which flies over semihosting, for campaigns and for measuring.
#![no_std]

pub mod board;
pub mod faults;
pub mod host;
mod mailbox;
pub mod mark;
mod owned;
pub mod panic_gate;
pub mod report;
pub mod restart;
mod ring;
pub mod tasks;
pub mod uart;
