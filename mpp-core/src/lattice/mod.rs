//! Smooth paths over a lattice of stations, heights and slopes, by dynamic programming. The lattice is
//! the deterministic counterpart of RRT*-AR.
//!
//! From one station to the next the slope of a path changes by at most one step, because the aircraft
//! cannot turn more. The height follows from the slopes. One pass from the aircraft and one pass from the
//! far end meet at the *via* station. There the search knows the cost of the best path through every
//! height, and from there on the cost-to-go. Each minimum of the cost gives a path. These paths differ in the way they pass the obstacles,
//! or in their heights.

mod cost_to_go;
mod edges;

use crate::map::{DistanceField, Height};
use crate::tuning::UNKNOWN_COST;
use crate::tuning::lattice::{
    AGILE, ALTITUDE_WEIGHT, BAND_MARGIN, MARGIN, MARGIN_WEIGHT, RISE, SPACING, STRETCH,
};
use core::ops::Range;
pub use cost_to_go::CostToGo;
use edges::{
    Choice, EDGE_REACH, Edges, HEIGHTS, LEVEL, Layer, MIDDLE, NEVER, NO_COSTS, NO_POINT_COSTS,
    POINTS, PointCosts, QUARTERS, VIA, choice, forbid, in_units, reached, row, settle,
};

/// Number of stations, the station at the aircraft included.
pub const STATIONS: usize = 17;
/// Greatest number of paths from one search.
pub const MAX_LATTICE_PATHS: usize = 6;

/// The changes of slope from a station back to the one before, and from a station to the next one. Among equal costs the first
/// one stays: the lowest start, and the edge without a turn.
const BEFORE: [i32; 3] = [1, 0, -1];
const AFTER: [i32; 3] = [0, -1, 1];

/// Greatest distance of a path in height from where it starts \[m\].
pub(crate) const CLIMB: f64 = MIDDLE as f64 * RISE;

/// A path: its height at each station \[m\].
pub type LatticePath = [f64; STATIONS];

/// Start of the paths, and the limits that they keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticeTask {
    /// Downrange position of the start \[m\].
    pub x: f64,
    /// Height of the start \[m\].
    pub z: f64,
    /// Slope at the start [-].
    pub slope: f64,
    /// Height to which the paths return \[m\].
    pub altitude: f64,
    /// Middle of the altitude band, and its reach to either side \[m\].
    pub band: [f64; 2],
    /// Greatest curvature of a path [1/m].
    pub curvature: f64,
    /// Clearance that a path should have where there is room \[m\].
    pub room: f64,
    /// Weight of the squared lack of it [1/m^2].
    pub room_weight: f64,
    /// Distance ahead beyond which an unknown point costs nothing \[m\].
    pub unknown_ahead: f64,
}

/// The search and its tables.
#[derive(Clone, Debug)]
pub struct Lattice {
    task: LatticeTask,
    spacing: f64,
    slope_step: f64,
    station: usize,
    /// Costs between the start and the present station, or between the present station and the far end.
    layer: Layer,
    /// Costs at the next station, as far as the search knows them.
    next: Layer,
    /// Terms of the costs of points that depend on their heights alone.
    heights: [[HeightTerms; 2]; HEIGHTS],
    /// PointCosts of the points of the present edges.
    point_costs: PointCosts,
    /// Costs from the start to the via station.
    to_via: Layer,
    /// Best previous slope for each height and slope, at each station up to the via station.
    before: [Choice; VIA + 1],
    /// Best next slope for each height and slope, at each station from the via station on.
    after: [Choice; STATIONS - VIA],
}

impl Lattice {
    /// A lattice before its first search.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            task: LatticeTask {
                x: 0.0,
                z: 0.0,
                slope: 0.0,
                altitude: 0.0,
                band: [0.0; 2],
                curvature: 0.0,
                room: 0.0,
                room_weight: 0.0,
                unknown_ahead: 0.0,
            },
            spacing: SPACING,
            slope_step: 0.0,
            station: STATIONS,
            layer: NO_COSTS,
            next: NO_COSTS,
            heights: [[HeightTerms::NONE; 2]; HEIGHTS],
            point_costs: NO_POINT_COSTS,
            to_via: NO_COSTS,
            before: [[[0; HEIGHTS]; _]; VIA + 1],
            after: [[[0; HEIGHTS]; _]; STATIONS - VIA],
        }
    }

    /// Starts a search. For an aircraft that turns less, the stations are farther apart and the slopes finer.
    /// The field must not change during the search.
    pub fn start(&mut self, task: &LatticeTask, field: &DistanceField) {
        self.task = *task;
        for (place, terms) in self.heights.as_flattened_mut().iter_mut().enumerate() {
            *terms = HeightTerms::new(task, field, place);
        }
        // RISE = spacing * step / 2 holds at every spacing.
        let stretch = libm::sqrt(AGILE / task.curvature.max(1e-6)).clamp(1.0, STRETCH);
        self.spacing = SPACING * stretch;
        self.slope_step = 2.0 * RISE / self.spacing;
        self.station = 0;
        forbid(&mut self.layer);
        let steps =
            libm::round(task.slope / self.slope_step).clamp(-f64::from(LEVEL), LEVEL.into());
        let slope = (steps as i32 + LEVEL) as usize;
        if let Some(costs) = self.layer.get_mut(slope) {
            costs[MIDDLE as usize] = 0;
        }
    }

    /// Distance between stations \[m\].
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Evaluates the edges of one station. Returns true until the search is complete.
    pub fn advance(&mut self, field: &DistanceField) -> bool {
        const LAST: usize = STATIONS - 1;
        match self.station {
            station @ 0..VIA => self.forward(field, station),
            station @ VIA..LAST => {
                if station == VIA {
                    self.to_via = self.layer;
                    self.layer = NO_COSTS;
                }
                // The second pass runs from the far end back to the via station.
                self.backward(field, LAST - 1 - (station - VIA));
            }
            _ => return false,
        }
        self.station += 1;
        self.station < LAST
    }

    #[inline(never)]
    fn forward(&mut self, field: &DistanceField, station: usize) {
        let reached = reached(&self.layer);
        self.write_point_costs(field, station, &reached);
        forbid(&mut self.next);
        for (to, costs) in (0..).zip(&mut self.next) {
            for (number, change) in (0..).zip(BEFORE) {
                let from = to + change;
                let Some((edges, known)) = Edges::new(from, to).zip(row(&self.layer, from)) else {
                    continue;
                };
                let heights = edges.starts(&reached);
                let costs = costs.get_mut(edges.ends(&heights)).unwrap_or_default();
                let known = known.get(heights.clone()).unwrap_or_default();
                edges.relax(&self.point_costs, heights.start, known, number, costs);
            }
        }
        if let Some(choices) = self.before.get_mut(station + 1) {
            settle(&self.next, &mut self.layer, choices);
        }
    }

    #[inline(never)]
    fn backward(&mut self, field: &DistanceField, station: usize) {
        let all = 0..HEIGHTS;
        self.write_point_costs(field, station, &all);
        forbid(&mut self.next);
        for (from, costs) in (0..).zip(&mut self.next) {
            for (number, change) in (0..).zip(AFTER) {
                let to = from + change;
                let Some((edges, known)) = Edges::new(from, to).zip(row(&self.layer, to)) else {
                    continue;
                };
                let heights = edges.starts(&all);
                let known = known.get(edges.ends(&heights)).unwrap_or_default();
                let costs = costs.get_mut(heights.clone()).unwrap_or_default();
                edges.relax(&self.point_costs, heights.start, known, number, costs);
            }
        }
        if let Some(choices) = self.after.get_mut(station - VIA) {
            settle(&self.next, &mut self.layer, choices);
        }
    }

    /// Writes the costs of the points on the edges of a station that begin at certain heights. The last quarter also
    /// contains the cost of the height itself.
    // Both passes call it, and each would hold a copy.
    #[inline(never)]
    fn write_point_costs(&mut self, field: &DistanceField, station: usize, heights: &Range<usize>) {
        let task = self.task;
        let first = (2 * heights.start).saturating_sub(EDGE_REACH);
        let last = (2 * heights.end + EDGE_REACH).min(POINTS);
        for (quarter, costs) in self.point_costs.iter_mut().enumerate() {
            let share = (quarter + 1) as f64 / QUARTERS as f64;
            let ahead = self.spacing * (station as f64 + share);
            let unknown = if ahead < task.unknown_ahead {
                UNKNOWN_COST * (1.0 - ahead / task.unknown_ahead)
            } else {
                0.0
            };
            let column = field.column(task.x + ahead, unknown > 0.0);
            let clearance_cost = |distance: f64, outside: f64| {
                let lack = (MARGIN - distance).max(0.0) + outside;
                let crowded = (task.room - distance).max(0.0);
                MARGIN_WEIGHT * lack * lack + task.room_weight * crowded * crowded
            };
            let far_cost = clearance_cost(column.farthest(), 0.0);
            let far = [far_cost, far_cost + unknown];
            let far_costs = far.map(in_units);
            let is_end = quarter + 1 == QUARTERS;
            let pairs = self.heights.get(first / 2..).unwrap_or_default();
            for (parity, costs) in costs.iter_mut().enumerate() {
                let start = (EDGE_REACH + first) / 2;
                let count = (last - first + 1 - parity) / 2;
                let costs = costs.get_mut(start..start + count).unwrap_or_default();
                for (cost, pair) in costs.iter_mut().zip(pairs) {
                    let terms = &pair[parity % 2];
                    let is_unknown = column.is_unknown(&terms.height);
                    let of_altitude = if is_end { terms.altitude_cost } else { 0.0 };
                    if column.is_far(&terms.height) && terms.outside == 0.0 {
                        let is_unknown = usize::from(is_unknown);
                        *cost = if is_end {
                            in_units(far[is_unknown] + of_altitude)
                        } else {
                            far_costs[is_unknown]
                        };
                        continue;
                    }
                    let mut sum = clearance_cost(column.distance(&terms.height), terms.outside);
                    if is_unknown {
                        sum += unknown;
                    }
                    *cost = in_units(sum + of_altitude);
                }
            }
        }
    }

    /// Writes the cost-to-go from the via station on. The call is valid only after the search.
    pub fn write_cost_to_go(&self, to: &mut CostToGo) {
        to.start = [self.task.x, self.task.z];
        to.spacing = self.spacing;
        to.slope_step = self.slope_step;
        to.layer = self.layer;
    }

    /// Writes the paths through the best heights of the via station, the best path first. The call is valid
    /// only after the search.
    pub fn paths(&self, paths: &mut heapless::Vec<LatticePath, MAX_LATTICE_PATHS>) {
        paths.clear();
        // The least cost through each height, and its slope.
        let (mut through, mut slopes) = ([0; HEIGHTS], [0_i8; HEIGHTS]);
        through.fill(NEVER);
        let passes = self.to_via.iter().zip(&self.layer);
        for (slope, (to, from)) in (0..).zip(passes) {
            let best = through.iter_mut().zip(&mut slopes);
            for ((least, best), (to, from)) in best.zip(to.iter().zip(from)) {
                let cost = to.saturating_add(*from);
                if cost < *least {
                    (*least, *best) = (cost, slope);
                }
            }
        }
        let mut minima: heapless::Vec<(u32, i32, i32), HEIGHTS> = heapless::Vec::new();
        for (height, (cost, slope)) in (0..).zip(through.iter().zip(&slopes)) {
            let at = |height: i32| {
                let place = usize::try_from(height).ok();
                place
                    .and_then(|place| through.get(place).copied())
                    .unwrap_or(NEVER)
            };
            if *cost < NEVER && *cost <= at(height - 1) && *cost < at(height + 1) {
                let _ = minima.push((*cost, height, i32::from(*slope)));
            }
        }
        while !paths.is_full()
            && let Some(best) = minima.iter_mut().min()
            && best.0 < NEVER
        {
            let (_, height, slope) = *best;
            best.0 = NEVER;
            let _ = paths.push(self.path(height, slope));
        }
    }

    /// The best path through a height and a slope at the via station.
    fn path(&self, height: i32, slope: i32) -> LatticePath {
        let z = |height: i32| self.task.z + RISE * f64::from(height - MIDDLE);
        let mut path = [z(height); STATIONS];
        let (before, after) = path.split_at_mut(VIA);
        let mut at = (height, slope);
        for (place, choices) in before.iter_mut().zip(&self.before[1..]).rev() {
            let slope = other_end(choices, at, &BEFORE);
            at = (at.0 - (slope - LEVEL) - (at.1 - LEVEL), slope);
            *place = z(at.0);
        }
        let mut at = (height, slope);
        for (place, choices) in after.iter_mut().skip(1).zip(&self.after) {
            let slope = other_end(choices, at, &AFTER);
            at = (at.0 + (at.1 - LEVEL) + (slope - LEVEL), slope);
            *place = z(at.0);
        }
        path
    }
}

/// The terms of the cost of a point that depend on its height alone.
#[derive(Clone, Copy, Debug)]
struct HeightTerms {
    height: Height,
    /// Distance beyond the band less its margin \[m\].
    outside: f64,
    /// Cost of the distance from the altitude [-].
    altitude_cost: f64,
}

impl HeightTerms {
    const NONE: Self = Self {
        height: Height::LOWEST,
        outside: 0.0,
        altitude_cost: 0.0,
    };

    fn new(task: &LatticeTask, field: &DistanceField, place: usize) -> Self {
        let z = task.z + 0.5 * RISE * (place as f64 - f64::from(2 * MIDDLE));
        let from_altitude = z - task.altitude;
        let [middle, half] = task.band;
        Self {
            height: field.height(z),
            outside: ((z - middle).abs() - half + BAND_MARGIN).max(0.0),
            altitude_cost: ALTITUDE_WEIGHT * from_altitude * from_altitude,
        }
    }
}

/// The slope at the other end of the best edge at a height and a slope.
fn other_end(choices: &Choice, at: (i32, i32), changes: &[i32]) -> i32 {
    let change = choice(choices, at).and_then(|number| changes.get(number));
    change.map_or(LEVEL, |change| at.1 + change)
}
