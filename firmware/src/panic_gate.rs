//! The panic handler, which makes the link of an image fail if any code in it can panic.

use core::panic::PanicInfo;

unsafe extern "C" {
    fn a_panic_path_is_still_reachable() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: the call never runs, because an image with this call does not link.
    unsafe { a_panic_path_is_still_reachable() }
}
