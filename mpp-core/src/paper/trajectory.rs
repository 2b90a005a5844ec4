//! Trajectories of the paper's method: a solution placed in the world, and the baseline that follows a path.

use super::{CollocationPoints, GridPoint};
use crate::config::{STAGE_PERIOD, STAGES};
use crate::qp::Solution;
use crate::trajectory::Trajectory;
use crate::vehicle::{AirState, Airframe, Control, Trim, VehicleState};

impl Trajectory {
    /// Places a solution in the world. Its states are deviations from level flight at trim that starts at
    /// `(x, z)` \[m\].
    pub fn place(&mut self, solution: &Solution, trim: &Trim, start: f64, x: f64, z: f64) {
        self.start_lines(start);
        for (stage, (knot, state)) in self.knots.iter_mut().zip(&solution.states).enumerate() {
            let elapsed = STAGE_PERIOD * stage as f64;
            knot.state = VehicleState {
                x: x + trim.state.airspeed * elapsed + state[0],
                z: z + state[1],
                air: AirState {
                    airspeed: trim.state.airspeed + state[2],
                    pitch: trim.state.pitch + state[3],
                    pitch_rate: trim.state.pitch_rate + state[4],
                    flight_path: trim.state.flight_path + state[5],
                },
            };
            let [elevator, thrust] = solution.controls[stage.min(STAGES - 1)];
            knot.feedforward = Control {
                thrust: trim.control.thrust + thrust,
                elevator: trim.control.elevator + elevator,
            };
        }
    }

    /// Follows collocation points at cruise speed in steady climbs and descents. This is the paper's
    /// baseline, which tracks a path without refinement. It starts at the aircraft's `state`.
    pub fn follow(
        &mut self,
        points: &CollocationPoints,
        trim: &Trim,
        airframe: &Airframe,
        start: f64,
        state: &VehicleState,
    ) {
        self.start_lines(start);
        let mut slope = 0.0;
        for (stage, (knot, point)) in self.knots.iter_mut().zip(points).enumerate() {
            // The last point keeps the slope that led to it.
            if let Some(next) = points.get(stage + 1) {
                slope = libm::atan2(next.row - point.row, next.col - point.col);
            }
            // If there is no steady flight at this slope, the controls of the trim serve instead.
            let steady = Trim::at_speed(airframe, trim.state.airspeed, slope).unwrap_or(*trim);
            knot.state = VehicleState {
                x: state.x + point.col - GridPoint::AIRCRAFT.col,
                z: state.z + point.row - GridPoint::AIRCRAFT.row,
                air: AirState {
                    pitch: slope + steady.state.angle_of_attack(),
                    flight_path: slope,
                    ..trim.state
                },
            };
            knot.feedforward = steady.control;
            // A steep descent would need a negative thrust, which the propeller does not give.
            knot.feedforward.thrust = knot.feedforward.thrust.max(0.0);
        }
    }
}
