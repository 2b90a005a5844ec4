//! The map in space: voxels of occupancy log-odds, which roll with the aircraft.
//!
//! The window goes with the aircraft in x and y. In z it covers a fixed band if the heights of plans lie in it: then the ground
//! is no part of it, and floor and ceiling are rows of programs. Higher bands are flown over terrain: the window goes with the
//! aircraft in z, too, and the ground is what hits show of it.

use super::evidence::{Change, Evidence, LAYERS, PASSED_ONCE, STEP_UP, UNANSWERED_ONCE};
use super::extent::Extent;
use super::level_grid::LevelGrid;
use super::walk::{SpaceBeam, Walk, back, entered, voxel, wrapped};
use crate::tuning::grid::{
    CELL, HIT_DOUBT, PASSED, PASSED_UNANSWERED, RANGE_DOUBT, UNANSWERED_SHARE,
};

/// Number of voxels along x, y and z.
pub const CELLS: [usize; 3] = [100, 96, LAYERS];
/// Voxels behind the aircraft, and to its left, that the window keeps.
const BEHIND: [i64; 2] = [8, CELLS[1] as i64 / 2];
/// Voxels behind an aircraft that flies backwards on top of these. More holds more of what is ahead of it then, and less of the way.
/// Source: decision 76.
const BACK: f64 = 60.0;
/// Voxels by which the aircraft may be off the middle of the window in z before it rolls. Less rolls to and fro, more sees less
/// of one side.
const OFF_MIDDLE: i64 = 4;
/// Most voxels that one beam passes: the window's extent along all axes.
const MOST_STEPS: usize = CELLS[0] + CELLS[1] + CELLS[2];

/// Occupancy log-odds of the voxels around the aircraft.
#[derive(Clone, Debug)]
pub struct VoxelGrid {
    /// By x and y, each modulo its length.
    evidence: [[Evidence; CELLS[1]]; CELLS[0]],
    /// Voxels that this scan has hit: a bit for each z.
    hit: [[u32; CELLS[1]]; CELLS[0]],
    /// What hits show of each column.
    extents: [[Extent; CELLS[1]]; CELLS[0]],
    /// First x and y in the window, in voxels, and where they lie in the memory.
    first: [i64; 2],
    corner: [usize; 2],
    /// First z in the window, in voxels, and whether it goes with the aircraft.
    floor: i64,
    follows: bool,
    /// Where the beams of this scan begin \[m\]. In the window also the voxel there, by axis: its place and its first side \[m\].
    origin: [f64; 3],
    begun: Option<[(usize, f64); 3]>,
    level: LevelGrid,
}

impl VoxelGrid {
    /// A map that knows nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            evidence: [[Evidence::NONE; CELLS[1]]; CELLS[0]],
            hit: [[0; CELLS[1]]; CELLS[0]],
            extents: [[Extent::FULL; CELLS[1]]; CELLS[0]],
            first: [0; 2],
            corner: [0; 2],
            floor: 0,
            follows: false,
            origin: [0.0; 3],
            begun: None,
            level: LevelGrid::new(),
        }
    }

    /// Forgets everything, and begins at this x \[m\] and y = 0, over level ground.
    pub fn clear(&mut self, x: f64) {
        (self.floor, self.follows) = (0, false);
        self.evidence.as_flattened_mut().fill(Evidence::NONE);
        self.extents.as_flattened_mut().fill(Extent::FULL);
        self.level.clear(x);
        self.place_window([voxel(x) - BEHIND[0], -BEHIND[1]]);
    }

    /// Whether a window goes with the aircraft in z: where plans have heights beyond one that begins at z = 0 \[m\].
    pub(crate) fn follows([low, high]: &[f64; 2]) -> bool {
        *low < 0.0 || *high > CELLS[2] as f64 * CELL
    }

    /// After [`clear`](Self::clear): takes the heights of plans \[m\], beyond which nothing need be known.
    pub fn cover(&mut self, heights: &[f64; 2], altitude: f64) {
        self.follows = Self::follows(heights);
        self.level.set_height(altitude);
    }

    /// First z in the window, in voxels.
    pub(super) fn floor(&self) -> i64 {
        self.floor
    }

    /// First x in the window, in voxels.
    #[must_use]
    pub fn first(&self) -> i64 {
        self.first[0]
    }

    /// Takes up a scan from a position \[m\], by a lidar with the range `sight` \[m\]. The beams are passed twice: first for
    /// their hits, then for what they passed.
    pub fn insert(
        &mut self,
        position: &[f64; 3],
        beams: impl Iterator<Item = SpaceBeam> + Clone,
        sight: f64,
    ) {
        self.begin(position, 0.0);
        beams.clone().for_each(|beam| self.mark(&beam));
        beams.for_each(|beam| self.pass(&beam, sight));
    }

    /// Begins a scan from a position \[m\], at a course \[rad\].
    pub fn begin(&mut self, position: &[f64; 3], course: f64) {
        self.roll(position, back(course));
        let [_, _, z] = position;
        self.climb(*z);
        self.hit.as_flattened_mut().fill(0);
        self.level.begin(position);
        self.origin = *position;
        let firsts = [self.first[0], self.first[1], self.floor];
        let begun: [_; 3] = core::array::from_fn(|axis| {
            let at = voxel(position[axis]);
            (at.wrapping_sub(firsts[axis]) as u64, at as f64 * CELL)
        });
        let inside = begun
            .iter()
            .zip(CELLS)
            .all(|((at, _), length)| *at < length as u64);
        self.begun = inside.then_some(begun.map(|(at, side)| (at as usize, side)));
    }

    /// Moves the window in x and y. A jump beyond the window clears all of it, and no more than that.
    fn roll(&mut self, [x, y, _]: &[f64; 3], back: f64) {
        let [length, width] = [CELLS[0] as i64, CELLS[1] as i64];
        let [old, side] = self.first;
        let first = voxel(*x) - BEHIND[0] - libm::round(BACK * back) as i64;
        for x in entered(old, first, CELLS[0]) {
            let at = x.rem_euclid(length) as usize;
            if let (Some(evidence), Some(extents)) =
                (self.evidence.get_mut(at), self.extents.get_mut(at))
            {
                evidence.fill(Evidence::NONE);
                extents.fill(Extent::FULL);
            }
        }
        let left = voxel(*y) - BEHIND[1];
        for y in entered(side, left, CELLS[1]) {
            let at = y.rem_euclid(width) as usize;
            for (evidence, extents) in self.evidence.iter_mut().zip(&mut self.extents) {
                if let (Some(evidence), Some(extent)) = (evidence.get_mut(at), extents.get_mut(at))
                {
                    (*evidence, *extent) = (Evidence::NONE, Extent::FULL);
                }
            }
        }
        self.place_window([first, left]);
    }

    /// Moves the window in z by whole steps, so that the aircraft is near its middle.
    fn climb(&mut self, z: f64) {
        let off = voxel(z) - self.floor - CELLS[2] as i64 / 2;
        if !self.follows || off.abs() <= OFF_MIDDLE {
            return;
        }
        let steps = (off + off.signum() * STEP_UP as i64 / 2) / STEP_UP as i64;
        self.floor += steps * STEP_UP as i64;
        // After so many steps nothing is left.
        let most = CELLS[2].div_ceil(STEP_UP) as u64;
        let (up, steps) = (steps > 0, steps.unsigned_abs().min(most) as u32);
        let columns = self.evidence.as_flattened_mut().iter_mut();
        columns.for_each(|column| column.roll(up, steps));
    }

    fn place_window(&mut self, first: [i64; 2]) {
        let at = |axis: usize| first[axis].rem_euclid(CELLS[axis] as i64) as usize;
        (self.first, self.corner) = (first, [at(0), at(1)]);
    }

    /// Places of a column in the window.
    fn place(&self, x: i64, y: i64) -> Option<[usize; 2]> {
        let ([first, left], [corner_x, corner_y]) = (self.first, self.corner);
        // A number below zero is a very large one here.
        let (x, y) = ((x - first) as u64, (y - left) as u64);
        (x < CELLS[0] as u64 && y < CELLS[1] as u64).then(|| {
            [
                wrapped(corner_x + x as usize, CELLS[0]),
                wrapped(corner_y + y as usize, CELLS[1]),
            ]
        })
    }

    /// Marks what a beam has hit. All beams of a scan are marked before the first one [passes](Self::pass).
    pub fn mark(&mut self, beam: &SpaceBeam) {
        let Some(range) = beam.range else {
            return;
        };
        let end = core::array::from_fn(|axis| self.origin[axis] + range * beam.direction[axis]);
        self.level.mark(&end);
        let [x, y, z] = end.map(voxel);
        // Of level ground the lowest layer is the ground's.
        let (z, least) = (z - self.floor, i64::from(!self.follows));
        let Some([x, y]) = self
            .place(x, y)
            .filter(|_| (least..CELLS[2] as i64).contains(&z))
        else {
            return;
        };
        if let (Some(evidence), Some(hit), Some(extent)) = (
            column(&mut self.evidence, x, y),
            column(&mut self.hit, x, y),
            column(&mut self.extents, x, y),
        ) {
            evidence.hit(z as usize);
            *hit |= 1 << z;
            extent.take(&end, range);
        }
    }

    /// Lowers the evidence of the voxels that a beam passes.
    pub fn pass(&mut self, beam: &SpaceBeam, sight: f64) {
        let (end, change, less) = match beam.range {
            // The last voxels before a hit may hold the obstacle: the attitude is not exact.
            Some(range) => {
                let end = range * (1.0 - RANGE_DOUBT) - HIT_DOUBT;
                (end, &PASSED_ONCE, PASSED)
            }
            None => (
                UNANSWERED_SHARE * sight,
                &UNANSWERED_ONCE,
                PASSED_UNANSWERED,
            ),
        };
        self.pass_until(&beam.direction, end, change);
        self.level.pass(&self.origin, &beam.direction, end, less);
    }

    /// Changes the voxels on the first `end` metres of a beam, by steps from face to face (Amanatides, Woo: "A fast voxel
    /// traversal algorithm for ray tracing", 1987).
    // Not inlined, so that the numbers of its loop stay in registers.
    #[inline(never)]
    fn pass_until(&mut self, direction: &[f64; 3], end: f64, change: &Change) {
        let Some(begun) = self.begun else {
            return;
        };
        let (from, corner) = (self.origin, [self.corner[0], self.corner[1], 0]);
        let [mut x, mut y, mut z] = core::array::from_fn(|axis| {
            let (at, side) = begun[axis];
            Walk::new(
                [corner[axis], at, CELLS[axis]],
                [side, from[axis]],
                direction[axis],
            )
        });
        let (evidence, hit) = (self.evidence.as_flattened_mut(), self.hit.as_flattened());
        // Steps to the sides that come before this distance need no other test.
        let past = end.next_up();
        let (mut bit, mut codes, mut soon) = (1 << z.at, &change[z.at % 2], z.next.min(past));
        for _ in 0..MOST_STEPS {
            let column = x.at * CELLS[1] + y.at;
            let (Some(evidence), Some(hit)) = (evidence.get_mut(column), hit.get(column)) else {
                return;
            };
            if hit & bit == 0 {
                evidence.pass(z.at / 2, codes);
            }
            let ahead = x.next < y.next;
            let goes_on = if (if ahead { x.next } else { y.next }) >= soon {
                let goes_on = soon < past && z.step(CELLS[2]);
                (bit, codes, soon) = (1 << z.at, &change[z.at % 2], z.next.min(past));
                goes_on
            } else if ahead {
                x.step(CELLS[0])
            } else {
                y.step(CELLS[1])
            };
            if !goes_on {
                return;
            }
        }
    }

    /// Whether something on the level of flight is known within a distance \[m\] along x and y; `None` beyond the window.
    #[must_use]
    pub fn is_met(&self, point: &[f64; 3], reach: f64) -> Option<bool> {
        self.level.is_met(point, reach)
    }

    /// Whether a point on the level of flight has been seen, and nothing is known within a distance \[m\] along x and y.
    #[must_use]
    pub fn is_free(&self, point: &[f64; 3], reach: f64) -> bool {
        self.level.is_free(point, reach)
    }

    /// Whether beams have passed a point, or half a metre above or below it.
    #[must_use]
    pub fn has_seen(&self, point: &[f64; 3]) -> bool {
        let [x, y, z] = point.map(voxel);
        let layer = z - self.floor;
        if !(0..LAYERS as i64).contains(&layer) {
            return false;
        }
        let near = (7_u64 << layer >> 1) as u32;
        let ([_, unknown], _) = self.column(x, y);
        unknown & near != near
    }

    /// Occupied and unknown voxels of the column at an x and y in voxels, a bit for each z, and what hits show of it. Outside of
    /// the window nothing is known. Over terrain what is below a hit counts as occupied as far as nobody has seen it.
    pub(super) fn column(&self, x: i64, y: i64) -> ([u32; 2], Extent) {
        let found = self.place(x, y).and_then(|[x, y]| {
            let evidence = self.evidence.get(x)?.get(y)?;
            let [occupied, unknown] = evidence.bits();
            let occupied = if self.follows {
                filled(occupied, unknown)
            } else {
                occupied
            };
            let bits = [occupied, unknown & !occupied];
            Some((bits, *self.extents.get(x)?.get(y)?))
        });
        found.unwrap_or(([0, u32::MAX], Extent::FULL))
    }
}

/// Bits, and all those that follow below one of them in a row of bits that may be filled.
fn filled(bits: u32, may_be: u32) -> u32 {
    let (mut filled, mut may_be) = (bits, may_be);
    for by in [1, 2, 4, 8, 16] {
        filled |= may_be & filled >> by;
        may_be &= may_be >> by;
    }
    filled
}

fn column<T, const Y: usize>(all: &mut [[T; Y]], x: usize, y: usize) -> Option<&mut T> {
    all.get_mut(x)?.get_mut(y)
}

#[cfg(test)]
mod tests;
