//! Tests how a trajectory is placed in the world and sampled: knots, lines in between, ends.

use crate::common::trajectories::{HORIZON, trajectory};
use mpp_core::config::{KNOTS, STAGE_PERIOD, STAGES, TICK_PERIOD};
use mpp_core::qp::Solution;
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{AirState, Control, Trim};

#[test]
fn samples_meet_the_knots_and_are_straight_in_between() {
    let trajectory = trajectory(7.5);
    for stage in 0..KNOTS {
        let at = trajectory
            .sample(7.5 + STAGE_PERIOD * stage as f64)
            .unwrap();
        let knot = trajectory.knots[stage];
        assert!((at.state.x - knot.state.x).abs() < 1e-9);
        assert!((at.state.air.to_vector() - knot.state.air.to_vector()).amax() < 1e-9);
        assert!((at.feedforward.elevator - knot.feedforward.elevator).abs() < 1e-9);
    }
    for stage in 0..STAGES {
        let (from, to) = (trajectory.knots[stage], trajectory.knots[stage + 1]);
        let at = trajectory
            .sample(7.5 + STAGE_PERIOD * (stage as f64 + 0.25))
            .unwrap();
        let between = |a: f64, b: f64| 0.75 * a + 0.25 * b;
        assert!((at.state.x - between(from.state.x, to.state.x)).abs() < 1e-9);
        assert!((at.state.z - between(from.state.z, to.state.z)).abs() < 1e-9);
        let air = from.state.air.to_vector() * 0.75 + to.state.air.to_vector() * 0.25;
        assert!((at.state.air.to_vector() - air).amax() < 1e-9);
        let (a, b) = (from.feedforward, to.feedforward);
        assert!((at.feedforward.thrust - between(a.thrust, b.thrust)).abs() < 1e-9);
        assert!((at.feedforward.elevator - between(a.elevator, b.elevator)).abs() < 1e-9);
    }
}

#[test]
fn samples_are_continuous_and_end_with_the_horizon() {
    let trajectory = trajectory(2.0);
    let mut last = trajectory.sample(2.0).unwrap();
    for tick in 1..=4_500 {
        let now = trajectory.sample(2.0 + f64::from(tick) * 1e-3).unwrap();
        assert!((now.state.x - last.state.x).abs() < 0.013);
        assert!((now.state.air.to_vector() - last.state.air.to_vector()).amax() < 1e-3);
        last = now;
    }
    for outside in [
        1.99,
        2.0 + HORIZON + 0.01,
        -1e9,
        1e9,
        f64::NAN,
        f64::INFINITY,
    ] {
        assert!(trajectory.sample(outside).is_none(), "{outside}");
    }
    // Ticks that are added up miss the boundary by rounding.
    let mut time = 2.0;
    (0..450).for_each(|_| time += TICK_PERIOD);
    assert!(trajectory.sample(time).is_some() && trajectory.sample(2.0 - 1e-9).is_some());
}

#[test]
fn solutions_are_placed_as_deviations_from_level_flight() {
    let trim = Trim {
        state: AirState {
            airspeed: 11.0,
            pitch: 0.2,
            pitch_rate: 0.01,
            flight_path: 0.03,
        },
        control: Control {
            thrust: 5.0,
            elevator: 3.0,
        },
    };
    let mut solution = Solution::new();
    for (stage, state) in solution.states.iter_mut().enumerate() {
        *state = core::array::from_fn(|index| stage as f64 + 0.1 * index as f64);
    }
    for (stage, control) in solution.controls.iter_mut().enumerate() {
        *control = [stage as f64 + 0.7, stage as f64 + 0.8];
    }
    let mut placed = Trajectory::new();
    placed.place(&solution, &trim, 9.0, 100.0, 40.0);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    assert!(near(placed.start, 9.0));
    for (stage, knot) in placed.knots.iter().enumerate() {
        let s = stage as f64;
        assert!(near(knot.state.x, 100.0 + 11.0 * STAGE_PERIOD * s + s));
        assert!(near(knot.state.z, 40.0 + s + 0.1));
        assert!(near(knot.state.air.airspeed, 11.0 + s + 0.2));
        assert!(near(knot.state.air.pitch, 0.2 + s + 0.3));
        assert!(near(knot.state.air.pitch_rate, 0.01 + s + 0.4));
        assert!(near(knot.state.air.flight_path, 0.03 + s + 0.5));
        let last = s.min(STAGES as f64 - 1.0);
        assert!(near(knot.feedforward.elevator, 3.0 + last + 0.7));
        assert!(near(knot.feedforward.thrust, 5.0 + last + 0.8));
    }
}
