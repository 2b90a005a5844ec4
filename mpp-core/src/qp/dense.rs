//! Small dense algebra on the controls of the horizon.

use super::Weights;
use crate::config::STAGES;

/// Controls of the whole horizon, stage by stage.
pub(super) const CONTROLS: usize = 2 * STAGES;

pub(super) type ControlVector = [f64; CONTROLS];

/// Lower Cholesky factor of `R + w G'G`, `G` being given by rows; none if it is not positive
/// definite.
pub(super) fn factor(
    lower: &mut [ControlVector; CONTROLS],
    terminal: &[ControlVector; 6],
    weights: &Weights,
) -> Option<()> {
    for row in 0..CONTROLS {
        for col in 0..row + 1 {
            let coupling: f64 = terminal.iter().map(|state| state[row] * state[col]).sum();
            let own = if row == col {
                weights.control[row % 2]
            } else {
                0.0
            };
            let mut value = own + weights.terminal * coupling;
            if let Some(known) = lower[col].get(..col) {
                value -= dot(&lower[row], known);
            }
            lower[row][col] = if row > col {
                value / lower[col][col]
            } else if value > 0.0 && value.is_finite() {
                libm::sqrt(value)
            } else {
                return None;
            };
        }
    }
    Some(())
}

/// `L^-1 b`, in place on the first `len` entries of `b`.
pub(super) fn forward<const N: usize>(lower: &[[f64; N]; N], len: usize, b: &mut [f64; N]) {
    for (index, row) in lower.iter().enumerate().take(len) {
        if let Some((known, [value, ..])) = b.split_at_mut_checked(index)
            && let Some(diagonal) = row.get(index)
        {
            *value = (*value - dot(row, known)) / diagonal;
        }
    }
}

/// `L^-T b`, in place on the first `len` entries of `b`.
pub(super) fn backward<const N: usize>(lower: &[[f64; N]; N], len: usize, b: &mut [f64; N]) {
    for (index, row) in lower.iter().enumerate().take(len).rev() {
        if let Some((earlier, [value, ..])) = b.split_at_mut_checked(index)
            && let Some(diagonal) = row.get(index)
        {
            *value /= diagonal;
            for (earlier, factor) in earlier.iter_mut().zip(row) {
                *earlier -= factor * *value;
            }
        }
    }
}

/// Product of `b` with the first entries of `a`, in four sums side by side: they need not wait for
/// each other.
pub(super) fn dot<const N: usize>(a: &[f64; N], b: &[f64]) -> f64 {
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
