//! Beams, the windows that roll, and the ways of beams through them.

use super::cell::rounded_down;
use crate::tuning::grid::CELL;
use core::ops::Range;

/// One beam of a lidar in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceBeam {
    /// Unit direction.
    pub direction: [f64; 3],
    /// Range of the return \[m\]; `None` if nothing came back.
    pub range: Option<f64>,
}

/// By how much windows lie behind the aircraft at a course \[rad\]: not at all up to a right angle to the way, 1 against it.
pub(super) fn back(course: f64) -> f64 {
    (-libm::cos(course)).max(0.0)
}

/// The way of a beam along an axis.
pub(super) struct Walk {
    /// Place in the memory, and what a step adds to it, modulo the length: one, or one less than none.
    pub(super) at: usize,
    by: usize,
    /// Steps that stay in the window.
    left: usize,
    /// Distances along the beam: of the next face, and between faces \[m\].
    pub(super) next: f64,
    each: f64,
}

impl Walk {
    /// From a place in the window, whose memory begins at a corner, in a voxel with a side \[m\], by a share of the beam [-].
    pub(super) fn new(
        [corner, at, length]: [usize; 3],
        [side, from]: [f64; 2],
        speed: f64,
    ) -> Self {
        let (next, each, by, left) = if speed > 1e-12 {
            (
                (side + CELL - from) / speed,
                CELL / speed,
                1,
                length - 1 - at,
            )
        } else if speed < -1e-12 {
            ((side - from) / speed, -CELL / speed, length - 1, at)
        } else {
            (f64::INFINITY, f64::INFINITY, 0, 0)
        };
        let at = wrapped(corner + at, length);
        Self {
            at,
            by,
            left,
            next,
            each,
        }
    }

    /// Steps to the next voxel. Returns false outside of the window.
    pub(super) fn step(&mut self, length: usize) -> bool {
        let inside = self.left > 0;
        self.left = self.left.wrapping_sub(1);
        self.at = wrapped(self.at + self.by, length);
        self.next += self.each;
        inside
    }
}

/// Numbers of a window of some length that lie in it after its first one has changed, and did not before.
pub(super) fn entered(old: i64, first: i64, length: usize) -> Range<i64> {
    let length = length as i64;
    if first > old {
        (old + length).max(first)..first + length
    } else {
        first..old.min(first + length)
    }
}

/// The place of a number below twice a length.
pub(super) fn wrapped(at: usize, length: usize) -> usize {
    if at < length { at } else { at - length }
}

/// Number of the voxel that holds a coordinate \[m\]. Coordinates that make no sense are far away.
pub(crate) fn voxel(coordinate: f64) -> i64 {
    rounded_down(coordinate / CELL).into()
}
