//! The truncated distance field in space, in a window of the map around the aircraft.

use super::clear_column::{ClearColumn, along};
use super::extent::{Extent, PART, PARTS};
use super::voxels::{CELLS, VoxelGrid, row_centre, row_of, voxel};
use crate::tuning::grid::{CELL, OCCUPIED};

/// Length of the window along x, and its width along y, in voxels. The height is that of the map.
const LENGTH: usize = 104;
const WIDTH: usize = 68;
const HEIGHT: usize = CELLS[2];
/// Voxels of the window behind the aircraft.
const BEHIND: i64 = 8;
/// Greatest distance that the field tells, in voxels: 3 m.
const REACH: i32 = 6;
/// Greatest distance that the field tells \[m\].
pub const MOST_CLEARANCE: f64 = REACH as f64 * CELL;
/// Diagonal of a voxel, and a little more against rounding \[m\].
const DIAGONAL: f64 = 1.733 * CELL;
/// Square of a distance beyond the reach, in parts of a voxel.
const FAR: u16 = (REACH * PARTS * REACH * PARTS) as u16;

type Columns = [[u32; WIDTH]; LENGTH];
type Squares = [[[u16; HEIGHT]; WIDTH]; LENGTH];

/// Distances \[m\] to what hits have shown of the nearest occupied voxel, and what nobody has seen.
#[derive(Clone, Debug)]
pub struct VoxelField {
    /// Occupied and unknown voxels: a bit for each z.
    occupied: Columns,
    unknown: Columns,
    extents: [[Extent; WIDTH]; LENGTH],
    /// Squared distances of the centres of voxels, in parts of a voxel.
    squares: Squares,
    /// First x and first row of the window.
    first: [i64; 2],
}

impl VoxelField {
    /// A field without obstacles.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            occupied: [[0; WIDTH]; LENGTH],
            unknown: [[0; WIDTH]; LENGTH],
            extents: [[Extent::FULL; WIDTH]; LENGTH],
            squares: [[[FAR; HEIGHT]; WIDTH]; LENGTH],
            first: [0; 2],
        }
    }

    /// Takes the occupancy of the map around a position \[m\], and computes the distances.
    pub fn update(&mut self, map: &VoxelGrid, position: &[f64; 3]) {
        let rows = (CELLS[1] - WIDTH) as i64;
        let row = (row_of(position[1]) - WIDTH as i64 / 2).max(0).min(rows);
        self.first = [(voxel(position[0]) - BEHIND).max(map.first()), row];
        let slices = self.occupied.iter_mut().zip(&mut self.unknown);
        for ((x, (occupied, unknown)), extents) in
            (self.first[0]..).zip(slices).zip(&mut self.extents)
        {
            for ((row, (occupied, unknown)), extent) in (row as usize..)
                .zip(occupied.iter_mut().zip(unknown))
                .zip(extents)
            {
                (*occupied, *unknown) = map.column(x, row).map_or((0, u32::MAX), bits);
                *extent = map.extent(x, row);
            }
        }
        self.measure();
    }

    /// Lowers the squared distances around every occupied column.
    fn measure(&mut self) {
        self.squares.as_flattened_mut().as_flattened_mut().fill(FAR);
        for at in 0..LENGTH {
            for row in 0..WIDTH {
                let column = self.column(at, row);
                if column == 0 {
                    continue;
                }
                let mut heights = [FAR; HEIGHT];
                along_column(column, &mut heights);
                let sides = self.extent(at, row).sides();
                for (x, slice) in around(at, LENGTH) {
                    let ahead = off(x, sides[0]);
                    for (y, row) in around(row, WIDTH) {
                        let right = off(y, sides[1]);
                        let square = ahead * ahead + right * right;
                        let to = self
                            .squares
                            .get_mut(slice)
                            .and_then(|slice| slice.get_mut(row));
                        if let Some(to) = to.filter(|_| square < i32::from(FAR)) {
                            lower(to, &heights, square as u16);
                        }
                    }
                }
            }
        }
    }

    fn column(&self, x: usize, row: usize) -> u32 {
        let slice = self.occupied.get(x).and_then(|slice| slice.get(row));
        slice.copied().unwrap_or(0)
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
            within(row_of(*y) - self.first[1], WIDTH),
            within(voxel(*z), HEIGHT),
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
        let middle = CELLS[1] as f64 / 2.0;
        let at = [
            x - self.first[0] as f64,
            y + middle - self.first[1] as f64,
            z,
        ];
        let mut low = [0; 3];
        let mut share = [0.0; 3];
        for (axis, length) in [LENGTH, WIDTH, HEIGHT].into_iter().enumerate() {
            (low[axis], share[axis]) = along(at[axis], length);
        }
        (low, share)
    }

    /// [`is_clear`](Self::is_clear) for the points of a vertical line.
    pub(crate) fn clear_column(&self, x: f64, y: f64, distance: f64) -> ClearColumn<'_> {
        let ([x, y, _], _) = self.cube(&[x, y, 0.0]);
        let needed = (distance + DIAGONAL) / PART;
        ClearColumn {
            squares: self.squares.get(x).and_then(|slice| slice.get(y)),
            needed: libm::ceil(needed * needed).min(f64::from(u16::MAX)) as u16,
        }
    }

    /// Whether [`clearance`](Self::clearance) is at least a distance \[m\], as far as one voxel tells: distances of the centres
    /// around a point differ by the diagonal of a voxel at most.
    #[must_use]
    pub fn is_clear(&self, point: &[f64; 3], distance: f64) -> bool {
        let [x, y, z] = *point;
        self.clear_column(x, y, distance).is_clear(z)
    }

    /// [`clearance`](Self::clearance), and its slope [-].
    #[must_use]
    pub fn clearance_and_slope(&self, point: &[f64; 3]) -> (f64, [f64; 3]) {
        let ([x, y, z], share) = self.cube(point);
        // Value and slopes along z, then y, then x.
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
        let column = |x: usize, y: usize| {
            let squares = self.squares.get(x).and_then(|slice| slice.get(y));
            let [below, above] = [z, z + 1].map(|z| {
                let square = squares.and_then(|squares| squares.get(z));
                root(square.copied().unwrap_or(FAR))
            });
            [mix(below, above, share[2]), above - below]
        };
        let slice = |x| {
            let ([near, near_up], [far, far_up]) = (column(x, y), column(x, y + 1));
            [
                mix(near, far, share[1]),
                far - near,
                mix(near_up, far_up, share[1]),
            ]
        };
        let (from, to) = (slice(x), slice(x + 1));
        let [value, right, up] =
            core::array::from_fn(|index| mix(from[index], to[index], share[0]));
        let slope = [to[0] - from[0], right, up];
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
                    row_centre(y + self.first[1] as usize) - 0.5 * CELL,
                ];
                let sides = self.extent(x, y).sides();
                let side =
                    |axis: usize, which: usize| corner[axis] + f64::from(sides[axis][which]) * PART;
                // A word has so many bits.
                for _ in 0..HEIGHT {
                    if left == 0 {
                        break;
                    }
                    let z = left.trailing_zeros();
                    left &= left - 1;
                    let bottom = f64::from(z) * CELL;
                    each(&[
                        [side(0, 0), side(1, 0), bottom],
                        [side(0, 1), side(1, 1), bottom + CELL],
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

/// Occupied and unknown voxels of a column.
fn bits(evidence: &[i8; HEIGHT]) -> (u32, u32) {
    let (mut occupied, mut unknown) = (0, 0);
    for (z, evidence) in evidence.iter().enumerate() {
        occupied |= u32::from(*evidence >= OCCUPIED) << z;
        unknown |= u32::from(*evidence == 0) << z;
    }
    (occupied, unknown)
}

/// Squared distances of the centres of voxels along z.
fn along_column(occupied: u32, squares: &mut [u16; HEIGHT]) {
    for (z, square) in squares.iter_mut().enumerate() {
        // Bits above z and z itself, bits up to z.
        let above = (occupied >> z).trailing_zeros() as i32;
        let below = (occupied << (HEIGHT - 1 - z)).leading_zeros() as i32;
        let distance = (above.min(below) * PARTS - PARTS / 2).max(0);
        if distance < REACH * PARTS {
            *square = (distance * distance) as u16;
        }
    }
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

fn lower(to: &mut [u16; HEIGHT], from: &[u16; HEIGHT], square: u16) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = (*to).min(from.saturating_add(square));
    }
}

/// Distance \[m\] of a square.
fn root(square: u16) -> f64 {
    libm::sqrt(f64::from(square)) * PART
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{CELL, MOST_CLEARANCE, VoxelField};
    use crate::map::voxels::{SpaceBeam, VoxelGrid};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use std::boxed::Box;
    use std::vec::Vec;

    /// Beams at random points, one a column: the field has the distance to the nearest part of a column that one of them shows,
    /// the surface has them all, and the slope is that of the clearance.
    #[test]
    fn the_field_has_the_distance_to_what_hits_have_shown() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        let mut draw = |low: f64, high: f64| {
            low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut map, mut field) = (Box::new(VoxelGrid::new()), Box::new(VoxelField::new()));
        map.clear(0.0);
        let from = [0.25, 0.25, 8.25];
        // Least and greatest coordinates of a sixteenth of a column, and of a voxel in height.
        let part = |at: f64, edge: f64| [0.0, 1.0].map(|end| (libm::floor(at / edge) + end) * edge);
        let mut shown: Vec<[[f64; 2]; 3]> = Vec::new();
        let mut columns: Vec<[i64; 2]> = Vec::new();
        let mut beams = Vec::new();
        while shown.len() < 60 {
            let to = [draw(3.0, 40.0), draw(-12.0, 12.0), draw(1.0, 15.0)];
            let column = [to[0], to[1]].map(|at| libm::floor(at / CELL) as i64);
            if columns.contains(&column) {
                continue;
            }
            columns.push(column);
            let way: Vec<f64> = to.iter().zip(&from).map(|(to, from)| to - from).collect();
            let range = libm::sqrt(way.iter().map(|it| it * it).sum());
            let direction = core::array::from_fn(|axis| way[axis] / range);
            beams.push(SpaceBeam {
                direction,
                range: Some(range),
            });
            let fine = CELL / 16.0;
            shown.push([part(to[0], fine), part(to[1], fine), part(to[2], CELL)]);
        }
        map.insert(&from, beams.iter().copied(), 45.0);
        field.update(&map, &from);
        let mut seen = 0;
        field.surface(&[0.0, -15.0, 0.0], &[45.0, 15.0, 15.9], |[least, most]| {
            let same = |shown: &[[f64; 2]; 3]| {
                (0..3).all(|axis| {
                    let [low, high] = shown[axis];
                    (low - least[axis]).abs() < 1e-9 && (high - most[axis]).abs() < 1e-9
                })
            };
            assert!(shown.iter().any(same), "{least:?} {most:?}");
            seen += 1;
        });
        assert!(seen > 50, "{seen}");
        let distance = |point: &[f64; 3], shown: &[[f64; 2]; 3]| {
            let off = point.iter().zip(shown);
            let squares = off.map(|(at, [low, high])| {
                let off = (low - at).max(at - high).max(0.0);
                off * off
            });
            libm::sqrt(squares.sum())
        };
        let mut clear = 0;
        for _ in 0..2000 {
            let point = [draw(0.0, 42.0), draw(-14.0, 14.0), draw(0.5, 15.0)];
            let centre = point.map(|it| (libm::floor(it / CELL) + 0.5) * CELL);
            let all = shown.iter().map(|shown| distance(&centre, shown));
            let nearest = all.fold(MOST_CLEARANCE, f64::min);
            assert!(
                (field.clearance(&centre) - nearest).abs() < 1e-9,
                "{point:?}"
            );
            // Within a cell between centres the clearance is linear along an axis.
            let (_, slope) = field.clearance_and_slope(&point);
            for axis in 0..3 {
                let mut moved = point;
                let middle = libm::floor(point[axis] / CELL - 0.5) * CELL + CELL;
                moved[axis] += if point[axis] < middle { 0.01 } else { -0.01 };
                let by = field.clearance(&moved) - field.clearance(&point);
                let expected = slope[axis] * (moved[axis] - point[axis]);
                assert!((by - expected).abs() < 1e-9, "{point:?} {axis}");
            }
            let wanted = draw(0.3, 2.0);
            if field.is_clear(&point, wanted) {
                assert!(field.clearance(&point) >= wanted, "{point:?} {wanted}");
                clear += 1;
            }
        }
        assert!(clear > 500, "{clear}");
    }
}
