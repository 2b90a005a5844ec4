//! Links only if nothing that the flight core does can panic.
//!
//! The image feeds bytes of unknown value to a [`FlightNode`], so that link, estimator, regulator,
//! map, path search, raytracing and program are all reachable. Its panic handler calls a function
//! that does not exist: if the optimiser leaves a single path to a panic, linking fails. It is
//! built as the firmware is (`thumbv7em-none-eabihf`, fat LTO) and never run.
//!
//! `.ci/cross` links it, and lists the paths if that fails.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use flight_node::FlightNode;
use hil_protocol::{Decoder, MAX_FRAME, encode};

unsafe extern "C" {
    fn a_panic_path_is_still_reachable() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: never runs: an image with this call does not link.
    unsafe { a_panic_path_is_still_reachable() }
}

/// Initialised at compile time: built at run time, the node would pass over the stack.
#[unsafe(link_section = ".axisram")]
static mut NODE: FlightNode = FlightNode::new();

/// Bytes that the optimiser knows nothing about: some UART's data register.
const DATA: *mut u8 = 0x4000_4004 as *mut u8;

fn read() -> u8 {
    // SAFETY: never runs.
    unsafe { DATA.read_volatile() }
}

fn write(bytes: &[u8]) {
    for byte in bytes {
        // SAFETY: never runs.
        unsafe { DATA.write_volatile(*byte) }
    }
}

#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    // SAFETY: the only reference, taken once.
    let node = unsafe { &mut *(&raw mut NODE) };
    // The other end of the link, for the messages that a node never sends.
    let mut decoder = Decoder::new();
    let mut buffer = [0; MAX_FRAME];
    loop {
        let byte = read();
        node.receive(&[byte], write);
        if let Some(Ok(message)) = decoder.push(byte)
            && let Ok(frame) = encode(&message, &mut buffer)
        {
            write(frame);
        }
    }
}
