//! The map in space: voxels of occupancy log-odds, which roll ahead with the aircraft.
//!
//! The window is `CELLS[0]` voxels long in x and covers a fixed band in y and z. The ground is no part of it: floor and ceiling
//! are rows of programs.

use super::extent::Extent;
use super::rolling_grid::updated;
use crate::tuning::grid::{
    CELL, HIT, HIT_DOUBT, PASSED, PASSED_UNANSWERED, RANGE_DOUBT, UNANSWERED_SHARE,
};
use crate::vehicle::between;

/// Number of voxels along x, y and z. A column along z is one word of bits.
pub const CELLS: [usize; 3] = [128, 128, 32];
/// Voxels behind the aircraft that the window keeps.
const BEHIND: i64 = 16;
/// Row of y = 0.
const MIDDLE: i64 = CELLS[1] as i64 / 2;
/// Most voxels that one beam passes: the window's extent along all axes.
const MOST_STEPS: usize = CELLS[0] + CELLS[1] + CELLS[2];

/// One beam of a lidar in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceBeam {
    /// Unit direction.
    pub direction: [f64; 3],
    /// Range of the return \[m\]; `None` if nothing came back.
    pub range: Option<f64>,
}

/// Occupancy log-odds of the voxels around the aircraft.
#[derive(Clone, Debug)]
pub struct VoxelGrid {
    /// By x modulo the length, y and z; 0 is unknown, positive occupied.
    evidence: [[[i8; CELLS[2]]; CELLS[1]]; CELLS[0]],
    /// Voxels that this scan has hit: a bit for each z.
    hit: [[u32; CELLS[1]]; CELLS[0]],
    /// What hits show of each column.
    extents: [[Extent; CELLS[1]]; CELLS[0]],
    /// First x in the window, in voxels.
    first: i64,
}

impl VoxelGrid {
    /// A map that knows nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            evidence: [[[0; CELLS[2]]; CELLS[1]]; CELLS[0]],
            hit: [[0; CELLS[1]]; CELLS[0]],
            extents: [[Extent::FULL; CELLS[1]]; CELLS[0]],
            first: 0,
        }
    }

    /// Forgets everything, and begins at this x \[m\].
    pub fn clear(&mut self, x: f64) {
        for slice in &mut self.evidence {
            slice.as_flattened_mut().fill(0);
        }
        self.extents.as_flattened_mut().fill(Extent::FULL);
        self.first = voxel(x) - BEHIND;
    }

    /// First x in the window, in voxels.
    #[must_use]
    pub fn first(&self) -> i64 {
        self.first
    }

    /// Takes up a scan from a position \[m\], by a lidar with the range `sight` \[m\]. The beams are passed twice: first for
    /// their hits, then for what they passed.
    pub fn insert(
        &mut self,
        position: &[f64; 3],
        beams: impl Iterator<Item = SpaceBeam> + Clone,
        sight: f64,
    ) {
        self.roll(position[0]);
        for slice in &mut self.hit {
            slice.fill(0);
        }
        for beam in beams.clone() {
            if let Some(range) = beam.range {
                let end =
                    core::array::from_fn(|axis| position[axis] + range * beam.direction[axis]);
                self.mark(&end, range);
            }
        }
        for beam in beams {
            let (end, miss) = match beam.range {
                // The last voxels before a hit may hold the obstacle: the attitude is not exact.
                Some(range) => (range * (1.0 - RANGE_DOUBT) - HIT_DOUBT, PASSED),
                None => (UNANSWERED_SHARE * sight, PASSED_UNANSWERED),
            };
            self.pass(position, &beam.direction, end, miss);
        }
    }

    fn roll(&mut self, x: f64) {
        let first = voxel(x) - BEHIND;
        let length = CELLS[0] as i64;
        // A jump beyond the window clears all of it, and no more than that.
        for x in (self.first + length).max(first)..(first + length) {
            let at = x.rem_euclid(length) as usize;
            if let Some(slice) = self.evidence.get_mut(at) {
                slice.as_flattened_mut().fill(0);
            }
            if let Some(slice) = self.extents.get_mut(at) {
                slice.fill(Extent::FULL);
            }
        }
        self.first = self.first.max(first);
    }

    /// Places of a voxel in the window.
    fn place(&self, [x, y, z]: [i64; 3]) -> Option<[usize; 3]> {
        let inside = x >= self.first && x < self.first + CELLS[0] as i64;
        let [_, rows, layers] = CELLS.map(|cells| cells as i64);
        let y = y + MIDDLE;
        let inside = inside && (0..rows).contains(&y) && (0..layers).contains(&z);
        inside.then(|| {
            [
                x.rem_euclid(CELLS[0] as i64) as usize,
                y as usize,
                z as usize,
            ]
        })
    }

    fn mark(&mut self, point: &[f64; 3], range: f64) {
        let at = point.map(voxel);
        // The lowest layer is the ground's.
        let Some([x, y, z]) = self.place(at).filter(|[_, _, z]| *z > 0) else {
            return;
        };
        if let (Some(evidence), Some(hit)) = (
            cell(&mut self.evidence, x, y, z),
            column(&mut self.hit, x, y),
        ) {
            *evidence = updated(*evidence, HIT);
            *hit |= 1 << z;
        }
        let extent = self.extents.get_mut(x).and_then(|slice| slice.get_mut(y));
        if let Some(extent) = extent {
            extent.take(point, range);
        }
    }

    /// Lowers the evidence of the voxels that a beam passes on its first `end` metres, by steps from face to face (Amanatides,
    /// Woo: "A fast voxel traversal algorithm for ray tracing", 1987).
    fn pass(&mut self, from: &[f64; 3], direction: &[f64; 3], end: f64, miss: i8) {
        let start = from.map(voxel);
        // Small numbers from the corner of the window: the loop runs for every voxel of every beam.
        let first = self.first.rem_euclid(CELLS[0] as i64) as usize;
        let (Some(_), [x, y, z]) = (self.place(start), start) else {
            return;
        };
        let mut at = [x - self.first, y + MIDDLE, z].map(|it| it as i32);
        let mut next = [f64::INFINITY; 3];
        let mut each = [f64::INFINITY; 3];
        let mut step = [-1; 3];
        for axis in 0..3 {
            let speed = direction[axis];
            let corner = start[axis] as f64 * CELL;
            if speed > 1e-12 {
                (each[axis], next[axis]) = (CELL / speed, (corner + CELL - from[axis]) / speed);
                step[axis] = 1;
            } else if speed < -1e-12 {
                (each[axis], next[axis]) = (-CELL / speed, (corner - from[axis]) / speed);
            }
        }
        for _ in 0..MOST_STEPS {
            let [x, y, z] = at.map(|it| it as usize);
            // A number below zero is a very large one here.
            if x >= CELLS[0] || y >= CELLS[1] || z >= CELLS[2] {
                return;
            }
            let x = (first + x) % CELLS[0];
            let hit = column(&mut self.hit, x, y).is_some_and(|hit| *hit >> z & 1 == 1);
            if let Some(evidence) = cell(&mut self.evidence, x, y, z).filter(|_| !hit) {
                *evidence = updated(*evidence, -miss);
            }
            let axis = if next[0] < next[1] {
                if next[0] < next[2] { 0 } else { 2 }
            } else if next[1] < next[2] {
                1
            } else {
                2
            };
            if next[axis] > end {
                return;
            }
            at[axis] += step[axis];
            next[axis] += each[axis];
        }
    }

    /// The evidence of the column at a voxel's x and row; `None` outside of the window.
    pub(crate) fn column(&self, x: i64, row: usize) -> Option<&[i8; CELLS[2]]> {
        let inside = x >= self.first && x < self.first + CELLS[0] as i64;
        let slice = self.evidence.get(x.rem_euclid(CELLS[0] as i64) as usize);
        slice.filter(|_| inside)?.get(row)
    }
}

impl VoxelGrid {
    /// What hits show of the column at a voxel's x and row.
    pub(crate) fn extent(&self, x: i64, row: usize) -> Extent {
        let slice = self.extents.get(x.rem_euclid(CELLS[0] as i64) as usize);
        let extent = slice.and_then(|slice| slice.get(row));
        extent.copied().unwrap_or(Extent::FULL)
    }
}

/// Number of the voxel that holds a coordinate \[m\]. Coordinates that make no sense are far away.
pub(crate) fn voxel(coordinate: f64) -> i64 {
    const FARTHEST: f64 = 1e12;
    between(libm::floor(coordinate / CELL), [-FARTHEST, FARTHEST]) as i64
}

/// Row of the window that holds a y \[m\], unbounded.
pub(crate) fn row_of(y: f64) -> i64 {
    voxel(y) + MIDDLE
}

/// The y of the centre of a row \[m\].
pub(crate) fn row_centre(row: usize) -> f64 {
    (row as i64 - MIDDLE) as f64 * CELL + 0.5 * CELL
}

fn cell<const Y: usize, const Z: usize>(
    all: &mut [[[i8; Z]; Y]],
    x: usize,
    y: usize,
    z: usize,
) -> Option<&mut i8> {
    all.get_mut(x)?.get_mut(y)?.get_mut(z)
}

fn column<const Y: usize>(all: &mut [[u32; Y]], x: usize, y: usize) -> Option<&mut u32> {
    all.get_mut(x)?.get_mut(y)
}
