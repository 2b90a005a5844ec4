//! An image links only if nothing in it can panic.

use core::panic::PanicInfo;

unsafe extern "C" {
    fn a_panic_path_is_still_reachable() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: never runs: an image with this call does not link.
    unsafe { a_panic_path_is_still_reachable() }
}
