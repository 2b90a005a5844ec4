//! Statics that belong to one priority.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;

/// A value in a static that only one priority uses.
pub struct Owned<T>(UnsafeCell<MaybeUninit<T>>);

// SAFETY: the caller of `get` promises that only one priority uses the value. Another priority may have
// written it.
unsafe impl<T: Send> Sync for Owned<T> {}

impl<T> Owned<T> {
    pub const fn uninit() -> Self {
        Self(UnsafeCell::new(MaybeUninit::uninit()))
    }

    /// # Safety
    /// No reference to the value is alive.
    #[inline(always)]
    pub unsafe fn write(&'static self, value: T) {
        // SAFETY: the caller promises it.
        unsafe { (*self.0.get()).write(value) };
    }

    /// Writes bytes of zero in place, so that a large value never lies on the stack.
    ///
    /// # Safety
    /// No reference to the value is alive, and bytes of zero are a valid `T`: see [`zeros`].
    pub unsafe fn write_zeros(&'static self) {
        // SAFETY: the caller promises it.
        unsafe { (*self.0.get()).as_mut_ptr().write_bytes(0, 1) };
    }

    /// # Safety
    /// The value was written, and no other reference to it is alive.
    #[expect(clippy::mut_from_ref, reason = "the caller is the only user")]
    pub unsafe fn get(&'static self) -> &'static mut T {
        // SAFETY: the caller promises it.
        unsafe { (*self.0.get()).assume_init_mut() }
    }
}

/// A `T` of zeros. A constant with this value proves that such a `T` is valid: the compiler checks every
/// constant, and refuses a constant whose bytes are not a value of its type.
///
/// # Safety
/// Only a constant may call this function.
pub const unsafe fn zeros<T>() -> T {
    // SAFETY: the compiler checks the value, as described above.
    unsafe { MaybeUninit::zeroed().assume_init() }
}
