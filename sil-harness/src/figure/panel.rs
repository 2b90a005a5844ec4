//! One pair of axes with curves and circles.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type DrawingError = DrawingAreaErrorKind<std::io::Error>;

/// Text height [px]; the backend shows it smaller by 1.24.
const TEXT: u32 = 100;
/// Room left of the plot for numbers and label, and around the panel for half a number [px].
const LEFT: u32 = 380;
const MARGIN_LEFT: u32 = 40;
const MARGIN_BOTTOM: u32 = 25;
const RIGHT: u32 = 90;
const TOP: u32 = 50;
/// Room below the plot with numbers and label, and without [px].
const BELOW_LABELLED: u32 = 230;
const BELOW: u32 = 35;

const GREY: RGBColor = RGBColor(222, 222, 222);
const DARK: RGBColor = RGBColor(40, 40, 40);

pub(super) fn text_style() -> TextStyle<'static> {
    ("sans-serif", TEXT).into_font().color(&DARK)
}

pub(super) fn left_middle() -> Pos {
    Pos::new(HPos::Left, VPos::Center)
}

/// Width and height of the plot itself in a panel of this size [px].
pub(super) fn plot_size(panel: (u32, u32), labelled: bool) -> (f64, f64) {
    let below = if labelled { BELOW_LABELLED } else { BELOW };
    (
        f64::from(panel.0 - MARGIN_LEFT - LEFT - RIGHT),
        f64::from(panel.1 - TOP - below - MARGIN_BOTTOM),
    )
}

/// One axis: its label (empty: no numbers either), range and distance of the ticks.
#[derive(Clone)]
pub(super) struct Axis {
    label: &'static str,
    range: Range<f64>,
    step: f64,
}

impl Axis {
    /// Exactly over this range, with at most so many ticks, on round values.
    pub(super) fn tight(label: &'static str, range: Range<f64>, most_ticks: u32) -> Self {
        const STEPS: [f64; 12] = [
            0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0,
        ];
        let least = (range.end - range.start) / f64::from(most_ticks);
        let step = STEPS.into_iter().find(|&step| step >= least);
        Self {
            label,
            range,
            step: step.unwrap_or(least),
        }
    }

    /// With a little room around this range, and wide enough that noise does not look like motion.
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

/// As a coordinate of `plotters`, with ticks and numbers of our own: its own use the platform's
/// logarithm.
impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
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

/// A line in one colour, in pieces.
pub(super) struct Curve {
    colour: RGBColor,
    width: u32,
    pieces: Vec<Vec<(f64, f64)>>,
}

impl Curve {
    /// The flown line is the wider one: the planned line, drawn upon it, leaves its edges visible.
    pub(super) const FLOWN_WIDTH: u32 = 16;
    pub(super) const PLANNED_WIDTH: u32 = 9;

    /// One piece through every point.
    pub(super) fn flown(colour: RGBColor, x: &[f64], y: &[f64]) -> Self {
        Self {
            colour,
            width: Self::FLOWN_WIDTH,
            pieces: vec![thinned(x.iter().copied().zip(y.iter().copied()).collect())],
        }
    }

    /// One piece for each range, without the points that are missing.
    pub(super) fn planned(
        colour: RGBColor,
        x: &[Option<f64>],
        y: &[Option<f64>],
        ranges: &[Range<usize>],
    ) -> Self {
        let piece = |range: &Range<usize>| {
            let points = x.iter().zip(y).skip(range.start).take(range.len());
            thinned(points.filter_map(|(x, y)| Some(((*x)?, (*y)?))).collect())
        };
        Self {
            colour,
            width: Self::PLANNED_WIDTH,
            pieces: ranges.iter().map(piece).collect(),
        }
    }

    pub(super) fn points(&self) -> impl Iterator<Item = &(f64, f64)> {
        self.pieces.iter().flatten()
    }
}

/// Every fourth point and the last: 25 points a second draw a smooth line, 100 on whole pixels a
/// ragged one.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    const STRIDE: usize = 4;
    let last = points.len().saturating_sub(1);
    let kept = points.into_iter().enumerate();
    kept.filter(|(index, _)| index % STRIDE == 0 || *index == last)
        .map(|(_, point)| point)
        .collect()
}

/// Axes, and what is drawn between them: circles (centre, radius [px], colour) below curves.
pub(super) struct Panel {
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) circles: Vec<((f64, f64), u32, RGBColor)>,
    pub(super) curves: Vec<Curve>,
}

impl Panel {
    pub(super) fn draw(&self, area: &Canvas<'_>) -> Result<(), DrawingError> {
        let labelled = !self.x.label.is_empty();
        let mut chart = ChartBuilder::on(area)
            .margin_left(MARGIN_LEFT)
            .margin_top(TOP)
            .margin_bottom(MARGIN_BOTTOM)
            .margin_right(RIGHT)
            .x_label_area_size(if labelled { BELOW_LABELLED } else { BELOW })
            .y_label_area_size(LEFT)
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(GREY.stroke_width(4))
            .axis_style(DARK.stroke_width(5))
            .set_all_tick_mark_size(20)
            .label_style(text_style())
            .axis_desc_style(text_style())
            .x_desc(self.x.label)
            .y_desc(self.y.label)
            .draw()?;
        let circle = |&(centre, radius, colour): &((f64, f64), u32, RGBColor)| {
            Circle::new(centre, radius, colour.filled())
        };
        chart.draw_series(self.circles.iter().map(circle))?;
        for curve in &self.curves {
            let style = curve.colour.stroke_width(curve.width);
            let lines = curve.pieces.iter().filter(|piece| piece.len() > 1);
            chart.draw_series(lines.map(|piece| PathElement::new(piece.clone(), style)))?;
        }
        Ok(())
    }
}
