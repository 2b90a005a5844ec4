//! A fixed ring of bytes between two priorities.

use core::sync::atomic::{AtomicU8, AtomicU32, AtomicUsize, Ordering};

/// Number of places in the ring; a power of two. A harness in lockstep sends a scan and a sensor frame at
/// a time, which are 600 bytes. An answer is shorter.
pub const PLACES: usize = 1024;
/// Half of the places. A ring that fills up passes this length.
pub const HALF: usize = PLACES / 2;

/// Number of bytes lost because a ring was full.
static LOST: AtomicU32 = AtomicU32::new(0);

/// Number of bytes that all rings have lost since the start.
#[must_use]
pub fn lost() -> u32 {
    LOST.load(Ordering::Relaxed)
}

/// A ring with a single producer and a single consumer. Neither of them ever waits.
pub struct Ring {
    bytes: [AtomicU8; PLACES],
    /// Number of all bytes put in so far, modulo the word size.
    head: AtomicUsize,
    /// Number of all bytes taken out so far, modulo the word size.
    tail: AtomicUsize,
}

impl Ring {
    /// An empty ring.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            bytes: [const { AtomicU8::new(0) }; PLACES],
            head: AtomicUsize::new(0),
            tail: AtomicUsize::new(0),
        }
    }

    /// Puts in bytes. Those for which there is no room, the last ones, are lost. Only the producer may call this
    /// function.
    pub fn push(&self, bytes: &[u8]) {
        let head = self.head.load(Ordering::Relaxed);
        let used = head.wrapping_sub(self.tail.load(Ordering::Acquire));
        let taken = bytes.len().min(PLACES.saturating_sub(used));
        for (index, byte) in bytes.iter().take(taken).enumerate() {
            self.bytes[head.wrapping_add(index) % PLACES].store(*byte, Ordering::Relaxed);
        }
        self.head.store(head.wrapping_add(taken), Ordering::Release);
        let lost = bytes.len().saturating_sub(taken);
        if lost > 0 {
            LOST.fetch_add(lost as u32, Ordering::Relaxed);
        }
    }

    /// Number of bytes in the ring, as the caller's priority sees it.
    pub fn len(&self) -> usize {
        let (head, tail) = (&self.head, &self.tail);
        head.load(Ordering::Relaxed)
            .wrapping_sub(tail.load(Ordering::Relaxed))
    }

    /// Takes out the oldest byte. Only the consumer may call this function.
    pub fn pop(&self) -> Option<u8> {
        let tail = self.tail.load(Ordering::Relaxed);
        if tail == self.head.load(Ordering::Acquire) {
            return None;
        }
        let byte = self.bytes[tail % PLACES].load(Ordering::Relaxed);
        self.tail.store(tail.wrapping_add(1), Ordering::Release);
        Some(byte)
    }
}

impl Default for Ring {
    fn default() -> Self {
        Self::new()
    }
}
