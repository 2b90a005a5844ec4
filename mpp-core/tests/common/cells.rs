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

/// The occupied cells together with the cells that count as hidden parts of obstacles.
pub(crate) struct Cells(Vec<Vec<bool>>);

impl Cells {
    /// Completes the cells by the definition. First come unknown cells that share an edge with an
    /// occupied cell, then unknown cells that share an edge or a corner with one of these.
    pub(crate) fn completed(map: &RollingGrid) -> Self {
        let all = |of: &dyn Fn(i32, i32) -> bool| {
            let row = |row| (0..COLS as i32).map(|col| of(row, col)).collect();
            Self((0..ROWS as i32).map(row).collect())
        };
        let unknown = |row: i32, col: i32| map.row(row as usize).1 >> col & 1 == 1;
        let grown = |cells: &Self, reach: i32| {
            all(&|row, col| {
                let near = (-1..=1).flat_map(|up: i32| (-1..=1).map(move |right: i32| (up, right)));
                cells.at(row, col)
                    || unknown(row, col)
                        && near
                            .filter(|(up, right)| up.abs() + right.abs() <= reach)
                            .any(|(up, right)| cells.at(row + up, col + right))
            })
        };
        let touched = all(&|row, col| occupied(map, row, col));
        grown(&grown(&touched, 1), 2)
    }

    pub(crate) fn at(&self, row: i32, col: i32) -> bool {
        let row = usize::try_from(row).ok().and_then(|row| self.0.get(row));
        let cell = usize::try_from(col)
            .ok()
            .and_then(|col| row.and_then(|row| row.get(col)));
        cell.is_some_and(|cell| *cell)
    }

    /// Centres of the cells, by row and column.
    pub(crate) fn centres(&self, map: &RollingGrid) -> Vec<(f64, f64)> {
        let cells = (0..ROWS as i32).flat_map(|row| (0..COLS as i32).map(move |col| (row, col)));
        cells
            .filter(|(row, col)| self.at(*row, *col))
            .map(|(row, col)| centre(map, row, col))
            .collect()
    }
}
