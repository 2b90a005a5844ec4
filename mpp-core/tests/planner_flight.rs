//! Tests the cycle of preset `flight`: what it keeps from the cycle before, its bound, and what it
//! hands over.

use crate::common::dense::dense;
use crate::common::planning::{FEASIBLE, SCATTERED, level, plan, planner};
use crate::common::world::{clearance, scan};
use mpp_core::config::{KNOTS, MAX_PATHS, STAGE_PERIOD, STAGES};
use mpp_core::lattice::{MAX_LATTICE_PATHS, STATIONS};
use mpp_core::planner::{PlanSummary, Planner, Verdict};
use mpp_core::qp::{MAX_ITERATIONS, Penalty};
use mpp_core::settings::{PlaneSettings, Settings};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{Conditions, PathControl, PathState, VehicleState};

/// The previous plan and the lattice's paths.
const CANDIDATES: usize = 1 + MAX_LATTICE_PATHS;
/// Each candidate once, then two further rounds for the best two.
const PROGRAMS: usize = CANDIDATES + 2 * 2;
/// One slice for the map, the stations, and for each program its faces, its set-up, its
/// solution at 8 steps a slice and the search for the next candidate.
const MOST_SLICES: usize = 1 + STATIONS + PROGRAMS * (MAX_ITERATIONS / 8 + 4);

fn rank(summary: &PlanSummary) -> (f64, f64) {
    (summary.violation.max(FEASIBLE), summary.cost)
}

fn with_own(change: impl FnOnce(&mut PlaneSettings)) -> Settings {
    let mut settings = Settings::flight();
    change(settings.planner.plane_mut().unwrap());
    settings
}

/// Number of cycles after which the map of the same place no longer differs in anything that
/// counts.
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
        // Two plans of equal worth may take turns. The unknown parts of the way, and the way on
        // from the via station, have prices too, which the cost does not show.
        let mut last = [next(), next()];
        for _ in 0..6 {
            let now = next();
            let dearest = last[0].1.max(last[1].1);
            // A plan that is improved again may move by far less than a millimetre.
            let most = last[0].0.max(last[1].0) + 1e-3;
            assert!(now.0 <= most && now.1 <= dearest * 1.01);
            last = [last[1], now];
        }
    }
}

#[test]
fn the_parts_of_a_price_add_up_to_the_price_that_the_planner_ranks_by() {
    let mut planner = planner(&Settings::flight());
    let state = level(&planner);
    let discs = [(125.0, 50.5, 1.0), (138.0, 47.0, 1.0)];
    planner.begin(3.0, &state, &Conditions::STILL, &scan(&discs, &state));
    let (mut least, mut effort, mut priced) = (f64::INFINITY, f64::NAN, 0);
    while planner.advance() {
        let own = planner.plane().unwrap();
        let Some((price, parts)) = own.price_parts(own.at_hand()) else {
            continue;
        };
        let sum = parts.clearance + parts.unknown + parts.cost_to_go + parts.effort;
        assert!((sum - price).abs() < 1e-9 * price, "{parts:?} of {price}");
        if price < least {
            (least, effort) = (price, parts.effort);
        }
        priced += 1;
    }
    assert!(priced > 3);
    let own = planner.plane().unwrap();
    assert_eq!(own.price().to_bits(), least.to_bits());
    assert_eq!(planner.summary().cost.to_bits(), effort.to_bits());
    assert!(own.price_parts(own.offers()).is_none());
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
    // The plan is made at 3 s for 4.5 s.
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
        let mut settings = Settings::flight();
        settings.planner.paths = MAX_PATHS;
        let mut planner = planner(&settings);
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
            assert!(summary.complete);
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
        if matches!(verdict, Verdict::Feasible | Verdict::LeastViolating) {
            offered += 1;
            follows_the_point_mass(starved.best(), &state);
            // The price is the square of the violation, so the worst violation may grow a little.
            assert!(
                rank(&summary).0 <= last.0 + 0.2,
                "{summary:?} after {last:?}"
            );
            last = rank(&summary);
        } else {
            assert!(offered == 0, "what was offered stays");
            follows_the_point_mass(starved.best(), &state);
        }
    }
    assert!(
        offered > slices / 4 && offered < slices,
        "{offered} of {slices}"
    );
    assert_eq!(rank(whole.summary()), last);
}

/// Checks that a trajectory starts at a state, and that its knots and the states in between are a
/// roll-out.
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
        let end = knots[stage].after(airframe, &control, STAGE_PERIOD, 1);
        assert!(off(&end, &knots[stage + 1]) < 1e-9, "stage {stage}");
        for share in [0.01, 0.3, 0.64, 0.99] {
            let time = trajectory.start + STAGE_PERIOD * (stage as f64 + share);
            let sample = trajectory.sample(time).unwrap();
            let there = knots[stage].after(airframe, &control, share * STAGE_PERIOD, 1);
            assert!(off(&PathState::of(&sample.state), &there) < 1e-9);
            let (_, feedforward) = there.reference(airframe, &control);
            assert!((sample.feedforward.thrust - control.thrust).abs() < 1e-12);
            assert!((sample.feedforward.elevator - feedforward.elevator).abs() < 1e-6);
        }
        // There is no jump where a stage ends.
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
    // Rows cost next to nothing, and there is little thrust: only the roll-out holds the limits.
    let eager = with_own(|own| {
        let (linear, quadratic) = (1e-3, 1e-3);
        own.penalty = Penalty { linear, quadratic };
        own.thrust_max = 8.0;
    });
    let (mut planned, mut most) = (0, [0.0_f64; 2]);
    for seed in 0..8 {
        let discs = dense(seed);
        let mut planner = planner(&eager);
        let mut state = level(&planner);
        // The aircraft is slow and dives with its nose too high, so the plan asks for all that the
        // limits allow.
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

/// The map keeps what was seen: the plan leads around an obstacle that is out of sight by now.
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
        // The step is small, so that the next flight does not start behind the window. That would
        // lay the map again.
        state.x += 2.0;
    }
    // This is as if the flight had ended in the middle of a cycle.
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
