//! The truncated distance field in space, in a window of the map around the aircraft.

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
/// Square of a distance beyond the reach.
const FAR: u8 = (REACH * REACH + 1) as u8;

type Columns = [[u32; WIDTH]; LENGTH];
type Squares = [[[u8; HEIGHT]; WIDTH]; LENGTH];

/// Distances \[m\] to the nearest centre of an occupied voxel, and what nobody has seen.
#[derive(Clone, Debug)]
pub struct VoxelField {
    /// Occupied and unknown voxels: a bit for each z.
    occupied: Columns,
    unknown: Columns,
    /// Squared distances, in voxels.
    squares: Squares,
    /// The same along z and y alone.
    partial: Squares,
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
            squares: [[[FAR; HEIGHT]; WIDTH]; LENGTH],
            partial: [[[FAR; HEIGHT]; WIDTH]; LENGTH],
            first: [0; 2],
        }
    }

    /// Takes the occupancy of the map around a position \[m\], and computes the distances.
    pub fn update(&mut self, map: &VoxelGrid, position: &[f64; 3]) {
        let rows = (CELLS[1] - WIDTH) as i64;
        let row = (row_of(position[1]) - WIDTH as i64 / 2).max(0).min(rows);
        self.first = [(voxel(position[0]) - BEHIND).max(map.first()), row];
        let slices = self.occupied.iter_mut().zip(&mut self.unknown);
        for (x, (occupied, unknown)) in (self.first[0]..).zip(slices) {
            for (row, (occupied, unknown)) in (row as usize..).zip(occupied.iter_mut().zip(unknown))
            {
                (*occupied, *unknown) = map.column(x, row).map_or((0, u32::MAX), bits);
            }
        }
        self.measure();
    }

    /// Squared distances, axis by axis: `min over o of (square(o) + (o - at)^2)`.
    fn measure(&mut self) {
        for (slice, occupied) in self.partial.iter_mut().zip(&self.occupied) {
            let mut along_z = [[FAR; HEIGHT]; WIDTH];
            for (squares, occupied) in along_z.iter_mut().zip(occupied) {
                along_column(*occupied, squares);
            }
            *slice = along_z;
            for (row, occupied) in occupied.iter().enumerate() {
                if *occupied == 0 {
                    continue;
                }
                if let Some(from) = along_z.get(row) {
                    spread(slice, row, from);
                }
            }
        }
        self.squares = self.partial;
        for at in 0..LENGTH {
            for row in 0..WIDTH {
                let Some(from) = self.partial.get(at).and_then(|slice| slice.get(row)) else {
                    continue;
                };
                if from.iter().all(|square| *square >= FAR) {
                    continue;
                }
                for offset in -REACH..=REACH {
                    let to = at as i32 + offset;
                    let slice = usize::try_from(to)
                        .ok()
                        .and_then(|to| self.squares.get_mut(to));
                    if let Some(to) = slice.and_then(|slice| slice.get_mut(row)) {
                        lower(to, from, (offset * offset) as u8);
                    }
                }
            }
        }
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

    fn square(&self, [x, y, z]: [usize; 3]) -> u8 {
        let column = self.squares.get(x).and_then(|slice| slice.get(y));
        column
            .and_then(|column| column.get(z))
            .copied()
            .unwrap_or(FAR)
    }

    /// Distance \[m\] of the voxel of a point, at most [`MOST_CLEARANCE`].
    #[must_use]
    pub fn nearest(&self, point: &[f64; 3]) -> f64 {
        root(self.square(self.place(point)))
    }

    /// Distance of a point \[m\], at most [`MOST_CLEARANCE`], interpolated between the centres of voxels.
    #[must_use]
    pub fn clearance(&self, point: &[f64; 3]) -> f64 {
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
            let inside = at[axis].max(0.0).min(length as f64 - 1.001);
            let floor = libm::floor(inside);
            (low[axis], share[axis]) = (floor as usize, inside - floor);
        }
        let [x, y, z] = low;
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
        let column = |x, y| {
            mix(
                root(self.square([x, y, z])),
                root(self.square([x, y, z + 1])),
                share[2],
            )
        };
        let slice = |x| mix(column(x, y), column(x, y + 1), share[1]);
        mix(slice(x), slice(x + 1), share[0])
    }

    /// Whether nobody has seen the voxel of a point.
    #[must_use]
    pub fn is_unknown(&self, point: &[f64; 3]) -> bool {
        let [x, y, z] = self.place(point);
        let column = self.unknown.get(x).and_then(|slice| slice.get(y));
        column.is_some_and(|column| *column >> z & 1 == 1)
    }

    /// Calls `each` with the centre of every occupied voxel of a box that has a free neighbour.
    pub fn surface(&self, low: &[f64; 3], high: &[f64; 3], mut each: impl FnMut([f64; 3])) {
        let ([x0, y0, z0], [x1, y1, z1]) = (self.place(low), self.place(high));
        let layers = (u32::MAX << z0) & (u32::MAX >> (HEIGHT - 1 - z1));
        let column = |x: usize, y: usize| {
            let slice = self.occupied.get(x).and_then(|slice| slice.get(y));
            slice.copied().unwrap_or(0)
        };
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
                // A word has so many bits.
                for _ in 0..HEIGHT {
                    if left == 0 {
                        break;
                    }
                    let z = left.trailing_zeros();
                    left &= left - 1;
                    each([
                        (x as i64 + self.first[0]) as f64 * CELL + 0.5 * CELL,
                        row_centre(y + self.first[1] as usize),
                        f64::from(z) * CELL + 0.5 * CELL,
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

impl Default for VoxelField {
    fn default() -> Self {
        Self::new()
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

/// Squared distances along z.
fn along_column(occupied: u32, squares: &mut [u8; HEIGHT]) {
    if occupied == 0 {
        return;
    }
    for (z, square) in squares.iter_mut().enumerate() {
        // Bits above z and z itself, bits up to z.
        let above = (occupied >> z).trailing_zeros() as i32;
        let below = (occupied << (HEIGHT - 1 - z)).leading_zeros() as i32;
        let distance = above.min(below);
        if distance <= REACH {
            *square = (distance * distance) as u8;
        }
    }
}

/// Lowers the squares of the rows around `row` by those of a column in it.
fn spread(slice: &mut [[u8; HEIGHT]; WIDTH], row: usize, from: &[u8; HEIGHT]) {
    for offset in -REACH..=REACH {
        let to = row as i32 + offset;
        let to = usize::try_from(to).ok().and_then(|to| slice.get_mut(to));
        if let Some(to) = to {
            lower(to, from, (offset * offset) as u8);
        }
    }
}

fn lower(to: &mut [u8; HEIGHT], from: &[u8; HEIGHT], square: u8) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = (*to).min(from.saturating_add(square));
    }
}

/// Distance \[m\] of a square in voxels.
fn root(square: u8) -> f64 {
    ROOTS
        .get(usize::from(square))
        .copied()
        .unwrap_or(MOST_CLEARANCE)
}

/// Square roots in metres, by Newton's method.
const ROOTS: [f64; (REACH * REACH) as usize + 1] = {
    let mut roots = [0.0; (REACH * REACH) as usize + 1];
    let mut square = 1;
    while square < roots.len() {
        let (mut guess, mut round) = (REACH as f64, 0);
        while round < 12 {
            guess = 0.5 * (guess + square as f64 / guess);
            round += 1;
        }
        roots[square] = guess * CELL;
        square += 1;
    }
    roots
};

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{CELL, MOST_CLEARANCE, VoxelField};
    use crate::map::voxels::{SpaceBeam, VoxelGrid};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use std::boxed::Box;
    use std::vec::Vec;

    /// Beams at random points: the field has the distance to the nearest of their voxels, and the surface has them all.
    #[test]
    fn the_field_has_the_distance_to_the_nearest_voxel() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        let mut draw = |low: f64, high: f64| {
            low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut map, mut field) = (Box::new(VoxelGrid::new()), Box::new(VoxelField::new()));
        map.clear(0.0);
        let from = [0.25, 0.25, 8.25];
        let mut hits: Vec<[f64; 3]> = Vec::new();
        let mut beams = Vec::new();
        for _ in 0..60 {
            let to = [draw(3.0, 40.0), draw(-12.0, 12.0), draw(1.0, 15.0)];
            let way: Vec<f64> = to.iter().zip(&from).map(|(to, from)| to - from).collect();
            let range = libm::sqrt(way.iter().map(|it| it * it).sum());
            let direction = core::array::from_fn(|axis| way[axis] / range);
            beams.push(SpaceBeam {
                direction,
                range: Some(range),
            });
            hits.push(to.map(|it| (libm::floor(it / CELL) + 0.5) * CELL));
        }
        map.insert(&from, &beams, 45.0);
        field.update(&map, &from);
        let mut seen = 0;
        field.surface(&[0.0, -15.0, 0.0], &[45.0, 15.0, 15.9], |centre| {
            assert!(
                hits.iter()
                    .any(|hit| hit.map(f64::to_bits) == centre.map(f64::to_bits)),
                "{centre:?}"
            );
            seen += 1;
        });
        assert!(seen > 50);
        for _ in 0..2000 {
            let point = [draw(0.0, 42.0), draw(-14.0, 14.0), draw(0.5, 15.5)];
            let centre = point.map(|it| (libm::floor(it / CELL) + 0.5) * CELL);
            let square = |hit: &[f64; 3]| -> f64 {
                hit.iter()
                    .zip(&centre)
                    .map(|(a, b)| (a - b) * (a - b))
                    .sum()
            };
            let nearest = hits.iter().map(|hit| libm::sqrt(square(hit)));
            let nearest = nearest.fold(MOST_CLEARANCE, f64::min);
            assert!((field.nearest(&point) - nearest).abs() < 1e-9, "{point:?}");
            assert!((field.clearance(&centre) - nearest).abs() < 1e-9);
        }
    }
}
