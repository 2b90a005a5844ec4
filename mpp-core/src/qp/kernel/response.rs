//! Response of the outputs to the normalised controls. A row leaves out the controls that come too late to
//! change its output.

use super::super::layout::{OUTPUTS, reach};
use core::ops::Range;

/// One row for each output, with one entry for each control that can change the output. The length of a
/// row is rounded up to a multiple of four, after the sums of [`super::controls::dot`]. The sums are then
/// identical to the bit with sums over all controls.
#[derive(Clone, Debug)]
pub(in crate::qp) struct Response(pub(in crate::qp) [f64; ENTRIES]);

/// Start of each row, and number of controls that reach its output.
const OUTPUT_ROWS: [(usize, usize); OUTPUTS] = {
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
    let (start, reach) = OUTPUT_ROWS[OUTPUTS - 1];
    start + reach.next_multiple_of(4)
};

/// Place of a row.
fn range(output: usize) -> Range<usize> {
    let (start, reach) = OUTPUT_ROWS.get(output).copied().unwrap_or_default();
    start..start + reach.next_multiple_of(4)
}

impl Response {
    pub(super) const fn new() -> Self {
        Self([0.0; ENTRIES])
    }

    /// A row. Its length is a multiple of four.
    pub(in crate::qp) fn row(&self, output: usize) -> &[f64] {
        self.0.get(range(output)).unwrap_or(&[])
    }

    /// The rows of outputs. They are empty if two of the outputs are the same.
    pub(super) fn rows_mut<const N: usize>(&mut self, outputs: [usize; N]) -> [&mut [f64]; N] {
        self.0
            .get_disjoint_mut(outputs.map(range))
            .unwrap_or_else(|_| core::array::from_fn(|_| Default::default()))
    }
}
