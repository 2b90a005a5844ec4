//! USART3 on pins PD8 and PD9, which the debugger of the board shows to a computer as a serial port: 1 Mbaud, eight
//! bits, no parity, one stop bit.

use cortex_m::peripheral::NVIC;
use firmware::serial::{self, Line};
use stm32h7::stm32h743v::{Interrupt, Peripherals, USART3};

/// Cycles of the line's clock of 100 MHz in a bit.
const DIVIDER: u16 = 100;
/// The function of the pins that is USART3.
const FUNCTION: u8 = 7;
/// The mode of a pin that has a function.
const ALTERNATE: u8 = 2;
/// Interrupt flags of errors: parity, framing, noise, overrun. A lost byte shows in the frame's checksum.
const ERRORS: u32 = 0b1111;

fn usart() -> USART3 {
    // SAFETY: before the interrupt is enabled only `set_up` uses the registers, and then only the interrupt.
    unsafe { Peripherals::steal() }.USART3
}

/// Gives the pins to the line and sets its rate.
pub fn set_up() {
    // SAFETY: as above, and nothing else uses these pins.
    let board = unsafe { Peripherals::steal() };
    board.RCC.ahb4enr.modify(|_, w| w.gpioden().set_bit());
    board.RCC.apb1lenr.modify(|_, w| w.usart3en().set_bit());
    // A read after the switch of a clock makes sure that the clock runs.
    let _ = board.RCC.apb1lenr.read();
    board
        .GPIOD
        .afrh
        .modify(|_, w| w.afr8().bits(FUNCTION).afr9().bits(FUNCTION));
    board
        .GPIOD
        .moder
        .modify(|_, w| w.moder8().bits(ALTERNATE).moder9().bits(ALTERNATE));
    let line = board.USART3;
    // SAFETY: the divider is at least 16, as the line wants.
    line.brr.write(|w| unsafe { w.bits(u32::from(DIVIDER)) });
    line.cr1.write(|w| {
        w.fifoen().set_bit().te().set_bit().re().set_bit();
        w.rxneie().set_bit().ue().set_bit()
    });
}

/// Enables the interrupt, and sends the bytes that are already in the ring.
pub fn start() {
    // SAFETY: the handler is ready.
    unsafe { NVIC::unmask(Interrupt::USART3) };
    kick();
}

/// Starts sending.
pub fn kick() {
    NVIC::pend(Interrupt::USART3);
}

/// Handles the interrupt of the line, and ignores others.
pub fn interrupt(number: i16) {
    if number == Interrupt::USART3 as i16 {
        serial::interrupt::<Usart>();
    }
}

/// The registers of the line, in its interrupt.
struct Usart;

impl Line for Usart {
    fn acknowledge() {
        // SAFETY: a one clears its flag, and changes nothing else.
        usart().icr.write(|w| unsafe { w.bits(ERRORS) });
    }

    fn take() -> Option<u8> {
        let line = usart();
        let has_byte = line.isr.read().rxne().bit_is_set();
        has_byte.then(|| line.rdr.read().bits() as u8)
    }

    fn has_room() -> bool {
        usart().isr.read().txe().bit_is_set()
    }

    fn put(byte: u8) {
        // SAFETY: every byte can be sent.
        usart().tdr.write(|w| unsafe { w.bits(u32::from(byte)) });
    }

    fn await_room(wanted: bool) {
        usart().cr1.modify(|_, w| w.txeie().bit(wanted));
    }
}
