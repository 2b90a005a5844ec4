//! Vectors over the controls of the horizon.

use super::super::INPUTS;
use crate::config::STAGES;

/// Number of controls in the whole horizon, rounded up to a multiple of four. They are ordered by stage; what fills up is zero.
pub(in crate::qp) const CONTROLS: usize = (INPUTS * STAGES).next_multiple_of(4);

pub(in crate::qp) type ControlVector = [f64; CONTROLS];

/// `sum += factor term`, up to the end of the shorter one. An image that is built for size keeps loops as they
/// are, so this one takes four entries at a time.
pub(super) fn add_scaled(sum: &mut [f64], term: &[f64], factor: f64) {
    let (chunks, rest) = term.as_chunks::<4>();
    for (sum, term) in sum.as_chunks_mut::<4>().0.iter_mut().zip(chunks) {
        for (sum, term) in sum.iter_mut().zip(term) {
            *sum += factor * term;
        }
    }
    for (sum, term) in sum.iter_mut().skip(4 * chunks.len()).zip(rest) {
        *sum += factor * term;
    }
}

/// Product of `b` with the first entries of `a`. The function keeps four independent sums, which need not
/// wait for each other.
pub(in crate::qp) fn dot(a: &[f64], b: &[f64]) -> f64 {
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

/// `sum += factor term` over all controls.
#[inline(never)]
pub(super) fn add_all(sum: &mut ControlVector, term: &ControlVector, factor: f64) {
    for (sum, term) in sum.iter_mut().zip(term) {
        *sum += factor * term;
    }
}
