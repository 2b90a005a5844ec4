//! CMSDK UART 0 by interrupts, with a ring of fixed size in each direction.

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
/// Control bits that enable transmitter, receiver and the interrupts of both.
const ENABLE: u32 = 0b1111;

/// The last byte of a frame.
const DELIMITER: u8 = 0;

#[derive(Clone, Copy)]
struct Line(u16);

// SAFETY: the number belongs to an interrupt of this board.
unsafe impl cortex_m::interrupt::InterruptNumber for Line {
    fn number(self) -> u16 {
        self.0
    }
}

const RX: Line = Line(0);
const TX: Line = Line(1);

static RECEIVED: Ring = Ring::new();
static TO_SEND: Ring = Ring::new();
/// Number of bytes lost because a ring was full.
static LOST: AtomicU32 = AtomicU32::new(0);

fn read(register: usize) -> u32 {
    // SAFETY: the address is a register of the UART.
    unsafe { UART.add(register).read_volatile() }
}

fn write(register: usize, value: u32) {
    // SAFETY: the address is a register of the UART.
    unsafe { UART.add(register).write_volatile(value) };
}

/// Starts the UART and its interrupts, and sends the bytes that are already in the ring.
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

/// Takes the next received byte. Only the step may call this function.
#[must_use]
pub fn receive() -> Option<u8> {
    RECEIVED.pop()
}

/// Puts bytes into the ring; [`kick`] sends them. Only the step may call this function.
pub fn send(bytes: &[u8]) {
    count_lost(TO_SEND.push(bytes));
}

/// Whether the ring has room for a short report. Only the step may call this function.
#[must_use]
pub fn has_room() -> bool {
    TO_SEND.len() <= HALF
}

/// Starts sending.
pub fn kick() {
    NVIC::pend(TX);
}

/// Number of bytes lost in both directions since the start.
#[must_use]
pub fn lost() -> u32 {
    LOST.load(Ordering::Relaxed)
}

fn count_lost(bytes: usize) {
    if bytes > 0 {
        LOST.fetch_add(bytes as u32, Ordering::Relaxed);
    }
}

/// Handles an interrupt of the UART, and ignores other interrupts. The watchdog raises one as a warning
/// before it resets the core.
pub fn interrupt(number: i16) {
    if number != RX.0 as i16 && number != TX.0 as i16 {
        return;
    }
    mark::begin();
    write(INTERRUPT, 0b11);
    while read(STATE) & RX_FULL != 0 {
        let byte = read(DATA) as u8;
        count_lost(RECEIVED.push(&[byte]));
        // The step must also take bytes in time if no delimiter comes.
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
