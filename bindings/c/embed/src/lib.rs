//! The library `libmpp`. On a flight computer its panic handler calls a function that does not exist: a program with a path
//! to a panic does not link. A host has the standard library's handler.
#![no_std]

#[cfg(not(target_os = "none"))]
extern crate std;

pub use mpp_c::*;

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn a_panic_path_is_still_reachable() -> !;
    }
    // SAFETY: the function does not exist, so nothing that links calls it.
    unsafe { a_panic_path_is_still_reachable() }
}
