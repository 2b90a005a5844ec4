//! What a flight looks like: the obstacles, and the candidates of each cycle; and the scans of a flight that is flown
//! again.

use crate::messages::{Joined, line, scene_update};
use hil_protocol::LidarScan;
use mpp_sim::field::{FieldFile, Point};
use mpp_sim::flight::fly_with;
use mpp_sim::inspector::PlanDetail;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Again, Ground};
use mpp_sim::pipe::PipeLink;
use mpp_sim::tick_record::TickRecord;
use serde_json::Value;

/// Points of a circle's outline.
const CORNERS: u32 = 32;
/// Thickness of an outline \[m\].
const OUTLINE: f64 = 0.1;
pub(crate) const OBSTACLE: [f64; 4] = [0.75, 0.35, 0.2, 1.0];
pub(crate) const CANDIDATE: [f64; 4] = [0.6, 0.6, 0.6, 0.6];
pub(crate) const CHOSEN: [f64; 4] = [0.1, 0.7, 0.3, 1.0];

/// Whether an obstacle of the field moves.
pub(crate) fn moves(field: &FieldFile) -> bool {
    field
        .obstacles()
        .iter()
        .any(|obstacle| obstacle.velocity != (0.0, 0.0))
}

/// A `foxglove.SceneUpdate` of the obstacles at a time \[ns\].
pub(crate) fn obstacles(time: u64, field: &FieldFile) -> Value {
    let seconds = time as f64 / 1e9;
    let moved = |points: &[Point], velocity: Point| -> Vec<Point> {
        let moved = |(x, z): &Point| (x + velocity.0 * seconds, z + velocity.1 * seconds);
        points.iter().map(moved).collect()
    };
    let mut lines = Vec::new();
    let mut add = |joined, thickness, points| lines.push(line(joined, thickness, OBSTACLE, points));
    for circle in &field.circle {
        let outline = outline((circle.x, circle.z), circle.radius);
        add(Joined::Loop, OUTLINE, moved(&outline, circle.velocity));
    }
    for capsule in &field.capsule {
        let ends = moved(&[capsule.from, capsule.to], capsule.velocity);
        add(Joined::Strip, 2.0 * capsule.radius, ends);
    }
    for polygon in &field.polygon {
        add(
            Joined::Loop,
            OUTLINE,
            moved(&polygon.points, polygon.velocity),
        );
    }
    for polyline in &field.polyline {
        add(
            Joined::Strip,
            polyline.thickness,
            moved(&polyline.points, polyline.velocity),
        );
    }
    for edge in field.ground.iter().chain(&field.ceiling) {
        add(Joined::Strip, OUTLINE, edge.points.clone());
    }
    scene_update(time, "field", &lines)
}

fn outline((x, z): Point, radius: f64) -> Vec<Point> {
    let corner = |number| {
        let angle = core::f64::consts::TAU * f64::from(number) / f64::from(CORNERS);
        let (sin, cos) = libm::sincos(angle);
        (x + radius * cos, z + radius * sin)
    };
    (0..CORNERS).map(corner).collect()
}

/// A `foxglove.SceneUpdate` of a planning cycle: candidate paths, and the trajectory that was chosen.
pub(crate) fn cycle(time: u64, detail: &PlanDetail) -> Value {
    let candidates = detail.paths.iter();
    let mut lines: Vec<Value> = candidates
        .map(|path| line(Joined::Strip, 0.05, CANDIDATE, path.iter().copied()))
        .collect();
    lines.push(line(
        Joined::Strip,
        0.15,
        CHOSEN,
        detail.trajectory.iter().copied(),
    ));
    scene_update(time, "plan", &lines)
}

/// The scans of a flight; none if it does not come out the same again, or if the map was told.
pub(crate) fn scans(log: &FlightLog) -> Vec<LidarScan> {
    again(log).unwrap_or_default()
}

fn again(log: &FlightLog) -> Option<Vec<LidarScan>> {
    let scenario = log
        .header
        .scenario()
        .ok()
        .filter(|asked| !asked.is_advised())?;
    let until = u32::try_from(log.ticks.t.len()).ok()?;
    let mut again = Again::new(Some(log.orders.clone()), Scans(Vec::new())).until(Some(until));
    let flown = fly_with(&scenario, &mut PipeLink::new(), &mut again).ok()?;
    (flown.hash().ok()? == log.hash().ok()?).then_some(again.ground.0)
}

/// Keeps every scan of a flight.
struct Scans(Vec<LidarScan>);

impl Ground for Scans {
    fn watch(&mut self, record: &TickRecord<'_>) {
        self.0.extend(record.scan.cloned());
    }
}
