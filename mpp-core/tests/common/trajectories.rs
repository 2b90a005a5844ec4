//! Trajectories in which every number is different.

use mpp_core::config::{STAGE_PERIOD, STAGES};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{AirState, Control, VehicleState};

/// A trajectory in which every number is different.
pub(crate) fn trajectory(start: f64) -> Trajectory {
    let mut trajectory = Trajectory::new();
    trajectory.start = start;
    for (stage, knot) in trajectory.knots.iter_mut().enumerate() {
        let s = stage as f64;
        knot.state = VehicleState {
            x: 3.0 * s,
            z: 50.0 + libm::sin(s),
            air: AirState {
                airspeed: 12.0 + 0.1 * s,
                pitch: 0.15 + 0.01 * libm::cos(s),
                pitch_rate: 0.02 * s,
                flight_path: 0.03 * libm::sin(2.0 * s),
            },
        };
        knot.feedforward = Control {
            thrust: 4.0 + 0.2 * s,
            elevator: 3.0 - 0.1 * s,
        };
    }
    trajectory
}

/// Length of a trajectory \[s\].
pub(crate) const HORIZON: f64 = STAGES as f64 * STAGE_PERIOD;
