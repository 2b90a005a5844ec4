//! The roll-out of a candidate and its linearisation.

use super::limits::Limits;
use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
use crate::qp::{Dynamics, Solution, StageState};
use crate::trajectory::STEPS;
use crate::vehicle::{Airframe, PathControl, PathState, Trim, Wind};
use nalgebra::{SMatrix, SVector, Vector2};

/// Angles of the program are in tenths of a radian, so that they have about the same weight as metres.
pub(super) const ANGLE_SCALE: f64 = 10.0;
/// Number of states of a program: there is no pitch rate.
pub(super) const MOTION_STATES: usize = 5;
/// State of a program: deviations in x, z, airspeed, pitch and flight path.
pub(super) type MotionState = StageState<MOTION_STATES>;

/// A trajectory as the aircraft would fly it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub(super) knots: [PathState; KNOTS],
    pub(super) controls: [PathControl; STAGES],
    /// The price that ranks the candidate. It is infinite before the first improvement.
    pub(super) price: f64,
}

impl Candidate {
    /// Integrates the motion from the first knot on under the controls of a program. It limits the angle of
    /// attack and the thrust.
    pub(super) fn roll_out(
        &mut self,
        solution: &Solution<MOTION_STATES>,
        frame: &Frame,
        limits: &Limits,
    ) {
        let [down, up] = limits.rolled_out;
        let trim = &frame.trim;
        let level = trim.state.angle_of_attack();
        let [first, later @ ..] = &mut self.knots;
        let mut state = *first;
        let stages = self.controls.iter_mut().zip(later).zip(&solution.controls);
        for ((control, knot), [rate, thrust]) in stages {
            let aimed = state.angle_of_attack + rate * STAGE_PERIOD;
            let allowed = aimed.max(level - down).min(level + up);
            let turn = limits.turn_rate * STAGE_PERIOD;
            let slowest = state.angle_of_attack - turn;
            let reached = allowed.max(slowest).min(state.angle_of_attack + turn);
            *control = PathControl {
                angle_of_attack_rate: (reached - state.angle_of_attack) / STAGE_PERIOD,
                thrust: (trim.control.thrust + thrust)
                    .min(limits.thrust_max)
                    .max(0.0),
            };
            state = frame.after(&state, control);
            *knot = state;
        }
    }
}

/// The origin of the program's deviations: level flight at trim that starts at the aircraft.
pub(super) struct Frame {
    pub(super) airframe: Airframe,
    pub(super) trim: Trim,
    pub(super) wind: Wind,
    pub(super) start: PathState,
}

impl Frame {
    /// The state one stage after a knot.
    fn after(&self, knot: &PathState, control: &PathControl) -> PathState {
        knot.after_in(&self.wind, &self.airframe, control, STAGE_PERIOD, STEPS)
    }

    /// The program's state: deviations in position and speed, and in pitch and flight path in tenths of a
    /// radian.
    pub(super) fn deviation(&self, state: &PathState, stage: usize) -> SVector<f64, MOTION_STATES> {
        let trim = &self.trim.state;
        let level = self.start.x + trim.airspeed * STAGE_PERIOD * stage as f64;
        SVector::from([
            state.x - level,
            state.z - self.start.z,
            state.airspeed - trim.airspeed,
            ANGLE_SCALE * (state.flight_path + state.angle_of_attack - trim.pitch),
            ANGLE_SCALE * (state.flight_path - trim.flight_path),
        ])
    }

    /// Writes the dynamics of each stage, linearised about a candidate.
    pub(super) fn linearise(
        &self,
        candidate: &Candidate,
        dynamics: &mut [Dynamics<MOTION_STATES>; STAGES],
    ) {
        let [_, following @ ..] = &candidate.knots;
        let knots = candidate.knots.iter().zip(following);
        let stages = dynamics.iter_mut().zip(knots.zip(&candidate.controls));
        for (stage, (dynamics, ((knot, following), control))) in stages.enumerate() {
            let (state, input) = knot.sensitivity(&self.airframe, control, STAGE_PERIOD);
            // These columns convert between the program's (pitch, path) and the point mass's (path, angle
            // of attack).
            let [x, z, v, path, alpha] = state.data.0;
            let mut turning = path;
            for (turning, alpha) in turning.iter_mut().zip(&alpha) {
                *turning -= alpha;
            }
            let [alpha, turning] = [alpha, turning].map(|column| column.map(|it| it / ANGLE_SCALE));
            let a: SMatrix<f64, MOTION_STATES, MOTION_STATES> =
                [x, z, v, alpha, turning].map(program_state).into();
            let b: SMatrix<f64, MOTION_STATES, 2> = input.data.0.map(program_state).into();
            // A roll-out ends each stage in its next knot; a path need not.
            let next = if candidate.price.is_finite() {
                *following
            } else {
                self.after(knot, control)
            };
            let thrust = control.thrust - self.trim.control.thrust;
            let control = Vector2::new(control.angle_of_attack_rate, thrust);
            let offset =
                self.deviation(&next, stage + 1) - a * self.deviation(knot, stage) - b * control;
            *dynamics = Dynamics { a, b, offset };
        }
    }
}

/// Converts deviations of the point mass to the program's state.
fn program_state([x, z, v, path, alpha]: [f64; 5]) -> MotionState {
    let pitch = ANGLE_SCALE * (path + alpha);
    [x, z, v, pitch, ANGLE_SCALE * path]
}
