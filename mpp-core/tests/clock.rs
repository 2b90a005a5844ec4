//! Tests the 100 Hz loop with a clock that jumps, goes back, or tells no time.

use crate::common::sensors::{frame, lively};
use crate::common::trajectories::trajectory;
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::PositionVerdict;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::Verdict;
use mpp_core::settings::Settings;

fn flight_loop() -> FlightLoop {
    FlightLoop::new(&Settings::flight()).unwrap()
}

#[test]
fn time_that_is_none_is_counted_and_survived() {
    let mut flight = flight_loop();
    let state = flight.state();
    flight.step(0.0, &frame(&state));
    flight.step(f64::NAN, &frame(&state));
    assert_eq!(flight.health().time_jumps, 1);
    assert!(flight.estimate().is_finite());
    // The step after it has no time since the last one either. The next step has.
    flight.step(0.02, &frame(&state));
    flight.step(0.03, &frame(&state));
    assert_eq!(flight.health().time_jumps, 2);
    assert_eq!(flight.health().predictions_diverged, 0);
    // Positions are still taken at once.
    let mut ahead = frame(&state);
    ahead.position.as_mut().unwrap().x += 1.0;
    let used = flight.step(0.04, &ahead).position;
    assert_eq!(used, Some(PositionVerdict::Accepted));
}

/// A clock that jumps ahead by any time, or back, leaves an estimate that the sensors correct within a second.
#[test]
fn a_clock_that_jumps_is_counted_and_survived() {
    for jump in [0.6, 10.0, 1e4, 1e9, -1.0, -1e9] {
        let mut flight = flight_loop();
        let state = flight.state();
        let mut time = 0.0;
        for tick in 0..200 {
            if tick == 100 {
                time += jump;
            }
            time += TICK_PERIOD;
            let out = flight.step(time, &lively(&state, tick));
            assert!(out.control.elevator.is_finite());
        }
        assert_eq!(flight.health().time_jumps, 1, "{jump}");
        let off = flight.estimate().to_vector() - state.air.to_vector();
        assert!(off.amax() < 0.05, "{off} after {jump} s");
    }
}

/// A clock that jumps during a turn leaves the estimate and the plan as they were: one tick has passed. If steps were
/// lost instead, the sensors show another motion, and the plan continues at the time of the clock.
#[test]
fn a_jump_of_the_clock_is_told_from_lost_steps() {
    let [same, turned, slower] = [(0.0, 0.0), (0.2, 0.0), (0.0, -4.0)];
    for (changed, jump) in [(same, 0.8), (same, 100.0), (turned, 0.8), (slower, 0.8)] {
        let lost = changed != same;
        let mut flight = flight_loop();
        let mut state = flight.state();
        flight.adopt(0.0, Verdict::Feasible, &trajectory(0.0));
        let mut time = 0.0;
        for tick in 0..100 {
            time = f64::from(tick) * TICK_PERIOD;
            state.x += state.air.airspeed * TICK_PERIOD;
            flight.step(time, &lively(&state, tick));
        }
        let start = flight.trajectory().unwrap().start;
        let before = *flight.estimate();
        let flown = if lost { jump } else { TICK_PERIOD };
        state.x += state.air.airspeed * flown;
        let (angle, faster) = changed;
        state.air.pitch += angle;
        state.air.flight_path += angle;
        state.air.airspeed += faster;
        time += jump;
        // The first position comes three ticks later.
        for tick in 100..103 {
            let mut blind = lively(&state, tick);
            blind.position = None;
            flight.step(time, &blind);
            assert!(flight.is_lost());
            time += TICK_PERIOD;
            state.x += state.air.airspeed * TICK_PERIOD;
        }
        flight.step(time, &lively(&state, 103));
        assert!(!flight.is_lost());
        assert!((flight.state().x - state.x).abs() < 0.1);
        let delay = flight.trajectory().unwrap().start - start;
        let expected = jump - flown;
        assert!((delay - expected).abs() < 0.03, "{delay} of {expected} s");
        if lost {
            // The aircraft flew without control, so the filter doubts its motion and believes the sensors.
            let off = flight.estimate().airspeed - state.air.airspeed;
            assert!(off.abs() < 1.0, "{off} m/s");
        } else {
            assert!((flight.estimate().pitch - before.pitch).abs() < 0.01);
        }
    }
}
