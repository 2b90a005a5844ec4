//! Ranges of values.

use std::ops::Range;

/// The greatest value that a picture shows. No flight gets so far in metres, in an hour at 2,000 m/s.
const GREATEST: f64 = 1e7;

/// The range from the least value to the greatest, as far as a picture shows them.
pub(super) fn bounds(values: impl Iterator<Item = f64>) -> Range<f64> {
    let shown = values.map(|value| value.clamp(-GREATEST, GREATEST));
    shown.fold(f64::INFINITY..f64::NEG_INFINITY, |range, value| {
        range.start.min(value)..range.end.max(value)
    })
}

pub(super) fn widened(range: Range<f64>, by: f64) -> Range<f64> {
    range.start - by..range.end + by
}
