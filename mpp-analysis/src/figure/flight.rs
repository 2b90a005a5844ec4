//! One flight, like Figure 7 of the paper: the flight through the field, true to scale, and the motion
//! over time below it.

use super::error::FigureError;
use super::mark::Outline;
use super::marks;
use super::page::{document, draw_mark};
use super::palette::{CLOSEST, FLOWN, OBSTACLE, REFERENCE, of_outcome};
use super::panel::{self, Axis, Canvas, Curve, DrawingError, Panel};
use super::range::bounds;
use super::strips::{CANVAS, FIELD_HEIGHT, field_panels, unbroken};
use crate::closest::{Closest, closest};
use mpp_sim::log::FlightLog;
use mpp_sim::outcome::{FLIGHT_PATH_LIMIT, PITCH_LIMIT};
use plotters::prelude::*;

/// Heights \[px\] of the legend above the field and of the upper row over time below it. The lower row takes the rest.
const LEGEND_HEIGHT: u32 = 150;
const ROW_HEIGHT: u32 = 685;
/// Draws the flight as an SVG document. The same log gives the same bytes.
///
/// The upper part shows the reference (blue, broken where a new plan takes over) and the flown path
/// (orange) among the obstacles, both axes to the same scale; a flight of more than 300 m goes on in further strips. The
/// lower part shows flight path angle, pitch, airspeed and commanded thrust over time, with the limits that the values
/// come at least half as far as.
///
/// # Errors
/// [`FigureError`].
pub fn flight_svg(log: &FlightLog) -> Result<String, FigureError> {
    if log.ticks.t.is_empty() {
        return Err(FigureError::EmptyFlight);
    }
    let closest = closest(log);
    let strips = field_panels(log, closest.as_ref());
    let field: u32 = strips.iter().map(|(_, height)| height).sum();
    let size = (CANVAS.0, CANVAS.1 - FIELD_HEIGHT + field);
    document(size, |canvas| draw(log, &strips, closest.as_ref(), canvas))
}

fn draw(
    log: &FlightLog,
    strips: &[(Panel, u32)],
    closest: Option<&Closest>,
    canvas: &Canvas<'_>,
) -> Result<(), DrawingError> {
    let (legend, mut rest) = canvas.split_vertically(LEGEND_HEIGHT);
    draw_legend(&legend, log)?;
    for (strip, height) in strips {
        let (area, below) = rest.split_vertically(*height);
        rest = below;
        strip.draw(&area)?;
    }
    let (upper, lower) = rest.split_vertically(ROW_HEIGHT);
    let t = &log.ticks;
    let half = CANVAS.0 / 2;
    let (left, right) = upper.split_horizontally(half);
    let angle = |(words, limit): (_, f64), flown: &[f64], planned| {
        let limit = Some(limit.to_degrees());
        motion_panel(log, ("", words), 1_f64.to_degrees(), flown, planned, limit)
    };
    let marked = |mut panel: Panel, area: &Canvas<'_>| {
        marks::add_closest_time(&mut panel, closest);
        panel.draw(area)
    };
    let path = ("Path γ (deg)", FLIGHT_PATH_LIMIT);
    marked(angle(path, &t.flight_path, &t.ref_flight_path), &left)?;
    let pitch = ("Pitch θ (deg)", PITCH_LIMIT);
    marked(angle(pitch, &t.pitch, &t.ref_pitch), &right)?;
    let (left, right) = lower.split_horizontally(half);
    let speed = ("Time (s)", "Airspeed (m/s)");
    marked(
        motion_panel(log, speed, 1.0, &t.airspeed, &t.ref_airspeed, None),
        &left,
    )?;
    let thrust = ("Time (s)", "Thrust (N)");
    marked(motion_panel(log, thrust, 1.0, &t.thrust, &[], None), &right)
}

/// A panel with one column over time, times `scale`, and with the reference's column.
fn motion_panel(
    log: &FlightLog,
    (x_label, y_label): (&'static str, &'static str),
    scale: f64,
    flown: &[f64],
    planned: &[Option<f64>],
    limit: Option<f64>,
) -> Panel {
    let time = &log.ticks.t;
    let flown: Vec<_> = flown.iter().map(|value| scale * value).collect();
    let planned: Vec<_> = planned
        .iter()
        .map(|value| value.map(|v| scale * v))
        .collect();
    let planned_time: Vec<_> = time.iter().copied().map(Some).collect();
    let curves = [
        Curve::flown(FLOWN, time, &flown),
        Curve::planned(REFERENCE, &planned_time, &planned, &unbroken(log)),
    ];
    let span = bounds(time.iter().copied().chain([log.summary.t_end]));
    let mut values = bounds(curves.iter().flat_map(Curve::points).map(|point| point.1));
    let limit = limit.filter(|limit| 2.0 * values.end.max(-values.start) >= *limit);
    if let Some(limit) = limit {
        values = values.start.min(-limit)..values.end.max(limit);
    }
    let x = Axis::tight(x_label, span, 5);
    let mut panel = Panel::new(x, Axis::around(y_label, values, 4));
    if let Some(limit) = limit {
        marks::add_limits(&mut panel, limit);
    }
    panel.curves.extend(curves);
    panel
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
        (1150, FLOWN, Curve::FLOWN_WIDTH, "flown"),
    ] {
        let line = vec![(x, MIDDLE), (x + SAMPLE, MIDDLE)];
        area.draw(&PathElement::new(line, colour.stroke_width(width)))?;
        area.draw(&text(words, x + SAMPLE + 50))?;
    }
    if !log.header.field.is_empty() {
        area.draw(&Circle::new((1730, MIDDLE), 28, OBSTACLE.filled()))?;
        area.draw(&text("obstacle", 1790))?;
        draw_mark(area, (2330, MIDDLE), Outline::Ring, CLOSEST)?;
        area.draw(&text("closest", 2390))?;
    }
    let outcome = log.summary.outcome;
    draw_mark(
        area,
        (2880, MIDDLE),
        marks::of_end(outcome),
        of_outcome(outcome),
    )?;
    let colour = of_outcome(outcome);
    let style = panel::text_style().color(&colour).pos(panel::left_middle());
    area.draw(&Text::new(outcome.to_string(), (2940, MIDDLE), style))
}
