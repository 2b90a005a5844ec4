//! Axes with ticks on round values.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;
use std::ops::Range;

/// The least distance of ticks, and the number of greater ones that are tried: as many as a range may need.
const FINEST: f64 = 0.1;
const MOST_STEPS: usize = 1000;
/// Greatest distance of a drawn place from the start of its axis, in lengths of the axis. What is farther away, is
/// drawn there.
const BEYOND: f64 = 100.0;

/// One axis: its label, its range and the distance of its ticks. An axis with an empty label has no
/// numbers either.
#[derive(Clone)]
pub(super) struct Axis {
    pub(super) label: &'static str,
    pub(super) range: Range<f64>,
    step: f64,
}

impl Axis {
    /// An axis exactly over this range, with at most this number of ticks, on round values.
    pub(super) fn tight(label: &'static str, range: Range<f64>, most_ticks: u32) -> Self {
        let least = (range.end - range.start) / f64::from(most_ticks);
        // 1, 2 and 5 in every decade.
        let mut step = FINEST;
        for factor in [2.0, 2.5, 2.0].into_iter().cycle().take(MOST_STEPS) {
            if step >= least {
                break;
            }
            step *= factor;
        }
        Self { label, range, step }
    }

    /// An axis with a little room around this range. It is so wide that noise does not look like
    /// motion.
    pub(super) fn around(label: &'static str, range: Range<f64>, most_ticks: u32) -> Self {
        const LEAST_SPAN: f64 = 2.0;
        let span = (range.end - range.start).max(LEAST_SPAN);
        let middle = 0.5 * (range.start + range.end);
        Self::tight(
            label,
            middle - 0.57 * span..middle + 0.57 * span,
            most_ticks,
        )
    }
}

/// The axis is a coordinate of `plotters` with our own ticks and numbers, because those of
/// `plotters` use the platform's logarithm.
impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
        let share = share.clamp(-BEYOND, BEYOND);
        first + (f64::from(last - first) * share).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        let first = (self.range.start / self.step).ceil() as i64;
        let last = (self.range.end / self.step).floor() as i64;
        (first..=last).map(|k| k as f64 * self.step).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        if self.label.is_empty() {
            String::new()
        } else if self.step < 1.0 {
            format!("{value:.1}")
        } else {
            format!("{value:.0}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_however_long_the_range_is() {
        for (end, ticks, step) in [
            (20.0, 5, 5.0),
            (600.0, 5, 200.0),
            (7_000.0, 8, 1_000.0),
            (86_400.0, 5, 20_000.0),
            (1e14, 4, 5e13),
            (1e18, 8, 2e17),
        ] {
            let axis = Axis::tight("x", 0.0..end, ticks);
            let points = axis.key_points(10);
            assert!(
                points.len() > 2 && points.len() <= ticks as usize + 1,
                "{points:?}"
            );
            assert!((points[1] / step - 1.0).abs() < 1e-9, "{points:?}");
            assert_eq!(axis.format_ext(&points[1]), format!("{:.0}", points[1]));
        }
        let axis = Axis::tight("x", f64::MIN..f64::MAX, 5);
        assert!(axis.key_points(10).len() <= 6);
        assert_eq!(axis.map(&f64::NAN, (0, 100)), 0);
    }

    #[test]
    fn what_is_far_beyond_an_axis_is_drawn_within_the_numbers_of_pixels() {
        let axis = Axis::tight("x", 0.0..10.0, 5);
        assert_eq!(axis.map(&15.0, (100, 200)), 250);
        for (value, pixel) in [(1e300, 10_100), (f64::NEG_INFINITY, -9_900)] {
            assert_eq!(axis.map(&value, (100, 200)), pixel);
        }
    }
}
