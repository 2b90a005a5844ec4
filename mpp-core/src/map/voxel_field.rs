//! The truncated distance field in space, in a window of the map around the aircraft.

use super::cell::rounded_down;
use super::extent::{Extent, PART};
use super::near_slices::WIDTH;
pub(crate) use super::near_slices::{LENGTH, NearSlices};
use super::upright::{
    Around, FAR_COLUMN, FARTHEST, HEIGHT, REACH, Storey, UNIT, Upright, along, mixed,
};
use super::voxels::VoxelGrid;
use super::walk::{back, voxel};
use crate::tuning::grid::CELL;
use core::ops::Range;

/// Voxels of the window behind the aircraft, and to its left.
const BEHIND: i64 = 8;
const LEFT: i64 = WIDTH as i64 / 2;
/// Voxels by which the window moves back, and to the side to which it flies, where an aircraft flies backwards: a part of what the
/// [`VoxelGrid`] then holds. Source: decision 76.
const BACK: [f64; 2] = [40.0, 16.0];
/// Greatest distance that the field tells \[m\].
pub const MOST_CLEARANCE: f64 = REACH as f64 * CELL;
/// Diagonal of a voxel, and a little more against rounding: half a unit at either end \[m\].
const DIAGONAL: f64 = 1.733 * CELL + UNIT;

type Columns = [[u32; WIDTH]; LENGTH];

/// Distances \[m\] to what hits have shown of the nearest occupied voxel, and what nobody has seen.
#[derive(Clone, Debug)]
pub struct VoxelField {
    /// Occupied and unknown voxels: a bit for each z.
    occupied: Columns,
    unknown: Columns,
    extents: [[Extent; WIDTH]; LENGTH],
    /// Distances of the centres of voxels, in units.
    distances: [[[u8; HEIGHT]; WIDTH]; LENGTH],
    /// First x, y and z of the window, in voxels, as two kinds of numbers.
    first: [i64; 3],
    start: [f64; 3],
}

impl VoxelField {
    /// A field without obstacles.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            occupied: [[0; WIDTH]; LENGTH],
            unknown: [[0; WIDTH]; LENGTH],
            extents: [[Extent::FULL; WIDTH]; LENGTH],
            distances: [[[FARTHEST; HEIGHT]; WIDTH]; LENGTH],
            first: [0; 3],
            start: [0.0; 3],
        }
    }

    /// Moves the window to a position \[m\]. Then come all slices by [`look`](Self::look), then all by [`measure`](Self::measure).
    pub(crate) fn begin(&mut self, map: &VoxelGrid, [x, y, _]: &[f64; 3], course: f64) {
        let [behind, aside] = BACK.map(|it| libm::round(it * back(course)) as i64);
        let ahead = (voxel(*x) - BEHIND - behind).max(map.first());
        let side = if libm::sin(course) < 0.0 {
            aside
        } else {
            -aside
        };
        self.first = [ahead, voxel(*y) - LEFT - side, map.floor()];
        self.start = self.first.map(|it| it as f64);
    }

    /// Takes the occupancy of some slices from the map.
    pub(crate) fn look(&mut self, map: &VoxelGrid, slices: Range<usize>) {
        let [x, y, _] = self.first;
        for slice in slices {
            let (Some(occupied), Some(unknown), Some(extents)) = (
                self.occupied.get_mut(slice),
                self.unknown.get_mut(slice),
                self.extents.get_mut(slice),
            ) else {
                return;
            };
            for (y, ((occupied, unknown), extent)) in
                (y..).zip(occupied.iter_mut().zip(unknown).zip(extents))
            {
                ([*occupied, *unknown], *extent) = map.column(x + slice as i64, y);
            }
        }
    }

    /// Computes the distances in a slice, from every occupied column within reach. The slices come one after the other.
    pub(crate) fn measure(&mut self, slice: usize, near: &mut NearSlices) {
        let entered = if slice == 0 {
            0
        } else {
            slice + REACH as usize
        };
        for entered in entered..(slice + REACH as usize + 1).min(LENGTH) {
            if let (Some(columns), Some(unknown), Some(extents)) = (
                self.occupied.get(entered),
                self.unknown.get(entered),
                self.extents.get(entered),
            ) {
                near.enter(entered, columns, unknown, extents);
            }
        }
        if let Some(distances) = self.distances.get_mut(slice) {
            near.measure(slice, &self.extents, distances);
        }
    }

    fn column(&self, x: usize, row: usize) -> u32 {
        let slice = self.occupied.get(x).and_then(|slice| slice.get(row));
        slice.copied().unwrap_or(0)
    }

    fn unknown_column(&self, x: usize, row: usize) -> u32 {
        let slice = self.unknown.get(x).and_then(|slice| slice.get(row));
        slice.copied().unwrap_or(u32::MAX)
    }

    fn extent(&self, x: usize, row: usize) -> Extent {
        let slice = self.extents.get(x).and_then(|slice| slice.get(row));
        slice.copied().unwrap_or(Extent::FULL)
    }

    /// Places of the voxel of a point, moved into the window.
    fn place(&self, point: &[f64; 3]) -> [usize; 3] {
        // Voxels have numbers of 32 bits, which a flight computer subtracts and compares with fewer instructions.
        let within = |axis: usize, length: usize| {
            let at = rounded_down(point[axis] / CELL).saturating_sub(self.first[axis] as i32);
            at.max(0).min(length as i32 - 1) as usize
        };
        [within(0, LENGTH), within(1, WIDTH), within(2, HEIGHT)]
    }

    /// Distance of a point \[m\], at most [`MOST_CLEARANCE`], interpolated between the centres of voxels.
    #[must_use]
    pub fn clearance(&self, point: &[f64; 3]) -> f64 {
        self.clearance_and_slope(point).0
    }

    /// The voxel with the least numbers of the eight whose centres lie around a point, and the place of the point among them [-].
    fn cube(&self, point: &[f64; 3]) -> ([usize; 3], [f64; 3]) {
        let [x, y, z] = point.map(|it| it / CELL - 0.5);
        let at = [x - self.start[0], y - self.start[1], z - self.start[2]];
        let mut low = [0; 3];
        let mut share = [0.0; 3];
        for (axis, length) in [LENGTH, WIDTH, HEIGHT].into_iter().enumerate() {
            (low[axis], share[axis]) = along(at[axis], length);
        }
        (low, share)
    }

    /// The columns of centres around a point.
    fn around(&self, x: usize, y: usize) -> Around<'_> {
        [x, x + 1].map(|x| {
            let slice = self.distances.get(x);
            [y, y + 1].map(|y| slice.and_then(|slice| slice.get(y)).unwrap_or(&FAR_COLUMN))
        })
    }

    /// The place of a height \[m\] on all vertical lines.
    pub(crate) fn storey(&self, z: f64) -> Storey {
        Storey::of(z, self.first[2])
    }

    /// The points above and below each other at `x` and `y` \[m\], of which [`is_clear`](Self::is_clear) tells.
    pub(crate) fn upright(&self, x: f64, y: f64, needed: u8) -> Upright<'_> {
        let ([column, row, _], [ahead, right, _]) = self.cube(&[x, y, 0.0]);
        let [slice, place, _] = self.place(&[x, y, 0.0]);
        let unknown = self.unknown.get(slice).and_then(|slice| slice.get(place));
        Upright {
            around: self.around(column, row),
            share: [ahead, right],
            unknown: unknown.copied().unwrap_or(0),
            needed,
        }
    }

    /// Whether [`clearance`](Self::clearance) is at least the distance of [`needed`], as far as one voxel tells: distances of the
    /// centres around a point differ by the diagonal of a voxel at most.
    pub(crate) fn is_clear(&self, point: &[f64; 3], needed: u8) -> bool {
        let ([x, y, z], _) = self.cube(point);
        let column = self.distances.get(x).and_then(|slice| slice.get(y));
        (column.and_then(|column| column.get(z))).is_some_and(|distance| *distance >= needed)
    }

    /// [`clearance`](Self::clearance), and its slope [-].
    #[must_use]
    #[inline(never)]
    pub fn clearance_and_slope(&self, point: &[f64; 3]) -> (f64, [f64; 3]) {
        let ([x, y, z], share) = self.cube(point);
        let (value, slope) = mixed(&self.around(x, y), z, share);
        (value, slope.map(|it| it / CELL))
    }

    /// Whether nobody has seen the voxel of a point.
    #[must_use]
    pub fn is_unknown(&self, point: &[f64; 3]) -> bool {
        let [x, y, z] = self.place(point);
        let column = self.unknown.get(x).and_then(|slice| slice.get(y));
        column.is_some_and(|it| *it >> z & 1 == 1)
    }

    /// Calls `each` with the least and the greatest coordinates of what hits have shown of every occupied voxel of a box that has
    /// a free neighbour.
    pub fn surface(&self, low: &[f64; 3], high: &[f64; 3], mut each: impl FnMut(&[[f64; 3]; 2])) {
        let ([x0, y0, z0], [x1, y1, z1]) = (self.place(low), self.place(high));
        let layers = (u32::MAX << z0) & (u32::MAX >> (HEIGHT - 1 - z1));
        let column = |x: usize, y: usize| self.column(x, y);
        for x in x0..=x1 {
            for y in y0..=y1 {
                let all = column(x, y);
                if all & layers == 0 {
                    continue;
                }
                let beside = column(x.wrapping_sub(1), y) & column(x + 1, y);
                let beside = beside & column(x, y.wrapping_sub(1)) & column(x, y + 1);
                let inner = beside & (all << 1) & (all >> 1);
                let mut left = all & layers & !inner;
                let corner = [
                    (x as i64 + self.first[0]) as f64 * CELL,
                    (y as i64 + self.first[1]) as f64 * CELL,
                ];
                let extent = self.extent(x, y);
                let (sides, free) = (extent.sides(), !(all | self.unknown_column(x, y)));
                let side =
                    |axis: usize, which: usize| corner[axis] + f64::from(sides[axis][which]) * PART;
                // A word has so many bits.
                for _ in 0..HEIGHT {
                    if left == 0 {
                        break;
                    }
                    let z = left.trailing_zeros();
                    left &= left - 1;
                    let bottom = (self.start[2] + f64::from(z)) * CELL;
                    let [low, high] = (extent.height(z as usize, free))
                        .map(|part| bottom + f64::from(part) * PART);
                    each(&[
                        [side(0, 0), side(1, 0), low],
                        [side(0, 1), side(1, 1), high],
                    ]);
                }
            }
        }
    }

    /// Whether a point lies within the length of the window.
    #[must_use]
    pub fn covers(&self, x: f64) -> bool {
        voxel(x) < self.first[0] + LENGTH as i64
    }
}

/// Distance of the centre before a point, in units, from which on the point has a distance \[m\].
pub(crate) fn needed(distance: f64) -> u8 {
    let needed = libm::ceil((distance + DIAGONAL) / UNIT);
    needed.min(f64::from(u8::MAX)) as u8
}

#[cfg(test)]
mod tests;
