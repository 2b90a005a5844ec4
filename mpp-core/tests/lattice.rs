//! Tests the paths of the lattice: the rules of every path, how paths pass obstacles, and that no
//! path is cheaper.

use crate::common::draw::Draw;
use crate::common::rolling_grid::{field, pose, random_map};
use mpp_core::lattice::{CostToGo, Lattice, LatticePath, LatticeTask, MAX_LATTICE_PATHS, STATIONS};
use mpp_core::map::{DistanceField, RollingGrid};
use mpp_core::sense::LidarScan;
use std::collections::BTreeMap;

/// Distance between heights \[m\], half the number of heights on either side, and slopes in each
/// direction.
const RISE: f64 = 0.25;
const HEIGHTS: i32 = 48;
const SLOPES: i32 = 4;

/// A task with turns within a radius of 18 m, which is full agility.
const TASK: LatticeTask = LatticeTask {
    x: 100.0,
    z: 50.0,
    slope: 0.0,
    altitude: 50.0,
    band: [50.0, 10.3],
    curvature: 1.0 / 18.0,
    room: 2.0,
    room_weight: 0.0,
    unknown_ahead: 26.0,
};

fn paths(field: &DistanceField, task: &LatticeTask) -> (f64, Vec<LatticePath>) {
    let mut lattice = Box::new(Lattice::new());
    lattice.start(task, field);
    let mut slices = 1;
    while lattice.advance(field) {
        slices += 1;
        assert!(slices < STATIONS, "a slice a station");
    }
    let mut paths = heapless::Vec::new();
    lattice.paths(&mut paths);
    assert!(paths.len() <= MAX_LATTICE_PATHS);
    (lattice.spacing(), paths.to_vec())
}

/// The field of points that beams from `(100, 50)` hit twice, with free space about.
fn discs(discs: &[(f64, f64)]) -> DistanceField {
    let mut map = RollingGrid::new();
    map.roll(100.0, 50.0);
    let mut fan = LidarScan::new();
    (fan.angle_min, fan.angle_increment) = (-0.9, 0.018);
    fan.ranges = [0.0; 100].into_iter().collect();
    map.insert(&fan, 45.0, &pose(100.0, 50.0, 0.0));
    for _ in 0..2 {
        for (x, z) in discs {
            let mut scan = LidarScan::new();
            scan.angle_min = libm::atan2(z - 50.0, x - 100.0);
            let range = libm::hypot(x - 100.0, z - 50.0) as f32;
            assert!(scan.ranges.push(range).is_ok());
            map.insert(&scan, 45.0, &pose(100.0, 50.0, 0.0));
        }
    }
    field(&map)
}

/// Slopes of a path in steps, from the heights: `rise = slope + next slope` in units of [`RISE`].
fn slopes(path: &LatticePath, first: i32) -> Vec<i32> {
    let mut slopes = vec![first];
    for pair in path.windows(2) {
        let rise = (pair[1] - pair[0]) / RISE;
        assert!((rise - rise.round()).abs() < 1e-9, "heights are multiples");
        slopes.push(rise.round() as i32 - slopes[slopes.len() - 1]);
    }
    slopes
}

/// The search's cost, from its definition.
struct Costs<'a> {
    field: &'a DistanceField,
    task: LatticeTask,
    spacing: f64,
}

impl Costs<'_> {
    /// Cost of one edge, from a station's height and slope to the next slope, in sixteenths.
    fn edge(&self, station: usize, height: i32, slope: i32, next: i32) -> u32 {
        let mut cost = if slope == next { 0 } else { 16 };
        cost += (0.8 * f64::from(next * next)) as u32;
        for quarter in 1..=4 {
            let halves = 2 * height + slope * quarter + (next - slope) * (quarter * quarter / 8);
            let ahead = self.spacing * (station as f64 + f64::from(quarter) / 4.0);
            let x = self.task.x + ahead;
            let z = self.task.z + 0.5 * RISE * f64::from(halves);
            let off = z - self.task.altitude;
            let outside = (off.abs() - self.task.band[1] + 0.5).max(0.0);
            let distance = self.field.distance(x, z);
            let lack = (1.2 - distance).max(0.0) + outside;
            let crowded = (self.task.room - distance).max(0.0);
            let mut point = 10.0 * lack * lack + self.task.room_weight * crowded * crowded;
            if ahead < self.task.unknown_ahead && self.field.is_unknown(x, z) {
                point += 5.0 * (1.0 - ahead / self.task.unknown_ahead);
            }
            point += if quarter == 4 { 0.01 * off * off } else { 0.0 };
            cost += (16.0 * point) as u32;
        }
        cost
    }

    fn path(&self, slopes: &[i32]) -> u32 {
        let mut height = 0;
        let edges = slopes.windows(2).enumerate().map(|(station, pair)| {
            let cost = self.edge(station, height, pair[0], pair[1]);
            height += pair[0] + pair[1];
            cost
        });
        edges.sum()
    }

    /// The least cost of any path: station by station, from the aircraft to the end.
    fn least(&self, first: i32) -> u32 {
        let mut reached = BTreeMap::from([((0, first), 0_u32)]);
        for station in 0..STATIONS - 1 {
            let mut next = BTreeMap::new();
            for ((height, slope), so_far) in reached {
                for turned in (slope - 1).max(-SLOPES)..=(slope + 1).min(SLOPES) {
                    let to = height + slope + turned;
                    if to.abs() <= HEIGHTS {
                        let cost = so_far + self.edge(station, height, slope, turned);
                        let place = next.entry((to, turned)).or_insert(u32::MAX);
                        *place = cost.min(*place);
                    }
                }
            }
            reached = next;
        }
        reached.into_values().min().unwrap_or(u32::MAX)
    }
}

/// Slope at the start, in steps.
fn first_slope(task: &LatticeTask, spacing: f64) -> i32 {
    let steps = task.slope * spacing / (2.0 * RISE);
    (steps.round() as i32).clamp(-SLOPES, SLOPES)
}

fn tasks(draw: &mut Draw) -> LatticeTask {
    LatticeTask {
        z: 50.0 + draw.between(-9.0, 9.0),
        slope: draw.between(-0.9, 0.9),
        curvature: draw.between(0.005, 0.1),
        room: draw.between(1.0, 3.0),
        room_weight: draw.between(-1.0, 2.0).max(0.0),
        unknown_ahead: draw.between(20.0, 50.0),
        ..TASK
    }
}

#[test]
fn every_path_starts_at_the_aircraft_and_turns_by_one_step_at_most() {
    let mut found = 0;
    for seed in 0..40 {
        let mut draw = Draw::new(seed);
        let field = field(&random_map(&mut draw, 100.0, 2));
        let task = tasks(&mut draw);
        let (spacing, paths) = paths(&field, &task);
        for path in &paths {
            assert!((path[0] - task.z).abs() < 1e-9);
            let slopes = slopes(path, first_slope(&task, spacing));
            let turns = slopes.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            assert!(turns.max() <= Some(1), "{slopes:?}");
            assert!(slopes.iter().all(|slope| slope.abs() <= SLOPES));
            // One step of slope over one spacing is no more than roll-outs can turn.
            let curvature = 2.0 * RISE / (spacing * spacing);
            assert!(curvature <= task.curvature * 1.75 || spacing >= 3.6 - 1e-9);
        }
        found += paths.len();
    }
    assert!(found > 80, "{found}");
}

#[test]
fn no_path_is_cheaper_than_the_first_and_the_others_follow_by_cost() {
    for seed in 0..25 {
        let mut draw = Draw::new(seed);
        let scans = seed as usize % 4;
        let field = field(&random_map(&mut draw, 100.0, scans));
        let task = tasks(&mut draw);
        let (spacing, paths) = paths(&field, &task);
        let first = first_slope(&task, spacing);
        let costs = Costs {
            field: &field,
            task,
            spacing,
        };
        let found: Vec<u32> = paths
            .iter()
            .map(|path| costs.path(&slopes(path, first)))
            .collect();
        assert!(found.is_sorted(), "{found:?}");
        assert_eq!(found.first(), Some(&costs.least(first)), "seed {seed}");
    }
}

#[test]
fn the_cost_to_go_is_what_the_best_path_costs_from_the_via_station() {
    let mut compared = 0;
    for seed in 0..25 {
        let mut draw = Draw::new(seed);
        let field = field(&random_map(&mut draw, 100.0, 2));
        let task = tasks(&mut draw);
        let mut lattice = Box::new(Lattice::new());
        lattice.start(&task, &field);
        while lattice.advance(&field) {}
        let mut found = heapless::Vec::new();
        lattice.paths(&mut found);
        let spacing = lattice.spacing();
        let mut cost_to_go = Box::new(CostToGo::new());
        lattice.write_cost_to_go(&mut cost_to_go);
        let via = ((cost_to_go.via() - task.x) / spacing).round() as usize;
        let costs = Costs {
            field: &field,
            task,
            spacing,
        };
        for path in &found {
            let slopes = slopes(path, first_slope(&task, spacing));
            let rest = costs.path(&slopes) - costs.path(&slopes[..=via]);
            let rest = (f64::from(rest) / 16.0).min(2000.0);
            let slope = 2.0 * RISE / spacing * f64::from(slopes[via]);
            let cost = cost_to_go.at(path[via], slope);
            assert!((cost - rest).abs() < 1e-3, "seed {seed}: {cost}");
            // Half a step aside the cost lies between the costs at either end.
            let aside = cost_to_go.at(path[via] + RISE, slope);
            let between = cost_to_go.at(path[via] + 0.5 * RISE, slope);
            assert!((between - 0.5 * (cost + aside)).abs() < 1e-3);
            compared += 1;
        }
        for (z, slope) in [(f64::INFINITY, 9.0), (f64::NEG_INFINITY, -9.0)] {
            assert!((0.0..=2000.0).contains(&cost_to_go.at(z, slope)));
        }
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn nothing_in_the_way_is_flown_straight_on_and_back_to_the_altitude() {
    let empty = DistanceField::new();
    let (_, level) = paths(&empty, &TASK);
    assert!(level[0].iter().all(|z| (z - 50.0).abs() < 1e-12));
    for off in [-8.0, 8.0] {
        let task = LatticeTask {
            z: 50.0 + off,
            slope: 0.3 * off.signum(),
            ..TASK
        };
        let (_, paths) = paths(&empty, &task);
        let most = paths[0]
            .iter()
            .map(|z| (z - 50.0).abs())
            .fold(0.0, f64::max);
        assert!(most <= TASK.band[1] - 0.5, "{most} m from the altitude");
        let end = paths[0][STATIONS - 1] - 50.0;
        assert!(end * off < 0.5 * off * off, "{end}");
    }
}

#[test]
fn a_single_obstacle_is_passed_on_both_sides() {
    let field = discs(&[(120.0, 50.0)]);
    let (spacing, paths) = paths(&field, &TASK);
    // Station 8 is 19.2 m ahead.
    assert!((spacing - 2.4).abs() < 1e-9);
    let above = paths.iter().filter(|path| path[8] > 51.0);
    let below = paths.iter().filter(|path| path[8] < 49.0);
    assert!(above.count() >= 1 && below.count() >= 1, "{paths:?}");
}

#[test]
fn a_wall_is_passed_through_its_gap_and_within_the_band() {
    for gap in [44.0, 47.0, 53.0, 56.0, 59.0] {
        let wall: Vec<(f64, f64)> = (0..90)
            .map(|i| (121.0, 36.0 + 0.3 * f64::from(i)))
            .filter(|(_, z)| f64::abs(z - gap) > 2.0)
            .collect();
        let (_, paths) = paths(&discs(&wall), &TASK);
        let through = &paths[0];
        // Station 9 is 21.6 m ahead.
        assert!((through[9] - gap).abs() < 2.0, "{gap}: {through:?}");
        assert!(
            through
                .iter()
                .all(|z| (z - 50.0).abs() <= TASK.band[1] - 0.5)
        );
    }
}

#[test]
fn a_search_that_is_started_again_is_as_new() {
    let field = discs(&[(118.0, 51.0), (126.0, 46.0)]);
    let mut lattice = Box::new(Lattice::new());
    let runs = [
        TASK,
        LatticeTask {
            z: 45.0,
            curvature: 0.01,
            ..TASK
        },
        TASK,
    ]
    .map(|task| {
        lattice.start(&task, &field);
        while lattice.advance(&field) {}
        let mut paths = heapless::Vec::new();
        lattice.paths(&mut paths);
        paths
    });
    assert_eq!(runs[0], runs[2]);
    assert_ne!(runs[0], runs[1]);
}
