//! A mailbox for one letter from one priority to another. The queue of `heapless` is not used here: it
//! divides by its length, which the compiler does not know there, and this is a path to a panic.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

/// A mailbox with a single producer and a single consumer. Neither of them ever waits.
pub struct Mailbox<T> {
    full: AtomicBool,
    letter: UnsafeCell<MaybeUninit<T>>,
}

// SAFETY: only the producer uses the letter while the box is not full, and only the consumer while it is
// full; `full` hands the letter over, and a full box holds one. Each of them is one priority, as `post` and `take` demand.
unsafe impl<T: Send> Sync for Mailbox<T> {}

impl<T> Mailbox<T> {
    /// An empty box.
    pub const fn new() -> Self {
        Self {
            full: AtomicBool::new(false),
            letter: UnsafeCell::new(MaybeUninit::uninit()),
        }
    }

    /// Whether a letter waits to be taken.
    pub fn is_full(&self) -> bool {
        self.full.load(Ordering::Acquire)
    }

    /// Posts a letter. The function drops the letter if the box is full, so the caller must check first.
    ///
    /// # Safety
    /// Only the producer's priority may call this function.
    pub unsafe fn post(&self, letter: T) {
        if !self.is_full() {
            // SAFETY: the box is not full, so the letter is the producer's.
            unsafe { (*self.letter.get()).write(letter) };
            self.full.store(true, Ordering::Release);
        }
    }

    /// Reads the letter that waits, in place, and takes it out.
    ///
    /// # Safety
    /// Only the consumer's priority may call this function.
    pub unsafe fn read<R>(&self, read: impl FnOnce(&T) -> R) -> Option<R> {
        if !self.is_full() {
            return None;
        }
        // SAFETY: the box is full, so the letter is the consumer's.
        let result = unsafe { read((*self.letter.get()).assume_init_ref()) };
        // SAFETY: the same; nobody reads the letter again.
        unsafe { (*self.letter.get()).assume_init_drop() };
        self.full.store(false, Ordering::Release);
        Some(result)
    }

    /// Takes the letter that waits.
    ///
    /// # Safety
    /// Only the consumer's priority may call this function.
    pub unsafe fn take(&self) -> Option<T> {
        if !self.is_full() {
            return None;
        }
        // SAFETY: the box is full, so the letter is the consumer's.
        let letter = unsafe { (*self.letter.get()).assume_init_read() };
        self.full.store(false, Ordering::Release);
        Some(letter)
    }
}
