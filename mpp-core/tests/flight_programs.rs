//! Tests what the programs of preset `flight` know of the aircraft: the lag of its motor, and the ends of motor and
//! elevator.

use crate::common::planning::{level, plan, planner};
use crate::common::world::scan;
use mpp_core::config::STAGE_PERIOD;
use mpp_core::qp::{Condensed, RowKind, Solution, Solver, Status};
use mpp_core::settings::Settings;
use mpp_core::vehicle::Conditions;

/// The states of a program are `(x, z, v, theta, thrust, gamma)`.
#[test]
fn programs_know_path_and_thrust() {
    let mut settings = Settings::flight();
    settings.actuators.thrust_lag = Some(STAGE_PERIOD);
    let mut planner = planner(&settings);
    let state = level(&planner);
    let scan = scan(&[(125.0, 50.5, 1.0)], &state);
    planner.begin(0.0, &state, &Conditions::STILL, &scan);
    let remains = libm::exp(-1.0);
    let mut seen = 0;
    while planner.advance() {
        let Some((_, problem)) = planner.candidate() else {
            continue;
        };
        assert!(problem.initial[4].abs() + problem.target[4].abs() == 0.0);
        for stage in planner.plane().unwrap().stages().unwrap() {
            let (a, b) = (stage.a(), stage.b);
            // Nothing but its command changes the thrust.
            assert!((a[(4, 4)] - remains).abs() < 1e-12);
            assert!((a.row(4).sum() - a[(4, 4)]).abs() + b[(4, 0)].abs() == 0.0);
            // A command of 1 N for long gives a thrust of 1 N, and any thrust accelerates.
            let gain = b[(4, 1)] / (1.0 - remains);
            assert!((a[(2, 4)] * gain).abs() > 0.0 && b[(2, 1)] > 0.0);
            let (by_given, by_command) = (a[(2, 4)] * gain, b[(2, 1)]);
            let in_mean = 1.0 - remains;
            assert!((by_given / (by_given + by_command) - in_mean).abs() < 1e-9);
            // A path that points up climbs.
            assert!(a[(1, 5)] > 0.0);
        }
        seen += 1;
    }
    assert!(seen > 3);
}

/// The greatest thrust above trim in the solutions of all programs of a cycle \[N\], and the greatest excess of their angle
/// of attack over its upper limit \[rad\].
fn asked_at_most(settings: &Settings) -> (f64, f64) {
    let mut planner = planner(settings);
    let state = level(&planner);
    let discs = [(113.0, 50.3, 4.0)];
    // The second cycle has the plan of the first one as a candidate, too.
    plan(&mut planner, &state, &discs);
    planner.begin(3.5, &state, &Conditions::STILL, &scan(&discs, &state));
    let (mut shared, mut solver) = (Box::new(Condensed::new()), Box::new(Solver::new()));
    let mut solution = Solution::new();
    let (mut thrust, mut excess): (f64, f64) = (0.0, 0.0);
    while planner.advance() {
        let Some((_, problem)) = planner.candidate() else {
            continue;
        };
        let stages = planner.plane().unwrap().stages().unwrap();
        shared
            .condense_varying(&settings.planner.weights, |own| *own = *stages)
            .unwrap();
        if solver.solve(&shared, &problem) != Status::Optimal {
            continue;
        }
        solver.solution(&shared, &mut solution);
        let rows = problem.bounds.0.iter().enumerate();
        let up = rows.filter(|(row, _)| matches!(RowKind::of(*row), RowKind::Attitude(_, 0)));
        for (state, (_, bound)) in solution.states.iter().skip(1).zip(up) {
            // Angles of programs are in tenths of a radian.
            excess = excess.max(0.1 * (state[3] - state[5] - bound));
        }
        let asked = solution.controls.iter().map(|[_, thrust]| *thrust);
        thrust = asked.fold(thrust, f64::max);
    }
    (thrust, excess)
}

#[test]
fn programs_end_where_motor_and_elevator_end() {
    let free = Settings::flight();
    let mut limited = free;
    limited.actuators.thrust_max = Some(15.0);
    limited.actuators.elevator_below = Some(2.0);
    limited.actuators.elevator_above = Some(2.0);
    let rise = 15.0 - planner(&free).trim().control.thrust;
    let (thrust, excess) = asked_at_most(&free);
    assert!(thrust > rise + 0.5 && excess > 1e-3, "{thrust} {excess}");
    let (thrust, excess) = asked_at_most(&limited);
    assert!((thrust - rise).abs() < 1e-6, "{thrust} of {rise}");
    assert!(excess < 1e-6, "{excess}");
}
