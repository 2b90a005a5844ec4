//! Ranges of values.

use std::ops::Range;

/// The range from the least value to the greatest.
pub(super) fn bounds(values: impl Iterator<Item = f64>) -> Range<f64> {
    values.fold(f64::INFINITY..f64::NEG_INFINITY, |range, value| {
        range.start.min(value)..range.end.max(value)
    })
}

pub(super) fn widened(range: Range<f64>, by: f64) -> Range<f64> {
    range.start - by..range.end + by
}
