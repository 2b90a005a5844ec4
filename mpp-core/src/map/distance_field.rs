//! The truncated distance field \(ESDF\): the distance to the nearest occupied cell, for every cell of the grid.

use super::cell::bit;
use super::rolling_grid::{COLS, ROWS, RollingGrid};
use crate::tuning::grid::{BEHIND, CELL};
use crate::tuning::open;
use core::ops::Range;

/// Greatest distance that the field knows \[cells\]. Larger distances read as this one.
const REACH: usize = 6;
/// Greatest distance that the field gives \[m\].
pub const FAR: f64 = CELL * REACH as f64;
/// Number of pairs of rows and columns within reach.
const WITHIN_REACH: usize = 35;
/// Rows that the field needs at once: a power of two that holds the rows within reach of one row.
const ROWS_AT_ONCE: usize = (2 * REACH + 1).next_power_of_two();
/// Columns to one side that the field needs at once, likewise a power of two.
const COLS_AT_ONCE: usize = (REACH + 1).next_power_of_two();
/// The field stores distances in units of `1 / PARTS` m.
const PARTS: f64 = 64.0;
/// [`FAR`] in these units.
const FAR_PARTS: u8 = part_of_square(REACH * REACH);

/// Rows within 11 m of the middle of the window, and columns ahead, in which cells are open or not.
const OPEN_ROWS: Range<usize> = 10..54;
const OPEN_COLS: u128 = ((1 << open::AHEAD) - 1) << BEHIND;

/// Distance field of the map of one cycle.
#[derive(Clone, Debug)]
pub struct DistanceField {
    distance: [[u8; COLS]; ROWS],
    /// The occupied cells while the field is built; then those of them that have a free neighbour.
    surface: [u128; ROWS],
    unknown: [u128; ROWS],
    /// Number of open cells.
    open: u32,
    first_x: f64,
    floor: f64,
    /// Radius of the aircraft \[m\].
    body_radius: f64,
}

impl DistanceField {
    /// The field of an empty map.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            distance: [[u8::MAX; COLS]; ROWS],
            surface: [0; ROWS],
            unknown: [0; ROWS],
            open: 0,
            first_x: 0.0,
            floor: 0.0,
            body_radius: 0.0,
        }
    }

    /// Computes the field of a map for an aircraft with this radius \[m\]: exact distances between cell centres
    /// up to [`FAR`].
    pub fn build(&mut self, map: &RollingGrid, body_radius: f64) {
        (self.first_x, self.floor) = (map.first_x(), map.floor());
        self.body_radius = body_radius;
        for row in 0..ROWS {
            (self.surface[row], self.unknown[row]) = map.row(row);
        }
        self.complete();
        self.open = 0;
        let mut beside = [[0; COLS_AT_ONCE]; ROWS_AT_ONCE];
        for row in 0..REACH {
            self.write_beside(row, &mut beside[row]);
        }
        for row in 0..ROWS {
            let last = row + REACH;
            self.write_beside(last, &mut beside[last % ROWS_AT_ONCE]);
            let known = write_distances(&beside, row, &mut self.distance[row]);
            if OPEN_ROWS.contains(&row) {
                self.open += (OPEN_COLS & !known & !self.unknown[row]).count_ones();
            }
        }
        self.keep_surface();
    }

    /// Share of the cells ahead that are open [-]: a beam has passed them, and no occupied cell is within [`FAR`].
    #[must_use]
    pub fn openness(&self) -> f64 {
        f64::from(self.open) / f64::from(OPEN_ROWS.len() as u32 * open::AHEAD)
    }

    /// Marks unknown cells within about a metre of an occupied cell as occupied. If one obstacle hides a
    /// part of another, beams touch only the visible part; this rule completes it. The rule also fills the
    /// unknown cells before the face of an obstacle, where a range may be wrong.
    fn complete(&mut self) {
        for diagonally in [false, true] {
            let mut below = 0;
            for row in 0..ROWS {
                let own = self.surface[row];
                let beside = self.occupied_row(row + 1) | below;
                let mut near = beside | own << 1 | own >> 1;
                if diagonally {
                    near |= beside << 1 | beside >> 1;
                }
                self.surface[row] = own | near & self.unknown[row];
                below = own;
            }
        }
    }

    /// For each number of columns, writes the cells of a row that are so far to the left or right of an occupied cell.
    /// The function shifts whole rows at a time.
    fn write_beside(&self, row: usize, beside: &mut [u128; COLS_AT_ONCE]) {
        let own = self.occupied_row(row);
        let (mut left, mut right) = (own, own);
        for cells in beside {
            *cells = left | right;
            left <<= 1;
            right >>= 1;
        }
    }

    /// A row of occupied cells while the field is built.
    fn occupied_row(&self, row: usize) -> u128 {
        self.surface.get(row).copied().unwrap_or(0)
    }

    /// Keeps those of the occupied cells that have a free neighbour.
    fn keep_surface(&mut self) {
        let mut below = 0;
        for row in 0..ROWS {
            let (own, above) = (self.surface[row], self.occupied_row(row + 1));
            self.surface[row] = own & !(own << 1 & own >> 1 & above & below);
            below = own;
        }
    }

    /// Distance from the aircraft at a point `(x, z)` \[m\] to the nearest centre of an occupied cell \[m\],
    /// negative if the cell is inside the aircraft's radius. It is bilinear between cell centres and at most
    /// [`FAR`]. A point outside the window gets the distance at its edge.
    #[must_use]
    pub fn distance(&self, x: f64, z: f64) -> f64 {
        let (col, right) = split((x - self.first_x) / CELL - 0.5, COLS);
        let (row, up) = split((z - self.floor) / CELL - 0.5, ROWS);
        let at = |row: usize, col: usize| f64::from(self.distance[row % ROWS][col % COLS]);
        let low = at(row, col) * (1.0 - right) + at(row, col + 1) * right;
        let high = at(row + 1, col) * (1.0 - right) + at(row + 1, col + 1) * right;
        (low * (1.0 - up) + high * up) * (1.0 / PARTS) - self.body_radius
    }

    /// The field at one place downrange \[m\], and `with_unknown` which cells there are unknown.
    pub(crate) fn column(&self, x: f64, with_unknown: bool) -> Column {
        let (col, right) = split((x - self.first_x) / CELL - 0.5, COLS);
        let mut column = Column {
            along: [0.0; ROWS],
            far: [false; ROWS],
            unknown: [false; ROWS],
            body_radius: self.body_radius,
        };
        let mut far_above = false;
        let rows = column.along.iter_mut().zip(&mut column.far);
        for ((along, is_far), distances) in rows.zip(&self.distance).rev() {
            let [here, next] = [distances[col % COLS], distances[(col + 1) % COLS]];
            let far_here = here.min(next) >= FAR_PARTS;
            *along = if far_here {
                f64::from(FAR_PARTS)
            } else {
                f64::from(here) * (1.0 - right) + f64::from(next) * right
            };
            *is_far = far_here && far_above;
            far_above = far_here;
        }
        let col = cell((x - self.first_x) / CELL).filter(|col| with_unknown && *col < COLS);
        if let Some(col) = col {
            for (unknown, cells) in column.unknown.iter_mut().zip(&self.unknown) {
                *unknown = bit(cells, col);
            }
        }
        column
    }

    /// Where a height \[m\] lies in the field.
    pub(crate) fn height(&self, z: f64) -> Height {
        let (below, up) = split((z - self.floor) / CELL - 0.5, ROWS);
        let within = cell((z - self.floor) / CELL).unwrap_or(ROWS);
        Height {
            below: below as u8,
            within: within.min(ROWS) as u8,
            up,
        }
    }

    /// Whether the cell of a point is in the window and the map knows nothing of it.
    #[must_use]
    pub fn is_unknown(&self, x: f64, z: f64) -> bool {
        let found = self.cell_of(x, z);
        found.is_some_and(|(row, col)| bit(&self.unknown[row % ROWS], col))
    }

    /// Whether the cell of a point is occupied.
    #[must_use]
    pub fn is_occupied(&self, x: f64, z: f64) -> bool {
        let found = self.cell_of(x, z);
        found.is_some_and(|(row, col)| self.distance[row % ROWS][col % COLS] == 0)
    }

    /// Row and column of the cell of a point, if it lies in the window.
    fn cell_of(&self, x: f64, z: f64) -> Option<(usize, usize)> {
        let row = cell((z - self.floor) / CELL)?;
        let col = cell((x - self.first_x) / CELL)?;
        (row < ROWS && col < COLS).then_some((row, col))
    }

    /// Visits the centres of the occupied cells in a box that have a free neighbour. `x` and `z` are the
    /// least and greatest coordinates of the box \[m\].
    pub fn surface(&self, x: [f64; 2], z: [f64; 2], mut visit: impl FnMut(f64, f64)) {
        let (Some([first, last]), Some([low, high])) =
            (cells(x, self.first_x, COLS), cells(z, self.floor, ROWS))
        else {
            return;
        };
        let kept = (u128::MAX << first) & (u128::MAX >> (COLS - 1 - last));
        for (row, cells) in self.surface.iter().enumerate().take(high + 1).skip(low) {
            let cells = cells & kept;
            if cells == 0 {
                continue;
            }
            let z = self.floor + CELL * (row as f64 + 0.5);
            for (first, mut bits) in (0_u32..).step_by(WORD).zip(words(cells)) {
                while bits != 0 {
                    let col = first + bits.trailing_zeros();
                    bits &= bits - 1;
                    visit(self.first_x + CELL * (f64::from(col) + 0.5), z);
                }
            }
        }
    }
}

/// The distance field at one place downrange, for callers that ask at many heights.
pub(crate) struct Column {
    /// Distances between the cell centres of a row, by row [1 / PARTS m].
    along: [f64; ROWS],
    /// Whether everything from the centre of a row to that of the next one is far, by row.
    far: [bool; ROWS],
    unknown: [bool; ROWS],
    body_radius: f64,
}

const _: () = assert!(ROWS <= u8::MAX as usize);

/// A height in the distance field, for callers that ask at many places downrange.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Height {
    /// The last row whose centre is below.
    below: u8,
    /// The row that contains the height; [`ROWS`] outside of the field.
    within: u8,
    /// Share of the way from the centre of the row below to that of the next one [-].
    up: f64,
}

impl Height {
    /// The lowest row, to be overwritten.
    pub(crate) const LOWEST: Self = Self {
        below: 0,
        within: 0,
        up: 0.0,
    };
}

impl Column {
    /// The distance at heights that are far \[m\].
    pub(crate) fn farthest(&self) -> f64 {
        FAR - self.body_radius
    }

    /// Whether a height lies between cells that are [`FAR`] from all occupied ones.
    pub(crate) fn is_far(&self, height: &Height) -> bool {
        self.far[usize::from(height.below) % ROWS]
    }

    /// The same as [`DistanceField::distance`].
    pub(crate) fn distance(&self, height: &Height) -> f64 {
        let Height { below, up, .. } = *height;
        let row = usize::from(below);
        let (low, high) = (self.along[row % ROWS], self.along[(row + 1) % ROWS]);
        (low * (1.0 - up) + high * up) * (1.0 / PARTS) - self.body_radius
    }

    /// The same as [`DistanceField::is_unknown`].
    pub(crate) fn is_unknown(&self, height: &Height) -> bool {
        let unknown = self.unknown.get(usize::from(height.within));
        unknown.is_some_and(|unknown| *unknown)
    }
}

/// Number of cells in a word of the processor.
const WORD: usize = usize::BITS as usize;

/// The cells of a row in words, which a processor searches faster than the whole row.
fn words(cells: u128) -> [usize; COLS / WORD] {
    core::array::from_fn(|word| (cells >> (word * WORD)) as usize)
}

/// The number of the cell that holds a coordinate in cells. It is `None` below the first cell.
fn cell(coordinate: f64) -> Option<usize> {
    (coordinate >= 0.0).then_some(coordinate as usize)
}

/// First and last cell of that part of a range \[m\] that lies in the window.
fn cells([least, greatest]: [f64; 2], edge: f64, count: usize) -> Option<[usize; 2]> {
    let [first, last] = [least, greatest].map(|value| libm::floor((value - edge) / CELL));
    let inside = last >= 0.0 && first < count as f64;
    inside.then(|| [first.max(0.0) as usize, (last as usize).min(count - 1)])
}

/// Index of the cell at a position, and share of the way to the next cell. Both stay inside `cells` cells.
pub(crate) fn split(position: f64, cells: usize) -> (usize, f64) {
    let inside = position.clamp(0.0, (cells - 1) as f64 - 1e-9);
    let index = inside as usize;
    (index, inside - index as f64)
}

/// Writes the distances of one row. `beside` has the cells beside the occupied ones for the rows within reach, at
/// their numbers modulo [`ROWS_AT_ONCE`]. The result are the cells that have an occupied cell within reach.
fn write_distances(
    beside: &[[u128; COLS_AT_ONCE]; ROWS_AT_ONCE],
    row: usize,
    distances: &mut [u8; COLS],
) -> u128 {
    distances.fill(FAR_PARTS);
    let mut known: u128 = 0;
    for &[rise, along, distance] in &NEAREST_FIRST {
        let at = |row: usize| beside[row % ROWS_AT_ONCE][usize::from(along) % COLS_AT_ONCE];
        let rise = usize::from(rise);
        let new = (at(row + rise) | at(row + ROWS_AT_ONCE - rise)) & !known;
        if new == 0 {
            continue;
        }
        known |= new;
        let blocks = distances.as_chunks_mut::<WORD>().0;
        for (mut bits, distances) in words(new).into_iter().zip(blocks) {
            while bits != 0 {
                distances[bits.trailing_zeros() as usize % WORD] = distance;
                bits &= bits - 1;
            }
        }
    }
    known
}

/// Rows and columns from a cell to another one within reach, and their distance \[1 / PARTS m\], nearest first.
const NEAREST_FIRST: [[u8; 3]; WITHIN_REACH] = {
    let mut all = [[0; 3]; WITHIN_REACH];
    let (mut squared, mut count) = (0, 0);
    while squared <= REACH * REACH {
        let mut rise = 0;
        while rise * rise <= squared {
            let along = (squared - rise * rise).isqrt();
            if along * along + rise * rise == squared {
                all[count] = [rise as u8, along as u8, part_of_square(squared)];
                count += 1;
            }
            rise += 1;
        }
        squared += 1;
    }
    assert!(count == WITHIN_REACH);
    all
};

/// Distance \[1 / PARTS m\] of a squared distance \[cells^2\]: the integer root.
const fn part_of_square(squared: usize) -> u8 {
    let scale = (PARTS * CELL) as usize;
    (squared * scale * scale).isqrt() as u8
}

const _: () = assert!(FAR * PARTS < 256.0);
