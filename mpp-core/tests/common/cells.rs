//! Cells of a rolling grid.

use mpp_core::map::RollingGrid;

/// Edge of a cell \[m\], and numbers of columns and rows of the window.
pub(crate) const CELL: f64 = 0.5;
pub(crate) const COLS: usize = 128;
pub(crate) const ROWS: usize = 64;

/// Whether a cell of the window is occupied. No cell outside of the window is.
pub(crate) fn occupied(map: &RollingGrid, row: i32, col: i32) -> bool {
    let inside = (0..COLS as i32).contains(&col) && (0..ROWS as i32).contains(&row);
    inside && map.row(row as usize).0 >> col & 1 == 1
}

/// Centre of a cell of the window \[m\].
pub(crate) fn centre(map: &RollingGrid, row: i32, col: i32) -> (f64, f64) {
    (
        map.first_x() + CELL * (f64::from(col) + 0.5),
        map.floor() + CELL * (f64::from(row) + 0.5),
    )
}
