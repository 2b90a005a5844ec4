//! Dense linear algebra on the controls of the horizon.

use super::Weights;
use super::triangle::{Triangle, entries};
use crate::config::STAGES;

/// Number of controls in the whole horizon. They are ordered by stage.
pub(super) const CONTROLS: usize = 2 * STAGES;

pub(super) type ControlVector = [f64; CONTROLS];

/// Upper factor `U` of a positive definite matrix, `U U'`. If a vector `b` is zero from some control on,
/// `U^-1 b` is zero from that control on too.
#[derive(Clone, Debug)]
pub(super) struct Upper {
    /// Rows from the last to the first. Each row begins with its diagonal entry.
    rows: Triangle<{ entries(CONTROLS) }>,
}

impl Upper {
    pub(super) const fn new() -> Self {
        Self {
            rows: Triangle::new(),
        }
    }

    /// A row, which begins with its diagonal entry.
    fn row(&self, index: usize) -> &[f64] {
        self.rows.row(CONTROLS - 1 - index)
    }

    /// Factors `R + w G'G`, where `terminal` contains the rows of `G`. Returns `None` if the matrix is not
    /// positive definite.
    pub(super) fn factor(
        &mut self,
        terminal: &[ControlVector; 6],
        weights: &Weights,
    ) -> Option<()> {
        for col in (0..CONTROLS).rev() {
            for row in (0..col + 1).rev() {
                let coupling: f64 = terminal.iter().map(|state| state[row] * state[col]).sum();
                let own = if row == col {
                    weights.control[row % 2]
                } else {
                    0.0
                };
                let mut value = own + weights.terminal * coupling;
                let ([diagonal, later @ ..], Some(others)) =
                    (self.row(col), self.row(row).get(col + 1 - row..))
                else {
                    return None;
                };
                value -= dot(others, later);
                let entry = if row < col {
                    value / diagonal
                } else if value > 0.0 && value.is_finite() {
                    libm::sqrt(value)
                } else {
                    return None;
                };
                *self.rows.row_mut(CONTROLS - 1 - row).get_mut(col - row)? = entry;
            }
        }
        Some(())
    }

    /// Computes `U^-1 b` in place. Only the first `len` entries of `b` may differ from zero.
    pub(super) fn solve(&self, len: usize, b: &mut [f64]) {
        let len = len.min(CONTROLS);
        for (index, row) in (0..len).rev().zip(self.rows.rows_from(CONTROLS - len)) {
            if let (Some([value, known @ ..]), [diagonal, factors @ ..]) =
                (b.get_mut(index..len), row)
            {
                *value = (*value - dot(factors, known)) / diagonal;
            }
        }
    }

    /// Computes `U^-T b` in place.
    pub(super) fn solve_transposed(&self, b: &mut ControlVector) {
        for (index, row) in self.rows.rows_before(CONTROLS).enumerate() {
            if let (Some([value, later @ ..]), [diagonal, factors @ ..]) = (b.get_mut(index..), row)
            {
                *value /= diagonal;
                for (later, factor) in later.iter_mut().zip(factors) {
                    *later -= factor * *value;
                }
            }
        }
    }
}

/// Product of `b` with the first entries of `a`. The function keeps four independent sums, which need not
/// wait for each other.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (chunks, rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in a.as_chunks::<4>().0.iter().zip(chunks) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    let tail: f64 = a
        .iter()
        .skip(4 * chunks.len())
        .zip(rest)
        .map(|(a, b)| a * b)
        .sum();
    sums[0] + sums[1] + (sums[2] + sums[3]) + tail
}
