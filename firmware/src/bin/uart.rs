//! The image that flies over UART 0, by interrupts.
#![no_std]
#![no_main]

use firmware::{board, uart};

firmware::serial_image!(board, uart, |_| {});
