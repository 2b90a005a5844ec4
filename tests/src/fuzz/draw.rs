//! Random numbers with a liking for the edges.

use chacha20::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// A generator that gives the same numbers for the same seed and round.
pub(super) struct Draw {
    generator: ChaCha8Rng,
    /// Whether numbers are plausible without exception.
    pub(super) tame: bool,
}

impl Draw {
    pub(super) fn new(seed: u64, round: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(round);
        Self {
            generator,
            tame: false,
        }
    }

    /// 64 random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// A whole number below a bound.
    pub(super) fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound.max(1) as u64) as usize
    }

    /// Whether something happens that happens once in so many times.
    pub(super) fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    /// A number near a plausible one, or an edge, or any bits.
    pub(super) fn number(&mut self, plausible: f64) -> f64 {
        const EDGES: [f64; 12] = [
            0.0,
            -0.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN,
            5e-324,
            f64::MIN_POSITIVE,
            -1.0,
            1e9,
            4_294_967_296.0,
        ];
        match self.below(16) {
            _ if self.tame => plausible,
            0 => EDGES[self.below(EDGES.len())],
            1 => f64::from_bits(self.bits()),
            2 => plausible * 10.0_f64.powi(self.below(13) as i32 - 6),
            _ => plausible * (0.9 + 0.2 * (self.below(1000) as f64) / 1000.0),
        }
    }

    /// A count near a plausible one, or an edge, or any bits.
    pub(super) fn count(&mut self, plausible: u32) -> u32 {
        match self.below(12) {
            _ if self.tame => plausible,
            0 => 0,
            1 => u32::MAX,
            2 => self.bits() as u32,
            3 => plausible.wrapping_add(1),
            4 => plausible.wrapping_sub(1),
            _ => plausible,
        }
    }

    /// Random bytes, at most so many.
    pub(super) fn bytes(&mut self, most: usize) -> Vec<u8> {
        (0..self.below(most + 1))
            .map(|_| self.bits() as u8)
            .collect()
    }

    /// Flips, drops, doubles or cuts some bytes.
    pub(super) fn damage(&mut self, bytes: &mut Vec<u8>) {
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            match self.below(5) {
                _ if bytes.is_empty() => bytes.push(self.bits() as u8),
                0 => bytes[at] ^= 1 << self.below(8),
                1 => bytes[at] = self.bits() as u8,
                2 => drop(bytes.remove(at)),
                3 => bytes.insert(at, self.bits() as u8),
                _ => bytes.truncate(at),
            }
        }
    }
}
