//! One flight, like Figure 7 of the paper: the flight through the field, true to scale, and the motion
//! over time below it.

use super::error::FigureError;
use super::field;
use super::page::{document, to_scale};
use super::palette::{FLOWN, OBSTACLE, REFERENCE};
use super::panel::{self, Axis, Canvas, Curve, DrawingError, Panel};
use super::range::{bounds, widened};
use mpp_sim::log::FlightLog;
use plotters::prelude::*;
use std::ops::Range;

/// Size on the canvas \[px\]; shown as 1000 x 600.
pub(super) const CANVAS: (u32, u32) = (4000, 2400);
/// Heights from top to bottom \[px\]: the legend, the field, the upper row over time. The lower row
/// takes the rest.
const LEGEND_HEIGHT: u32 = 150;
pub(super) const FIELD_HEIGHT: u32 = 720;
const ROW_HEIGHT: u32 = 685;
/// Least room that is shown around the field \[m\].
const FIELD_MARGIN: f64 = 4.0;

/// Draws the flight as an SVG document. The same log gives the same bytes.
///
/// The upper part shows the reference (blue, broken where a new plan takes over) and the flown path
/// (orange) among the obstacles, both axes to the same scale. The lower part shows flight path
/// angle, pitch, airspeed and commanded thrust over time.
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

/// A panel with one column over time, times `scale`, and with the reference's column.
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

/// A panel with the flight among the obstacles. Both axes have the same scale.
pub(super) fn field_panel(log: &FlightLog) -> Panel {
    let t = &log.ticks;
    let curves = vec![
        Curve::flown(FLOWN, &t.x, &t.z),
        Curve::planned(REFERENCE, &t.ref_x, &t.ref_z, &unbroken(log)),
    ];
    let shapes = field::drawn(log);
    let edges = |pick: fn(&(f64, f64)) -> f64| {
        let extents = shapes.iter().flat_map(field::extent);
        extents.flat_map(move |(point, room)| [pick(&point) - room, pick(&point) + room])
    };
    let points = |pick: fn(&(f64, f64)) -> f64| curves.iter().flat_map(Curve::points).map(pick);
    let x = widened(bounds(points(|p| p.0).chain(edges(|p| p.0))), FIELD_MARGIN);
    let z = widened(bounds(points(|p| p.1).chain(edges(|p| p.1))), FIELD_MARGIN);

    let (x, z, scale) = to_scale((CANVAS.0, FIELD_HEIGHT), true, x, z);
    let mut panel = Panel {
        curves,
        ..Panel::new(
            Axis::tight("Downrange distance (m)", x, 8),
            Axis::tight("Height (m)", z, 4),
        )
    };
    field::add(&mut panel, &shapes, scale);
    panel
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

/// Draws the names of the colours, in one line above the field.
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
