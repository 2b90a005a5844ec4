//! The image for the board Nucleo-H743ZI. It flies over the serial line of the board's debugger. Nobody has run it
//! on a board yet: docs/nucleo.md says what is proven.
#![no_std]
#![no_main]

mod board;
mod line;

firmware::serial_image!(board, line, |peripherals| {
    board::start(peripherals);
    board::note_watchdog();
    line::set_up();
});
