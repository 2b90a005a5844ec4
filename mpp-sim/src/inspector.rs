//! The planner's map, candidates and choice in each cycle, for people to look at.
//!
//! The core reports only its choice. The same planner gets the same scans and states here, so it
//! goes through the same candidates, one slice at a time.

use crate::field::Point;
use crate::tick_record::TickRecord;
use mpp_core::config::{DIRECTIONS, KNOTS, STAGE_PERIOD};
use mpp_core::corridor::DIRECTION_VECTORS;
use mpp_core::paper::GridPoint;
use mpp_core::paper::config::{GRID_COLS, GRID_ROWS};
use mpp_core::planner::plane::PlanePlanner;
use mpp_core::planner::{PlanSummary, Planner, SetupError};
use mpp_core::sense::LidarScan;
use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use serde::{Deserialize, Serialize};

/// Half of the side of the square to which unbounded corridors are cut \[m\].
const SQUARE: f64 = 8.0;
/// Edge of a cell of the map with memory \[m\], and the window that is shown relative to the
/// aircraft \[m\].
const CELL: f64 = 0.5;
const WINDOW: [f64; 2] = [-8.0, 56.0];
/// Half of the window's height \[m\].
const HEIGHT: f64 = 16.0;

/// A row of cells: low corner `(x, z)`, and their length together \[m\].
pub type Cells = (f64, f64, f64);

/// One planning cycle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanDetail {
    /// Tick of the cycle's scan.
    pub tick: u32,
    /// Position of the aircraft.
    pub from: Point,
    /// Positions where beams ended.
    pub hits: Vec<Point>,
    /// Cells that the planner took for occupied and for unknown. They come from the map with
    /// memory, if the preset has one. Otherwise they come from the grid of this one scan, in which
    /// nothing is unknown.
    pub map: Map,
    /// Collocation points of every candidate path.
    pub paths: Vec<Vec<Point>>,
    /// What came of each of these paths.
    pub judged: Vec<Judged>,
    /// The path from whose program the chosen trajectory comes.
    pub chosen: Option<usize>,
    /// Corridor of the chosen candidate: a polygon for each stage boundary, empty where nothing is
    /// left.
    pub corridor: Vec<Vec<Point>>,
    /// The trajectory that was chosen.
    pub trajectory: Vec<Point>,
}

/// The planner's judgement of a path after it was refined.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// Index of the candidate. The flight planner refines the best candidates in several rounds, and each round is a
    /// path of its own.
    pub candidate: usize,
    /// Whether the trajectory met every constraint.
    pub feasible: bool,
    /// The price that ranks the trajectories; null if no program of the candidate had a solution. Of the paper's
    /// method it is the cost of a trajectory that was better than all before it, and null of the others.
    pub price: Option<f64>,
    /// The parts of the price; null of the paper's method, whose cost has no parts.
    pub parts: Option<Parts>,
}

/// The parts of a price [-], and the lack of clearance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Parts {
    /// Price of what is missing of the margin, of the wanted room and of the altitude band.
    pub clearance: f64,
    /// Price of unknown cells near ahead.
    pub unknown: f64,
    /// Price of the way on after the window in which the planner refines.
    pub onward: f64,
    /// Price of controls and of the end state.
    pub effort: f64,
    /// Worst lack of clearance \[m\].
    pub lack: f64,
}

/// The planner's knowledge of obstacles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Edge of a cell \[m\].
    pub cell: f64,
    /// Cells that count as occupied.
    pub occupied: Vec<Cells>,
    /// Cells that no beam has reported on.
    pub unknown: Vec<Cells>,
}

/// A planner whose cycles can be inspected.
pub struct Inspector {
    planner: Box<Planner>,
}

impl Inspector {
    /// An inspector for a flight that begins with these values.
    ///
    /// # Errors
    /// [`SetupError`] when the planner cannot be set up. The core could not be set up either.
    pub fn new(tuning: &Tuning) -> Result<Self, SetupError> {
        let mut planner = Box::new(Planner::new());
        planner.set_up(&tuning.settings)?;
        Ok(Self { planner })
    }

    /// The cycle that begins at this moment, if a scan was taken. `tuning` holds the values in
    /// force.
    pub fn look(&mut self, record: &TickRecord<'_>, tuning: &Tuning) -> Option<PlanDetail> {
        let wire = record.scan?;
        let state = record.tick.estimate;
        let planner = &mut self.planner;
        // The core does the same: values that it refuses were never in force.
        let _ = planner.retune(&tuning.settings.planner);
        let scan = core_scan(wire);
        planner.begin(record.tick.t, &state, &record.tick.conditions, &scan);

        let mut detail = PlanDetail {
            tick: wire.tick,
            from: place(state.x, state.z),
            ..PlanDetail::default()
        };
        // The planner reckons in units of its own.
        let length = planner.plane().map_or(1.0, |own| own.units().length);
        let mut corridor = None;
        let mut best = f64::INFINITY;
        let mut best_violation = f64::INFINITY;
        for _ in 0..slices(tuning) {
            let refining = planner.candidate().is_some();
            let before = *planner.summary();
            let more = planner.advance();
            if planner.summary().candidates > before.candidates {
                detail.judged.push(judged(planner, &before, length));
            }
            if let Some((path, problem)) = planner.candidate()
                && !refining
            {
                let path = path.map(|(x, z)| place(x * length, z * length));
                detail.paths.push(path.into());
                corridor = Some(problem.bounds);
            }
            let summary = planner.summary();
            if (summary.cost, summary.violation) != (best, best_violation) {
                (best, best_violation) = (summary.cost, summary.violation);
                detail.chosen = detail.judged.len().checked_sub(1);
                if let (Some(bounds), Some(path)) = (&corridor, detail.paths.last()) {
                    let cruise = planner.trim().state.airspeed;
                    detail.corridor = polygons(&bounds.0, cruise, path, length);
                }
            }
            if !more {
                break;
            }
        }
        // A candidate that was begun but not ended at the deadline does not count.
        detail.paths.truncate(planner.summary().candidates);
        detail.map = map(planner, &state, tuning.settings.planner.altitude, length);
        detail.hits = hits(&scan, &state);
        if best.is_finite() {
            let knots = planner.best().knots.iter();
            detail.trajectory = knots.map(|k| place(k.state.x, k.state.z)).collect();
        }
        let _ = planner.finish();
        Some(detail)
    }
}

/// The judgement of the path that the last slice finished. `before` is the summary before that slice.
fn judged(planner: &Planner, before: &PlanSummary, length: f64) -> Judged {
    let now = planner.summary();
    let feasible = now.feasible > before.feasible;
    let Some(own) = planner.plane() else {
        let better = (now.cost, now.violation) != (before.cost, before.violation);
        return Judged {
            candidate: before.candidates,
            feasible,
            price: better.then_some(now.cost),
            parts: None,
        };
    };
    let candidate = own.at_hand();
    let (price, parts) = own.price_parts(candidate).unzip();
    Judged {
        candidate,
        feasible,
        price,
        parts: parts.map(|parts| Parts {
            clearance: parts.clearance,
            unknown: parts.unknown,
            onward: parts.cost_to_go,
            effort: parts.effort,
            lack: parts.lack * length,
        }),
    }
}

/// A scan of the link as the core takes it.
#[must_use]
pub fn core_scan(wire: &hil_protocol::LidarScan) -> LidarScan {
    LidarScan {
        angle_min: f64::from(wire.angle_min),
        angle_increment: f64::from(wire.angle_increment),
        ranges: wire.ranges.clone(),
    }
}

/// Number of slices that a cycle may use.
fn slices(tuning: &Tuning) -> u64 {
    let configure = &tuning.configure;
    u64::from(configure.latency_ticks) * u64::from(configure.slices_per_tick)
}

fn place(x: f64, z: f64) -> Point {
    let centimetres = |value: f64| (value * 100.0).round() / 100.0;
    (centimetres(x), centimetres(z))
}

/// A point of the grid in the world.
fn world(state: &VehicleState, point: GridPoint) -> Point {
    let origin = GridPoint::AIRCRAFT;
    place(
        state.x + point.col - origin.col,
        state.z + point.row - origin.row,
    )
}

fn map(planner: &Planner, state: &VehicleState, altitude: f64, length: f64) -> Map {
    if let Some(paper) = planner.paper() {
        let low = world(state, GridPoint { row: 0.0, col: 0.0 });
        let grid = paper.grid();
        let occupied = |row: usize, col: usize| grid.occupied(row as i32, col as i32);
        return Map {
            cell: 1.0,
            occupied: rows(low, 1.0, [GRID_ROWS, GRID_COLS], occupied),
            unknown: Vec::new(),
        };
    }
    let Some(known) = planner.plane().map(PlanePlanner::clearance) else {
        return Map::default();
    };
    // The window in units of the planner.
    let low = (
        ((state.x / length + WINDOW[0]) / CELL).floor() * CELL,
        altitude / length - HEIGHT,
    );
    let middle = |at: f64, cells: usize| at + CELL * (cells as f64 + 0.5);
    let extent = [
        (2.0 * HEIGHT / CELL) as usize,
        ((WINDOW[1] - WINDOW[0]) / CELL) as usize,
    ];
    let cells = |is: &dyn Fn(f64, f64) -> bool| {
        let low_corner = (low.0 * length, low.1 * length);
        rows(low_corner, CELL * length, extent, |row, col| {
            is(middle(low.0, col), middle(low.1, row))
        })
    };
    Map {
        cell: CELL * length,
        occupied: cells(&|x, z| known.is_occupied(x, z)),
        unknown: cells(&|x, z| known.is_unknown(x, z)),
    }
}

/// The cells of a raster for which `is` holds. Neighbours in a row are one entry.
fn rows(
    low: Point,
    cell: f64,
    [rows, cols]: [usize; 2],
    is: impl Fn(usize, usize) -> bool,
) -> Vec<Cells> {
    let mut found = Vec::new();
    for row in 0..rows {
        let mut col = 0;
        while col < cols {
            let length = (col..cols).take_while(|col| is(row, *col)).count();
            if length > 0 {
                let (x, z) = place(low.0 + cell * col as f64, low.1 + cell * row as f64);
                found.push((x, z, cell * length as f64));
            }
            col += length.max(1);
        }
    }
    found
}

fn hits(scan: &LidarScan, state: &VehicleState) -> Vec<Point> {
    let beams = scan.ranges.iter().enumerate();
    beams
        .filter(|(_, range)| **range > 0.0)
        .map(|(beam, range)| {
            let (up, ahead) = libm::sincos(state.air.pitch + scan.beam_angle(beam));
            let range = f64::from(*range);
            place(state.x + range * ahead, state.z + range * up)
        })
        .collect()
}

/// The parts that the eight half-planes of each stage boundary leave of a square about its path.
/// Bounds and cruise are in units of `length` \[m\].
fn polygons(bounds: &[f64], cruise: f64, path: &[Point], length: f64) -> Vec<Vec<Point>> {
    // The half-planes are relative to level flight from the first place of the path.
    let start = path.first().copied().unwrap_or_default();
    let stages = bounds.chunks(DIRECTIONS).take(KNOTS).zip(path).enumerate();
    stages
        .map(|(stage, (bounds, (x, z)))| {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let mut polygon: Vec<Point> = corners
                .iter()
                .map(|(right, up)| (x + SQUARE * length * right, z + SQUARE * length * up))
                .collect();
            let level = (
                start.0 + length * cruise * STAGE_PERIOD * stage as f64,
                start.1,
            );
            for ([up, ahead], bound) in DIRECTION_VECTORS.iter().zip(bounds) {
                polygon = cut(&polygon, |(x, z)| {
                    length * bound - ahead * (x - level.0) - up * (z - level.1)
                });
            }
            polygon.iter().map(|(x, z)| place(*x, *z)).collect()
        })
        .collect()
}

/// The part of a convex polygon where `inside` is not negative.
fn cut(polygon: &[Point], inside: impl Fn(Point) -> f64) -> Vec<Point> {
    let mut kept = Vec::new();
    for (from, to) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (a, b) = (inside(*from), inside(*to));
        if a >= 0.0 {
            kept.push(*from);
        }
        if (a >= 0.0) != (b >= 0.0) {
            let share = a / (a - b);
            kept.push((
                from.0 + share * (to.0 - from.0),
                from.1 + share * (to.1 - from.1),
            ));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_in_a_row_are_one() {
        let occupied = ["##.#", "....", ".###"];
        let is = |row: usize, col: usize| occupied[row].as_bytes()[col] == b'#';
        let expected = [(1.0, 5.0, 1.0), (2.5, 5.0, 0.5), (1.5, 6.0, 1.5)];
        assert_eq!(rows((1.0, 5.0), 0.5, [3, 4], is), expected);
    }

    #[test]
    fn a_square_is_cut_by_a_half_plane() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let left = cut(&square, |(x, _)| 1.0 - x);
        assert_eq!(left, [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)]);
        assert!(cut(&square, |_| -1.0).is_empty());
        assert_eq!(cut(&square, |_| f64::INFINITY), square);
    }
}
