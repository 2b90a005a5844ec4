//! Response of the outputs to the normalised controls. A row leaves out the controls that come too late to
//! change its output.

use super::controls::{ControlVector, dot};
use super::rows::{OUTPUTS, reach};
use crate::config::STAGES;
use core::ops::Range;

/// One row for each output, with one entry for each control that can change the output. The length of a
/// row is rounded up to a multiple of four, after the sums of [`super::controls::dot`]. The sums are then
/// identical to the bit with sums over all controls.
#[derive(Clone, Debug)]
pub(super) struct Response([f64; ENTRIES]);

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
    pub(super) fn row(&self, output: usize) -> &[f64] {
        self.0.get(range(output)).unwrap_or(&[])
    }

    pub(super) fn row_mut(&mut self, output: usize) -> &mut [f64] {
        self.0.get_mut(range(output)).unwrap_or(&mut [])
    }

    /// The rows of outputs. They are empty if two of the outputs are the same.
    pub(super) fn rows_mut<const N: usize>(&mut self, outputs: [usize; N]) -> [&mut [f64]; N] {
        self.0
            .get_disjoint_mut(outputs.map(range))
            .unwrap_or_else(|_| core::array::from_fn(|_| Default::default()))
    }

    /// The products of the rows of all positions and thrusts with a vector. Those of two stages are equally long.
    #[inline(always)]
    pub(super) fn products(&self, vector: &ControlVector, mut put: impl FnMut(usize, f64)) {
        let known = vector.as_chunks::<4>().0;
        let mut rest = self.0.as_chunks::<4>().0;
        for len in 1..=STAGES / 2 {
            let Some((rows, later)) = rest.split_at_checked(4 * len) else {
                return;
            };
            rest = later;
            let (one, two) = rows.split_at(2 * len);
            for (offset, rows) in [(0, one), (2, two)] {
                let (one, other) = rows.split_at(len);
                let [a, b] = pair(one, other, known);
                put(4 * (len - 1) + offset, a);
                put(4 * (len - 1) + offset + 1, b);
            }
        }
        for len in 1..=STAGES / 2 {
            let Some((rows, later)) = rest.split_at_checked(2 * len) else {
                return;
            };
            rest = later;
            let (one, other) = rows.split_at(len);
            let [a, b] = pair(one, other, known);
            put(2 * STAGES + 2 * (len - 1), a);
            put(2 * STAGES + 2 * (len - 1) + 1, b);
        }
    }

    /// The products of the responses of an output and the next one.
    pub(super) fn pair(&self, output: usize) -> Pair {
        let [one, other] = [output, output + 1].map(|output| self.row(output));
        Pair {
            first: dot(one, one),
            both: dot(one, other),
            second: dot(other, other),
        }
    }
}

/// Products of the responses of two outputs, from which the norms of all rows in these outputs follow.
pub(super) struct Pair {
    first: f64,
    both: f64,
    second: f64,
}

impl Pair {
    /// Squared norm of the response of a row that bounds `p first + q second`.
    pub(super) fn norm_squared(&self, [p, q]: [f64; 2]) -> f64 {
        p * p * self.first + 2.0 * p * q * self.both + q * q * self.second
    }
}

/// Products of two rows with a vector.
#[inline(always)]
fn pair(one: &[[f64; 4]], other: &[[f64; 4]], vector: &[[f64; 4]]) -> [f64; 2] {
    let (mut first, mut second) = ([0.0; 4], [0.0; 4]);
    for ((one, other), v) in one.iter().zip(other).zip(vector) {
        for k in 0..4 {
            first[k] += one[k] * v[k];
            second[k] += other[k] * v[k];
        }
    }
    [first, second].map(|[a, b, c, d]| (a + c) + (b + d))
}
