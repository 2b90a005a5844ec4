//! The occupancy grid: a binary matrix of 1 m cells about the aircraft, padded by one cell
//! (paper, section II-C).
//!
//! Grid coordinates are `(row, col)`: row counts height, column downrange distance; the aircraft is
//! at `(ORIGIN_ROW, ORIGIN_COL)`, the low corner of that cell. The grid does not pitch with the
//! aircraft.

mod clearance;
mod memory;
mod walk;

use crate::Rules;
use crate::config::{GRID_COLS, GRID_ROWS, ORIGIN_COL, ORIGIN_ROW};
use crate::sense::LidarScan;
pub(crate) use clearance::split;
pub use clearance::{ClearanceField, FAR};
pub use memory::MemoryMap;
pub(crate) use walk::CellWalk;

/// Cells that a walk across the whole grid can pass: the bound of every walk.
pub(crate) const MAX_WALK: usize = GRID_ROWS + GRID_COLS + 3;

const WORDS: usize = GRID_COLS.div_ceil(64);

/// A point in grid coordinates [m].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridPoint {
    /// Height above the grid's low edge.
    pub row: f64,
    /// Distance from the grid's near edge.
    pub col: f64,
}

impl GridPoint {
    /// Where the aircraft is.
    pub const AIRCRAFT: Self = Self {
        row: ORIGIN_ROW as f64,
        col: ORIGIN_COL as f64,
    };

    /// Distance to another point [m].
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let (row, col) = (self.row - other.row, self.col - other.col);
        libm::sqrt(row * row + col * col)
    }

    /// The point at a share (0 to 1) of the way to `other`.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        Self {
            row: self.row * (1.0 - share) + other.row * share,
            col: self.col * (1.0 - share) + other.col * share,
        }
    }
}

/// Occupied cells, one bit each; whatever is not marked counts as free.
#[derive(Clone, Debug)]
pub struct OccupancyGrid {
    rows: [[u64; WORDS]; GRID_ROWS],
}

impl OccupancyGrid {
    /// A free grid.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            rows: [[0; WORDS]; GRID_ROWS],
        }
    }

    /// Frees every cell.
    pub fn clear(&mut self) {
        self.rows = [[0; WORDS]; GRID_ROWS];
    }

    /// Marks a cell; false when it lies outside of the grid.
    pub fn mark(&mut self, row: i32, col: i32) -> bool {
        let Some((word, bit)) = Self::bit(col) else {
            return false;
        };
        let cells = usize::try_from(row)
            .ok()
            .and_then(|row| self.rows.get_mut(row));
        match cells.and_then(|cells| cells.get_mut(word)) {
            Some(cells) => {
                *cells |= bit;
                true
            }
            None => false,
        }
    }

    /// Frees a cell.
    pub fn unmark(&mut self, row: usize, col: usize) {
        if let Some((word, bit)) = i32::try_from(col).ok().and_then(Self::bit)
            && let Some(cells) = self.rows.get_mut(row).and_then(|cells| cells.get_mut(word))
        {
            *cells &= !bit;
        }
    }

    /// Whether a cell is occupied; outside of the grid nothing is.
    #[must_use]
    pub fn occupied(&self, row: i32, col: i32) -> bool {
        let Some((word, bit)) = Self::bit(col) else {
            return false;
        };
        usize::try_from(row)
            .ok()
            .and_then(|row| self.rows.get(row))
            .and_then(|cells| cells.get(word))
            .is_some_and(|cells| cells & bit != 0)
    }

    /// Whether the cell that holds a point is occupied.
    #[must_use]
    pub fn occupied_at(&self, point: GridPoint) -> bool {
        self.occupied(libm::floor(point.row) as i32, libm::floor(point.col) as i32)
    }

    /// Word and mask of a column, none outside of the grid.
    fn bit(col: i32) -> Option<(usize, u64)> {
        let col = usize::try_from(col).ok().filter(|col| *col < GRID_COLS)?;
        Some((col / 64, 1 << (col % 64)))
    }

    /// Rebuilds the grid from one scan at a pitch [rad]: a mark where each beam ended, padded.
    /// Returns how many hits lay outside of the grid.
    ///
    /// The authors' code frees the aircraft's own cell before padding, so that an obstacle nearer
    /// than 1 m vanishes; the corrected rules keep it.
    pub fn rebuild(&mut self, scan: &LidarScan, pitch: f64, rules: Rules) -> usize {
        self.clear();
        let mut outside = 0;
        for (beam, range) in scan.ranges.iter().enumerate() {
            let range = f64::from(*range);
            if range > 0.0 {
                let angle = pitch + (scan.angle_min + scan.angle_increment * beam as f64);
                let (sin, cos) = libm::sincos(angle);
                // Rounding towards the low corner, as the cells are numbered.
                let row = libm::floor(GridPoint::AIRCRAFT.row + range * sin) as i32;
                let col = libm::floor(GridPoint::AIRCRAFT.col + range * cos) as i32;
                outside += usize::from(!self.mark(row, col));
            }
        }
        if rules == Rules::Authors {
            self.unmark(ORIGIN_ROW, ORIGIN_COL);
        }
        self.pad();
        outside
    }

    /// Whether every cell that the segment passes is free.
    #[must_use]
    pub fn segment_is_free(&self, from: GridPoint, to: GridPoint) -> bool {
        let length = from.distance(&to);
        if length <= 0.0 {
            return !self.occupied_at(from);
        }
        let direction = [(to.row - from.row) / length, (to.col - from.col) / length];
        CellWalk::new(from, direction)
            .take(MAX_WALK)
            .take_while(|(_, _, entered)| *entered <= length)
            .all(|(row, col, _)| !self.occupied(row, col))
    }

    /// Marks the eight neighbours of every occupied cell.
    pub fn pad(&mut self) {
        let mut below = [0; WORDS];
        for row in 0..GRID_ROWS {
            let own = widen(&self.rows[row]);
            let above = self.rows.get(row + 1).map_or([0; WORDS], widen);
            for word in 0..WORDS {
                self.rows[row][word] = below[word] | own[word] | above[word];
            }
            below = own;
        }
    }
}

impl Default for OccupancyGrid {
    fn default() -> Self {
        Self::new()
    }
}

/// A row of cells with the neighbours to its left and right.
fn widen(cells: &[u64; WORDS]) -> [u64; WORDS] {
    let mut wide = *cells;
    for word in 0..WORDS {
        wide[word] |= cells[word] << 1 | cells[word] >> 1;
        if word > 0 {
            wide[word] |= cells[word - 1] >> 63;
        }
        if let Some(next) = cells.get(word + 1) {
            wide[word] |= next << 63;
        }
    }
    // Bits beyond the last column stay free.
    wide[WORDS - 1] &= u64::MAX >> (WORDS * 64 - GRID_COLS);
    wide
}
