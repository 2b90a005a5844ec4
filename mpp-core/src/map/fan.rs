//! What the beams of a scan show as a fan: its sectors, and what returns where.

use super::rolling_grid::is_return;
use crate::sense::LidarScan;
use crate::tuning::scan_match::{OFF, OFF_SHARE, SECTORS};

/// Whether a beam of each sector has returned.
#[inline(never)]
pub(super) fn answers(scan: &LidarScan, sight: f64) -> [bool; SECTORS] {
    let mut answers = [false; SECTORS];
    for (beam, range) in scan.ranges.iter().enumerate() {
        answers[sector(beam, scan.ranges.len())] |= is_return(f64::from(*range), sight);
    }
    answers
}

/// Whether a beam returns from beneath the body axis.
pub(crate) fn sees_below(scan: &LidarScan, sight: f64) -> bool {
    let mut ranges = scan.ranges.iter().enumerate();
    ranges.any(|(beam, range)| is_return(f64::from(*range), sight) && scan.beam_angle(beam) < 0.0)
}

/// The farthest return of a scan \[m\]; 0 without one.
#[inline(never)]
pub(super) fn farthest(scan: &LidarScan, sight: f64) -> f64 {
    let ranges = scan.ranges.iter().map(|range| f64::from(*range));
    ranges
        .filter(|range| is_return(*range, sight))
        .fold(0.0, f64::max)
}

/// Whether a beam from `first - 1` to `first + 2` returns from an expected range \[m\]. It is `None` if none does and something
/// nearer hides what was expected, or a beam is bad.
pub(super) fn met(
    scan: &LidarScan,
    sight: f64,
    first: usize,
    expected: f64,
    reversed: bool,
) -> Option<bool> {
    let off = OFF + OFF_SHARE * expected;
    let mut hidden = false;
    // Of `len` beams `len - 1 - beam` is `len + !beam`. With a branch the loop would be compiled twice.
    let (turned, end) = if reversed {
        (usize::MAX, scan.ranges.len())
    } else {
        (0, 0)
    };
    for beam in first.saturating_sub(1)..first + 3 {
        let sent = (beam ^ turned).wrapping_add(end);
        let range = scan.ranges.get(sent).map_or(0.0, |range| f64::from(*range));
        if is_return(range, sight) {
            if libm::fabs(range - expected) < off {
                return Some(true);
            }
            hidden |= range < expected;
        }
        hidden |= range < 0.0;
    }
    (!hidden).then_some(false)
}

/// The sector of a beam among so many.
pub(super) fn sector(beam: usize, beams: usize) -> usize {
    (beam * SECTORS / beams.max(1)) % SECTORS
}
