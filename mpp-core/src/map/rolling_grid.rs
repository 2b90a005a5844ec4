//! The rolling occupancy grid: log-odds of obstacles in the world frame, in a window that moves along with the
//! aircraft.
//!
//! A beam lowers the log-odds of the cells on its way, and raises those of the cell at its end. No beam sees
//! the back of an obstacle, so the map knows nothing of it; [`super::DistanceField`] completes it.

use super::cell::{FixedPoint, at_least, bit, rounded_down, zeros};
use crate::sense::LidarScan;
use crate::tuning::grid::{
    BEHIND, BLIND_CELLS, BLIND_SHARE, CELL, FIRST_STEP, FREE, HIT, HIT_DOUBT, ISOLATED_CELLS,
    LIMIT, OCCUPIED, PASSED, PASSED_UNANSWERED, RANGE_DOUBT, STEP, UNANSWERED_SHARE,
};
use crate::vehicle::Pose;
use core::ops::Range;

/// Number of cells downrange; a power of two.
pub(super) const COLS: usize = 128;
/// Number of cells in height; a power of two.
pub(super) const ROWS: usize = 64;
/// Greatest number of steps along one beam.
const MAX_STEPS: u16 = (COLS + ROWS) as u16 * 2;

/// The rolling occupancy grid.
///
/// # Example
///
/// One hit makes a cell occupied. The [`super::DistanceField`] completes what lies behind it.
///
/// ```
/// use mpp_core::map::{DistanceField, FAR, RollingGrid};
/// use mpp_core::vehicle::Pose;
/// use mpp_core::sense::LidarScan;
///
/// // One beam along the body axis, which returns from 20.1 m.
/// let mut scan = LidarScan::new();
/// scan.ranges.push(20.1).expect("there is room for 128 beams");
///
/// let mut map = RollingGrid::new();
/// map.roll(0.0, 50.0);
/// map.insert(&scan, 45.0, &Pose { x: 0.0, z: 50.2, pitch: 0.0 });
/// let mut field = Box::new(DistanceField::new());
/// field.build(&map, 0.0);
///
/// assert!(field.is_occupied(20.1, 50.2) && field.is_occupied(21.1, 50.2));
/// assert!(!field.is_occupied(10.0, 50.2) && !field.is_unknown(10.0, 50.2));
/// assert!(field.is_unknown(10.0, 60.0));
/// assert!((field.distance(10.0, 50.2) - FAR).abs() < 1e-9);
/// assert!(field.distance(18.0, 50.2) < 2.5);
/// ```
#[derive(Clone, Debug)]
pub struct RollingGrid {
    /// Log-odds of each cell. Rows count up from [`Self::floor`]; columns are world columns modulo [`COLS`].
    log_odds: [[i8; COLS]; ROWS],
    /// World column at the near edge of the window.
    first_col: i32,
    /// Height of the low edge of the window \[m\].
    floor: f64,
    started: bool,
}

/// Cells that a beam of a scan ended in and that stand alone, columns as in the map. The other beams of the scan
/// do not clear them.
#[derive(Clone, Debug)]
pub struct IsolatedHits([u128; ROWS]);

impl IsolatedHits {
    /// No cell.
    #[must_use]
    pub const fn none() -> Self {
        Self([0; ROWS])
    }
}

impl RollingGrid {
    /// Number of rows and of columns of the window.
    pub const SHAPE: [usize; 2] = [ROWS, COLS];

    /// A map that knows nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            log_odds: [[0; COLS]; ROWS],
            first_col: 0,
            floor: 0.0,
            started: false,
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.started = false;
    }

    /// Moves the window along with an aircraft at `x` \[m\], and centres its height on `altitude` \[m\], to
    /// whole cells. At the first call, and when the aircraft is behind the window, the function empties the
    /// map. An aircraft is behind the window after a position that was far wrong.
    pub fn roll(&mut self, x: f64, altitude: f64) {
        let first = rounded_down(x / CELL).saturating_sub(BEHIND);
        let behind = first < self.first_col.saturating_sub(BEHIND);
        if !self.started || behind {
            self.log_odds = [[0; COLS]; ROWS];
            self.floor = altitude - 0.5 * CELL * ROWS as f64;
            self.first_col = first;
            self.started = true;
        }
        let ahead = first.saturating_sub(self.first_col).clamp(0, COLS as i32);
        for col in 0..ahead {
            let slot = slot(self.first_col.saturating_add(col));
            for row in &mut self.log_odds {
                row[slot] = 0;
            }
        }
        self.first_col = first.max(self.first_col);
        self.roll_rows(altitude);
    }

    /// Moves the rows of the window to another altitude \[m\]. Rows that come into the window are not known.
    fn roll_rows(&mut self, altitude: f64) {
        let floor = altitude - 0.5 * CELL * ROWS as f64;
        let up = libm::round((floor - self.floor) / CELL);
        let rows = (libm::fabs(up) as usize).min(ROWS);
        if rows == 0 {
            return;
        }
        // A turn to the right is one to the left by the rest, and the image holds one rotation.
        let left = if up > 0.0 { rows } else { ROWS - rows };
        self.log_odds.rotate_left(left);
        let fresh = if up > 0.0 { ROWS - rows..ROWS } else { 0..rows };
        for row in self.log_odds.get_mut(fresh).unwrap_or_default() {
            *row = [0; COLS];
        }
        self.floor += CELL * up;
    }

    /// Overwrites the whole window with certain knowledge. `occupied` tells whether the cell
    /// with the centre `(x, z)` \[m\] is occupied.
    pub fn know(&mut self, occupied: impl Fn(f64, f64) -> bool) {
        let (first, floor) = (self.first_col, self.floor);
        for (row, log_odds) in self.log_odds.iter_mut().enumerate() {
            let z = floor + CELL * (row as f64 + 0.5);
            for col in 0..COLS as i32 {
                let col = first.saturating_add(col);
                let x = CELL * (f64::from(col) + 0.5);
                log_odds[slot(col)] = if occupied(x, z) { LIMIT } else { -FREE };
            }
        }
    }

    /// Takes in a scan from a pose by a lidar with the range `sight` \[m\].
    pub fn insert(&mut self, scan: &LidarScan, sight: f64, pose: &Pose) {
        let mut isolated = IsolatedHits::none();
        self.write_isolated_hits(scan, sight, pose, &mut isolated);
        self.insert_beams(scan, 0..scan.ranges.len(), sight, pose, &isolated);
    }

    /// Takes in the beams of a scan with the numbers `beams`. Numbers beyond the last beam have no effect. `isolated` are
    /// the cells of [`Self::write_isolated_hits`] for the same scan and pose.
    pub fn insert_beams(
        &mut self,
        scan: &LidarScan,
        beams: Range<usize>,
        sight: f64,
        pose: &Pose,
        isolated: &IsolatedHits,
    ) {
        let &Pose { x, z, pitch } = pose;
        let ranges = scan.ranges.iter().enumerate().take(beams.end);
        for (beam, range) in ranges.skip(beams.start) {
            let range = f64::from(*range);
            // A bad beam shows nothing: neither an obstacle nor free space.
            if range < 0.0 {
                continue;
            }
            let angle = pitch + scan.beam_angle(beam);
            let (up, ahead) = libm::sincos(angle);
            let beam = [(x, z), (ahead, up)];
            if is_return(range, sight) {
                self.pass(
                    beam,
                    range - HIT_DOUBT - RANGE_DOUBT * range,
                    PASSED,
                    isolated,
                );
                let place = self.slot_at(self.locate((x + range * ahead, z + range * up)));
                if let Some((row, slot)) = place
                    && let Some(cells) = self.log_odds.get_mut(row)
                {
                    cells[slot] = updated(cells[slot], HIT);
                }
            } else {
                self.pass(beam, UNANSWERED_SHARE * sight, PASSED_UNANSWERED, isolated);
            }
        }
    }

    /// Whether a scan has no return although obstacles that the map knows stand in its fan. The scan then does not
    /// show free space: the lidar is blind.
    #[must_use]
    pub fn contradicts(&self, scan: &LidarScan, sight: f64, pose: &Pose) -> bool {
        if !self.started || has_return(scan, sight) {
            return false;
        }
        let middle = 0.5 * (scan.ranges.len().saturating_sub(1)) as f64;
        let centre = pose.pitch + scan.angle_min + scan.angle_increment * middle;
        let half = libm::fabs(scan.angle_increment) * middle * BLIND_SHARE;
        let mut seen = 0_u32;
        for (row, log_odds) in self.log_odds.iter().enumerate() {
            let up = self.floor + CELL * (row as f64 + 0.5) - pose.z;
            for col in 0..COLS as i32 {
                let col = self.first_col.saturating_add(col);
                if log_odds
                    .get(slot(col))
                    .is_none_or(|log_odds| *log_odds < OCCUPIED)
                {
                    continue;
                }
                let ahead = CELL * (f64::from(col) + 0.5) - pose.x;
                let off = libm::fabs(libm::atan2(up, ahead) - centre);
                let near = libm::hypot(ahead, up) < BLIND_SHARE * sight;
                seen += u32::from(near && off < half);
            }
        }
        seen >= BLIND_CELLS
    }

    /// Lowers the log-odds of each cell along a beam, up to a length \[m\]. The beam has its start \[m\]
    /// and its direction [-].
    // Both kinds of beams call it, and each would hold a copy.
    #[inline(never)]
    fn pass(
        &mut self,
        [(x, z), (ahead, up)]: [(f64, f64); 2],
        length: f64,
        by: i8,
        isolated: &IsolatedHits,
    ) {
        let steps = libm::ceil((length - FIRST_STEP) * (1.0 / STEP)) as u16;
        let near_edge = f64::from(self.first_col);
        let mut col = FixedPoint::of((x + FIRST_STEP * ahead) / CELL - near_edge);
        let mut row = FixedPoint::of((z + FIRST_STEP * up - self.floor) / CELL);
        let [next_col, next_row] = [ahead, up].map(|share| FixedPoint::of(STEP / CELL * share));
        let first_slot = slot(self.first_col);
        let (mut last, mut entered) = (None, false);
        for _ in 0..steps.min(MAX_STEPS) {
            let place = (row.cell(), col.cell());
            let before = last.replace(place);
            (row, col) = (row.after(next_row), col.after(next_col));
            let (row, col) = (place.0 as usize, place.1 as usize);
            let (Some(cells), Some(isolated), 0..COLS) =
                (self.log_odds.get_mut(row), isolated.0.get(row), col)
            else {
                // A beam that leaves the window does not come back.
                if entered {
                    break;
                }
                continue;
            };
            entered = true;
            let slot = (first_slot + col) % COLS;
            let cell = &mut cells[slot];
            // Most cells on the way are as free as they can be. A beam of this scan that ended in a cell that stands alone says
            // more than others that pass.
            if *cell > -FREE && before != Some(place) && !bit(isolated, slot) {
                *cell = updated(*cell, -by);
            }
        }
    }

    /// Writes the cells that the beams of a scan ended in and that stand alone: a pole, a wire, or a bar end on.
    /// Beams that pass the rim of something larger clear the cells that errors of the range set beside it.
    pub fn write_isolated_hits(
        &self,
        scan: &LidarScan,
        sight: f64,
        pose: &Pose,
        isolated: &mut IsolatedHits,
    ) {
        let mut hits = [0_u128; ROWS];
        for (beam, range) in scan.ranges.iter().enumerate() {
            let range = f64::from(*range);
            if is_return(range, sight) {
                let (up, ahead) = libm::sincos(pose.pitch + scan.beam_angle(beam));
                let place = (pose.x + range * ahead, pose.z + range * up);
                if let Some((row, slot)) = self.slot_at(self.locate(place))
                    && let Some(cells) = hits.get_mut(row)
                {
                    *cells |= 1 << slot;
                }
            }
        }
        for (row, isolated) in isolated.0.iter_mut().enumerate() {
            *isolated = 0;
            let near = hits.get(row.saturating_sub(2)..(row + 3).min(ROWS));
            let near = near.unwrap_or_default();
            let mut rest = hits.get(row).copied().unwrap_or(0);
            while rest != 0 {
                let col = rest.trailing_zeros();
                rest &= rest - 1;
                let about =
                    |cells: &u128| (cells.rotate_left(2).rotate_right(col) & 0b11111).count_ones();
                if near.iter().map(about).sum::<u32>() <= ISOLATED_CELLS {
                    *isolated |= 1 << col;
                }
            }
        }
    }

    /// Row and world column of a point `(x, z)` \[m\].
    pub(crate) fn locate(&self, (x, z): (f64, f64)) -> (i32, i32) {
        (
            rounded_down((z - self.floor) / CELL),
            rounded_down(x / CELL),
        )
    }

    /// Row and slot of a cell by its row and world column, if it lies in the window.
    fn slot_at(&self, (row, col): (i32, i32)) -> Option<(usize, usize)> {
        let ahead = col.checked_sub(self.first_col)?;
        let inside = (0..COLS as i32).contains(&ahead) && (0..ROWS as i32).contains(&row);
        inside.then_some((row as usize, slot(col)))
    }

    /// Log-odds of the cell that holds a place `(x, z)` \[m\]; 0 if no beam has seen it, or outside of the window.
    #[must_use]
    pub fn log_odds(&self, place: (f64, f64)) -> i8 {
        self.log_odds_of(self.locate(place))
    }

    /// The same of a cell by its row and world column.
    pub(crate) fn log_odds_of(&self, cell: (i32, i32)) -> i8 {
        let found = self.slot_at(cell);
        found.map_or(0, |(row, slot)| {
            self.log_odds.get(row).map_or(0, |cells| cells[slot])
        })
    }

    /// Downrange position of the window's near edge \[m\].
    #[must_use]
    pub fn first_x(&self) -> f64 {
        f64::from(self.first_col) * CELL
    }

    /// Height of the window's low edge \[m\].
    #[must_use]
    pub fn floor(&self) -> f64 {
        self.floor
    }

    /// Two bit masks of one row of the window, from the near edge on: the cells that count as occupied, and
    /// the cells of which the map knows nothing.
    #[must_use]
    pub fn row(&self, row: usize) -> (u128, u128) {
        let (mut occupied, mut unknown) = (0, 0);
        if let Some(log_odds) = self.log_odds.get(row) {
            for cells in log_odds.as_chunks::<32>().0.iter().rev() {
                let (mut block, mut unknown_block) = (0, 0);
                for four in cells.as_chunks::<4>().0.iter().rev() {
                    block = block << 4 | at_least::<OCCUPIED>(*four);
                    unknown_block = unknown_block << 4 | zeros(*four);
                }
                occupied = occupied << 32 | u128::from(block);
                unknown = unknown << 32 | u128::from(unknown_block);
            }
        }
        let first = slot(self.first_col) as u32;
        (occupied.rotate_right(first), unknown.rotate_right(first))
    }
}

/// The log-odds of a cell after a beam, within the limits. It is never 0, because 0 means that no beam has seen
/// the cell.
fn updated(log_odds: i8, change: i8) -> i8 {
    match log_odds.saturating_add(change).clamp(-FREE, LIMIT) {
        0 => -1,
        sum => sum,
    }
}

/// Whether a beam of a scan by a lidar with this range \[m\] has met an obstacle.
#[inline(never)]
pub(crate) fn has_return(scan: &LidarScan, sight: f64) -> bool {
    let mut ranges = scan.ranges.iter();
    ranges.any(|range| is_return(f64::from(*range), sight))
}

/// Whether a range \[m\] is that of an obstacle. Some lidars give 0 where nothing came back, others their full
/// range.
pub(super) fn is_return(range: f64, sight: f64) -> bool {
    range > 0.0 && range < sight
}

/// Index at which the map stores a world column.
fn slot(col: i32) -> usize {
    col as usize & (COLS - 1)
}

const _: () = assert!(COLS.is_power_of_two() && COLS == u128::BITS as usize);
