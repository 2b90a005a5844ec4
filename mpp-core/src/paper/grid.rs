//! The occupancy grid: a binary matrix of 1 m cells around the aircraft, padded by one cell (paper,
//! section II-C).
//!
//! Grid coordinates are `(row, col)`: the row counts height, and the column counts downrange distance.
//! The aircraft is at `(ORIGIN_ROW, ORIGIN_COL)`, the low corner of that cell. The grid does not pitch
//! with the aircraft.

use super::{CellWalk, GridPoint, Rules};
use crate::map::cell::rounded_down;
use crate::paper::config::{GRID_COLS, GRID_ROWS, ORIGIN_COL, ORIGIN_ROW};
use crate::sense::LidarScan;

/// Greatest number of cells on a walk across the whole grid. It bounds every walk.
pub(super) const MAX_WALK: usize = GRID_ROWS + GRID_COLS + 3;

const WORDS: usize = GRID_COLS.div_ceil(64);
/// No cell. As a constant it is one call that writes zeros, not a store for each word.
const NO_CELLS: [[u64; WORDS]; GRID_ROWS] = [[0; WORDS]; GRID_ROWS];

/// Occupancy of the cells, one bit for each. A cell without a mark counts as free.
#[derive(Clone, Debug)]
pub struct OccupancyGrid {
    rows: [[u64; WORDS]; GRID_ROWS],
}

impl OccupancyGrid {
    /// A free grid.
    #[must_use]
    pub const fn new() -> Self {
        Self { rows: NO_CELLS }
    }

    /// Frees every cell.
    pub fn clear(&mut self) {
        self.rows = NO_CELLS;
    }

    /// Marks a cell as occupied. Returns false if the cell lies outside of the grid.
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

    /// Whether a cell is occupied. A cell outside of the grid counts as free.
    #[must_use]
    pub fn occupied(&self, row: i32, col: i32) -> bool {
        let (Ok(row), Ok(col)) = (usize::try_from(row), usize::try_from(col)) else {
            return false;
        };
        let cells = self.rows.get(row).and_then(|cells| cells.get(col / 64));
        // A flight computer takes a byte of a word with fewer instructions than it shifts the word.
        let bits = cells.map_or(0, |cells| cells.to_le_bytes()[col / 8 % 8]);
        col < GRID_COLS && bits >> (col % 8) & 1 == 1
    }

    /// Whether the cell that holds a point is occupied.
    #[must_use]
    pub fn occupied_at(&self, point: GridPoint) -> bool {
        self.occupied(rounded_down(point.row), rounded_down(point.col))
    }

    /// Word and mask of a column, or `None` for a column outside of the grid.
    fn bit(col: i32) -> Option<(usize, u64)> {
        let col = usize::try_from(col).ok().filter(|col| *col < GRID_COLS)?;
        Some((col / 64, 1 << (col % 64)))
    }

    /// Rebuilds the grid from one scan at a pitch \[rad\]: marks the cell in which each beam ended, and pads
    /// the marks. Returns the number of hits outside of the grid.
    ///
    /// The authors' code frees the aircraft's own cell before the padding, so that an obstacle nearer than
    /// 1 m vanishes. The corrected rules keep this obstacle.
    pub fn rebuild(&mut self, scan: &LidarScan, pitch: f64, rules: Rules) -> usize {
        self.clear();
        let mut outside = 0;
        for (beam, range) in scan.ranges.iter().enumerate() {
            let range = f64::from(*range);
            if range > 0.0 {
                let angle = pitch + scan.beam_angle(beam);
                let (sin, cos) = libm::sincos(angle);
                // The low corner of a cell has the cell's number as coordinates.
                let row = rounded_down(GridPoint::AIRCRAFT.row + range * sin);
                let col = rounded_down(GridPoint::AIRCRAFT.col + range * cos);
                outside += usize::from(!self.mark(row, col));
            }
        }
        if rules.are_authors() {
            self.unmark(ORIGIN_ROW, ORIGIN_COL);
        }
        self.pad();
        outside
    }

    /// Whether every cell that the segment passes is free.
    #[must_use]
    pub fn segment_is_free(&self, from: GridPoint, to: GridPoint) -> bool {
        if self.box_is_free(from, to) {
            return true;
        }
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

    /// Whether every cell of the box about two points is free. A walk between the points stays in this box. The
    /// slack is far more than the rounding of a walk.
    fn box_is_free(&self, from: GridPoint, to: GridPoint) -> bool {
        const SLACK: f64 = 1e-6;
        let cells = |a: f64, b: f64, count: usize| {
            let inside = |cell: i32| cell.clamp(0, count as i32) as usize;
            let low = rounded_down(a.min(b) - SLACK);
            let high = rounded_down(a.max(b) + SLACK).saturating_add(1);
            inside(low)..inside(high)
        };
        let rows = cells(from.row, to.row, GRID_ROWS);
        let cols = cells(from.col, to.col, GRID_COLS);
        let mut masks = [0; WORDS];
        for (word, mask) in masks.iter_mut().enumerate() {
            // The bits before a column, of those in this word.
            let before = |col: usize| match col.saturating_sub(64 * word) {
                bits @ 0..64 => (1_u64 << bits) - 1,
                _ => u64::MAX,
            };
            *mask = before(cols.end) & !before(cols.start);
        }
        let mut rows = self.rows.get(rows).unwrap_or_default().iter();
        rows.all(|row| {
            row.iter()
                .zip(&masks)
                .all(|(cells, mask)| cells & mask == 0)
        })
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

/// A row in which the left and right neighbours of each occupied cell are occupied too.
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
