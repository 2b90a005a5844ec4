//! CMSDK UART 0 by interrupts, with a fixed ring each way.

use crate::mark::{self, Region};
use crate::ring::{HALF, Ring};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::{NVIC, SCB};

const UART: *mut u32 = 0x4000_4000 as *mut u32;
const DATA: usize = 0;
const STATE: usize = 1;
const CONTROL: usize = 2;
const INTERRUPT: usize = 3;
const BAUD_DIVIDER: usize = 4;
const TX_FULL: u32 = 1;
const RX_FULL: u32 = 2;
/// Transmitter, receiver and the interrupts of both.
const ENABLE: u32 = 0b1111;

/// The frame's last byte.
const DELIMITER: u8 = 0;

#[derive(Clone, Copy)]
struct Line(u16);

// SAFETY: the number of an interrupt of this board.
unsafe impl cortex_m::interrupt::InterruptNumber for Line {
    fn number(self) -> u16 {
        self.0
    }
}

const RX: Line = Line(0);
const TX: Line = Line(1);

static RECEIVED: Ring = Ring::new();
static TO_SEND: Ring = Ring::new();
/// Bytes that found a ring full.
static LOST: AtomicU32 = AtomicU32::new(0);

fn read(register: usize) -> u32 {
    // SAFETY: a register of the UART.
    unsafe { UART.add(register).read_volatile() }
}

fn write(register: usize, value: u32) {
    // SAFETY: a register of the UART.
    unsafe { UART.add(register).write_volatile(value) };
}

/// Starts the UART and its interrupts, and sends what is in the ring already.
pub fn start() {
    write(BAUD_DIVIDER, 16);
    write(CONTROL, ENABLE);
    // SAFETY: both handlers are ready.
    unsafe {
        NVIC::unmask(RX);
        NVIC::unmask(TX);
    }
    kick();
}

/// The next byte that came. Only for the step.
#[must_use]
pub fn receive() -> Option<u8> {
    RECEIVED.pop()
}

/// Puts bytes in the ring; [`kick`] sends them. Only for the step.
pub fn send(bytes: &[u8]) {
    for byte in bytes {
        if !TO_SEND.push(*byte) {
            count_lost();
        }
    }
}

/// Whether a short report can be sent. Only for the step.
#[must_use]
pub fn has_room() -> bool {
    TO_SEND.len() <= HALF
}

/// Starts sending.
pub fn kick() {
    NVIC::pend(TX);
}

/// Bytes that were lost in either direction since the start.
#[must_use]
pub fn lost() -> u32 {
    LOST.load(Ordering::Relaxed)
}

fn count_lost() {
    LOST.fetch_add(1, Ordering::Relaxed);
}

/// An interrupt of the UART; others are nothing to us. (The watchdog warns by one before it
/// resets.)
pub fn interrupt(number: i16) {
    if number != RX.0 as i16 && number != TX.0 as i16 {
        return;
    }
    mark::begin();
    write(INTERRUPT, 0b11);
    while read(STATE) & RX_FULL != 0 {
        let byte = read(DATA) as u8;
        if !RECEIVED.push(byte) {
            count_lost();
        }
        // What has no end must be looked at in time, too.
        if byte == DELIMITER || RECEIVED.len() == HALF {
            SCB::set_pendst();
        }
    }
    while read(STATE) & TX_FULL == 0 {
        let Some(byte) = TO_SEND.pop() else {
            break;
        };
        write(DATA, u32::from(byte));
    }
    mark::end(Region::Uart);
}
