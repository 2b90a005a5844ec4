//! A flight among the obstacles, true to scale: in one panel, or in strips one below the other.

use super::page::to_scale;
use super::palette::{FLOWN, REFERENCE};
use super::panel::{self, Axis, Curve, Panel};
use super::range::{bounds, widened};
use super::{field, marks};
use crate::closest::Closest;
use mpp_sim::field::Shape;
use mpp_sim::log::FlightLog;
use std::ops::Range;

/// Size on the canvas of a flight in one panel \[px\]; shown as 1000 x 600.
pub(super) const CANVAS: (u32, u32) = (4000, 2400);
/// Height of the panel of the field in it \[px\].
pub(super) const FIELD_HEIGHT: u32 = 720;
/// Least length of a strip, and how far a field is shown beyond the flight \[m\].
const STRIP: f64 = 300.0;
const BEYOND: f64 = 60.0;
/// Greatest number of strips.
const MOST_STRIPS: f64 = 8.0;
/// How far beyond the flown path the reference is shown, at world scale 1 \[m\]. Only absurd positions lead it farther.
const STRAY: f64 = 100.0;
/// Least height of a strip's plot \[px\].
const LEAST_PLOT: f64 = 100.0;
/// Least room that is shown around the field \[m\].
const FIELD_MARGIN: f64 = 4.0;
/// Radius of the dot of a replan in a single panel and in strips \[px\].
const REPLAN: [u32; 2] = [13, 9];

/// The panels with the flight among the obstacles and their heights \[px\]: one, or the strips of a long flight. Both
/// axes of each have the same scale.
pub(super) fn field_panels(log: &FlightLog, closest: Option<&Closest>) -> Vec<(Panel, u32)> {
    let t = &log.ticks;
    let curves = [
        Curve::flown(FLOWN, &t.x, &t.z),
        Curve::planned(REFERENCE, &t.ref_x, &t.ref_z, &unbroken(log)),
    ];
    let mut shapes = field::drawn(log);
    let shown = |pick: fn(&(f64, f64)) -> f64| {
        let flown = bounds(curves[0].points().map(pick));
        let near = widened(flown, STRAY * log.header.world_scale);
        let points = curves.iter().flat_map(Curve::points);
        points.map(move |point| pick(point).max(near.start).min(near.end))
    };
    // A field that goes on far beyond the flight is not shown to its end.
    let reach = bounds(shown(|p| p.0)).end + BEYOND;
    shapes.retain(|shape| lies_in(shape, &(f64::NEG_INFINITY..reach)));
    let edges = |pick: fn(&(f64, f64)) -> f64| {
        let extents = shapes.iter().flat_map(field::extent);
        let room = extents.flat_map(move |(p, room)| [pick(&p) - room, pick(&p) + room]);
        widened(bounds(shown(pick).chain(room)), FIELD_MARGIN)
    };
    let (x, z) = (edges(|p| p.0), edges(|p| p.1));
    let length = x.end - x.start;
    let count = (length / STRIP).ceil().clamp(1.0, MOST_STRIPS);
    let strip = |index: u32| {
        let start = x.start + length * f64::from(index) / count;
        let mut strip = axes(
            start..start + length / count,
            z.clone(),
            index,
            count as u32,
        );
        let scale = (strip.0.x.range.end - strip.0.x.range.start)
            / panel::plot_size((CANVAS.0, strip.1), true).0;
        let panel = &mut strip.0;
        marks::add_goal(panel, log);
        let mut here = shapes.clone();
        here.retain(|shape| lies_in(shape, &panel.x.range));
        field::add(panel, &here, scale);
        for curve in &curves {
            for piece in curve.pieces() {
                panel.line(curve.colour, curve.width, piece);
            }
        }
        marks::add_events(panel, log, closest, REPLAN[usize::from(count > 1.0)]);
        strip
    };
    (0..count as u32).map(strip).collect()
}

/// An empty strip of these, with its height. Only the last one names the downrange axis, only one the height.
fn axes(x: Range<f64>, z: Range<f64>, index: u32, count: u32) -> (Panel, u32) {
    let (height, ticks) = if count == 1 {
        (FIELD_HEIGHT, 4)
    } else {
        (strip_height(&x, &z), 1)
    };
    let (x, z, _) = to_scale((CANVAS.0, height), true, x, z);
    // An axis without a name has no numbers either.
    let name = |here: bool, name: &'static str| if here { name } else { " " };
    let x = Axis::tight(name(index + 1 == count, "Downrange distance (m)"), x, 8);
    let z = Axis::tight(name(index == count / 2, "Height (m)"), z, ticks);
    (Panel::new(x, z), height)
}

/// Whether a part of a shape lies in this range. Ground and ceiling are everywhere.
fn lies_in(shape: &Shape, x: &Range<f64>) -> bool {
    let extent = field::extent(shape);
    let low = extent.iter().map(|(point, room)| point.0 - room);
    let high = extent.iter().map(|(point, room)| point.0 + room);
    let (low, high) = (bounds(low).start, bounds(high).end);
    extent.is_empty() || (low < x.end && high > x.start)
}

/// The height of a strip that shows these ranges to scale, at most as high as wide \[px\].
fn strip_height(x: &Range<f64>, z: &Range<f64>) -> u32 {
    let (width, plot) = panel::plot_size((CANVAS.0, FIELD_HEIGHT), true);
    let frame = f64::from(FIELD_HEIGHT) - plot;
    (frame + ((z.end - z.start) * width / (x.end - x.start)).clamp(LEAST_PLOT, width)) as u32
}

/// The tick ranges over which the reference is one plan's, from one replan to the next.
pub(super) fn unbroken(log: &FlightLog) -> Vec<Range<usize>> {
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
