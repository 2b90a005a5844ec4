//! Tests that plans allow for a thrust that lags behind its command.

use crate::common::dense::dense;
use crate::common::planning::{level, plan, planner};
use crate::common::world::scan;
use mpp_core::config::{STAGE_PERIOD, STAGES};
use mpp_core::planner::{Planner, Verdict};
use mpp_core::settings::Settings;
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{
    ActuatorLimits, Conditions, Control, PathControl, PathState, ThrustLag, VehicleState,
};
use proptest::prelude::*;

/// Period of the integration that the plans are compared with \[s\].
const STEP: f64 = 1e-3;
const STEPS: usize = 250;

/// A motor as that of `docs/scenarios/actuators.toml`, but slower.
const MOTOR: ActuatorLimits = ActuatorLimits {
    thrust_max: Some(15.0),
    thrust_lag: Some(0.3),
    ..ActuatorLimits::NONE
};

fn thrust(thrust: f64) -> Control {
    Control {
        thrust,
        elevator: 0.0,
    }
}

proptest! {
    /// The thrust of a stage is what the actuators give tick for tick.
    #[test]
    fn a_stage_is_that_of_the_actuators(lag in 0.02..5.0, given in 0.0..20.0, command in 0.0..20.0) {
        let actuators = ActuatorLimits { thrust_lag: Some(lag), ..ActuatorLimits::NONE };
        let stage = ThrustLag::new(&actuators, STAGE_PERIOD);
        let mean = stage.mean(given, command);
        let (mut now, mut sum) = (thrust(given), 0.0);
        for step in 0..STEPS {
            let share = step as f64 / STEPS as f64;
            prop_assert!((stage.within(share, mean, command) - now.thrust).abs() < 1e-9);
            let next = actuators.given(thrust(command), now, STEP);
            sum += 0.5 * (now.thrust + next.thrust);
            now = next;
        }
        prop_assert!((stage.end(given, command) - now.thrust).abs() < 1e-9);
        // The sum of trapezia errs by (step / lag)^2 / 12.
        prop_assert!((mean - sum / STEPS as f64).abs() < 1e-2);
        // A program relies on both being linear in both.
        let by = |stage: &dyn Fn(f64, f64) -> f64| stage(1.0, 0.0) * given + stage(0.0, 1.0) * command;
        prop_assert!((by(&|g, c| stage.end(g, c)) - stage.end(given, command)).abs() < 1e-9);
        prop_assert!((by(&|g, c| stage.mean(g, c)) - mean).abs() < 1e-9);
    }
}

#[test]
fn without_a_lag_the_command_acts_at_once() {
    let none = ThrustLag::new(&ActuatorLimits::NONE, STAGE_PERIOD);
    assert_eq!(none, ThrustLag::NONE);
    for value in [
        none.end(3.0, 8.0),
        none.mean(3.0, 8.0),
        none.within(0.0, 8.0, 8.0),
        none.within(1.0, 8.0, 8.0),
    ] {
        assert!((value - 8.0).abs() < 1e-12);
    }
}

/// Flies the commands of a plan with this motor in small steps. Gives the greatest errors of the plan's airspeed [m/s] and
/// height \[m\] at the stage boundaries.
fn errors(plan: &Trajectory, motor: &ActuatorLimits, start: f64) -> (f64, f64) {
    let airframe = Settings::flight().airframe.balanced();
    let mut state = PathState::of(&plan.knots[0].state);
    let mut given = thrust(start);
    let (mut speed, mut height) = (0.0_f64, 0.0_f64);
    for pair in plan.knots.windows(2) {
        let [from, to] = pair else { continue };
        let rise = to.state.air.angle_of_attack() - from.state.air.angle_of_attack();
        for _ in 0..STEPS {
            let before = given.thrust;
            given = motor.given(from.feedforward, given, STEP);
            let control = PathControl {
                angle_of_attack_rate: rise / STAGE_PERIOD,
                thrust: 0.5 * (before + given.thrust),
            };
            state = state.after(&airframe, &control, STEP, 1);
        }
        speed = speed.max((state.airspeed - to.state.air.airspeed).abs());
        height = height.max((state.z - to.state.z).abs());
    }
    (speed, height)
}

fn replan(
    planner: &mut Planner,
    time: f64,
    state: &VehicleState,
    discs: &[(f64, f64, f64)],
) -> bool {
    planner.begin(time, state, &Conditions::STILL, &scan(discs, state));
    while planner.advance() {}
    planner.finish() != Verdict::Nothing
}

#[test]
fn the_aircraft_flies_the_plan_with_the_lag_of_its_motor() {
    let mut settings = Settings::flight();
    settings.actuators = MOTOR;
    let (mut worst, mut if_at_once) = ((0.0_f64, 0.0_f64), 0.0_f64);
    for seed in 1..12 {
        let mut planner = planner(&settings);
        let discs = dense(seed);
        let mut state = level(&planner);
        let mut given = planner.trim().control.thrust;
        // Each plan continues with the thrust that the last one has at that time.
        for cycle in 0..4 {
            let time = 0.5 * f64::from(cycle);
            assert!(replan(&mut planner, time, &state, &discs));
            let plan = planner.best();
            assert!(
                (plan.thrust(time).unwrap() - given).abs() < 1e-6,
                "seed {seed}"
            );
            let (speed, height) = errors(plan, &MOTOR, given);
            worst = (worst.0.max(speed), worst.1.max(height));
            if_at_once = if_at_once.max(errors(plan, &ActuatorLimits::NONE, given).0);
            let next = time + 0.5;
            state = plan.sample(next).unwrap().state;
            given = plan.thrust(next).unwrap();
        }
    }
    // The plan's stages have the mean thrust.
    assert!(worst.0 < 0.03 && worst.1 < 0.03, "{worst:?}");
    assert!(
        if_at_once > 0.3,
        "{if_at_once}: the plans hardly use the motor"
    );
}

#[test]
fn a_plan_has_a_thrust_as_long_as_it_lasts() {
    let mut settings = Settings::flight();
    settings.actuators = MOTOR;
    let mut planner = planner(&settings);
    let state = level(&planner);
    assert_ne!(plan(&mut planner, &state, &dense(3)), Verdict::Nothing);
    let best = planner.best();
    let (start, end) = (best.start, best.start + STAGES as f64 * STAGE_PERIOD);
    assert!(best.thrust(start).is_some() && best.thrust(end).is_some());
    assert!(best.thrust(start - 0.1).is_none() && best.thrust(end + 0.1).is_none());
    assert!(Trajectory::new().thrust(0.0).is_none());
}
