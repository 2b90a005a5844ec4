//! Statics that belong to one priority.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;

/// A value in a static, used by one priority only.
pub struct Owned<T>(UnsafeCell<MaybeUninit<T>>);

// SAFETY: whoever calls `get` promises that one priority alone uses the value.
unsafe impl<T> Sync for Owned<T> {}

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

    /// # Safety
    /// No reference to the value is alive, and bytes of zero are a valid `T`.
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
