//! The steps of a planning cycle: scan and grid, one path with its rays and half-planes, many
//! candidates.

use super::error::FigureError;
use super::one_replan::{Candidate, OneReplan};
use super::page::{COLUMN, RING, Sample, document, legend, legend_height, to_scale};
use super::palette::{FLOWN, OBSTACLE, REFERENCE};
use super::panel::{Axis, BELOW_SAVED, Panel, clipped};
use mpp_core::config::STAGES;
use mpp_core::corridor::DIRECTION_VECTORS;
use mpp_core::paper::config::{GRID_COLS, GRID_ROWS, RAY_LIMIT};
use mpp_core::paper::{GridPoint, Padding, cast_ray};
use mpp_sim::field::{Circle, FieldFile, Obstacle, Point};
use plotters::prelude::*;
use std::ops::Range;

/// The points of a path.
const POINT: RGBColor = RGBColor(30, 30, 30);
/// A lidar return.
const HIT: RGBColor = RGBColor(200, 30, 70);
/// A lidar beam.
const BEAM: RGBColor = RGBColor(205, 205, 205);
/// An occupied cell of the grid.
const CELL: RGBColor = RGBColor(190, 190, 190);
/// A ray from a collocation point.
const RAY: RGBColor = RGBColor(86, 180, 233);
/// The region that half-planes leave.
const REGION: RGBColor = RGBColor(240, 228, 66);
/// A candidate with a feasible trajectory.
const FEASIBLE: RGBColor = RGBColor(0, 158, 115);
/// A candidate without a feasible trajectory.
const INFEASIBLE: RGBColor = RGBColor(204, 121, 167);

const THIN: u32 = 4;
const MEDIUM: u32 = 8;
const THICK: u32 = 16;

/// Distances that are shown behind the aircraft, ahead of it, and above and below it \[m\].
const BEHIND: f64 = 3.0;
const AHEAD: f64 = 58.0;
const HALF_HEIGHT: f64 = 13.0;

/// Height of a panel whose downrange axis is labelled \[px\].
const HEIGHT: u32 = 1080;

/// Least room, in every direction, about the point whose half-planes are shown \[m\].
const ROOM: f64 = 1.0;

/// Distance by which each edge of a drawn cell is moved outwards \[m\].
const SEAM: f64 = 0.02;

/// One in this number of collocation points shows its rays.
const RAYS_EVERY: usize = 6;

/// Draws the lidar's scan above, and the grid that it becomes below.
///
/// # Errors
/// [`FigureError`].
pub fn scan_svg(cycle: &OneReplan) -> Result<String, FigureError> {
    let entries = [
        (Sample::Dot(FLOWN), "aircraft"),
        (Sample::Dot(OBSTACLE), "obstacle"),
        (Sample::Line(BEAM, MEDIUM), "beam"),
        (Sample::Ring(OBSTACLE), "obstacle out of sight"),
        (Sample::Dot(HIT), "lidar return"),
        (Sample::Area(CELL.to_rgba()), "occupied cell"),
    ];
    let top = legend_height(entries.len());
    let upper_height = HEIGHT - BELOW_SAVED;
    document((COLUMN, top + upper_height + HEIGHT), |canvas| {
        let (head, rest) = canvas.split_vertically(top);
        let (upper, lower) = rest.split_vertically(upper_height);
        legend(&head, &entries)?;
        let (mut sky, scale) = about_the_aircraft(cycle, false);
        add_obstacles(&mut sky, cycle, scale);
        for hit in &cycle.hits {
            sky.line(BEAM, THIN, &[(cycle.state.x, cycle.state.z), *hit]);
            sky.dot(*hit, 12, HIT);
        }
        sky.draw(&upper)?;
        let (mut map, _) = about_the_aircraft(cycle, true);
        add_cells(&mut map, cycle);
        for hit in &cycle.hits {
            map.dot(*hit, 12, HIT);
        }
        map.draw(&lower)
    })
}

/// Draws one candidate path above, with the rays of some of its points. Below, draws one point with
/// its rays and with the convex region that its half-planes leave.
///
/// # Errors
/// [`FigureError`].
pub fn rays_svg(cycle: &OneReplan) -> Result<String, FigureError> {
    let entries = [
        (Sample::Dot(POINT), "collocation point"),
        (Sample::Line(RAY, MEDIUM), "ray, ending at a cell"),
        (Sample::Area(region_colour()), "allowed region"),
        (Sample::Area(CELL.to_rgba()), "occupied cell"),
    ];
    let (candidate, stage) = tightest(cycle)?;
    let top = legend_height(entries.len());
    document((COLUMN, top + 2 * HEIGHT), |canvas| {
        let (head, rest) = canvas.split_vertically(top);
        let (upper, lower) = rest.split_vertically(HEIGHT);
        legend(&head, &entries)?;
        let (mut whole, _) = about_the_aircraft(cycle, true);
        whole.dots.clear();
        add_cells(&mut whole, cycle);
        for point in candidate
            .points
            .iter()
            .skip(stage % RAYS_EVERY)
            .step_by(RAYS_EVERY)
        {
            add_rays(&mut whole, cycle, point, THIN);
        }
        add_path(&mut whole, cycle, &candidate.points);
        whole.draw(&upper)?;

        let point = &candidate.points[stage];
        let (x, z) = cycle.world(point);
        let (mut near, _) = axes(true, x - 12.0..x + 12.0, z - 7.0..z + 7.0);
        add_cells(&mut near, cycle);
        near.area(region_colour(), &region(cycle, point, stage));
        add_rays(&mut near, cycle, point, MEDIUM);
        add_path(&mut near, cycle, &candidate.points);
        near.dot((x, z), 40, POINT);
        near.draw(&lower)
    })
}

/// Draws one path and the trajectory that its program makes of it: the last step of a cycle with a single path. The path
/// is that of [`rays_svg`].
///
/// # Errors
/// [`FigureError`].
pub fn trajectory_svg(cycle: &OneReplan) -> Result<String, FigureError> {
    let entries = [
        (Sample::Dot(POINT), "path"),
        (Sample::Line(REFERENCE, THICK), "trajectory"),
        (Sample::Dot(FLOWN), "aircraft"),
        (Sample::Area(CELL.to_rgba()), "occupied cell"),
    ];
    let (candidate, _) = tightest(cycle)?;
    let top = legend_height(entries.len());
    document((COLUMN, top + HEIGHT), |canvas| {
        let (head, rest) = canvas.split_vertically(top);
        legend(&head, &entries)?;
        let (mut panel, _) = about_the_aircraft(cycle, true);
        add_cells(&mut panel, cycle);
        add_path(&mut panel, cycle, &candidate.points);
        let trajectory = candidate.refined.as_deref().unwrap_or_default();
        panel.line(REFERENCE, THICK, trajectory);
        panel.draw(&rest)
    })
}

/// The feasible candidate whose path is most enclosed, and the stage where it is.
fn tightest(cycle: &OneReplan) -> Result<(&Candidate, usize), FigureError> {
    let feasible = cycle.candidates.iter().filter(|one| one.refined.is_some());
    let enclosed = feasible.map(|one| (one, most_enclosed(cycle, &one.points)));
    let tightest = enclosed.min_by(|a, b| a.1.1.total_cmp(&b.1.1));
    let (candidate, (stage, _)) = tightest.ok_or(FigureError::NoCandidate)?;
    Ok((candidate, stage))
}

/// Draws every candidate and the chosen trajectory. A candidate is drawn as its refined trajectory,
/// or as its path if no trajectory keeps every row.
///
/// # Errors
/// [`FigureError`].
pub fn candidates_svg(cycle: &OneReplan) -> Result<String, FigureError> {
    let entries = [
        (Sample::Line(INFEASIBLE, MEDIUM), "infeasible path"),
        (Sample::Line(FEASIBLE, MEDIUM), "feasible trajectory"),
        (Sample::Dot(OBSTACLE), "obstacle"),
        (Sample::Line(REFERENCE, THICK), "chosen trajectory"),
        (Sample::Ring(OBSTACLE), "obstacle out of sight"),
        (Sample::Dot(FLOWN), "aircraft"),
    ];
    let top = legend_height(entries.len());
    document((COLUMN, top + HEIGHT), |canvas| {
        let (head, rest) = canvas.split_vertically(top);
        legend(&head, &entries)?;
        let (mut panel, scale) = about_the_aircraft(cycle, true);
        add_obstacles(&mut panel, cycle, scale);
        for candidate in cycle.candidates.iter().filter(|c| c.refined.is_none()) {
            let path = candidate.points.iter().map(|point| cycle.world(point));
            panel.line(INFEASIBLE, MEDIUM, &path.collect::<Vec<_>>());
        }
        for refined in cycle.candidates.iter().filter_map(|c| c.refined.as_ref()) {
            panel.line(FEASIBLE, MEDIUM, refined);
        }
        let knots = cycle.chosen.knots.iter();
        let chosen: Vec<Point> = knots.map(|knot| (knot.state.x, knot.state.z)).collect();
        panel.line(REFERENCE, THICK, &chosen);
        panel.draw(&rest)
    })
}

fn region_colour() -> RGBAColor {
    REGION.mix(0.55)
}

/// Axes about the aircraft, true to scale, with a mark for the aircraft.
fn about_the_aircraft(cycle: &OneReplan, labelled: bool) -> (Panel, f64) {
    let (x, z) = (cycle.state.x, cycle.state.z);
    let (x_range, z_range) = (x - BEHIND..x + AHEAD, z - HALF_HEIGHT..z + HALF_HEIGHT);
    let (mut panel, scale) = axes(labelled, x_range, z_range);
    panel.dot((x, z), 26, FLOWN);
    (panel, scale)
}

fn axes(labelled: bool, x: Range<f64>, z: Range<f64>) -> (Panel, f64) {
    let height = if labelled {
        HEIGHT
    } else {
        HEIGHT - BELOW_SAVED
    };
    let (x, z, scale) = to_scale((COLUMN, height), labelled, x, z);
    let words = if labelled {
        "Downrange distance (m)"
    } else {
        ""
    };
    let x = Axis::tight(words, x, 7);
    (Panel::new(x, Axis::tight("Height (m)", z, 5)), scale)
}

/// Adds the circles that lie wholly within the panel. Circles that no beam met are rings.
fn add_obstacles(panel: &mut Panel, cycle: &OneReplan, scale: f64) {
    for circle in FieldFile::of(&cycle.field.obstacles).circle {
        let Circle { x, z, radius, .. } = circle;
        let obstacle = Obstacle::circle(x, z, radius);
        let corners = [(x - radius, z - radius), (x + radius, z + radius)];
        if corners.iter().any(|corner| !panel.holds(*corner)) {
            continue;
        }
        // A return lies on the edge, except for its range error.
        if cycle
            .hits
            .iter()
            .any(|hit| obstacle.clearance(*hit, 0.0).abs() < radius)
        {
            panel
                .circles
                .push(((x, z), (radius / scale).round() as u32, OBSTACLE));
        } else {
            let edge: Vec<Point> = (0..=36)
                .map(|k| libm::sincos(f64::from(k) * core::f64::consts::TAU / 36.0))
                .map(|(sin, cos)| (x + radius * cos, z + radius * sin))
                .collect();
            panel.line(OBSTACLE, RING, &edge);
        }
    }
}

/// Adds the occupied cells within the panel. Each is drawn a little larger than it is, so that no
/// seams show.
fn add_cells(panel: &mut Panel, cycle: &OneReplan) {
    for row in 0..GRID_ROWS {
        for col in 0..GRID_COLS {
            let corner = |up: f64, ahead: f64| {
                cycle.world(&GridPoint {
                    row: row as f64 + up + SEAM * (2.0 * up - 1.0),
                    col: col as f64 + ahead + SEAM * (2.0 * ahead - 1.0),
                })
            };
            if cycle.grid.occupied(row as i32, col as i32) {
                let square = [
                    corner(0.0, 0.0),
                    corner(0.0, 1.0),
                    corner(1.0, 1.0),
                    corner(1.0, 0.0),
                ];
                panel.area(CELL.to_rgba(), &square);
            }
        }
    }
}

fn add_path(panel: &mut Panel, cycle: &OneReplan, points: &[GridPoint]) {
    let path: Vec<Point> = points.iter().map(|point| cycle.world(point)).collect();
    panel.line(POINT, MEDIUM, &path);
    for point in path {
        panel.dot(point, 22, POINT);
    }
}

/// Adds the rays of a point, each up to its end. A ray that ends at a cell gets a dot.
fn add_rays(panel: &mut Panel, cycle: &OneReplan, point: &GridPoint, width: u32) {
    let from = cycle.world(point);
    for direction in &DIRECTION_VECTORS {
        let reach = cast_ray(&cycle.grid, *point, direction);
        let to = (from.0 + reach * direction[1], from.1 + reach * direction[0]);
        panel.line(RAY, width, &[from, to]);
        if reach < RAY_LIMIT {
            panel.dot(to, 16, RAY);
        }
    }
}

/// Distances that the half-planes of a point leave in each direction, minus the padding \[m\].
fn reaches(cycle: &OneReplan, point: &GridPoint, stage: usize) -> [f64; 8] {
    let Padding { near, far } = Padding::AUTHORS;
    let padding = near + (far - near) * (stage as f64 / STAGES as f64);
    DIRECTION_VECTORS.map(|direction| cast_ray(&cycle.grid, *point, &direction) - padding)
}

/// Finds the point whose half-planes leave the smallest region, among the points that have some
/// room in every direction. Returns it with that region's area [m^2].
fn most_enclosed(cycle: &OneReplan, points: &[GridPoint]) -> (usize, f64) {
    let area = |stage: usize| {
        let inside = reaches(cycle, &points[stage], stage)
            .iter()
            .all(|reach| *reach > ROOM);
        let polygon = region(cycle, &points[stage], stage);
        let pairs = polygon.iter().zip(polygon.iter().cycle().skip(1));
        let area = 0.5 * pairs.map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>();
        if inside { area } else { f64::INFINITY }
    };
    let areas = (0..points.len()).map(|stage| (stage, area(stage)));
    areas
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or((0, f64::INFINITY))
}

/// The polygon that the half-planes of a point leave, in the world.
fn region(cycle: &OneReplan, point: &GridPoint, stage: usize) -> Vec<Point> {
    let centre = cycle.world(point);
    let far = 100.0;
    let mut polygon = vec![(-far, -far), (far, -far), (far, far), (-far, far)];
    for (direction, reach) in DIRECTION_VECTORS.iter().zip(reaches(cycle, point, stage)) {
        polygon = clipped(&polygon, (direction[1], direction[0]), reach);
    }
    polygon
        .iter()
        .map(|(x, z)| (centre.0 + x, centre.1 + z))
        .collect()
}
