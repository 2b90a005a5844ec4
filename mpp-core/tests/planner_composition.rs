//! Tests that the plan of a cycle is the best of its candidates' optima. Each optimum is solved
//! here to the end.

use crate::common::planning::{FEASIBLE, SCATTERED, level, plan, planner, with_planner};
use crate::common::world::{Disc, scan};
use mpp_core::corridor::Corridor;
use mpp_core::paper::config::TREE_SAMPLES;
use mpp_core::paper::{CollocationPoints, Extension, Path, Search, StageModel, resample};
use mpp_core::planner::{Planner, Verdict};
use mpp_core::qp::{Bounds, Condensed, Problem, Solution, Solver, Status};
use mpp_core::settings::{PlannerSettings, Settings};
use mpp_core::vehicle::{Conditions, VehicleState};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The presets of the paper's method.
fn paper_cycles() -> [Settings; 2] {
    [Settings::reference(), Settings::paper()]
}

/// Discs so close that every path comes nearer to them than it should.
const CLOSE: [Disc; 3] = [(107.0, 50.5, 1.5), (118.0, 46.0, 2.0), (119.0, 55.0, 2.0)];

/// Starts off the altitude \[m\], climbing \[rad\], faster than trim [m/s]. The last one needs less
/// than no thrust.
const STARTS: [(f64, f64, f64); 6] = [
    (0.0, 0.0, 0.0),
    (2.0, 0.1, 0.5),
    (-3.0, 0.0, -0.5),
    (1.0, -0.1, 0.0),
    (-1.0, 0.05, 1.0),
    (4.0, -0.2, 5.0),
];

/// The planner's model, set up independently of the planner.
fn model(settings: &Settings, planner: &Planner) -> StageModel {
    let own = settings.planner.paper().unwrap();
    StageModel::new(
        &settings.airframe,
        planner.trim(),
        own.jacobian,
        own.initial,
    )
    .unwrap()
}

/// The program of the planner's present candidate.
fn program(
    settings: &Settings,
    planner: &Planner,
    model: &StageModel,
    state: &VehicleState,
) -> Problem {
    let (trim, own) = (planner.trim(), settings.planner.paper().unwrap());
    let paper = planner.paper().unwrap();
    let mut corridor = Corridor::new();
    let cruise = trim.state.airspeed;
    corridor.trace(
        paper.grid(),
        paper.points(),
        cruise,
        &own.padding,
        own.rules,
    );
    let mut bounds = Bounds::none();
    bounds.set_corridor(&corridor);
    bounds.set_thrust([f64::INFINITY, trim.control.thrust]);
    Problem {
        initial: model.initial_state(trim, &state.air),
        target: [0.0, settings.planner.altitude - state.z, 0.0, 0.0, 0.0, 0.0],
        bounds,
        ..Problem::EMPTY
    }
}

/// Rank of the best candidate of a cycle, and the number of candidates.
fn best_of_all(
    settings: &Settings,
    planner: &mut Planner,
    state: &VehicleState,
    discs: &[Disc],
) -> ((f64, f64), usize) {
    let model = model(settings, planner);
    let mut shared = Box::new(Condensed::new());
    let weights = &settings.planner.weights;
    shared.condense(&model.dynamics(), weights).unwrap();
    let (mut solver, mut solution) = (Box::new(Solver::new()), Solution::new());
    let mut best = (f64::INFINITY, f64::INFINITY);
    let mut seen = 0;
    planner.begin(0.0, state, &Conditions::STILL, &scan(discs, state));
    let mut working = true;
    while working {
        working = planner.advance();
        if planner.summary().candidates > seen {
            seen += 1;
            let problem = program(settings, planner, &model, state);
            if solver.solve(&shared, &problem) == Status::Optimal
                && solver.solution(&shared, &mut solution) == Status::Optimal
            {
                let rank = (solution.violation.max(FEASIBLE), solution.cost);
                if rank < best {
                    best = rank;
                }
            }
        }
    }
    (best, seen)
}

#[test]
fn the_plan_is_the_best_of_all_candidates() {
    let mut found = 0;
    for preset in paper_cycles() {
        let settings = with_planner(
            preset,
            PlannerSettings {
                paths: 10,
                ..preset.planner
            },
        );
        let mut planner = planner(&settings);
        for (off, climb, faster) in STARTS {
            for discs in [&SCATTERED[..], &CLOSE] {
                let mut state = level(&planner);
                state.z += off;
                state.air.flight_path += climb;
                state.air.airspeed += faster;
                let (best, candidates) = best_of_all(&settings, &mut planner, &state, discs);
                let summary = *planner.summary();
                assert_eq!(summary.candidates, candidates);
                if best.1.is_infinite() {
                    assert_eq!(planner.finish(), Verdict::Nothing);
                    continue;
                }
                let (violation, cost) = (summary.violation.max(FEASIBLE), summary.cost);
                assert!((violation - best.0).abs() < 1e-9, "{summary:?}: {best:?}");
                assert!(
                    (cost - best.1).abs() <= 1e-9 * best.1.max(1.0),
                    "{summary:?}: {best:?}"
                );
                found += 1;
            }
        }
    }
    assert!(found >= 10, "{found}");
}

/// The first candidates of a seed, tree after tree and node after node.
fn candidates(settings: &Settings, planner: &Planner, count: usize) -> Vec<CollocationPoints> {
    let rules = settings.planner.paper().unwrap().rules;
    let grid = planner.paper().unwrap().grid();
    let mut random = Pcg64Mcg::seed_from_u64(settings.planner.seed);
    let mut unit = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let (mut search, mut path) = (Search::new(), Path::new());
    let mut found = Vec::new();
    while found.len() < count {
        search.restart(rules);
        let grown = |_: &usize| search.extend(grid, &mut unit) == Extension::Complete;
        (0..=TREE_SAMPLES).find(grown).unwrap();
        let mut next = 0;
        while let Some(after) = search.next_path(next, &mut path) {
            found.push(resample(&path, rules));
            next = after;
        }
    }
    found.truncate(count);
    found
}

#[test]
fn every_path_of_every_tree_is_a_candidate_in_turn() {
    for settings in paper_cycles() {
        let mut planner = planner(&settings);
        let state = level(&planner);
        planner.begin(0.0, &state, &Conditions::STILL, &scan(&SCATTERED, &state));
        let mut seen = Vec::new();
        while planner.advance() {
            if planner.summary().candidates > seen.len() {
                seen.push(*planner.paper().unwrap().points());
            }
        }
        seen.push(*planner.paper().unwrap().points());
        assert_eq!(seen.len(), settings.planner.paths);
        assert_eq!(seen, candidates(&settings, &planner, seen.len()));
    }
}

#[test]
fn the_plan_is_placed_where_the_aircraft_is() {
    for settings in paper_cycles() {
        let mut planner = planner(&settings);
        let mut state = level(&planner);
        state.x = 321.0;
        state.z = 47.0;
        assert_eq!(plan(&mut planner, &state, &[]), Verdict::Feasible);
        let first = planner.best().knots[0].state;
        assert!((first.x - 321.0).abs() < 1e-9 && (first.z - 47.0).abs() < 1e-9);
    }
}
