//! Pictures of flights through the challenge scenes (paper, Figure 1).

use super::error::FigureError;
use super::mark::Outline;
use super::page::{COLUMN, Sample, document, legend, legend_height, to_scale};
use super::palette::{BAD, FLOWN, OBSTACLE};
use super::panel::{Axis, BELOW_SAVED, Curve, Panel};
use super::{field, marks};
use mpp_sim::log::FlightLog;
use mpp_sim::outcome::ALTITUDE_BAND;
use mpp_sim::scenario::ALTITUDE;
use mpp_sim::scene::Scene;
use plotters::prelude::*;

/// The edges of the altitude band.
const BAND: RGBColor = RGBColor(140, 140, 140);
/// A flight with a single path.
const ALONE: RGBColor = RGBColor(150, 150, 150);
/// Ranges that are shown downrange and in height \[m\].
const SHOWN_X: (f64, f64) = (15.0, 105.0);
const SHOWN_Z: (f64, f64) = (33.0, 67.0);
/// Height of the last panel, whose downrange axis is labelled \[px\].
const HEIGHT: u32 = 1000;

/// Draws a panel for each scene with the flights through it: one with a single path and one with many, in this order.
/// The panels stand one below the other.
///
/// # Errors
/// [`FigureError`].
pub fn challenge_svg(scenes: &[(Scene, Vec<FlightLog>)]) -> Result<String, FigureError> {
    let entries = [
        (Sample::Line(ALONE, Curve::FLOWN_WIDTH), "flown with 1 path"),
        (Sample::Line(FLOWN, Curve::FLOWN_WIDTH), "with many paths"),
        (Sample::Dot(OBSTACLE), "obstacle"),
        (Sample::Mark(BAD, Outline::Cross), "failed here"),
        (Sample::Line(BAND, Curve::PLANNED_WIDTH), "altitude band"),
    ];
    let top = legend_height(entries.len());
    let last = scenes.len().saturating_sub(1);
    let size = (COLUMN, top + HEIGHT + (HEIGHT - BELOW_SAVED) * last as u32);
    document(size, |canvas| {
        let (head, mut rest) = canvas.split_vertically(top);
        legend(&head, &entries)?;
        for (index, (scene, logs)) in scenes.iter().enumerate() {
            let (area, below) = rest.split_vertically(height(index == last));
            rest = below;
            panel(*scene, logs, index == last).draw(&area)?;
        }
        Ok(())
    })
}

fn height(labelled: bool) -> u32 {
    if labelled {
        HEIGHT
    } else {
        HEIGHT - BELOW_SAVED
    }
}

fn panel(scene: Scene, logs: &[FlightLog], labelled: bool) -> Panel {
    let (shown_x, shown_z) = (SHOWN_X.0..SHOWN_X.1, SHOWN_Z.0..SHOWN_Z.1);
    let (x, z, scale) = to_scale((COLUMN, height(labelled)), labelled, shown_x, shown_z);
    let words = if labelled {
        "Downrange distance (m)"
    } else {
        ""
    };
    let x_axis = Axis::tight(words, x.clone(), 6);
    let mut panel = Panel::new(x_axis, Axis::tight("Height (m)", z.clone(), 5));
    let title = match scene {
        Scene::Flytrap => "Flytrap",
        Scene::Dynamics => "Obstacle against dynamics",
        Scene::LongWay => "Long way round",
    };
    let place = (
        x.start + 0.02 * (x.end - x.start),
        z.end - 0.08 * (z.end - z.start),
    );
    panel.labels.push((place, title.to_owned(), BLACK));
    for edge in [ALTITUDE - ALTITUDE_BAND, ALTITUDE + ALTITUDE_BAND] {
        // The edge is an area, so that obstacles lie upon it.
        let half = 0.5 * f64::from(Curve::PLANNED_WIDTH) * scale;
        let corners = [
            (x.start, -half),
            (x.end, -half),
            (x.end, half),
            (x.start, half),
        ];
        panel.area(BAND.to_rgba(), &corners.map(|(x, off)| (x, edge + off)));
    }
    if let Some(log) = logs.first() {
        field::add(&mut panel, &field::drawn(log), scale);
    }
    for log in logs {
        let colour = if log.header.paths == 1 { ALONE } else { FLOWN };
        let ticks = log.ticks.x.iter().copied().zip(log.ticks.z.iter().copied());
        let path: Vec<(f64, f64)> = ticks.step_by(4).collect();
        panel.line(colour, Curve::FLOWN_WIDTH, &path);
        marks::add_failure(&mut panel, log);
    }
    panel
}
