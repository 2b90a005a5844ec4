//! CMSDK UART 0, the serial line of the emulated board.

use crate::serial::{self, Line};
use cortex_m::peripheral::NVIC;

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

#[derive(Clone, Copy)]
struct Number(u16);

// SAFETY: the number belongs to an interrupt of this board.
unsafe impl cortex_m::interrupt::InterruptNumber for Number {
    fn number(self) -> u16 {
        self.0
    }
}

const RX: Number = Number(0);
const TX: Number = Number(1);

fn read(register: usize) -> u32 {
    // SAFETY: the address is a register of the UART.
    unsafe { UART.add(register).read_volatile() }
}

fn write(register: usize, value: u32) {
    // SAFETY: the address is a register of the UART.
    unsafe { UART.add(register).write_volatile(value) };
}

/// The registers of the UART. It interrupts by itself when it has sent a byte.
struct Uart;

impl Line for Uart {
    fn acknowledge() {
        write(INTERRUPT, 0b11);
    }

    fn take() -> Option<u8> {
        (read(STATE) & RX_FULL != 0).then(|| read(DATA) as u8)
    }

    fn has_room() -> bool {
        read(STATE) & TX_FULL == 0
    }

    fn put(byte: u8) {
        write(DATA, u32::from(byte));
    }

    fn await_room(_: bool) {}
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

/// Starts sending.
pub fn kick() {
    NVIC::pend(TX);
}

/// Handles an interrupt of the UART, and ignores other interrupts. The watchdog raises one as a warning
/// before it resets the core.
pub fn interrupt(number: i16) {
    if number == RX.0 as i16 || number == TX.0 as i16 {
        serial::interrupt::<Uart>();
    }
}
