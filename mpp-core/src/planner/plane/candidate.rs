//! The roll-out of a candidate and its linearisation.

use super::limits::Limits;
use crate::config::{STAGE_PERIOD, STAGES};
use crate::qp::{Dynamics, STATES, Solution, StageState};
use crate::trajectory::{RollOut, STEPS};
use crate::tuning::candidates::THRUST_SCALE;
use crate::vehicle::{Airframe, PathControl, PathState, ThrustLag, Trim, Wind};
use nalgebra::{Matrix5, SMatrix, SVector};

/// Angles of the program are in tenths of a radian, so that they have about the same weight as metres.
pub(super) const ANGLE_SCALE: f64 = 10.0;
/// Place of the thrust in the state of a program, which has no pitch rate.
const THRUST: usize = 4;

/// A trajectory as the aircraft would fly it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub(super) flown: RollOut,
    /// The price that ranks the candidate. It is infinite before the first improvement.
    pub(super) price: f64,
}

impl Candidate {
    /// Integrates the motion from the first knot on under the controls of a program. It limits the angle of
    /// attack and the thrust.
    pub(super) fn roll_out(&mut self, solution: &Solution, frame: &Frame, limits: &Limits) {
        self.steer(frame, limits, |stage, _| {
            solution.controls.get(stage).copied().unwrap_or_default()
        });
    }

    /// Integrates the motion under the rate of the angle of attack and the thrust beyond trim that `by` gives for each stage.
    // One copy for all who steer.
    #[inline(never)]
    pub(super) fn steer(
        &mut self,
        frame: &Frame,
        limits: &Limits,
        mut by: impl FnMut(usize, &PathState) -> [f64; 2],
    ) {
        let [down, up] = limits.rolled_out;
        let trim = &frame.trim;
        let level = trim.state.angle_of_attack();
        let RollOut {
            knots: [first, later @ ..],
            controls,
            thrust,
        } = &mut self.flown;
        let (mut state, mut given) = (*first, *thrust);
        for (stage, (control, knot)) in controls.iter_mut().zip(later).enumerate() {
            let [rate, thrust] = by(stage, &state);
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
            state = frame.after(&state, &frame.acting(control, given));
            given = frame.lag.end(given, control.thrust);
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
    pub(super) lag: ThrustLag,
}

impl Frame {
    /// The state one stage after a knot under the control that acts.
    fn after(&self, knot: &PathState, acting: &PathControl) -> PathState {
        knot.after_in(&self.wind, &self.airframe, acting, STAGE_PERIOD, STEPS)
    }

    /// The control that acts in a stage in which the thrust starts at `given`.
    fn acting(&self, control: &PathControl, given: f64) -> PathControl {
        PathControl {
            thrust: self.lag.mean(given, control.thrust),
            ..*control
        }
    }

    /// The program's state: deviations in position and speed, in pitch and flight path in tenths of a radian, and in
    /// the thrust in units of [`THRUST_SCALE`].
    // Not inlined, because three callers would hold a copy each.
    #[inline(never)]
    pub(super) fn deviation(
        &self,
        state: &PathState,
        thrust: f64,
        stage: usize,
    ) -> SVector<f64, STATES> {
        let trim = &self.trim.state;
        let level = self.start.x + trim.airspeed * STAGE_PERIOD * stage as f64;
        SVector::from([
            state.x - level,
            state.z - self.start.z,
            state.airspeed - trim.airspeed,
            ANGLE_SCALE * (state.flight_path + state.angle_of_attack - trim.pitch),
            (thrust - self.trim.control.thrust) / THRUST_SCALE,
            ANGLE_SCALE * (state.flight_path - trim.flight_path),
        ])
    }

    /// Writes the dynamics of each stage, linearised about a candidate.
    pub(super) fn linearise(&self, candidate: &Candidate, dynamics: &mut [Dynamics; STAGES]) {
        let RollOut {
            knots,
            controls,
            thrust,
        } = &candidate.flown;
        let mut given = *thrust;
        let knots = knots.iter().zip(knots.iter().skip(1));
        let stages = dynamics.iter_mut().zip(knots.zip(controls));
        for (stage, (dynamics, ((knot, following), control))) in stages.enumerate() {
            let acting = self.acting(control, given);
            // A roll-out ends each stage in its next knot; a path need not.
            let next = if candidate.price.is_finite() {
                *following
            } else {
                self.after(knot, &acting)
            };
            let by = knot.sensitivity(&next, &self.airframe, &acting, STAGE_PERIOD);
            *dynamics = program_model(by, &self.lag);
            let before = self.deviation(knot, given, stage);
            given = self.lag.end(given, control.thrust);
            let thrust = control.thrust - self.trim.control.thrust;
            let control = [control.angle_of_attack_rate, thrust];
            let after = self.deviation(&next, given, stage + 1);
            dynamics.offset = after - SVector::from(dynamics.step(&before.into(), &control));
        }
    }
}

/// The dynamics of a stage, without an offset, from the derivatives of the point mass. The thrust at the start of the
/// stage and the command act by their share of the mean thrust. Mean and end are linear in both, so one newton of each
/// gives the shares.
fn program_model((state, input): (Matrix5<f64>, SMatrix<f64, 5, 2>), lag: &ThrustLag) -> Dynamics {
    // These columns convert between the program's (pitch, path) and the point mass's (path, angle of attack).
    let [_, _, v, path, alpha] = state.data.0;
    let mut turning = path;
    for (turning, alpha) in turning.iter_mut().zip(&alpha) {
        *turning -= alpha;
    }
    let [alpha, turning] = [alpha, turning].map(|column| column.map(|it| it / ANGLE_SCALE));
    let [rate, mean] = input.data.0;
    let given = mean.map(|it| it * (lag.mean(1.0, 0.0) * THRUST_SCALE));
    let command = mean.map(|it| it * lag.mean(0.0, 1.0));
    let [v, alpha, mut given, turning] = [v, alpha, given, turning].map(program_state);
    let [rate, mut command] = [rate, command].map(program_state);
    given[THRUST] = lag.end(1.0, 0.0);
    command[THRUST] = lag.end(0.0, 1.0) / THRUST_SCALE;
    Dynamics {
        motion: [v, alpha, given, turning].into(),
        b: [rate, command].into(),
        offset: SVector::zeros(),
    }
}

/// Converts derivatives of the point mass to the program's state.
fn program_state([x, z, v, path, alpha]: [f64; 5]) -> StageState {
    let pitch = ANGLE_SCALE * (path + alpha);
    [x, z, v, pitch, 0.0, ANGLE_SCALE * path]
}
