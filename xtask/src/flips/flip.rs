//! The bits that flip.

use std::time::Duration;

/// Seed of the flights. Its bytes are found again in the memory of a core.
pub(crate) const FLIGHT_SEED: u64 = 0x0123_4567_89AB_CDEF;
/// The time that a silent core gets.
pub(crate) const PATIENCE: Duration = Duration::from_secs(10);

/// One bit, and the tick before which it flips.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flip {
    pub(crate) tick: u32,
    /// Place among the bytes in question.
    pub(crate) place: u64,
    pub(crate) bit: u32,
}

/// A generator of random numbers: SplitMix64.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        word ^ (word >> 31)
    }

    pub(crate) fn flip(&mut self, bytes: u64) -> Flip {
        Flip {
            tick: 50 + (self.next() % 350) as u32,
            place: self.next() % bytes.max(1),
            bit: (self.next() % 8) as u32,
        }
    }
}
