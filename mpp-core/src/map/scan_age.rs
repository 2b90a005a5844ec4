//! The age of scans that their stamps hide, found as a generalised likelihood ratio: two consecutive scans are laid over each other
//! by the poses of the past, once for each age, and what one age fits better than the other is summed up over scans.
//!
//! At a steady course every age fits; turns tell them apart.

use crate::tuning::scan_match::{AGES, EXPLAINS, KEPT, MOST_GAIN, OLDER};
use crate::vehicle::{Pose, ScanPoses};

/// The age of scans, and what speaks for another one.
#[derive(Clone, Debug)]
pub(super) struct AgeWatch {
    number: usize,
    /// How much better than the present age each age has fitted lately, as a sum of misfits [-].
    gains: [f64; AGES],
}

impl AgeWatch {
    pub(super) const fn new() -> Self {
        Self {
            number: 0,
            gains: [0.0; AGES],
        }
    }

    pub(super) fn number(&self) -> usize {
        self.number
    }

    pub(super) fn pose<'a>(&self, poses: &'a ScanPoses) -> &'a Pose {
        poses.get(self.number).unwrap_or(&poses[0])
    }

    /// Takes the sum of the misfits of so many returns at each age that is tried.
    #[inline(never)]
    pub(super) fn note(&mut self, misfits: &[f64], returns: f64) {
        let present = misfits.get(self.number).copied().unwrap_or(0.0);
        let (mut likeliest, mut most) = (self.number, OLDER);
        for (number, (gain, misfit)) in self.gains.iter_mut().zip(misfits).enumerate() {
            let better = (present - misfit).min(MOST_GAIN);
            *gain *= KEPT;
            if better < 0.0 || *misfit < EXPLAINS * returns {
                *gain = (*gain + better).max(0.0);
            }
            if *gain > most {
                (likeliest, most) = (number, *gain);
            }
        }
        if likeliest != self.number {
            (self.number, self.gains) = (likeliest, [0.0; AGES]);
        }
    }
}
