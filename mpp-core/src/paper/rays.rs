//! The corridor of the paper's method: rays around each collocation point give eight half-planes (paper, section
//! III-B).

use super::{CellWalk, CollocationPoints, GridPoint, MAX_WALK, OccupancyGrid, Rules};
use crate::config::{STAGE_PERIOD, STAGES};
use crate::corridor::{Corridor, DIRECTION_VECTORS};
use crate::paper::config::{GRID_COLS, ORIGIN_COL, ORIGIN_ROW, RAY_LIMIT, SEARCH_ROW};

/// Distance kept from the cell that a ray hit \[m\]. It grows linearly over the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Padding {
    /// Distance at the first stage boundary.
    pub near: f64,
    /// Distance at the last stage boundary.
    pub far: f64,
}

impl Padding {
    /// The authors' values; the paper says "slightly".
    pub const AUTHORS: Self = Self {
        near: 1.5,
        far: 2.5,
    };

    fn at(&self, stage: usize) -> f64 {
        self.near + (self.far - self.near) * (stage as f64 / STAGES as f64)
    }
}

impl Corridor {
    /// Traces the rays of every collocation point; `cruise` is the airspeed of straight and level
    /// flight [m/s].
    pub fn trace(
        &mut self,
        grid: &OccupancyGrid,
        points: &CollocationPoints,
        cruise: f64,
        padding: &Padding,
        rules: Rules,
    ) {
        for (stage, (point, bounds)) in points.iter().zip(&mut self.bounds).enumerate() {
            let level_row = point.row - ORIGIN_ROW as f64;
            let level_col = point.col - ORIGIN_COL as f64 - cruise * STAGE_PERIOD * stage as f64;
            for (direction, bound) in DIRECTION_VECTORS.iter().zip(bounds) {
                let reach = match rules {
                    Rules::Authors => {
                        let hit = authors_ray(grid, *point, direction);
                        direction[0] * (hit.row - point.row) + direction[1] * (hit.col - point.col)
                    }
                    Rules::Corrected => cast_ray(grid, *point, direction),
                };
                *bound =
                    reach + direction[0] * level_row + direction[1] * level_col - padding.at(stage);
            }
        }
    }
}

/// Distance \[m\] from a point along a unit vector to the near side of the first occupied cell. It is at
/// most [`RAY_LIMIT`].
#[must_use]
pub fn cast_ray(grid: &OccupancyGrid, origin: GridPoint, direction: &[f64; 2]) -> f64 {
    CellWalk::new(origin, *direction)
        .take(MAX_WALK)
        .take_while(|(_, _, entered)| *entered < RAY_LIMIT)
        .find(|(row, col, _)| grid.occupied(*row, *col))
        .map_or(RAY_LIMIT, |(_, _, entered)| entered)
}

/// Number of rows in the window that the authors' rays see. The lowest row is [`SEARCH_ROW`].
const WINDOW_ROWS: i32 = 48;
/// Number of columns in the window that the authors' rays see.
const WINDOW_COLS: i32 = 80;
const _: () = assert!(WINDOW_COLS as usize <= GRID_COLS);

/// End point of a ray in the authors' code, in grid coordinates. It serves comparison with that code.
///
/// The ray steps from grid line to grid line of either axis and tests the cell at its position. In a
/// negative direction it therefore tests the cell that it has just crossed, and returns the far side of
/// an obstacle. Below the low edges of the window it reads the cells at the opposite edges. It returns
/// the low corner of the last cell.
#[must_use]
pub fn authors_ray(grid: &OccupancyGrid, origin: GridPoint, direction: &[f64; 2]) -> GridPoint {
    let mut at = [origin.row - SEARCH_ROW as f64, origin.col];
    let inverse = [1.0 / direction[0], 1.0 / direction[1]];
    let mut travelled = 0.0;
    for _ in 0..MAX_WALK {
        if travelled >= RAY_LIMIT {
            break;
        }
        let mut ratio = [0.0; 2];
        for axis in 0..2 {
            let line = if direction[axis] < 0.0 {
                libm::ceil(at[axis] - 1.0)
            } else {
                libm::floor(at[axis] + 1.0)
            };
            // A product, not a division: the last digit of a division would move rays along cell boundaries.
            ratio[axis] = (line - at[axis]) * inverse[axis];
        }
        let length = ratio[0].min(ratio[1]);
        at[0] += length * direction[0];
        at[1] += length * direction[1];
        let (row, col) = (at[0] as i32, at[1] as i32);
        if at[0] >= f64::from(WINDOW_ROWS) || at[1] >= f64::from(WINDOW_COLS) {
            break;
        }
        let wrapped_row = if row < 0 { row + WINDOW_ROWS } else { row };
        let wrapped_col = if col < 0 { col + WINDOW_COLS } else { col };
        if grid.occupied(wrapped_row + SEARCH_ROW as i32, wrapped_col) {
            break;
        }
        travelled += length;
    }
    GridPoint {
        row: libm::floor(at[0]) + SEARCH_ROW as f64,
        col: libm::floor(at[1]),
    }
}
