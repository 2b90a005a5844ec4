//! The obstacles of a flight in a panel.

use super::palette::OBSTACLE;
use super::panel::Panel;
use mpp_sim::field::{Obstacle, Point, Shape};
use mpp_sim::log::FlightLog;
use plotters::style::Color;

/// Least half width of an obstacle on the canvas \[px\]. What is thinner is drawn as wide as this, so
/// that it can be seen.
const THINNEST: u32 = 6;

/// The obstacles of a flight as they are drawn. One that moves is drawn where it was when it was
/// nearest to the aircraft.
pub(super) fn drawn(log: &FlightLog) -> Vec<Shape> {
    let obstacles = log.header.field.obstacles().into_iter();
    obstacles.map(|one| nearest(one, log)).collect()
}

fn nearest(obstacle: Obstacle, log: &FlightLog) -> Shape {
    let (ahead, up) = obstacle.velocity;
    if (ahead, up) == (0.0, 0.0) {
        return obstacle.shape;
    }
    let t = &log.ticks;
    let places = t.t.iter().zip(t.x.iter().zip(&t.z));
    let apart = places.map(|(time, (x, z))| (*time, obstacle.clearance((*x, *z), *time)));
    let least = apart.min_by(|a, b| a.1.total_cmp(&b.1));
    let time = least.map_or(0.0, |(time, _)| time);
    let mut shape = obstacle.shape;
    shape.shift((ahead * time, up * time));
    shape
}

/// Points of a shape with the room about each \[m\], which the panel should show. Ground and ceiling
/// have no end and are shown as far as the panel goes.
pub(super) fn extent(shape: &Shape) -> Vec<(Point, f64)> {
    let around = |points: &[Point], radius| points.iter().map(|p| (*p, radius)).collect();
    match shape {
        Shape::Circle { centre, radius } => vec![(*centre, *radius)],
        Shape::Line { points, radius } => around(points, *radius),
        Shape::Polygon { corners } => around(corners, 0.0),
        Shape::Ground(_) | Shape::Ceiling(_) => Vec::new(),
    }
}

/// Adds shapes to a panel in which a pixel is `scale` wide \[m\].
pub(super) fn add(panel: &mut Panel, shapes: &[Shape], scale: f64) {
    for shape in shapes {
        match shape {
            Shape::Circle { centre, radius } => add_circle(panel, *centre, *radius, scale),
            Shape::Line { points, radius } => {
                for point in points {
                    if panel.holds(*point) {
                        add_circle(panel, *point, *radius, scale);
                    }
                }
                for leg in points.windows(2) {
                    add_bar(
                        panel,
                        leg[0],
                        leg[1],
                        radius.max(f64::from(THINNEST) * scale),
                    );
                }
            }
            Shape::Polygon { corners } => panel.area(OBSTACLE.to_rgba(), corners),
            Shape::Ground(sheet) | Shape::Ceiling(sheet) => {
                panel.area(OBSTACLE.to_rgba(), sheet.corners());
            }
        }
    }
}

fn add_circle(panel: &mut Panel, centre: Point, radius: f64, scale: f64) {
    let radius = (radius / scale).round() as u32;
    panel.circles.push((centre, radius.max(THINNEST), OBSTACLE));
}

fn add_bar(panel: &mut Panel, from: Point, to: Point, half: f64) {
    let (x, z) = (to.0 - from.0, to.1 - from.1);
    let length = libm::hypot(x, z);
    if length <= 0.0 {
        return;
    }
    let (x, z) = (-z / length * half, x / length * half);
    let corners = [
        (from.0 + x, from.1 + z),
        (to.0 + x, to.1 + z),
        (to.0 - x, to.1 - z),
        (from.0 - x, from.1 - z),
    ];
    panel.area(OBSTACLE.to_rgba(), &corners);
}
