//! Small dense algebra on the controls of the horizon.

use super::Weights;
use crate::config::STAGES;

/// Controls of the whole horizon, stage by stage.
pub(super) const CONTROLS: usize = 2 * STAGES;

pub(super) type ControlVector = [f64; CONTROLS];

/// Upper factor `U` of `R + w G'G = U U'`, `G` being given by rows; none if it is not positive
/// definite. A vector that is zero from some control on keeps its zeros through `U^-1`.
pub(super) fn factor(
    upper: &mut [ControlVector; CONTROLS],
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
            if let (Some(one), Some(other)) = (upper[row].get(col + 1..), upper[col].get(col + 1..))
            {
                value -= dot(one, other);
            }
            upper[row][col] = if row < col {
                value / upper[col][col]
            } else if value > 0.0 && value.is_finite() {
                libm::sqrt(value)
            } else {
                return None;
            };
        }
    }
    Some(())
}

/// `U^-1 b`, in place, of a `b` that is zero but for its first `len` entries.
pub(super) fn solve_upper(upper: &[ControlVector; CONTROLS], len: usize, b: &mut ControlVector) {
    for (index, row) in upper.iter().enumerate().take(len).rev() {
        if let (Some([value, known @ ..]), Some([diagonal, factors @ ..])) =
            (b.get_mut(index..len), row.get(index..))
        {
            *value = (*value - dot(factors, known)) / diagonal;
        }
    }
}

/// `U^-T b`, in place.
pub(super) fn solve_transposed(upper: &[ControlVector; CONTROLS], b: &mut ControlVector) {
    for (index, row) in upper.iter().enumerate() {
        if let (Some([value, later @ ..]), Some([diagonal, factors @ ..])) =
            (b.get_mut(index..), row.get(index..))
        {
            *value /= diagonal;
            for (later, factor) in later.iter_mut().zip(factors) {
                *later -= factor * *value;
            }
        }
    }
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
