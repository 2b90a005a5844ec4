//! Numbers and bits of cells, for flight computers that round and shift long words slowly.

/// Whether a cell of a row is set. A flight computer takes a byte of the row with fewer instructions than it
/// shifts the row.
pub(super) fn bit(cells: &u128, col: usize) -> bool {
    cells.to_le_bytes()[col / 8 % 16] >> (col % 8) & 1 == 1
}

/// The number of the cell that holds a coordinate in cells: the coordinate, rounded down. Coordinates beyond the
/// range of numbers give its end. A flight computer does this with far fewer instructions than
/// `libm::floor`, and the result is the same.
pub(crate) fn rounded_down(coordinate: f64) -> i32 {
    let cut = coordinate as i32;
    cut.saturating_sub(i32::from(f64::from(cut) > coordinate))
}
