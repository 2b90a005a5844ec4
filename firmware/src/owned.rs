//! Statics that belong to one priority.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;

/// A value in a static, used by one priority only.
pub struct Owned<T>(UnsafeCell<MaybeUninit<T>>);

// SAFETY: whoever calls `get` promises that one priority alone uses the value, which may be another
// than that which wrote it.
unsafe impl<T: Send> Sync for Owned<T> {}

impl<T> Owned<T> {
    pub const fn uninit() -> Self {
        Self(UnsafeCell::new(MaybeUninit::uninit()))
    }

    /// # Safety
    /// No reference to the value is alive.
    #[inline(always)]
    pub unsafe fn write(&'static self, value: T) {
        // SAFETY: as the caller promises.
        unsafe { (*self.0.get()).write(value) };
    }

    /// Writes bytes of zero, in place: a large value never passes over the stack.
    ///
    /// # Safety
    /// No reference to the value is alive, and bytes of zero are a valid `T`: see [`zeros`].
    pub unsafe fn write_zeros(&'static self) {
        // SAFETY: as the caller promises.
        unsafe { (*self.0.get()).as_mut_ptr().write_bytes(0, 1) };
    }

    /// # Safety
    /// The value was written, and no other reference to it is alive.
    #[expect(clippy::mut_from_ref, reason = "the caller is the only user")]
    pub unsafe fn get(&'static self) -> &'static mut T {
        // SAFETY: as the caller promises.
        unsafe { (*self.0.get()).assume_init_mut() }
    }
}

/// A `T` of zeros. As a constant it is the proof that such a `T` is valid: the compiler looks at every
/// constant, and refuses one whose bytes are none of the values of its type.
///
/// # Safety
/// In a constant only.
pub const unsafe fn zeros<T>() -> T {
    // SAFETY: checked by the compiler, as said above.
    unsafe { MaybeUninit::zeroed().assume_init() }
}
