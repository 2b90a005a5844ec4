//! Occupancy log-odds of the voxels of a column, four bits each.

use super::extent::STOREYS;
use crate::tuning::grid::{FREE, HIT, LIMIT, OCCUPIED, PASSED, PASSED_UNANSWERED};

/// Voxels of a column. A word has a bit for each.
pub(super) const LAYERS: usize = 32;
/// Voxels by which a window rolls in height: as many as share the heights of hits, so that they stay in their places.
pub(super) const STEP_UP: usize = STOREYS;
/// Log-odds of a step: all numbers of the map in the plane are whole steps, but for the limit of free cells.
const STEP: i8 = 10;
const _: () = assert!(
    HIT % STEP == 0 && LIMIT % STEP == 0 && PASSED % STEP == 0 && PASSED_UNANSWERED % STEP == 0
);
/// Greatest steps against an obstacle, and for one.
const LEAST: i8 = -(FREE / STEP);
const MOST: i8 = LIMIT / STEP;
// Sixteen codes hold all steps, and one hit makes any voxel occupied.
const _: () = assert!(MOST - LEAST < 16 && (LEAST + HIT / STEP) * STEP >= OCCUPIED);

/// What a beam does to the codes of the lower and of the upper voxel of a pair, by the byte of the pair. A code is the number of
/// steps, modulo 16.
pub(super) type Change = [[u8; 256]; 2];
pub(super) static PASSED_ONCE: Change = change(-PASSED);
pub(super) static UNANSWERED_ONCE: Change = change(-PASSED_UNANSWERED);

/// Steps of a code.
const fn steps(code: usize) -> i8 {
    if code as i8 > MOST {
        code as i8 - 16
    } else {
        code as i8
    }
}

/// The code after a change of the log-odds, within the limits. It is never 0, because 0 means that no beam has seen the voxel.
const fn changed(code: usize, log_odds: i8) -> usize {
    let sum = steps(code) + log_odds / STEP;
    let sum = if sum > MOST {
        MOST
    } else if sum < LEAST {
        LEAST
    } else if sum == 0 {
        -1
    } else {
        sum
    };
    (sum & 15) as usize
}

const fn change(log_odds: i8) -> Change {
    let mut pairs = [[0; 256]; 2];
    let mut byte = 0;
    while byte < 256 {
        let [low, high] = [byte & 15, byte >> 4];
        pairs[0][byte] = (changed(low, log_odds) | high << 4) as u8;
        pairs[1][byte] = (low | changed(high, log_odds) << 4) as u8;
        byte += 1;
    }
    pairs
}

/// For two codes in a byte: which of them are occupied, and from the third bit on which are unknown.
const PAIRS: [u8; 256] = {
    let mut pairs = [0; 256];
    let mut byte = 0;
    while byte < pairs.len() {
        let codes = [byte & 15, byte >> 4];
        let mut half = 0;
        while half < 2 {
            let code = codes[half];
            pairs[byte] |= ((steps(code) * STEP >= OCCUPIED) as u8) << half;
            pairs[byte] |= ((code == 0) as u8) << (2 + half);
            half += 1;
        }
        byte += 1;
    }
    pairs
};

/// The evidence of a column: two voxels a byte, from the ground upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Evidence([u8; LAYERS / 2]);

impl Evidence {
    /// No beam has seen a voxel.
    pub(super) const NONE: Self = Self([0; LAYERS / 2]);

    /// Adds a hit to the voxel at a height.
    pub(super) fn hit(&mut self, z: usize) {
        if let Some(codes) = self.0.get_mut(z / 2) {
            let shift = z % 2 * 4;
            let code = *codes >> shift & 15;
            *codes ^= (code ^ changed(code.into(), HIT) as u8) << shift;
        }
    }

    /// Changes a voxel, by its pair and the part of the change for its place there.
    pub(super) fn pass(&mut self, pair: usize, change: &[u8; 256]) {
        if let Some(codes) = self.0.get_mut(pair) {
            *codes = change[usize::from(*codes)];
        }
    }

    /// Moves the window up or down by steps of [`STEP_UP`] voxels, and forgets those that leave it.
    pub(super) fn roll(&mut self, up: bool, steps: u32) {
        let (bits, by) = (u128::from_le_bytes(self.0), steps * 4 * STEP_UP as u32);
        let moved = if up {
            bits.checked_shr(by)
        } else {
            bits.checked_shl(by)
        };
        self.0 = moved.unwrap_or(0).to_le_bytes();
    }

    /// Occupied and unknown voxels: a bit for each z.
    pub(super) fn bits(&self) -> [u32; 2] {
        let (mut occupied, mut unknown) = (0, 0);
        for pair in self.0.iter().rev() {
            let found = PAIRS.get(usize::from(*pair)).copied().unwrap_or(0);
            occupied = occupied << 2 | u32::from(found & 3);
            unknown = unknown << 2 | u32::from(found >> 2);
        }
        [occupied, unknown]
    }
}

#[cfg(test)]
mod tests {
    use super::{Evidence, PASSED_ONCE, UNANSWERED_ONCE};

    /// The voxel at a height after hits, and beams that passed it.
    fn after(beams: &[Option<&super::Change>]) -> [u32; 2] {
        let mut column = Evidence::NONE;
        for beam in beams {
            match beam {
                Some(change) => column.pass(2, &change[1]),
                None => column.hit(5),
            }
        }
        let [occupied, unknown] = column.bits();
        // No other voxel changes.
        assert_eq!((occupied & !32, unknown | 32), (0, u32::MAX));
        [occupied >> 5, unknown >> 5 & 1]
    }

    #[test]
    fn hits_and_passes_add_up_within_the_limits() {
        let (hit, passed, unanswered) = (None, Some(&PASSED_ONCE), Some(&UNANSWERED_ONCE));
        assert_eq!(after(&[]), [0, 1]);
        assert_eq!(after(&[hit]), [1, 0]);
        assert_eq!(after(&[hit, passed]), [1, 0]);
        // Free, but seen.
        assert_eq!(after(&[hit, passed, passed]), [0, 0]);
        assert_eq!(after(&[passed; 40]), [0, 0]);
        // However many have passed: one hit.
        assert_eq!(after(&[&[passed; 40][..], &[hit]].concat()), [1, 0]);
        // However many have hit: three passes, or eight of beams without return.
        assert_eq!(after(&[&[hit; 40][..], &[passed; 2]].concat()), [1, 0]);
        assert_eq!(after(&[&[hit; 40][..], &[passed; 3]].concat()), [0, 0]);
        assert_eq!(after(&[&[hit; 40][..], &[unanswered; 7]].concat()), [1, 0]);
        assert_eq!(after(&[&[hit; 40][..], &[unanswered; 8]].concat()), [0, 0]);
    }
}
