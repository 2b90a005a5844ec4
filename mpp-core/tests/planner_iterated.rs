//! The cycle of preset `flight`: what it keeps from the cycle before, its bound, and what it hands over.
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod common {
    pub(crate) mod clearance;
    pub(crate) mod draw;
    pub(crate) mod planning;
    pub(crate) mod world;
}

use common::clearance::clearance;
use common::draw::Draw;
use common::planning::{FEASIBLE, SCATTERED, level, plan, planner, presets, with_planner};
use common::world::{Disc, scan};
use mpp_core::config::{KNOTS, MAX_PATHS, STAGE_PERIOD, STAGES, TREE_SAMPLES};
use mpp_core::estimate::Conditions;
use mpp_core::plan::{MAX_LATTICE_PATHS, STATIONS};
use mpp_core::planner::{PlanSummary, Planner, SetupError, Verdict};
use mpp_core::qp::{MAX_ITERATIONS, Penalty};
use mpp_core::settings::{Iteration, PlannerSettings, Settings};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{PathControl, PathState, VehicleState};

/// The previous plan, the lattice's paths, two of the tree.
const CANDIDATES: usize = 1 + MAX_LATTICE_PATHS + 2;
/// Each candidate once, then two further rounds of the best two.
const PROGRAMS: usize = CANDIDATES + 2 * 2;
/// One map, the stations, one tree, and each program's faces, its set-up, its solution at 8 steps
/// a slice and the look for the next.
const MOST_SLICES: usize =
    1 + STATIONS + TREE_SAMPLES / 10 + 1 + PROGRAMS * (MAX_ITERATIONS / 8 + 4);

/// 60 discs at random in 50 m x 24 m.
fn dense(seed: u64) -> Vec<Disc> {
    let mut draw = Draw::new(seed);
    (0..60)
        .map(|_| {
            (
                draw.between(112.0, 162.0),
                draw.between(38.0, 62.0),
                draw.between(0.3, 1.0),
            )
        })
        .collect()
}

fn rank(summary: &PlanSummary) -> (f64, f64) {
    (summary.violation.max(FEASIBLE), summary.cost)
}

fn with_iteration(change: impl FnOnce(&mut PlannerSettings)) -> Settings {
    let flight = Settings::flight();
    let mut changed = flight.planner;
    change(&mut changed);
    with_planner(flight, changed)
}

/// The map of a later cycle of the same place differs in nothing that counts.
const CYCLES_TO_FILL_THE_MAP: usize = 4;

#[test]
fn plans_do_not_drift_when_nothing_changes() {
    for seed in 0..6 {
        let discs = if seed == 0 {
            SCATTERED.to_vec()
        } else {
            dense(seed)
        };
        let mut planner = planner(&Settings::flight());
        let state = level(&planner);
        for _ in 0..CYCLES_TO_FILL_THE_MAP {
            plan(&mut planner, &state, &discs);
        }
        let mut next = || {
            plan(&mut planner, &state, &discs);
            rank(planner.summary())
        };
        // Two plans that are worth the same may take turns: what is not known of the way, and the way on
        // from the via station, have prices too, which the cost does not tell.
        let mut last = [next(), next()];
        for _ in 0..6 {
            let now = next();
            let dearest = last[0].1.max(last[1].1);
            assert!(now.0 <= last[1].0 && now.1 <= dearest * 1.01);
            last = [last[1], now];
        }
    }
}

#[test]
fn the_previous_plan_is_a_candidate_as_long_as_it_lasts() {
    let candidates = |time: f64| {
        let mut planner = planner(&Settings::flight());
        let state = level(&planner);
        plan(&mut planner, &state, &[]);
        planner.begin(time, &state, &Conditions::STILL, &scan(&[], &state));
        while planner.advance() {}
        planner.finish();
        planner.summary().candidates
    };
    // Planned at 3 s for 4.5 s.
    let without = candidates(2.0);
    assert!(without >= 1);
    for (time, more) in [(3.0, 1), (5.25, 1), (7.5, 1), (7.6, 0), (100.0, 0)] {
        assert_eq!(candidates(time), without + more, "at {time} s");
    }
}

#[test]
fn slices_are_bounded_in_dense_fields() {
    let mut most = 0;
    for seed in 0..6 {
        let mut planner = planner(&with_iteration(|p| p.paths = MAX_PATHS));
        let mut state = level(&planner);
        let discs = dense(seed);
        for cycle in 0..4 {
            planner.begin(
                0.25 * f64::from(cycle),
                &state,
                &Conditions::STILL,
                &scan(&discs, &state),
            );
            while planner.advance() {}
            planner.finish();
            let summary = *planner.summary();
            assert!(summary.complete && summary.tree_runs == 1);
            assert!(summary.slices <= MOST_SLICES, "{summary:?}");
            assert!(summary.candidates <= PROGRAMS, "{summary:?}");
            most = most.max(summary.candidates);
            state.x += 3.0;
        }
    }
    assert!(most > 6, "{most} programs: the fields are dense");
}

#[test]
fn starving_gives_the_best_so_far_and_the_next_cycle_is_sound() {
    let discs = dense(1);
    let mut whole = planner(&Settings::flight());
    let state = level(&whole);
    plan(&mut whole, &state, &discs);
    let slices = whole.summary().slices;
    let mut last = (f64::INFINITY, f64::INFINITY);
    let mut offered = 0;
    for budget in 0..=slices {
        let mut starved = planner(&Settings::flight());
        starved.begin(3.0, &state, &Conditions::STILL, &scan(&discs, &state));
        for _ in 0..budget {
            starved.advance();
        }
        let verdict = starved.finish();
        let summary = *starved.summary();
        assert_eq!(summary.complete, budget == slices);
        assert_eq!(verdict == Verdict::Nothing, summary.cost == f64::INFINITY);
        if verdict != Verdict::Nothing {
            offered += 1;
            follows_the_point_mass(starved.best(), &state);
            // Priced by the square of what is missing: the worst of it may grow a little.
            assert!(
                rank(&summary).0 <= last.0 + 0.2,
                "{summary:?} after {last:?}"
            );
            last = rank(&summary);
        } else {
            assert!(offered == 0, "what was offered stays");
        }
    }
    assert!(
        offered > slices / 4 && offered < slices,
        "{offered} of {slices}"
    );
    assert_eq!(rank(whole.summary()), last);
}

/// That a trajectory starts at a state, that its knots and what lies between are a roll-out.
fn follows_the_point_mass(trajectory: &Trajectory, state: &VehicleState) {
    let airframe = &Settings::flight().airframe;
    let knots: [PathState; KNOTS] = trajectory.knots.map(|knot| PathState::of(&knot.state));
    assert!(off(&knots[0], &PathState::of(state)) < 1e-12);
    for stage in 0..STAGES {
        let rise = knots[stage + 1].angle_of_attack - knots[stage].angle_of_attack;
        let control = PathControl {
            angle_of_attack_rate: rise / STAGE_PERIOD,
            thrust: trajectory.knots[stage].feedforward.thrust,
        };
        let end = knots[stage].after(airframe, &control, STAGE_PERIOD, 2);
        assert!(off(&end, &knots[stage + 1]) < 1e-9, "stage {stage}");
        for share in [0.01, 0.3, 0.64, 0.99] {
            let time = trajectory.start + STAGE_PERIOD * (stage as f64 + share);
            let sample = trajectory.sample(time).unwrap();
            let there = knots[stage].after(airframe, &control, share * STAGE_PERIOD, 2);
            assert!(off(&PathState::of(&sample.state), &there) < 1e-9);
            let (_, feedforward) = there.reference(airframe, &control);
            assert!((sample.feedforward.thrust - control.thrust).abs() < 1e-12);
            assert!((sample.feedforward.elevator - feedforward.elevator).abs() < 1e-6);
        }
        // No jump where a stage ends.
        let at = trajectory.start + STAGE_PERIOD * (stage as f64 + 1.0);
        let [before, after] = [-1e-9, 1e-9].map(|aside| trajectory.sample(at + aside).unwrap());
        let jump = off(&PathState::of(&before.state), &PathState::of(&after.state));
        assert!(jump < 1e-6, "{jump} at the end of stage {stage}");
    }
}

/// Largest difference of two states.
fn off(one: &PathState, other: &PathState) -> f64 {
    [
        one.x - other.x,
        one.z - other.z,
        one.airspeed - other.airspeed,
        one.flight_path - other.flight_path,
        one.angle_of_attack - other.angle_of_attack,
    ]
    .into_iter()
    .map(f64::abs)
    .fold(0.0, f64::max)
}

#[test]
fn plans_are_roll_outs_within_what_the_aircraft_can_do() {
    // Rows that cost next to nothing and little thrust: it is the roll-out that holds the limits.
    let eager = with_iteration(|p| {
        let (linear, quadratic) = (1e-3, 1e-3);
        p.penalty = Some(Penalty { linear, quadratic });
        p.iteration = p.iteration.map(|iteration| Iteration {
            thrust_max: 8.0,
            ..iteration
        });
    });
    let (mut planned, mut most) = (0, [0.0_f64; 2]);
    for seed in 0..8 {
        let discs = dense(seed);
        let mut planner = planner(&eager);
        let mut state = level(&planner);
        // Slow, diving, and the nose too high: all that can be had is asked for.
        let share = seed as f64 / 7.0;
        state.z -= 8.0 * share;
        state.air.airspeed -= 6.0 * share;
        state.air.flight_path = -0.5 * share;
        state.air.pitch += 0.4 * share;
        let verdict = plan(&mut planner, &state, &discs);
        if verdict == Verdict::Nothing {
            continue;
        }
        planned += 1;
        follows_the_point_mass(planner.best(), &state);
        let trim = planner.trim().state.angle_of_attack();
        for knot in &planner.best().knots[1..] {
            let alpha = knot.state.air.angle_of_attack() - trim;
            assert!(alpha.abs() <= 1.5 * 0.2 + 0.05 + 1e-9, "{alpha}");
            assert!((0.0..=8.0).contains(&knot.feedforward.thrust));
            most = [
                most[0].max(alpha.abs()),
                most[1].max(knot.feedforward.thrust),
            ];
            if verdict == Verdict::Feasible {
                assert!((knot.state.z - 50.0).abs() <= 10.3 + 1e-5);
            }
        }
    }
    assert!(planned >= 6, "{planned}");
    assert!(most[0] > 0.349 && most[1] > 7.99, "{most:?}");
}

/// The map holds what was seen: a plan around an obstacle that is out of sight by now.
#[test]
fn what_is_out_of_sight_is_still_flown_around() {
    let wall = [(128.0, 50.0, 3.0)];
    let mut planner = planner(&Settings::flight());
    let state = level(&planner);
    plan(&mut planner, &state, &wall);
    let mut blind = scan(&[], &state);
    blind.ranges.clear();
    planner.begin(3.0, &state, &Conditions::STILL, &blind);
    while planner.advance() {}
    assert_eq!(planner.finish(), Verdict::Feasible);
    let nearest = planner
        .best()
        .knots
        .map(|knot| clearance(&wall, knot.state.x, knot.state.z))
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    assert!(nearest > 0.3, "{nearest}");
}

#[test]
fn a_new_set_up_forgets_the_map_and_the_plan_of_a_former_flight() {
    let settings = Settings::flight();
    let cycles = |planner: &mut Planner| {
        let mut state = level(planner);
        let mut plans = Vec::new();
        for _ in 0..3 {
            plan(planner, &state, &SCATTERED);
            plans.push((planner.best().clone(), *planner.summary()));
            state.x += 3.0;
        }
        plans
    };
    let mut used = planner(&settings);
    let mut state = level(&used);
    for seed in 0..3 {
        plan(&mut used, &state, &dense(seed));
        // Not so far that the next flight starts behind the window, which lays the map anew.
        state.x += 2.0;
    }
    // As if the flight had ended in the middle of a cycle.
    used.begin(9.0, &state, &Conditions::STILL, &scan(&dense(4), &state));
    for _ in 0..30 {
        used.advance();
    }
    let remembering = cycles(&mut used.clone());
    used.set_up(&settings).unwrap();
    let fresh = cycles(&mut planner(&settings));
    assert_eq!(cycles(&mut used), fresh);
    assert_ne!(remembering, fresh, "there was something to forget");
}

#[test]
fn an_iteration_that_cannot_be_flown_is_refused() {
    let iteration = Settings::flight().planner.iteration.unwrap();
    let mut planner = Box::new(Planner::new());
    let mut refused = |settings: Settings| planner.set_up(&settings);
    for settings in presets() {
        assert_eq!(refused(settings), Ok(()));
    }
    let lacking: [fn(&mut PlannerSettings); 2] = [|p| p.penalty = None, |p| p.attitude = None];
    for lack in lacking {
        assert_eq!(refused(with_iteration(lack)), Err(SetupError::Number));
    }
    let fields: [fn(&mut Iteration) -> &mut f64; 3] =
        [|i| &mut i.margin, |i| &mut i.band, |i| &mut i.thrust_max];
    for field in fields {
        for number in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut broken = iteration;
            *field(&mut broken) = number;
            let settings = with_iteration(|p| p.iteration = Some(broken));
            assert_eq!(refused(settings), Err(SetupError::Number), "{broken:?}");
        }
    }
}
