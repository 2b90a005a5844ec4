//! A fixed ring of bytes between two priorities.

use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

/// Places in the ring; a power of two. A harness in lockstep has a scan and a sensor frame under
/// way, 600 bytes; an answer is shorter.
const PLACES: usize = 1024;
/// Half of them: a ring that fills comes by here.
pub const HALF: usize = PLACES / 2;

/// Single producer, single consumer; no one ever waits.
pub struct Ring {
    bytes: [AtomicU8; PLACES],
    /// Bytes ever put in, modulo the word.
    head: AtomicUsize,
    /// Bytes ever taken out, modulo the word.
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

    /// Puts a byte in; false if there is no room. Only for the producer.
    pub fn push(&self, byte: u8) -> bool {
        let head = self.head.load(Ordering::Relaxed);
        if head.wrapping_sub(self.tail.load(Ordering::Acquire)) == PLACES {
            return false;
        }
        self.bytes[head % PLACES].store(byte, Ordering::Relaxed);
        self.head.store(head.wrapping_add(1), Ordering::Release);
        true
    }

    /// Places taken, as far as the caller's priority sees.
    pub fn len(&self) -> usize {
        let (head, tail) = (&self.head, &self.tail);
        head.load(Ordering::Relaxed)
            .wrapping_sub(tail.load(Ordering::Relaxed))
    }

    /// Takes the oldest byte out. Only for the consumer.
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
