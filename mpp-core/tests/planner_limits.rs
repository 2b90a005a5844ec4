//! The limits of a plan: where it may start, and what the elevator's rate allows.

use crate::common::dense::dense;
use crate::common::planning::{level, plan, planner};
use crate::common::world::scan;
use mpp_core::config::STAGE_PERIOD;
use mpp_core::planner::Verdict;
use mpp_core::settings::Settings;
use mpp_core::vehicle::Conditions;

/// A plan starts where the step takes it over: on the last plan, with the present distance from it. The scan
/// keeps the place where it was made.
#[test]
fn a_plan_starts_where_it_is_taken_over() {
    let mut latent = Settings::flight();
    latent.planner.plane_mut().unwrap().latency = 0.3;
    let wall = [(128.0, 50.0, 3.0)];
    let mut planner = planner(&latent);
    let state = level(&planner);
    plan(&mut planner, &state, &wall);
    // Without a plan the aircraft flies on.
    let first = planner.best().clone();
    assert!((first.start - 3.3).abs() < 1e-12);
    assert!((first.knots[0].state.x - state.x - 0.3 * state.air.airspeed).abs() < 0.01);
    assert!((first.knots[0].state.z - state.z).abs() < 0.01);
    let field = planner.plane().unwrap().clearance();
    assert!(field.is_occupied(125.1, 50.2) && !field.is_occupied(121.0, 50.2));

    // One second later it is beside its plan.
    let mut beside = first.sample(4.3).unwrap().state;
    beside.z += 0.5;
    beside.air.airspeed -= 0.2;
    planner.begin(4.3, &beside, &Conditions::STILL, &scan(&wall, &beside));
    while planner.advance() {}
    planner.finish();
    let (then, start) = (
        first.sample(4.6).unwrap().state,
        planner.best().knots[0].state,
    );
    assert!((planner.best().start - 4.6).abs() < 1e-12);
    assert!((start.x - then.x).abs() < 1e-9 && (start.z - then.z - 0.5).abs() < 1e-9);
    assert!((start.air.airspeed - then.air.airspeed + 0.2).abs() < 1e-9);
}

/// An elevator with a rate turns no faster than it, and no farther than it reaches in a short time.
#[test]
fn plans_keep_to_the_elevators_rate() {
    let mut settings = Settings::flight();
    settings.actuators.elevator_rate = Some(20.0);
    let a = settings.airframe;
    let rate = 20.0 * (a.moment_elevator / a.moment_alpha).abs();
    let mut fastest = 0.0_f64;
    for seed in 0..6 {
        let mut planner = planner(&settings);
        let state = level(&planner);
        if plan(&mut planner, &state, &dense(seed)) == Verdict::Nothing {
            continue;
        }
        let trim = planner.trim().state.angle_of_attack();
        for pair in planner.best().knots.windows(2) {
            let [from, to] = [&pair[0], &pair[1]].map(|knot| knot.state.air.angle_of_attack());
            let turned = (to - from).abs() / STAGE_PERIOD;
            assert!(turned <= 0.9 * rate + 1e-9, "{turned} rad/s");
            assert!((to - trim).abs() <= 0.15 * rate + 1e-9);
            fastest = fastest.max(turned);
        }
    }
    assert!(
        fastest > 0.5 * rate,
        "the limit was met: {fastest} of {rate}"
    );
}

/// A plan that starts later returns to the same altitude: its program counts heights from where it starts.
#[test]
fn a_late_plan_returns_to_the_altitude() {
    let end = |latency: f64| {
        let mut settings = Settings::flight();
        settings.planner.plane_mut().unwrap().latency = latency;
        let mut planner = planner(&settings);
        let mut state = level(&planner);
        state.air.flight_path = 0.3;
        state.air.pitch += 0.3;
        state.z -= 1.8;
        plan(&mut planner, &state, &[]);
        planner.best().knots.last().unwrap().state.z
    };
    let (now, late) = (end(0.0), end(0.5));
    assert!(
        (now - 50.0).abs() < 0.5 && (late - 50.0).abs() < 0.5,
        "{now}, {late}"
    );
}

/// An aircraft whose angle of attack is beyond the limit of plans comes back no faster than its elevator turns.
#[test]
fn plans_come_back_within_the_elevators_rate() {
    let mut settings = Settings::flight();
    settings.actuators.elevator_rate = Some(20.0);
    let a = settings.airframe;
    let rate = 0.9 * 20.0 * (a.moment_elevator / a.moment_alpha).abs();
    let mut planner = planner(&settings);
    let mut state = level(&planner);
    state.air.pitch += 0.25;
    plan(&mut planner, &state, &[]);
    let knots = &planner.best().knots;
    let [from, to] = [&knots[0], &knots[1]].map(|knot| knot.state.air.angle_of_attack());
    assert!(
        (to - from).abs() / STAGE_PERIOD <= rate + 1e-9,
        "{from} to {to}"
    );
}
