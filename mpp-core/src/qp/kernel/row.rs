//! The left-hand side of a row.

use super::super::layout::{OUTPUTS, TERMS};

/// Left-hand side of a row in the outputs `y`: the sum of `factor y[output]` over the terms `(output, factor)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::qp) struct RowPattern(pub(in crate::qp) [(usize, f64); TERMS]);

impl RowPattern {
    /// The pattern of a row that bounds one output.
    pub(in crate::qp) fn single(output: usize, factor: f64) -> Self {
        let mut terms = [(output, 0.0); TERMS];
        terms[0].1 = factor;
        Self(terms)
    }

    /// Value of the row's left-hand side.
    pub(in crate::qp) fn value(&self, outputs: &[f64; OUTPUTS]) -> f64 {
        let [first, rest @ ..] = self
            .0
            .map(|(output, factor)| outputs.get(output).map_or(0.0, |value| value * factor));
        rest.iter().fold(first, |sum, term| sum + term)
    }
}
