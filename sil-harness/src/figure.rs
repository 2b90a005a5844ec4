//! Pictures: counterparts of the paper's figures.
//!
//! [`flight_svg`] is one flight, like Figure 7 of the paper: the flight through the field, true to
//! scale, and the motion over time below it. The others stand one to a column: the challenge scenes
//! (Figure 1), the steps of a planning cycle (Figures 4 to 6) and success rates (Figure 8). The same
//! colour means the same thing in all of them.

mod challenge;
mod cycle;
mod page;
mod panel;
mod process;
mod success;

pub use challenge::challenge_svg;
pub use cycle::{Candidate, Cycle};
pub use process::{candidates_svg, rays_svg, scan_svg};
pub use success::{Rule, success_svg};

use crate::log::{FlightLog, ObstacleEntry};
use page::{document, to_scale};
use panel::{Axis, Canvas, Curve, DrawingError, Panel};
use plotters::prelude::*;
use std::ops::Range;

/// The reference, a chosen plan: everyone tells blue from orange.
const REFERENCE: RGBColor = RGBColor(0, 114, 178);
/// What was flown.
const FLOWN: RGBColor = RGBColor(230, 120, 0);
/// The obstacles.
const OBSTACLE: RGBColor = RGBColor(70, 70, 70);

/// Size on the canvas [px]; shown as 1000 x 600.
const CANVAS: (u32, u32) = (4000, 2400);
/// Heights from top to bottom [px]: the legend, the field, the upper row over time; the lower row
/// takes the rest.
const LEGEND_HEIGHT: u32 = 150;
const FIELD_HEIGHT: u32 = 720;
const ROW_HEIGHT: u32 = 685;
/// Room around the field that is shown at least [m].
const FIELD_MARGIN: f64 = 4.0;

/// Why there is no picture.
#[derive(Debug)]
#[non_exhaustive]
pub enum FigureError {
    /// The log holds no tick.
    EmptyFlight,
    /// The flight or the planning cycle to be drawn did not come about.
    Cycle(String),
    /// The drawing library failed.
    Drawing(Box<dyn core::error::Error + Send + Sync>),
}

impl core::fmt::Display for FigureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::EmptyFlight => f.write_str("the flight log holds no tick to draw"),
            Self::Cycle(why) => write!(f, "nothing to draw: {why}"),
            Self::Drawing(error) => write!(f, "drawing: {error}"),
        }
    }
}

impl core::error::Error for FigureError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::EmptyFlight | Self::Cycle(_) => None,
            Self::Drawing(error) => Some(error.as_ref()),
        }
    }
}

impl From<DrawingError> for FigureError {
    fn from(error: DrawingError) -> Self {
        Self::Drawing(Box::new(error))
    }
}

/// The flight as an SVG document; the same log gives the same bytes.
///
/// Above, the reference (blue, broken where a new plan takes over) and the flown path (orange)
/// among the obstacles, both axes to the same scale; below, flight path angle, pitch, airspeed and
/// commanded thrust over time.
///
/// # Errors
/// [`FigureError`].
pub fn flight_svg(log: &FlightLog) -> Result<String, FigureError> {
    if log.ticks.t.is_empty() {
        return Err(FigureError::EmptyFlight);
    }
    document(CANVAS, |canvas| draw(log, canvas))
}

fn draw(log: &FlightLog, canvas: &Canvas<'_>) -> Result<(), DrawingError> {
    let (legend, rest) = canvas.split_vertically(LEGEND_HEIGHT);
    let (field, rest) = rest.split_vertically(FIELD_HEIGHT);
    let (upper, lower) = rest.split_vertically(ROW_HEIGHT);
    draw_legend(&legend, log)?;
    field_panel(log).draw(&field)?;

    let t = &log.ticks;
    let degrees = 1_f64.to_degrees();
    let half = CANVAS.0 / 2;
    let (left, right) = upper.split_horizontally(half);
    motion_panel(
        log,
        ("", "Path γ (deg)"),
        degrees,
        &t.flight_path,
        &t.ref_flight_path,
    )
    .draw(&left)?;
    motion_panel(log, ("", "Pitch θ (deg)"), degrees, &t.pitch, &t.ref_pitch).draw(&right)?;
    let (left, right) = lower.split_horizontally(half);
    motion_panel(
        log,
        ("Time (s)", "Airspeed (m/s)"),
        1.0,
        &t.airspeed,
        &t.ref_airspeed,
    )
    .draw(&left)?;
    motion_panel(log, ("Time (s)", "Thrust (N)"), 1.0, &t.thrust, &[]).draw(&right)
}

/// One column over time, times `scale`, with the reference's column.
fn motion_panel(
    log: &FlightLog,
    (x_label, y_label): (&'static str, &'static str),
    scale: f64,
    flown: &[f64],
    planned: &[Option<f64>],
) -> Panel {
    let time = &log.ticks.t;
    let flown: Vec<_> = flown.iter().map(|value| scale * value).collect();
    let planned: Vec<_> = planned
        .iter()
        .map(|value| value.map(|v| scale * v))
        .collect();
    let planned_time: Vec<_> = time.iter().copied().map(Some).collect();
    let curves = vec![
        Curve::flown(FLOWN, time, &flown),
        Curve::planned(REFERENCE, &planned_time, &planned, &unbroken(log)),
    ];
    let span = bounds(time.iter().copied().chain([log.summary.t_end]));
    let values = bounds(curves.iter().flat_map(Curve::points).map(|point| point.1));
    Panel {
        curves,
        ..Panel::new(
            Axis::tight(x_label, span, 5),
            Axis::around(y_label, values, 4),
        )
    }
}

/// The flight among the obstacles, both axes to the same scale.
fn field_panel(log: &FlightLog) -> Panel {
    let t = &log.ticks;
    let curves = vec![
        Curve::flown(FLOWN, &t.x, &t.z),
        Curve::planned(REFERENCE, &t.ref_x, &t.ref_z, &unbroken(log)),
    ];
    let edges = |pick: fn(&ObstacleEntry) -> f64| {
        let obstacles = log.header.field.iter();
        obstacles.flat_map(move |o| [pick(o) - o.radius, pick(o) + o.radius])
    };
    let points = |pick: fn(&(f64, f64)) -> f64| curves.iter().flat_map(Curve::points).map(pick);
    let x = widened(bounds(points(|p| p.0).chain(edges(|o| o.x))), FIELD_MARGIN);
    let z = widened(bounds(points(|p| p.1).chain(edges(|o| o.z))), FIELD_MARGIN);

    let (x, z, scale) = to_scale((CANVAS.0, FIELD_HEIGHT), true, x, z);
    let circles = log.header.field.iter();
    Panel {
        circles: circles
            .map(|o| ((o.x, o.z), (o.radius / scale).round() as u32, OBSTACLE))
            .collect(),
        curves,
        ..Panel::new(
            Axis::tight("Downrange distance (m)", x, 8),
            Axis::tight("Height (m)", z, 4),
        )
    }
}

/// The tick ranges over which the reference is one plan's, from one replan to the next.
fn unbroken(log: &FlightLog) -> Vec<Range<usize>> {
    let count = log.ticks.t.len();
    let mut breaks: Vec<usize> = log
        .plans
        .iter()
        .filter_map(|plan| usize::try_from(plan.used_from_tick?).ok())
        .filter(|&tick| tick < count)
        .chain([0, count])
        .collect();
    breaks.sort_unstable();
    breaks.windows(2).map(|pair| pair[0]..pair[1]).collect()
}

/// From the least value to the greatest.
fn bounds(values: impl Iterator<Item = f64>) -> Range<f64> {
    values.fold(f64::INFINITY..f64::NEG_INFINITY, |range, value| {
        range.start.min(value)..range.end.max(value)
    })
}

fn widened(range: Range<f64>, by: f64) -> Range<f64> {
    range.start - by..range.end + by
}

/// Names what the colours mean, in one line above the field.
fn draw_legend(area: &Canvas<'_>, log: &FlightLog) -> Result<(), DrawingError> {
    const MIDDLE: i32 = 80;
    const SAMPLE: i32 = 200;
    let text = |words: &str, x: i32| {
        let style = panel::text_style().pos(panel::left_middle());
        Text::new(words.to_owned(), (x, MIDDLE), style)
    };
    for (x, colour, width, words) in [
        (450, REFERENCE, Curve::PLANNED_WIDTH, "reference"),
        (1250, FLOWN, Curve::FLOWN_WIDTH, "flown"),
    ] {
        let line = vec![(x, MIDDLE), (x + SAMPLE, MIDDLE)];
        area.draw(&PathElement::new(line, colour.stroke_width(width)))?;
        area.draw(&text(words, x + SAMPLE + 50))?;
    }
    if !log.header.field.is_empty() {
        area.draw(&Circle::new((1950, MIDDLE), 28, OBSTACLE.filled()))?;
        area.draw(&text("obstacle", 2030))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
