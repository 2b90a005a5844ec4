//! Response of the outputs to the controls. A row leaves out the controls that come too late to change
//! its output.

use super::rows::{OUTPUTS, reach};

/// One row for each output, with one entry for each control that can change the output. The length of a
/// row is rounded up to a multiple of four, after the sums of [`super::dense::dot`]. The sums are then
/// identical to the bit with sums over all controls.
#[derive(Clone, Debug)]
pub(super) struct Response([f64; ENTRIES]);

/// Start of each row, and number of controls that reach its output.
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

    /// The rows. Their lengths are multiples of four.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        ROWS.iter().map_while(|(start, reach)| {
            let end = start + reach.next_multiple_of(4);
            self.0.get(*start..end)
        })
    }

    /// The rows, cut to the controls that reach their outputs and to at most `len` entries.
    pub(super) fn rows_within(&self, len: usize) -> impl Iterator<Item = &[f64]> {
        ROWS.iter()
            .map_while(move |(start, reach)| self.0.get(*start..start + reach.min(&len)))
    }

    /// A row. Its length is a multiple of four.
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

    /// Sets a row from the first entries of a row over all controls.
    pub(super) fn set_row(&mut self, output: usize, row: &[f64]) {
        for (place, value) in self.row_mut(output).iter_mut().zip(row) {
            *place = *value;
        }
    }
}
