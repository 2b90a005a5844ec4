//! The truncated distance field in space, in a window of the map around the aircraft.

use super::extent::{Extent, PART, PARTS};
use super::upright::{
    Around, FARTHEST, REACH, Storey, UNIT, UNITS, Upright, along, distance, mixed,
};
use super::voxels::{CELLS, VoxelGrid, voxel};
use crate::tuning::grid::CELL;
use core::ops::Range;

/// Length of the window along x, and its width along y, in voxels. The height is that of the map.
pub(crate) const LENGTH: usize = 96;
const WIDTH: usize = 64;
const HEIGHT: usize = CELLS[2];
/// Voxels of the window behind the aircraft, and to its left.
const BEHIND: i64 = 8;
const LEFT: i64 = WIDTH as i64 / 2;
/// Greatest distance that the field tells \[m\].
pub const MOST_CLEARANCE: f64 = REACH as f64 * CELL;
/// Diagonal of a voxel, and a little more against rounding: half a unit at either end \[m\].
const DIAGONAL: f64 = 1.733 * CELL + UNIT;
/// Square of a distance beyond the reach, in parts of a voxel.
const FAR: u16 = (REACH * PARTS * REACH * PARTS) as u16;
/// The distance of each square, rounded.
static ROOTS: [u8; FAR as usize + 1] = {
    let mut roots = [0; FAR as usize + 1];
    let (mut square, mut root) = (0, 0);
    while square < roots.len() {
        // The next one is nearer: twice the root, and 1, is at most four times the distance in units.
        while (2 * root + 1) * (2 * root + 1) <= 4 * UNITS * UNITS * square as u32 {
            root += 1;
        }
        roots[square] = root as u8;
        square += 1;
    }
    roots
};
const _: () = assert!(ROOTS[FAR as usize] == FARTHEST);

type Columns = [[u32; WIDTH]; LENGTH];
/// Squares of the distances of a column, two in a word.
type Pairs = [u32; HEIGHT / 2];
/// Slices within reach of one, with it.
const NEAR: usize = 2 * REACH as usize + 1;
const NO_HIT: u32 = (FAR as u32) << 16 | FAR as u32;
/// The top bits of a pair. Those of the least squares so far are set.
const TOPS: u32 = 0x8000_8000;
const _: () = assert!(2 * (FAR as u32) < 0x8000);

/// Squared distances along the occupied columns of the slices within reach of the one that is measured: each serves them all.
#[derive(Clone, Debug)]
pub(crate) struct NearSlices([[Pairs; WIDTH]; NEAR]);

impl NearSlices {
    pub(crate) const ZEROS: Self = Self([[[0; HEIGHT / 2]; WIDTH]; NEAR]);
}

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
    pub(crate) fn begin(&mut self, map: &VoxelGrid, [x, y, _]: &[f64; 3]) {
        let ahead = (voxel(*x) - BEHIND).max(map.first());
        self.first = [ahead, voxel(*y) - LEFT, map.floor()];
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
            self.enter(entered, near);
        }
        let mut squares = [[NO_HIT | TOPS; HEIGHT / 2]; WIDTH];
        for (offset, from) in around(slice, LENGTH) {
            let (Some(columns), Some(extents), Some(near)) = (
                self.occupied.get(from),
                self.extents.get(from),
                near.0.get(from % NEAR),
            ) else {
                continue;
            };
            let columns = columns.iter().zip(near).zip(extents).enumerate();
            for (row, ((column, heights), extent)) in columns {
                if *column == 0 {
                    continue;
                }
                let sides = extent.sides();
                // The slice lies on the other side of the column.
                let ahead = off(-offset, sides[0]);
                if ahead * ahead >= i32::from(FAR) {
                    continue;
                }
                let first = row.saturating_sub(REACH as usize);
                let rows = squares.get_mut(first..(row + REACH as usize + 1).min(WIDTH));
                let offsets = first as i32 - row as i32..;
                for (offset, squares) in offsets.zip(rows.unwrap_or(&mut [])) {
                    let right = off(offset, sides[1]);
                    let square = ahead * ahead + right * right;
                    if square < i32::from(FAR) {
                        lower(squares, heights, square as u32);
                    }
                }
            }
        }
        let distances = self.distances.get_mut(slice);
        let distances = distances.map_or(&mut [][..], |it| it.as_flattened_mut());
        let pairs = distances.as_chunks_mut::<2>().0.iter_mut();
        for (distances, pair) in pairs.zip(squares.as_flattened()) {
            *distances = [pair & 0x7fff, pair >> 16 & 0x7fff].map(|square| {
                let root = ROOTS.get(square as usize);
                root.copied().unwrap_or(FARTHEST)
            });
        }
    }

    /// Computes the squared distances along the occupied columns of a slice that comes within reach.
    fn enter(&self, slice: usize, near: &mut NearSlices) {
        let (Some(columns), Some(unknown), Some(extents), Some(near)) = (
            self.occupied.get(slice),
            self.unknown.get(slice),
            self.extents.get(slice),
            near.0.get_mut(slice % NEAR),
        ) else {
            return;
        };
        let columns = columns.iter().zip(unknown).zip(extents).zip(near);
        for (((column, unknown), extent), heights) in columns {
            if *column != 0 {
                *heights = along_column(*column, !(column | unknown), *extent);
            }
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
    fn place(&self, [x, y, z]: &[f64; 3]) -> [usize; 3] {
        let within = |at: i64, length: usize| at.max(0).min(length as i64 - 1) as usize;
        [
            within(voxel(*x) - self.first[0], LENGTH),
            within(voxel(*y) - self.first[1], WIDTH),
            within(voxel(*z) - self.first[2], HEIGHT),
        ]
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
            [y, y + 1].map(|y| slice.and_then(|slice| slice.get(y)))
        })
    }

    /// The place of a height \[m\] on all vertical lines.
    pub(crate) fn storey(&self, z: f64) -> Storey {
        Storey::of(z, self.first[2])
    }

    /// The points above and below each other at `x` and `y` \[m\], of which [`is_clear`](Self::is_clear) tells at a distance
    /// \[m\].
    pub(crate) fn upright(&self, x: f64, y: f64, distance: f64) -> Upright<'_> {
        let ([column, row, _], [ahead, right, _]) = self.cube(&[x, y, 0.0]);
        let [slice, place, _] = self.place(&[x, y, 0.0]);
        let unknown = self.unknown.get(slice).and_then(|slice| slice.get(place));
        Upright {
            around: self.around(column, row),
            share: [ahead, right],
            unknown: unknown.copied().unwrap_or(0),
            needed: needed(distance),
        }
    }

    /// Whether [`clearance`](Self::clearance) is at least a distance \[m\], as far as one voxel tells: distances of the centres
    /// around a point differ by the diagonal of a voxel at most.
    #[must_use]
    pub fn is_clear(&self, point: &[f64; 3], least: f64) -> bool {
        let ([x, y, z], _) = self.cube(point);
        let column = self.distances.get(x).and_then(|slice| slice.get(y));
        distance(column, z).is_some_and(|distance| distance >= needed(least))
    }

    /// [`clearance`](Self::clearance), and its slope [-].
    #[must_use]
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
fn needed(distance: f64) -> u8 {
    let needed = libm::ceil((distance + DIAGONAL) / UNIT);
    needed.min(f64::from(u8::MAX)) as u8
}

/// Squared distances of the centres of voxels along z.
fn along_column(occupied: u32, free: u32, extent: Extent) -> Pairs {
    const NONE: i32 = (REACH + HEIGHT as i32) * PARTS;
    let mut distances = [0; HEIGHT];
    let mut top = -NONE;
    for (z, distance) in distances.iter_mut().enumerate() {
        let bottom = z as i32 * PARTS;
        *distance = bottom + PARTS / 2 - top;
        if occupied >> z & 1 == 1 {
            let sides = extent.height(z, free);
            (*distance, top) = (off(0, sides), bottom + sides[1]);
        }
    }
    let mut above = 2 * NONE;
    for (z, distance) in distances.iter_mut().enumerate().rev() {
        let bottom = z as i32 * PARTS;
        if occupied >> z & 1 == 1 {
            let [low, _] = extent.height(z, free);
            above = bottom + low;
        } else {
            *distance = (*distance).min(above - bottom - PARTS / 2);
        }
    }
    let square = |distance: i32| {
        if distance < REACH * PARTS {
            (distance * distance) as u32
        } else {
            u32::from(FAR)
        }
    };
    let pairs = distances.as_chunks::<2>().0;
    let mut squares = [0; HEIGHT / 2];
    for (squares, [even, odd]) in squares.iter_mut().zip(pairs) {
        *squares = square(*even) | square(*odd) << 16;
    }
    squares
}

/// The places within reach of one, with their distances from it in voxels.
fn around(at: usize, length: usize) -> impl Iterator<Item = (i32, usize)> {
    (-REACH..=REACH).filter_map(move |offset| {
        let to = usize::try_from(at as i32 + offset).ok()?;
        (to < length).then_some((offset, to))
    })
}

/// Distance of the centre of a voxel from the sides of another one, `offset` voxels before it, in parts.
fn off(offset: i32, [low, high]: [i32; 2]) -> i32 {
    let centre = offset * PARTS + PARTS / 2;
    (low - centre).max(centre - high).max(0)
}

/// Lowers squares to those of another column with `square` added, if they are less. No sum reaches [`TOPS`], so pairs are
/// compared at once.
fn lower(to: &mut Pairs, from: &Pairs, square: u32) {
    let both = square << 16 | square;
    for (to, from) in to.iter_mut().zip(from) {
        let other = from + both;
        // The top bit stays where the other one is not greater.
        let tops = (*to - other) & TOPS;
        let less = tops - (tops >> 15);
        *to ^= (*to ^ other) & less;
    }
}

#[cfg(test)]
mod tests;
