//! Tests the 100 Hz loop: the hand-over of trajectories, and the faults that it survives.

use crate::common::sensors::{frame, lively};
use crate::common::trajectories::{HORIZON, trajectory};
use mpp_core::config::{KNOTS, TICK_PERIOD};
use mpp_core::estimate::{MeasurementStatus, PositionVerdict};
use mpp_core::flight::{Adoption, FlightLoop, Mode};
use mpp_core::health::Health;
use mpp_core::planner::{SetupError, Verdict};
use mpp_core::settings::{Setting, Settings};
use mpp_core::vehicle::Airframe;

fn flight_loop() -> FlightLoop {
    FlightLoop::new(&Settings::flight()).unwrap()
}

#[test]
fn without_a_trajectory_trim_is_held() {
    let mut flight = flight_loop();
    let mut state = flight.state();
    for tick in 0..100 {
        state.x += state.air.airspeed * TICK_PERIOD;
        let out = flight.step(f64::from(tick) * TICK_PERIOD, &lively(&state, tick));
        assert_eq!(out.mode, Mode::TrimHold);
        assert!((out.control.thrust - out.reference.feedforward.thrust).abs() < 1e-6);
        assert!((out.control.elevator - out.reference.feedforward.elevator).abs() < 1e-3);
    }
    assert_eq!(*flight.health(), Health::default());
    assert!(flight.trajectory().is_none());
}

#[test]
fn a_feasible_plan_replaces_whatever_was_flown() {
    let mut flight = flight_loop();
    for start in [1.0, 2.0] {
        let offered = trajectory(start);
        assert_eq!(
            flight.adopt(start, Verdict::Feasible, &offered),
            Adoption::Feasible
        );
        assert_eq!(flight.trajectory(), Some(&offered));
    }
    let expected = Health {
        plans_feasible: 2,
        ..Health::default()
    };
    assert_eq!(*flight.health(), expected);
}

#[test]
fn a_least_violating_plan_replaces_even_a_valid_one() {
    let mut flight = flight_loop();
    flight.adopt(1.0, Verdict::Feasible, &trajectory(1.0));
    let offered = trajectory(2.0);
    let adoption = flight.adopt(2.0, Verdict::LeastViolating, &offered);
    assert_eq!(adoption, Adoption::LeastViolating);
    assert_eq!(flight.trajectory(), Some(&offered));
    assert_eq!(flight.health().plans_least_violating, 1);
}

#[test]
fn nothing_keeps_a_trajectory_that_still_runs() {
    let mut flight = flight_loop();
    let flown = trajectory(1.0);
    flight.adopt(1.0, Verdict::Feasible, &flown);
    let adoption = flight.adopt(1.0 + HORIZON, Verdict::Nothing, &trajectory(9.0));
    assert_eq!(adoption, Adoption::Kept);
    assert_eq!(flight.trajectory(), Some(&flown));
    assert_eq!(
        (flight.health().plans_kept, flight.health().plans_trim_hold),
        (1, 0)
    );
}

#[test]
fn nothing_after_the_end_holds_trim() {
    let mut flight = flight_loop();
    assert_eq!(
        flight.adopt(0.0, Verdict::Nothing, &trajectory(0.0)),
        Adoption::TrimHold
    );
    flight.adopt(1.0, Verdict::Feasible, &trajectory(1.0));
    let late = 1.0 + HORIZON + TICK_PERIOD;
    assert_eq!(
        flight.adopt(late, Verdict::Nothing, &trajectory(late)),
        Adoption::TrimHold
    );
    assert!(flight.trajectory().is_none());
    assert_eq!(
        (flight.health().plans_kept, flight.health().plans_trim_hold),
        (0, 2)
    );
    let state = flight.state();
    assert_eq!(flight.step(late, &frame(&state)).mode, Mode::TrimHold);
}

#[test]
fn a_trajectory_is_tracked_from_its_start_to_its_end() {
    let mut flight = flight_loop();
    let flown = trajectory(1.0);
    let state = flight.state();
    flight.adopt(0.9, Verdict::Feasible, &flown);
    for (time, mode) in [
        (0.98, Mode::TrimHold),
        (1.0, Mode::Tracking),
        (1.1, Mode::Tracking),
        (1.0 + HORIZON, Mode::Tracking),
        (1.01 + HORIZON, Mode::TrimHold),
    ] {
        let out = flight.step(time, &frame(&state));
        assert_eq!(out.mode, mode, "{time}");
        if mode == Mode::Tracking {
            assert_eq!(Some(out.reference), flown.sample(time));
        }
    }
}

#[test]
fn frames_that_are_not_finite_are_counted_and_survived() {
    let mut flight = flight_loop();
    let state = flight.state();
    let mut bad = frame(&state);
    let air = bad.air.as_mut().unwrap();
    air.measurement.airspeed = f64::NAN;
    air.measurement.pitch = f64::INFINITY;
    bad.position.as_mut().unwrap().x = f64::NAN;
    for tick in 0..50 {
        let out = flight.step(f64::from(tick) * TICK_PERIOD, &bad);
        assert!(out.control.thrust.is_finite() && out.control.elevator.is_finite());
        assert_eq!(out.position, Some(PositionVerdict::NotFinite));
        assert_eq!(out.innovation.airspeed, MeasurementStatus::NotFinite);
    }
    let expected = Health {
        measurements_not_finite: 100,
        positions_not_finite: 50,
        ..Health::default()
    };
    assert_eq!(*flight.health(), expected);
    // Without positions the last one moves on with the estimated motion: 49 ticks of level flight.
    assert!((flight.state().x - state.x - 0.49 * state.air.airspeed).abs() < 0.01);
    assert!((flight.state().z - state.z).abs() < 0.01);

    let mut moved = frame(&state);
    moved.position.as_mut().unwrap().x = 7.0;
    let used = flight.step(0.5, &moved).position;
    assert_eq!(used, Some(PositionVerdict::Accepted));
    assert!((flight.state().x - 7.0).abs() < 1e-12 && flight.health().positions_not_finite == 50);
}

#[test]
fn spikes_are_counted_apart() {
    let mut flight = flight_loop();
    let mut spike = frame(&flight.state());
    spike.air.as_mut().unwrap().measurement.airspeed += 50.0;
    let before = *flight.estimate();
    flight.step(0.0, &spike);
    assert_eq!(flight.health().measurements_gated, 1);
    assert!((flight.estimate().airspeed - before.airspeed).abs() < 1e-9);
}

/// A source that holds its position between two fixes delivers nothing new: neither wind nor lift come of it,
/// and the position moves on with the aircraft.
#[test]
fn held_positions_are_bridged() {
    let mut flight = flight_loop();
    let mut state = flight.state();
    let mut delivered = state;
    for tick in 0..300 {
        state.x += state.air.airspeed * TICK_PERIOD;
        if tick % 10 == 0 {
            delivered = state;
        }
        let mut frame = lively(&state, tick);
        let position = frame.position.as_mut().unwrap();
        (position.x, position.z) = (delivered.x, delivered.z);
        let verdict = flight.step(f64::from(tick) * TICK_PERIOD, &frame).position;
        let used = verdict == Some(PositionVerdict::Accepted);
        assert_eq!(used, tick % 10 == 0);
        assert!((flight.state().x - state.x).abs() < 0.05, "tick {tick}");
    }
    assert_eq!(flight.health().positions_held, 270);
    let wind = flight.conditions().wind;
    assert!(wind.x.abs() < 0.1 && wind.z.abs() < 0.1, "{wind:?}");
}

/// A sensor that repeats one value to the last bit has none: the estimate continues with the other one.
#[test]
fn frozen_values_are_not_used() {
    for frozen in 0..2 {
        let mut flight = flight_loop();
        let state = flight.state();
        let mut first_flag = None;
        for tick in 0..100 {
            let mut frame = lively(&state, tick);
            if frozen == 0 {
                frame.air.as_mut().unwrap().measurement.airspeed = state.air.airspeed + 2.0;
            } else {
                frame.air.as_mut().unwrap().measurement.pitch = state.air.pitch + 0.03;
            }
            let verdicts = flight
                .step(f64::from(tick) * TICK_PERIOD, &frame)
                .innovation;
            let verdict = [verdicts.airspeed, verdicts.pitch][frozen];
            if verdict == MeasurementStatus::Frozen {
                first_flag.get_or_insert(tick);
            }
        }
        assert_eq!(first_flag, Some(5));
        assert_eq!(flight.health().measurements_frozen, 95);
    }
}

/// Without a finite command the elevator goes to trim, no faster than its rate.
#[test]
fn the_fall_back_keeps_the_elevators_rate() {
    let mut settings = Settings::flight();
    settings.actuators.elevator_rate = Some(20.0);
    let mut flight = FlightLoop::new(&settings).unwrap();
    let trim = settings.cruise.trim(&settings.airframe).unwrap();
    let mut plan = trajectory(0.0);
    for knot in &mut plan.knots {
        knot.feedforward.elevator = trim.control.elevator + 100.0;
    }
    flight.adopt(0.0, Verdict::Feasible, &plan);
    let state = flight.state();
    let mut last = trim.control.elevator;
    for tick in 0..60 {
        if tick == 30 {
            for knot in &mut plan.knots {
                knot.feedforward.elevator = f64::NAN;
            }
            flight.adopt(0.3, Verdict::Feasible, &plan);
        }
        let time = f64::from(tick) * TICK_PERIOD;
        let elevator = flight.step(time, &lively(&state, tick)).control.elevator;
        assert!(
            (elevator - last).abs() <= 20.0 * TICK_PERIOD + 1e-9,
            "tick {tick}"
        );
        last = elevator;
    }
    assert!(flight.health().commands_not_finite >= 30);
}

#[test]
fn thrust_is_never_negative() {
    let settings = Settings {
        airspeed_hold: 0.0,
        ..Settings::flight()
    };
    let mut flight = FlightLoop::new(&settings).unwrap();
    let mut diving = trajectory(0.0);
    diving
        .knots
        .iter_mut()
        .for_each(|knot| knot.feedforward.thrust = -2.0);
    diving.knots[KNOTS - 1].feedforward.thrust = 3.0;
    flight.adopt(0.0, Verdict::Feasible, &diving);
    let state = flight.state();
    let mut raised = 0;
    for tick in 0..450 {
        let out = flight.step(f64::from(tick) * TICK_PERIOD, &frame(&state));
        assert!(out.control.thrust >= 0.0);
        raised += u32::from(out.reference.feedforward.thrust < 0.0);
    }
    assert!(raised > 400 && flight.health().thrust_limited == raised);
}

#[test]
fn a_command_that_is_not_a_number_is_trim_and_counted() {
    let mut flight = flight_loop();
    let mut broken = trajectory(0.0);
    for knot in &mut broken.knots {
        knot.feedforward.elevator = f64::NAN;
    }
    let state = flight.state();
    let trim = flight.step(0.0, &frame(&state)).reference.feedforward;
    flight.adopt(0.0, Verdict::Feasible, &broken);
    assert_eq!(flight.step(0.01, &frame(&state)).control, trim);
    assert_eq!(flight.health().commands_not_finite, 1);
    assert!(flight.estimate().is_finite());
}

#[test]
fn an_airframe_that_does_not_fly_is_refused() {
    let heavy = Settings {
        airframe: Airframe {
            mass: f64::NAN,
            ..Airframe::PAPER
        },
        ..Settings::flight()
    };
    let error = SetupError::OutOfRange(Setting::Mass);
    assert_eq!(FlightLoop::new(&heavy).err(), Some(error));
}
