//! Random occupancy grids.

use crate::common::draw::Draw;
use mpp_core::paper::config::{GRID_COLS, GRID_ROWS};
use mpp_core::paper::{GridPoint, OccupancyGrid};

/// A point somewhere on the grid.
pub(crate) fn point(draw: &mut Draw) -> GridPoint {
    GridPoint {
        row: draw.between(0.0, GRID_ROWS as f64),
        col: draw.between(0.0, GRID_COLS as f64),
    }
}

/// A grid with this many random cells marked.
pub(crate) fn grid(draw: &mut Draw, cells: usize) -> OccupancyGrid {
    let mut grid = OccupancyGrid::new();
    for _ in 0..cells {
        let GridPoint { row, col } = point(draw);
        assert!(grid.mark(row as i32, col as i32));
    }
    grid
}
