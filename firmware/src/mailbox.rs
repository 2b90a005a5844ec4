//! One letter from one priority to another. (`heapless`'s queue divides by its length, which it has
//! forgotten by then: a path to a panic.)

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};

/// Single producer, single consumer; no one ever waits.
pub struct Mailbox<T> {
    full: AtomicBool,
    letter: UnsafeCell<Option<T>>,
}

// SAFETY: the producer has the letter to itself while the box is not full, the consumer while it is;
// `full` hands it over. Both are one priority each, as `post` and `take` demand.
unsafe impl<T: Send> Sync for Mailbox<T> {}

impl<T> Mailbox<T> {
    /// An empty box.
    pub const fn new() -> Self {
        Self {
            full: AtomicBool::new(false),
            letter: UnsafeCell::new(None),
        }
    }

    /// Whether a letter waits to be taken.
    pub fn is_full(&self) -> bool {
        self.full.load(Ordering::Acquire)
    }

    /// Posts a letter; drops it if the box is full, so look first.
    ///
    /// # Safety
    /// Only from the producer's priority.
    pub unsafe fn post(&self, letter: T) {
        if !self.is_full() {
            // SAFETY: the box is not full, so the letter is the producer's.
            unsafe { *self.letter.get() = Some(letter) };
            self.full.store(true, Ordering::Release);
        }
    }

    /// Takes the letter that waits.
    ///
    /// # Safety
    /// Only from the consumer's priority.
    pub unsafe fn take(&self) -> Option<T> {
        if !self.is_full() {
            return None;
        }
        // SAFETY: the box is full, so the letter is the consumer's.
        let letter = unsafe { (*self.letter.get()).take() };
        self.full.store(false, Ordering::Release);
        letter
    }
}
