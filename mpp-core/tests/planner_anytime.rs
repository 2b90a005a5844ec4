//! Tests the planner as an anytime machine: bounded, repeatable, and never worse with more slices.

use crate::common::planning::{FEASIBLE, SCATTERED, level, plan, planner, presets, with_planner};
use crate::common::sensors::frame;
use crate::common::world::{Disc, scan};
use mpp_core::config::MAX_PATHS;
use mpp_core::flight::FlightLoop;
use mpp_core::paper::config::{TREE_RUNS, TREE_SAMPLES};
use mpp_core::planner::{PlanSummary, Planner, Verdict};
use mpp_core::qp::{MAX_ITERATIONS, Weights};
use mpp_core::settings::{PlannerSettings, Settings};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{Conditions, VehicleState};

/// One slice for the map, the trees of a cycle at 10 samples a slice, and each path's corridor and
/// program at 8 steps a slice.
const MOST_SLICES: usize =
    1 + TREE_RUNS * (TREE_SAMPLES / 10 + 1) + MAX_PATHS * (MAX_ITERATIONS / 8 + 3);

/// What the planner ranks trajectories by: the price, or, in the paper's method, violation and cost.
fn rank(planner: &Planner) -> (f64, f64) {
    let summary = planner.summary();
    match planner.plane() {
        Some(flight) => (FEASIBLE, flight.price()),
        None => (summary.violation.max(FEASIBLE), summary.cost),
    }
}

#[test]
fn more_slices_never_give_a_worse_plan() {
    let mut improvements = 0;
    for settings in presets() {
        let mut planner = planner(&settings);
        let state = level(&planner);
        planner.begin(0.0, &state, &Conditions::STILL, &scan(&SCATTERED, &state));
        let mut last = (rank(&planner), planner.best().clone());
        loop {
            let more = planner.advance();
            let now = rank(&planner);
            assert!(now <= last.0, "{now:?} after {:?}", last.0);
            assert!(
                now < last.0 || *planner.best() == last.1,
                "only a better plan replaces one"
            );
            if now < last.0 {
                improvements += 1;
                let mut interrupted = planner.clone();
                let verdict = interrupted.finish();
                let violation = planner.summary().violation;
                assert_eq!(verdict == Verdict::Feasible, violation <= FEASIBLE);
                assert_ne!(verdict, Verdict::Nothing);
                assert_eq!(interrupted.best(), planner.best());
            }
            last = (now, planner.best().clone());
            if !more {
                break;
            }
        }
    }
    assert!(improvements >= 5, "{improvements}");
}

#[test]
fn an_interrupted_cycle_says_so_and_stops() {
    let mut planner = planner(&Settings::paper());
    let state = level(&planner);
    planner.begin(0.0, &state, &Conditions::STILL, &scan(&SCATTERED, &state));
    assert!(planner.is_working() && planner.advance());
    assert_eq!(planner.finish(), Verdict::Nothing);
    assert!(!planner.summary().complete && !planner.is_working() && !planner.advance());
    assert_eq!(planner.summary().slices, 1);
}

/// Plans two cycles, and calls `between` between slices.
fn two_cycles(planner: &mut Planner, mut between: impl FnMut()) -> Vec<(Trajectory, PlanSummary)> {
    let state = level(planner);
    let mut plans = Vec::new();
    for discs in [&SCATTERED[..], &SCATTERED[1..]] {
        planner.begin(0.5, &state, &Conditions::STILL, &scan(discs, &state));
        while planner.advance() {
            between();
        }
        planner.finish();
        plans.push((planner.best().clone(), *planner.summary()));
    }
    plans
}

#[test]
fn the_same_seed_gives_the_same_bits_whatever_runs_between_slices() {
    for settings in presets() {
        let alone = two_cycles(&mut planner(&settings), || {});
        let mut flight = FlightLoop::new(&settings).unwrap();
        let mut other = planner(&settings);
        let state = level(&other);
        other.begin(0.0, &state, &Conditions::STILL, &scan(&SCATTERED, &state));
        let mut time = 0.0;
        let busy = two_cycles(&mut planner(&settings), || {
            time += 0.01;
            flight.step(time, &frame(&VehicleState { x: time, ..state }));
            other.advance();
        });
        assert_eq!(alone, busy);
    }
}

#[test]
fn another_seed_searches_other_paths() {
    let settings = Settings::paper();
    let reseeded = with_planner(
        settings,
        PlannerSettings {
            seed: 1,
            ..settings.planner
        },
    );
    let ours = two_cycles(&mut planner(&settings), || {});
    let theirs = two_cycles(&mut planner(&reseeded), || {});
    assert_ne!(ours, theirs);
}

#[test]
fn slices_are_bounded_even_when_there_is_no_way() {
    for settings in presets() {
        let most = with_planner(
            settings,
            PlannerSettings {
                paths: MAX_PATHS,
                ..settings.planner
            },
        );
        let mut planner = planner(&most);
        let state = level(&planner);
        let closed: Vec<Disc> = (0..80)
            .map(|i| (120.0, 30.0 + 0.5 * f64::from(i), 1.5))
            .collect();
        for discs in [&[][..], &SCATTERED, &closed] {
            plan(&mut planner, &state, discs);
            let summary = planner.summary();
            assert!(summary.slices <= MOST_SLICES, "{summary:?}");
            assert!(summary.candidates <= MAX_PATHS && summary.feasible <= summary.candidates);
            assert!(summary.complete && summary.tree_runs <= TREE_RUNS);
        }
    }
}

#[test]
fn a_planner_set_up_again_plans_like_a_new_one() {
    for (first, second) in
        [(0, 1), (1, 2), (2, 0), (2, 1)].map(|(a, b): (usize, usize)| (presets()[a], presets()[b]))
    {
        let mut used = planner(&first);
        two_cycles(&mut used, || {});
        used.set_up(&second).unwrap();
        let mut new = planner(&second);
        assert_eq!(two_cycles(&mut used, || {}), two_cycles(&mut new, || {}));
        // The start is a motion that meets the attitude limits of the flight preset.
        let mut diving = level(&new);
        diving.air.flight_path = -0.62;
        diving.air.pitch = -0.3;
        diving.z += 12.0;
        assert_eq!(plan(&mut used, &diving, &[]), plan(&mut new, &diving, &[]));
        assert_eq!(used.summary(), new.summary());
    }
}

#[test]
fn a_planner_whose_last_set_up_failed_plans_nothing() {
    for settings in presets() {
        let mut planner = planner(&settings);
        let state = level(&planner);
        let weights = Weights {
            control: [1.0, -5.0],
            terminal: 1.0,
        };
        let bad = PlannerSettings {
            weights,
            ..settings.planner
        };
        assert!(planner.set_up(&with_planner(settings, bad)).is_err());
        assert_eq!(plan(&mut planner, &state, &SCATTERED), Verdict::Nothing);
    }
}
