//! The library `libmpp_c_embed.a` for flight computers. Its panic handler calls a function that does not exist: a program
//! with a path to a panic does not link.
#![no_std]

pub use mpp_c::*;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn a_panic_path_is_still_reachable() -> !;
    }
    // SAFETY: the function does not exist, so nothing that links calls it.
    unsafe { a_panic_path_is_still_reachable() }
}
