//! Tests the flight loop with an aircraft that lifts more or less than the core was told.

use crate::common::motion::after_tick;
use crate::common::sensors::frame;
use crate::common::world::scan;
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::LiftEstimator;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::Planner;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{
    ActuatorLimits, AirState, Airframe, Conditions, Control, Trim, VehicleState, air_rate,
};
use proptest::prelude::*;

const KNOWN: Airframe = Airframe::REFERENCE;

/// Shows the estimator the climb rates of an aircraft at level trim that has this much more lift: `a t`.
fn climb_at(estimator: &mut LiftEstimator, lift: f64, ticks: std::ops::Range<u32>) {
    let trim = Trim::at_speed(&KNOWN, 12.0, 0.0).unwrap();
    let pressure_area = 0.5 * KNOWN.air_density * 144.0 * KNOWN.wing_area;
    let acceleration = pressure_area * lift / KNOWN.mass;
    for tick in ticks {
        let time = f64::from(tick) * TICK_PERIOD;
        estimator.update(TICK_PERIOD, acceleration * time, &trim.state, trim.control);
    }
}

proptest! {
    #[test]
    fn lift_beyond_the_airframe_s_is_found_from_climb_rates(lift in -0.35..0.35) {
        let mut estimator = LiftEstimator::new(&KNOWN, 12.0);
        climb_at(&mut estimator, lift, 0..200);
        let early = estimator.offset() / lift;
        climb_at(&mut estimator, lift, 200..4000);
        let late = estimator.offset() / lift;
        prop_assert!((0.6..0.8).contains(&early), "after 2 s {early}");
        prop_assert!((late - 1.0).abs() < 0.02, "after 40 s {late}");
    }

    /// A time that is none, and a value that is no number, teach nothing. Without airspeed there is no lift.
    #[test]
    fn a_wrong_climb_rate_is_no_lift(
        climb in prop_oneof![Just(f64::NAN), Just(f64::INFINITY)],
        period in prop_oneof![Just(0.0), Just(-0.01), Just(f64::NAN)],
    ) {
        let trim = Trim::at_speed(&KNOWN, 12.0, 0.0).unwrap();
        let mut estimator = LiftEstimator::new(&KNOWN, 12.0);
        climb_at(&mut estimator, 0.1, 0..200);
        let before = estimator.offset();
        let stalled = AirState { airspeed: 0.0, ..trim.state };
        for (period, climb, air) in [
            (TICK_PERIOD, climb, trim.state),
            (period, 0.0, trim.state),
            (TICK_PERIOD, 0.0, stalled),
        ] {
            let mut other = estimator.clone();
            other.update(period, climb, &air, trim.control);
            prop_assert!((other.offset() - before).abs() < 1e-15);
        }
    }

    /// The noise of the climb rate averages out, however large its differences are: the sum of the
    /// differences is the difference between last and first.
    #[test]
    fn a_leap_of_the_climb_rate_and_back_averages_out(leap in -5.0..5.0) {
        let trim = Trim::at_speed(&KNOWN, 12.0, 0.0).unwrap();
        let mut estimator = LiftEstimator::new(&KNOWN, 12.0);
        climb_at(&mut estimator, 0.0, 0..300);
        estimator.update(TICK_PERIOD, leap, &trim.state, trim.control);
        estimator.update(TICK_PERIOD, 0.0, &trim.state, trim.control);
        prop_assert!(estimator.offset().abs() < 2e-3, "{}", estimator.offset());
    }

    /// However wrong the climb rates are, no plan has to use a lift offset beyond the limit.
    #[test]
    fn the_offset_stays_within_what_is_believed(rates in prop::collection::vec(-20.0..20.0, 1..300)) {
        let trim = Trim::at_speed(&KNOWN, 12.0, 0.0).unwrap();
        let mut estimator = LiftEstimator::new(&KNOWN, 12.0);
        for rate in rates {
            let control = Control { elevator: -20.0, ..trim.control };
            estimator.update(TICK_PERIOD, rate, &trim.state, control);
            prop_assert!(estimator.offset().abs() <= 0.4);
        }
    }

    #[test]
    fn flight_at_an_angle_of_attack_is_that_at_its_airspeed(airspeed in 9.0..20.0) {
        let by_speed = Trim::at_speed(&KNOWN, airspeed, 0.0).unwrap();
        let alpha = by_speed.state.angle_of_attack();
        let by_angle = Trim::at_angle_of_attack(&KNOWN, alpha).unwrap();
        prop_assert!((by_angle.state.airspeed - airspeed).abs() < 1e-9);
        prop_assert!((by_angle.control.thrust - by_speed.control.thrust).abs() < 1e-9);
        prop_assert!((KNOWN.angle_of_attack_for(by_angle.control.elevator) - alpha).abs() < 1e-12);
    }
}

#[test]
fn no_level_flight_exists_where_the_wing_does_not_carry() {
    assert!(Trim::at_angle_of_attack(&KNOWN, -0.3).is_err());
    assert!(Trim::at_angle_of_attack(&KNOWN, f64::NAN).is_err());
}

/// With errors of a tenth in mass, lift slope and pitch stiffness at their worst, an elevator of
/// trim +-2 holds level flight at 12 m/s only at its stop, if at all.
#[test]
fn a_wrong_airframe_cruises_with_the_elevator_near_its_trim() {
    for factor in [1.0, -1.0] {
        let truth = Airframe {
            mass: KNOWN.mass * (1.0 + 0.1 * factor),
            lift_alpha: KNOWN.lift_alpha * (1.0 - 0.1 * factor),
            moment_alpha: KNOWN.moment_alpha * (1.0 + 0.1 * factor),
            ..KNOWN
        };
        let settings = Settings {
            actuators: ActuatorLimits {
                elevator_below: Some(2.0),
                elevator_above: Some(2.0),
                ..ActuatorLimits::NONE
            },
            ..Settings::flight()
        };
        let trim = settings.cruise.trim(&KNOWN).unwrap();
        let needed = Trim::at_speed(&truth, 12.0, 0.0).unwrap().control.elevator;
        assert!(factor * (needed - trim.control.elevator) > 1.5, "{needed}");

        let (mean, end) = cruise(&settings, &truth);
        let off = (mean - trim.control.elevator).abs();
        assert!(off < 0.5 * (needed - trim.control.elevator).abs(), "{mean}");
        // With a low terminal weight the plan returns to the altitude slowly.
        assert!((end.z - 50.0).abs() < 2.5, "{end:?}");
        assert!(factor * (end.air.airspeed - 12.0) > 0.5, "{end:?}");
    }
}

/// Flies an aircraft without obstacles for 20 s. Returns the mean elevator of the last 5 s, and the
/// state at the end.
fn cruise(settings: &Settings, truth: &Airframe) -> (f64, VehicleState) {
    let mut planner = Box::new(Planner::new());
    planner.set_up(settings).unwrap();
    let mut flight = FlightLoop::new(settings).unwrap();
    let mut state = VehicleState {
        x: 0.0,
        z: 50.0,
        air: planner.trim().state,
    };
    let mut sum = 0.0;
    for tick in 0..2000 {
        let time = f64::from(tick) * TICK_PERIOD;
        let control = flight.step(time, &frame(&state)).control;
        if tick % 25 == 0 {
            let conditions = flight.conditions();
            planner.begin(time, &flight.state(), &conditions, &scan(&[], &state));
            while planner.advance() {}
            let verdict = planner.finish();
            flight.adopt(time, verdict, planner.best());
        }
        if tick >= 1500 {
            sum += control.elevator / 500.0;
        }
        state = after_tick(truth, &state, control);
    }
    (sum, state)
}

/// Thrust answers an airspeed below the trajectory's. No other preset does so.
#[test]
fn thrust_holds_the_airspeed_of_the_trajectory() {
    for (settings, more) in [(Settings::flight(), true), (Settings::paper(), false)] {
        let trim = settings.cruise.trim(&settings.airframe).unwrap();
        let mut flight = FlightLoop::new(&settings).unwrap();
        let slow = VehicleState {
            x: 0.0,
            z: 50.0,
            air: AirState {
                airspeed: trim.state.airspeed - 1.0,
                ..trim.state
            },
        };
        let step = flight.step(0.0, &frame(&slow));
        assert_eq!(step.control.thrust > trim.control.thrust, more);
    }
}

#[test]
fn still_air_changes_no_airframe() {
    assert_eq!(Conditions::STILL.airframe(&KNOWN), KNOWN);
}

/// The STOL transport of Nelson's table B, whose turn damps the pitch as much as its stiffness does.
const DAMPED: Airframe = Airframe {
    mass: 18143.7,
    pitch_inertia: 291_501.0,
    wing_area: 87.7934,
    moment_length: 3.07848,
    air_density: 1.225,
    lift_zero: 1.5,
    lift_alpha: 5.24,
    lift_alpha_rate: 0.043,
    lift_pitch_rate: 0.2535,
    lift_elevator: 0.0081,
    drag_zero: 0.0891,
    drag_induced: 0.0426,
    moment_zero: 0.0,
    moment_alpha: -0.78,
    moment_alpha_rate: -0.196,
    moment_pitch_rate: -1.152,
    moment_elevator: -0.037,
};

/// An autopilot's pitch loop of 7 rad/s with a damping of 0.84.
const LOOP: Airframe = Airframe {
    moment_zero: 0.0,
    moment_alpha: -0.379,
    moment_alpha_rate: 0.0,
    moment_pitch_rate: -0.091,
    moment_elevator: 0.379,
    ..KNOWN
};

/// The aircraft flies as it is known, up and down under its elevator. Errors are shares of the lift of level flight.
#[test]
fn the_damping_of_a_turn_is_no_lack_of_lift() {
    for (known, cruise, deflection, most) in
        [(DAMPED, 47.5488, -3.0, 0.035), (LOOP, 12.0, 0.1, 0.035)]
    {
        let trim = Trim::at_speed(&known, cruise, 0.0).unwrap();
        let mut estimator = LiftEstimator::new(&known, cruise);
        let mut air = trim.state;
        let mut worst = 0.0_f64;
        for tick in 0..800 {
            let side = if tick / 200 % 2 == 0 { 1.0 } else { -1.0 };
            let control = Control {
                elevator: trim.control.elevator + side * deflection,
                ..trim.control
            };
            let climb = air.airspeed * libm::sin(air.flight_path);
            estimator.update(TICK_PERIOD, climb, &air, control);
            let rate = air_rate(&known, &air, control).to_vector();
            air = AirState::from_vector(&(air.to_vector() + rate * TICK_PERIOD));
            worst = worst.max(estimator.observed().abs() / known.level_lift(cruise));
        }
        assert!(worst < most, "{worst} at {cruise} m/s");
    }
}
