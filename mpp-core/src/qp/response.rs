//! Response of the outputs to the normalised controls. A row leaves out the controls that come too late to
//! change its output.

use super::controls::dot;
use super::rows::{OUTPUTS, RowPattern, reach};

/// One row for each output, with one entry for each control that can change the output. The length of a
/// row is rounded up to a multiple of four, after the sums of [`super::controls::dot`]. The sums are then
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
}

/// Products of the responses of two outputs, from which the norms of all rows in these outputs follow.
pub(super) struct Pair {
    outputs: (usize, usize),
    first: f64,
    both: f64,
    second: f64,
}

impl Pair {
    /// No pair yet.
    pub(super) const fn none() -> Self {
        Self {
            outputs: (OUTPUTS, OUTPUTS),
            first: 0.0,
            both: 0.0,
            second: 0.0,
        }
    }

    /// Computes the products for the outputs of a row, unless they are those of the row before.
    pub(super) fn take_up(&mut self, response: &Response, row: &RowPattern) {
        let outputs = (row.first.0, row.second.0);
        if self.outputs == outputs {
            return;
        }
        let [one, other] = [outputs.0, outputs.1].map(|output| response.row(output));
        *self = Self {
            outputs,
            first: dot(one, one),
            both: dot(one, other),
            second: dot(other, other),
        };
    }

    /// Squared norm of a row's response. The row bounds the outputs of this pair.
    pub(super) fn norm_squared(&self, row: &RowPattern) -> f64 {
        let (p, q) = (row.first.1, row.second.1);
        p * p * self.first + 2.0 * p * q * self.both + q * q * self.second
    }
}
