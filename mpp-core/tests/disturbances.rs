//! Tests moving air and limited actuators, in the flight loop and in plans.

use crate::common::sensors::frame;
use crate::common::world::scan;
use mpp_core::config::{STAGE_PERIOD, TICK_PERIOD};
use mpp_core::estimate::Ekf;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::{Planner, SetupError, Verdict};
use mpp_core::sense::Measurement;
use mpp_core::settings::{Setting, Settings};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{
    ActuatorLimits, AirState, Airframe, Conditions, Control, Trim, VehicleState, Wind,
};
use proptest::prelude::*;

const TRIM: Control = Control {
    thrust: 4.0,
    elevator: 3.75,
};

fn some_limits() -> impl Strategy<Value = ActuatorLimits> {
    let limit = |most: f64| prop::option::of(0.01..most);
    (limit(30.0), limit(1.0), limit(5.0), limit(50.0)).prop_map(
        |(thrust_max, thrust_lag, elevator_range, elevator_rate)| ActuatorLimits {
            thrust_max,
            thrust_lag,
            elevator_below: elevator_range,
            elevator_above: elevator_range,
            elevator_rate,
            ..ActuatorLimits::NONE
        },
    )
}

fn some_control() -> impl Strategy<Value = Control> {
    (-50.0..50.0, -50.0..50.0).prop_map(|(thrust, elevator)| Control { thrust, elevator })
}

proptest! {
    /// Rates hold from any position of the elevator. The range holds where it was kept before.
    #[test]
    fn commands_keep_every_limit_and_those_that_do_stay(
        limits in some_limits(), commands in prop::collection::vec(some_control(), 1..40),
    ) {
        let mut last = TRIM;
        for command in commands {
            let within = limits.within(command, TRIM, last, TICK_PERIOD);
            prop_assert!(within.thrust >= 0.0);
            prop_assert!(limits.thrust_max.is_none_or(|most| within.thrust <= most));
            let off = (within.elevator - TRIM.elevator).abs();
            prop_assert!(limits.elevator_above.is_none_or(|range| off <= range + 1e-12));
            let moved = (within.elevator - last.elevator).abs();
            prop_assert!(limits.elevator_rate.is_none_or(|rate| moved <= rate * TICK_PERIOD + 1e-12));
            prop_assert_eq!(limits.within(within, TRIM, last, TICK_PERIOD), within);
            let given = limits.given(within, last, TICK_PERIOD);
            let (low, high) = (last.thrust.min(within.thrust), last.thrust.max(within.thrust));
            prop_assert!((low..=high).contains(&given.thrust));
            if limits.thrust_lag.is_none() {
                prop_assert_eq!(given, within);
            }
            last = given;
        }
    }
}

fn plan_in(settings: &Settings, wind: &Wind, discs: &[(f64, f64, f64)]) -> Box<Planner> {
    let mut planner = Box::new(Planner::new());
    planner.set_up(settings).unwrap();
    let air = planner.trim().state;
    let state = VehicleState {
        x: 100.0,
        z: 50.0,
        air,
    };
    let conditions = Conditions {
        wind: *wind,
        ..Conditions::STILL
    };
    planner.begin(3.0, &state, &conditions, &scan(discs, &state));
    while planner.advance() {}
    assert_ne!(planner.finish(), Verdict::Nothing);
    planner
}

/// A plan is a motion over ground. Between its knots the aircraft moves as it does through the air,
/// and with the wind.
#[test]
fn a_plan_moves_with_the_wind() {
    for wind in [Wind { x: 0.0, z: 0.8 }, Wind { x: -2.0, z: -1.0 }] {
        let planner = plan_in(&Settings::flight(), &wind, &[(130.0, 50.0, 1.0)]);
        let plan = planner.best();
        for pair in plan.knots.windows(2) {
            let [from, to] = pair else { continue };
            // Simpson's rule is applied to samples in between.
            let at = |share: f64| {
                let stage = plan.knots.iter().position(|knot| knot == from).unwrap_or(0);
                let time = plan.start + STAGE_PERIOD * (stage as f64 + share);
                plan.sample(time)
                    .map(|reference| wind.ground_velocity(&reference.state.air))
                    .unwrap()
            };
            let (start, middle, end) = (
                wind.ground_velocity(&from.state.air),
                at(0.5),
                wind.ground_velocity(&to.state.air),
            );
            let mean = |a: f64, b: f64, c: f64| STAGE_PERIOD * (a + 4.0 * b + c) / 6.0;
            let x = to.state.x - from.state.x - mean(start.0, middle.0, end.0);
            let z = to.state.z - from.state.z - mean(start.1, middle.1, end.1);
            assert!(x.abs() < 5e-3 && z.abs() < 5e-3, "{x}, {z} m");
        }
        // The plan still comes back to its height.
        let end = plan.knots[plan.knots.len() - 1].state.z;
        assert!((end - 50.0).abs() < 3.5, "ends at {end} m");
    }
}

fn with_actuators(actuators: ActuatorLimits) -> Settings {
    Settings {
        actuators,
        ..Settings::flight()
    }
}

#[test]
fn plans_ask_for_no_more_than_the_actuators_give() {
    let free = Settings::flight();
    let discs = [(115.0, 50.2, 1.0), (128.0, 47.0, 1.5), (140.0, 52.0, 1.0)];
    let most = |plan: &Trajectory, trim: &Trim| {
        let elevator = plan
            .knots
            .iter()
            .map(|knot| (knot.feedforward.elevator - trim.control.elevator).abs());
        let thrust = plan.knots.iter().map(|knot| knot.feedforward.thrust);
        (elevator.fold(0.0, f64::max), thrust.fold(0.0, f64::max))
    };
    let unlimited = plan_in(&free, &Wind::STILL, &discs);
    let asked = most(unlimited.best(), unlimited.trim());
    assert!(asked.0 > 2.5, "{asked:?}");
    let limited = plan_in(
        &with_actuators(ActuatorLimits {
            thrust_max: Some(5.0),
            elevator_below: Some(2.0),
            elevator_above: Some(2.0),
            ..ActuatorLimits::NONE
        }),
        &Wind::STILL,
        &discs,
    );
    let asked = most(limited.best(), limited.trim());
    // The rate of the angle of attack asks for a little of the elevator too.
    assert!(asked.0 < 2.0 + 1e-9 && asked.1 <= 5.0, "{asked:?}");
}

const SLUGGISH: ActuatorLimits = ActuatorLimits {
    elevator_below: Some(2.0),
    elevator_above: Some(2.0),
    ..ActuatorLimits::NONE
};

/// Clearance from the first disc of a plan among discs.
fn clearance(actuators: ActuatorLimits, discs: &[(f64, f64, f64)]) -> f64 {
    let planner = plan_in(&with_actuators(actuators), &Wind::STILL, discs);
    let (plan, first) = (planner.best(), discs[0]);
    (0..450_u32)
        .filter_map(|tick| plan.sample(plan.start + TICK_PERIOD * f64::from(tick)))
        .map(|it| libm::hypot(it.state.x - first.0, it.state.z - first.1) - first.2)
        .fold(f64::INFINITY, f64::min)
}

/// Every aircraft passes an obstacle that stands alone at a distance.
#[test]
fn open_country_is_passed_with_room() {
    for actuators in [ActuatorLimits::NONE, SLUGGISH] {
        let found = clearance(actuators, &[(135.0, 49.5, 1.0)]);
        assert!(found > 1.3, "{found}");
    }
}

/// An aircraft that turns little cannot win back the distance that a gust takes. An agile aircraft keeps no more room
/// between rows of obstacles than it needs.
#[test]
fn an_aircraft_that_turns_little_keeps_more_room_in_a_crowd() {
    let rows = (0..20).flat_map(|place| {
        let x = 102.0 + 2.5 * f64::from(place);
        [(x, 57.5, 1.0), (x, 42.5, 1.0)]
    });
    let discs: Vec<(f64, f64, f64)> = core::iter::once((135.0, 49.5, 1.0)).chain(rows).collect();
    let agile = clearance(ActuatorLimits::NONE, &discs);
    let sluggish = clearance(SLUGGISH, &discs);
    assert!(agile > 0.3 && sluggish > agile + 0.4, "{agile} {sluggish}");
}

#[test]
fn what_the_elevator_balances_is_the_trim_of_another_angle_of_attack() {
    let limits = ActuatorLimits {
        elevator_below: Some(1.0),
        elevator_above: Some(3.0),
        ..ActuatorLimits::NONE
    };
    for airframe in [Airframe::PAPER, Airframe::REFERENCE] {
        let [down, up] = limits.angle_of_attack(&airframe);
        for (alpha, room) in [(0.15 - down, -1.0), (0.15 + up, 3.0)] {
            let moved = airframe.elevator_for(alpha) - airframe.elevator_for(0.15);
            assert!((moved - room).abs() < 1e-9, "{moved}");
        }
        // An elevator that counts the other way has its sides exchanged.
        let turned = Airframe {
            moment_elevator: -airframe.moment_elevator,
            ..airframe
        };
        let exchanged = limits.angle_of_attack(&turned);
        assert!((exchanged[0] - up).abs() + (exchanged[1] - down).abs() < 1e-15);
    }
    let free = ActuatorLimits::NONE.angle_of_attack(&Airframe::PAPER);
    assert!(free.into_iter().all(f64::is_infinite));
}

#[test]
fn the_loop_clamps_counts_and_predicts_by_what_is_given() {
    let limits = ActuatorLimits {
        thrust_max: Some(6.0),
        thrust_lag: Some(0.2),
        elevator_below: Some(1.0),
        elevator_above: Some(1.0),
        elevator_rate: Some(20.0),
        ..ActuatorLimits::NONE
    };
    let mut flight = FlightLoop::new(&with_actuators(limits)).unwrap();
    let level = flight.state();
    // The nose is far up, so the regulator wants it down at once.
    let mut nose_up = level;
    nose_up.air.pitch += 0.02;
    let frame = frame(&nose_up);
    let trim = Settings::flight()
        .cruise
        .trim(&Settings::flight().airframe)
        .unwrap();
    let mut last = trim.control.elevator;
    for tick in 0..60 {
        let out = flight.step(f64::from(tick) * TICK_PERIOD, &frame);
        assert!((out.control.elevator - last).abs() <= 0.2 + 1e-9);
        assert!((out.control.elevator - trim.control.elevator).abs() <= 1.0 + 1e-9);
        last = out.control.elevator;
    }
    assert!(flight.health().elevator_limited > 0);
    assert_eq!(flight.health().thrust_limited, 0);
    flight.step(f64::NAN, &frame);
    assert!(flight.step(1.0, &frame).control.thrust.is_finite());
}

/// The filter predicts a thrust that lags with its lag. It equals a filter that gets the same
/// lagging thrust by hand.
#[test]
fn the_filter_predicts_by_the_lagging_thrust() {
    let limits = ActuatorLimits {
        thrust_lag: Some(0.5),
        ..ActuatorLimits::NONE
    };
    let settings = Settings {
        wind_change: None,
        airspeed_hold: 0.0,
        ..with_actuators(limits)
    };
    let trim = settings.cruise.trim(&settings.airframe).unwrap();
    let mut flight = FlightLoop::new(&settings).unwrap();
    let mut by_hand = Ekf::new(settings.airframe, settings.estimator, trim.state);
    let mut plan = Trajectory::new();
    for knot in &mut plan.knots {
        knot.state.air = trim.state;
        knot.feedforward = Control {
            thrust: 9.0,
            ..trim.control
        };
    }
    flight.adopt(0.0, Verdict::Feasible, &plan);
    let measurement = Measurement {
        airspeed: trim.state.airspeed,
        pitch: trim.state.pitch,
    };
    let (mut given, mut elevator) = (trim.control.thrust, trim.control.elevator);
    for tick in 0..100 {
        let time = f64::from(tick) * TICK_PERIOD;
        if tick > 0 {
            given += (9.0 - given) * (1.0 - libm::exp(-TICK_PERIOD / 0.5));
            let control = Control {
                thrust: given,
                elevator,
            };
            by_hand.predict(control, TICK_PERIOD).unwrap();
        }
        // Values that repeat to the last bit count as missing.
        let measurement = Measurement {
            airspeed: measurement.airspeed + 1e-9 * f64::from(tick % 2),
            pitch: measurement.pitch + 1e-9 * f64::from(tick % 2),
        };
        by_hand.update(&measurement);
        let seen = VehicleState {
            x: 12.0 * time,
            z: 50.0,
            air: AirState {
                airspeed: measurement.airspeed,
                pitch: measurement.pitch,
                ..trim.state
            },
        };
        elevator = flight.step(time, &frame(&seen)).control.elevator;
        let off = flight.estimate().to_vector() - by_hand.estimate().to_vector();
        assert!(off.amax() < 1e-9, "{off} at {tick}");
    }
    assert!(given > 8.0);
}

#[test]
fn limits_that_are_none_are_refused() {
    let weak = with_actuators(ActuatorLimits {
        thrust_max: Some(0.5),
        ..ActuatorLimits::NONE
    });
    assert_eq!(FlightLoop::new(&weak).err(), Some(SetupError::ThrustTooLow));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = with_actuators(ActuatorLimits {
            elevator_rate: Some(bad),
            ..ActuatorLimits::NONE
        });
        assert_eq!(
            Planner::new().set_up(&settings),
            Err(SetupError::OutOfRange(Setting::ElevatorRate))
        );
    }
}
