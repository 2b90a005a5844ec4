//! Occupancy log-odds of the level of flight in plan view, in a window as wide as circles need.
//!
//! A hit up to 2.5 m above or below the level occupies its cell; a beam has seen a cell free where it passes within 1.5 m of the
//! level. What is shorter, and stands between two rings of the lidar, is not seen.

use super::walk::{Walk, entered, voxel, wrapped};
use crate::tuning::grid::{CELL, FREE, HIT, LIMIT};

/// Cells along x and y, and those behind the aircraft and to its left.
const CELLS: [usize; 2] = [192, 160];
const BEHIND: [i64; 2] = [72, 80];
/// Cells in a word of bits.
const WORD: usize = 32;
/// Distance from the level up to which hits count \[m\]: the height of a wing that banks, and the errors of attitudes. Source: chosen.
const HITS: f64 = 2.5;
/// Distance from the level up to which passing beams count \[m\], and in which a way out stays. More sees between rings 4 deg
/// apart, and less of what is short. Source: decision 76.
const PASSES: f64 = 1.5;

/// The level of flight.
#[derive(Clone, Debug)]
pub(super) struct LevelGrid {
    /// Log-odds by x and y, each modulo its length; 0 where no beam has been.
    log_odds: [[i8; CELLS[1]]; CELLS[0]],
    /// Cells that this scan has changed: a bit for each. Of many beams that pass a thin trunk in its cell, the scan counts the one
    /// that hits.
    changed: [[u32; CELLS[1] / WORD]; CELLS[0]],
    /// First x and y in the window, in cells, and where they lie in the memory.
    first: [i64; 2],
    corner: [usize; 2],
    /// Height of the level \[m\].
    height: f64,
}

impl LevelGrid {
    pub(super) const fn new() -> Self {
        Self {
            log_odds: [[0; CELLS[1]]; CELLS[0]],
            changed: [[0; CELLS[1] / WORD]; CELLS[0]],
            first: [0; 2],
            corner: [0; 2],
            height: 0.0,
        }
    }

    /// Forgets everything, and begins at this x \[m\] and y = 0.
    pub(super) fn clear(&mut self, x: f64) {
        self.log_odds.as_flattened_mut().fill(0);
        self.place_window([voxel(x) - BEHIND[0], -BEHIND[1]]);
    }

    /// Takes the height of the level \[m\].
    pub(super) fn set_height(&mut self, height: f64) {
        self.height = height;
    }

    fn place_window(&mut self, first: [i64; 2]) {
        (self.first, self.corner) = (first, [0, 1].map(|axis| slot(first[axis], axis)));
    }

    /// Begins a scan from a position \[m\]. The window goes with the aircraft.
    pub(super) fn begin(&mut self, [x, y, _]: &[f64; 3]) {
        let [old_x, old_y] = self.first;
        let first = [voxel(*x) - BEHIND[0], voxel(*y) - BEHIND[1]];
        for x in entered(old_x, first[0], CELLS[0]) {
            if let Some(slice) = self.log_odds.get_mut(slot(x, 0)) {
                slice.fill(0);
            }
        }
        for y in entered(old_y, first[1], CELLS[1]) {
            for slice in &mut self.log_odds {
                if let Some(cell) = slice.get_mut(slot(y, 1)) {
                    *cell = 0;
                }
            }
        }
        self.place_window(first);
        self.changed.as_flattened_mut().fill(0);
    }

    /// Place of a point in the window, in cells from its first ones.
    fn place(&self, point: [f64; 2]) -> Option<[usize; 2]> {
        // A number below zero is a very large one here.
        let at = [0, 1].map(|axis| (voxel(point[axis]) - self.first[axis]) as u64);
        let inside = (at.iter().zip(CELLS)).all(|(at, length)| *at < length as u64);
        inside.then_some(at.map(|it| it as usize))
    }

    /// The cell at a place in the memory, if this scan has not changed it yet.
    fn change(&mut self, x: usize, y: usize) -> Option<&mut i8> {
        let changed = self.changed.get_mut(x)?.get_mut(y / WORD)?;
        let bit = 1 << (y % WORD);
        if *changed & bit != 0 {
            return None;
        }
        *changed |= bit;
        self.log_odds.get_mut(x)?.get_mut(y)
    }

    /// Marks the end of a beam \[m\].
    pub(super) fn mark(&mut self, [x, y, z]: &[f64; 3]) {
        if libm::fabs(z - self.height) > HITS {
            return;
        }
        let [corner_x, corner_y] = self.corner;
        if let Some([x, y]) = self.place([*x, *y])
            && let Some(cell) = self.change(
                wrapped(corner_x + x, CELLS[0]),
                wrapped(corner_y + y, CELLS[1]),
            )
        {
            *cell = cell.saturating_add(HIT).min(LIMIT);
        }
    }

    /// Takes something from the log-odds where the first `end` metres of a beam from an origin \[m\] pass the level.
    pub(super) fn pass(&mut self, origin: &[f64; 3], direction: &[f64; 3], end: f64, less: i8) {
        let [ahead, right, up] = *direction;
        let Some([from, to]) = self.crossed(origin[2], up, end) else {
            return;
        };
        let start = [origin[0] + from * ahead, origin[1] + from * right];
        let Some(place) = self.place(start) else {
            return;
        };
        let [mut x, mut y] = [0, 1].map(|axis| {
            let side = (self.first[axis] + place[axis] as i64) as f64 * CELL;
            Walk::new(
                [self.corner[axis], place[axis], CELLS[axis]],
                [side, start[axis]],
                direction[axis],
            )
        });
        for _ in 0..CELLS[0] + CELLS[1] {
            if let Some(cell) = self.change(x.at, y.at) {
                let lower = cell.saturating_sub(less).max(-FREE);
                *cell = if lower == 0 { -1 } else { lower };
            }
            let (nearer, length) = if x.next < y.next {
                (&mut x, CELLS[0])
            } else {
                (&mut y, CELLS[1])
            };
            if nearer.next >= to - from || !nearer.step(length) {
                return;
            }
        }
    }

    /// The part of a beam near the level \[m\], of one that begins at a height, climbs so much a metre, and has an end.
    fn crossed(&self, height: f64, climb: f64, end: f64) -> Option<[f64; 2]> {
        let below = self.height - height;
        let [from, to] = if libm::fabs(climb) > 1e-9 {
            let [one, other] = [-PASSES, PASSES].map(|it| (below + it) / climb);
            [one.min(other).max(0.0), one.max(other).min(end)]
        } else if libm::fabs(below) <= PASSES {
            [0.0, end]
        } else {
            return None;
        };
        (from < to).then_some([from, to])
    }

    /// Whether all cells within a distance of a point along x and y \[m\] are as wanted; `None` where they leave the window.
    fn all(&self, [x, y, _]: &[f64; 3], reach: f64, wanted: impl Fn(i8) -> bool) -> Option<bool> {
        let corners = [-reach, reach].map(|by| self.place([x + by, y + by]));
        let [Some([x0, y0]), Some([x1, y1])] = corners else {
            return None;
        };
        let [corner_x, corner_y] = self.corner;
        Some((x0..=x1).all(|x| {
            let slice = self.log_odds.get(wrapped(corner_x + x, CELLS[0]));
            slice.is_some_and(|slice| {
                (y0..=y1).all(|y| {
                    let cell = slice.get(wrapped(corner_y + y, CELLS[1]));
                    cell.is_some_and(|cell| wanted(*cell))
                })
            })
        }))
    }

    /// Whether a point lies on the level, and all cells within a distance along x and y \[m\] have been seen free.
    pub(super) fn is_free(&self, point: &[f64; 3], reach: f64) -> bool {
        let [_, _, z] = point;
        libm::fabs(z - self.height) <= PASSES
            && self.all(point, reach, |cell| cell < 0) == Some(true)
    }

    /// Whether a cell within a distance along x and y \[m\] was hit by more scans than one; `None` beyond the window.
    pub(super) fn is_met(&self, point: &[f64; 3], reach: f64) -> Option<bool> {
        self.all(point, reach, |cell| cell <= HIT)
            .map(|clear| !clear)
    }
}

fn slot(at: i64, axis: usize) -> usize {
    at.rem_euclid(CELLS[axis] as i64) as usize
}
