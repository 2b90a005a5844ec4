//! The map with memory: evidence of obstacles in the world frame, in a window that rolls along with
//! the aircraft.
//!
//! A beam speaks against obstacles on its way and for one where it ended. Of the back of an obstacle, which
//! no beam sees, the map knows nothing: [`super::ClearanceField`] completes it.

use crate::sense::LidarScan;
use core::ops::Range;

/// Edge of a cell [m].
pub(super) const CELL: f64 = 0.5;
/// Cells downrange; a power of two.
pub(super) const COLS: usize = 128;
/// Cells in height; a power of two.
pub(super) const ROWS: usize = 64;
/// Columns kept behind the aircraft.
const BEHIND: i32 = 16;

/// Evidence of one hit, and the evidence from which on a cell counts as occupied.
const HIT: i8 = 60;
const OCCUPIED: i8 = 25;
/// Evidence of a beam that passes on its way to a hit, and of one that never returned, which may
/// also be a beam that was lost.
const PASSED: i8 = 30;
const PASSED_UNANSWERED: i8 = 10;
/// Bound of the evidence either way: what is believed can be unlearned.
const LIMIT: i8 = 100;

/// Steps along a beam, within cells [m].
const STEP: f64 = 0.35;
/// Share of its range by which a hit may be too far, and length before a hit that says nothing [m].
const RANGE_DOUBT: f64 = 0.03;
const DOUBT: f64 = 1.0;
/// Share of the lidar's sight that a beam without return speaks for.
const UNANSWERED: f64 = 8.0 / 9.0;
/// Bound of the steps along one beam.
const MAX_STEPS: u16 = (COLS + ROWS) as u16 * 2;

/// The map.
#[derive(Clone, Debug)]
pub struct MemoryMap {
    /// By row from [`Self::floor`] up, and by world column modulo [`COLS`].
    evidence: [[i8; COLS]; ROWS],
    /// World column of the window's near edge.
    first_col: i32,
    /// Height of the window's low edge [m].
    floor: f64,
    started: bool,
}

impl MemoryMap {
    /// A map that knows nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            evidence: [[0; COLS]; ROWS],
            first_col: 0,
            floor: 0.0,
            started: false,
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.started = false;
    }

    /// Moves the window along with an aircraft at `x` [m]; the first time, and when the aircraft is
    /// behind it (after a position that was far wrong), it is laid anew about `altitude` [m].
    pub fn roll(&mut self, x: f64, altitude: f64) {
        let first = (libm::floor(x / CELL) as i32).saturating_sub(BEHIND);
        let behind = first < self.first_col.saturating_sub(BEHIND);
        if !self.started || behind {
            self.evidence = [[0; COLS]; ROWS];
            self.floor = altitude - 0.5 * CELL * ROWS as f64;
            self.first_col = first;
            self.started = true;
        }
        let ahead = first.saturating_sub(self.first_col).clamp(0, COLS as i32);
        for col in 0..ahead {
            let slot = slot(self.first_col.saturating_add(col));
            for row in &mut self.evidence {
                row[slot] = 0;
            }
        }
        self.first_col = first.max(self.first_col);
    }

    /// Takes what is known for what is remembered: whether the cell of each centre `(x, z)` [m] of the
    /// window is occupied.
    pub fn know(&mut self, occupied: impl Fn(f64, f64) -> bool) {
        let (first, floor) = (self.first_col, self.floor);
        for (row, evidence) in self.evidence.iter_mut().enumerate() {
            let z = floor + CELL * (row as f64 + 0.5);
            for col in 0..COLS as i32 {
                let col = first.saturating_add(col);
                let x = CELL * (f64::from(col) + 0.5);
                evidence[slot(col)] = if occupied(x, z) { LIMIT } else { -LIMIT };
            }
        }
    }

    /// Takes in a scan made at `(x, z)` [m] and a pitch [rad] by a lidar with this sight [m].
    pub fn insert(&mut self, scan: &LidarScan, sight: f64, x: f64, z: f64, pitch: f64) {
        self.insert_beams(scan, 0..scan.ranges.len(), sight, x, z, pitch);
    }

    /// Takes in some beams of a scan, as far as it has them.
    pub fn insert_beams(
        &mut self,
        scan: &LidarScan,
        beams: Range<usize>,
        sight: f64,
        x: f64,
        z: f64,
        pitch: f64,
    ) {
        let ranges = scan.ranges.iter().enumerate().take(beams.end);
        for (beam, range) in ranges.skip(beams.start) {
            let angle = pitch + (scan.angle_min + scan.angle_increment * beam as f64);
            let (up, ahead) = libm::sincos(angle);
            let at = |range: f64| (x + range * ahead, z + range * up);
            let range = f64::from(*range);
            if range > 0.0 {
                self.pass(at, range - DOUBT - RANGE_DOUBT * range, PASSED);
                if let Some(evidence) = self.cell_mut(self.locate(at(range))) {
                    *evidence = weighed(*evidence, HIT);
                }
            } else {
                self.pass(at, UNANSWERED * sight, PASSED_UNANSWERED);
            }
        }
    }

    /// Evidence against obstacles along a beam up to a length [m], once a cell.
    fn pass(&mut self, at: impl Fn(f64) -> (f64, f64), length: f64, evidence_against: i8) {
        let mut last = None;
        for step in 0..MAX_STEPS {
            let along = 0.25 + STEP * f64::from(step);
            if along >= length {
                break;
            }
            let place = self.locate(at(along));
            if last == Some(place) {
                continue;
            }
            last = Some(place);
            if let Some(evidence) = self.cell_mut(place) {
                *evidence = weighed(*evidence, -evidence_against);
            }
        }
    }

    /// Row and world column of a point `(x, z)` [m].
    fn locate(&self, (x, z): (f64, f64)) -> (i32, i32) {
        let row = libm::floor((z - self.floor) / CELL) as i32;
        (row, libm::floor(x / CELL) as i32)
    }

    fn cell_mut(&mut self, (row, col): (i32, i32)) -> Option<&mut i8> {
        let ahead = col.checked_sub(self.first_col)?;
        if !(0..COLS as i32).contains(&ahead) {
            return None;
        }
        let row = self.evidence.get_mut(usize::try_from(row).ok()?)?;
        Some(&mut row[slot(col)])
    }

    /// The window's near edge [m].
    #[must_use]
    pub fn first_x(&self) -> f64 {
        f64::from(self.first_col) * CELL
    }

    /// The window's low edge [m].
    #[must_use]
    pub fn floor(&self) -> f64 {
        self.floor
    }

    /// Of one row of the window, from the near edge on: cells that count as occupied, and cells that
    /// nothing is known of, a bit each.
    #[must_use]
    pub fn row(&self, row: usize) -> (u128, u128) {
        let (mut occupied, mut unknown) = (0, 0);
        if let Some(evidence) = self.evidence.get(row) {
            // Flight computers shift words of 32 bits.
            for cells in evidence.as_chunks::<32>().0.iter().rev() {
                let (mut block, mut unknown_block) = (0_u32, 0_u32);
                for (bit, evidence) in (0..).zip(cells) {
                    block |= u32::from(*evidence >= OCCUPIED) << bit;
                    unknown_block |= u32::from(*evidence == 0) << bit;
                }
                occupied = occupied << 32 | u128::from(block);
                unknown = unknown << 32 | u128::from(unknown_block);
            }
        }
        let first = slot(self.first_col) as u32;
        (occupied.rotate_right(first), unknown.rotate_right(first))
    }
}

impl Default for MemoryMap {
    fn default() -> Self {
        Self::new()
    }
}

/// Evidence with more of it; what was seen is never again as unknown as what was not.
fn weighed(evidence: i8, more: i8) -> i8 {
    match evidence.saturating_add(more).clamp(-LIMIT, LIMIT) {
        0 => -1,
        sum => sum,
    }
}

/// Where a world column is kept.
fn slot(col: i32) -> usize {
    col as usize & (COLS - 1)
}

const _: () = assert!(COLS.is_power_of_two() && COLS == u128::BITS as usize);
