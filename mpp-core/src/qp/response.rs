//! What outputs depend on, without the controls that come too late for them.

use super::rows::{OUTPUTS, reach};

/// A row for each output, as long as the controls that can change it. In fours, as sums go
/// ([`super::dense::dot`]): they are the same to the bit as over all controls.
#[derive(Clone, Debug)]
pub(super) struct Response([f64; ENTRIES]);

/// Where a row starts, and how many controls reach its output.
const ROWS: [(usize, usize); OUTPUTS] = {
    let mut rows = [(0, 0); OUTPUTS];
    let (mut output, mut start) = (0, 0);
    while output < OUTPUTS {
        rows[output] = (start, reach(output));
        start += reach(output).next_multiple_of(4);
        output += 1;
    }
    rows
};
const ENTRIES: usize = {
    let (start, reach) = ROWS[OUTPUTS - 1];
    start + reach.next_multiple_of(4)
};

impl Response {
    pub(super) const fn new() -> Self {
        Self([0.0; ENTRIES])
    }

    /// The rows, in fours.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        ROWS.iter().map_while(|(start, reach)| {
            let end = start + reach.next_multiple_of(4);
            self.0.get(*start..end)
        })
    }

    /// The rows as far as controls reach, and no farther than `len`.
    pub(super) fn rows_within(&self, len: usize) -> impl Iterator<Item = &[f64]> {
        ROWS.iter()
            .map_while(move |(start, reach)| self.0.get(*start..start + reach.min(&len)))
    }

    /// A row, in fours.
    pub(super) fn row(&self, output: usize) -> &[f64] {
        let (start, reach) = ROWS.get(output).copied().unwrap_or_default();
        let end = start + reach.next_multiple_of(4);
        self.0.get(start..end).unwrap_or(&[])
    }

    pub(super) fn row_mut(&mut self, output: usize) -> &mut [f64] {
        let (start, reach) = ROWS.get(output).copied().unwrap_or_default();
        let end = start + reach.next_multiple_of(4);
        self.0.get_mut(start..end).unwrap_or(&mut [])
    }

    /// Sets a row from one over all controls.
    pub(super) fn set_row(&mut self, output: usize, row: &[f64]) {
        for (place, value) in self.row_mut(output).iter_mut().zip(row) {
            *place = *value;
        }
    }
}
