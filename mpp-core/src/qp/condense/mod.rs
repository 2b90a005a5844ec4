//! The part of the program that all candidates of a model share. It eliminates the states: under the feedback
//! that is optimal without rows, the outputs follow from normalised controls whose Hessian is the identity.

mod feedback;

use super::controls::{CONTROLS, ControlVector, add_scaled, dot};
use super::response::Response;
use super::rows::{ATTITUDE_OUTPUT, OUTPUTS, ROWS, RowPattern, THRUST_OUTPUT, parts_mut};
use super::{Dynamics, PITCH, STATES, Solution, StageState, Weights};
use crate::config::{KNOTS, STAGES};
use crate::corridor::DIRECTION_VECTORS;
use feedback::Feedback;
use nalgebra::SVector;

/// Value of `|y|^2` below which a row with the response `y` is constant up to rounding. In the paper's model the
/// first position rows are constant, because a control changes the position only two stages later.
const UNCHANGEABLE: f64 = 1e-20;

/// The part of the program that all candidates of a model share.
#[derive(Clone, Debug)]
pub struct Condensed {
    dynamics: [Dynamics; STAGES],
    pub(super) weights: Weights,
    feedback: [Feedback; STAGES],
    /// Response of the outputs to the normalised controls.
    response: Response,
    /// Price of each row: `1 / |y|^2` for the row's response `y`, and 0 if the controls cannot change the row. A
    /// violation `s` takes a cost of `s^2 / 2` times the price to correct.
    pub(super) prices: [f64; ROWS],
}

/// The cost has no single optimum: a weight is not positive, or the model is not finite. The planner then
/// does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the plan's cost has no single optimum: give the controls positive weights, and the terminal \
     state one that is not negative"
)]
pub struct CondenseError;

impl Condensed {
    /// An empty workspace. All of it is zero, so that whoever needs a new one writes zeros in place.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            dynamics: [Dynamics::at_rest(); STAGES],
            weights: Weights {
                control: [0.0; 2],
                terminal: 0.0,
            },
            feedback: [Feedback::none(); STAGES],
            response: Response::new(),
            prices: [0.0; ROWS],
        }
    }

    /// Condenses a model that is the same in every stage.
    ///
    /// # Errors
    /// [`CondenseError`] if the cost has no single optimum.
    pub fn condense(&mut self, model: &Dynamics, weights: &Weights) -> Result<(), CondenseError> {
        self.dynamics.fill(*model);
        self.condense_stages(weights)
    }

    /// Condenses a different model for each stage. `linearise` writes the models in place, because they are
    /// large.
    ///
    /// # Errors
    /// [`CondenseError`] if the cost has no single optimum.
    pub fn condense_varying(
        &mut self,
        weights: &Weights,
        linearise: impl FnOnce(&mut [Dynamics; STAGES]),
    ) -> Result<(), CondenseError> {
        linearise(&mut self.dynamics);
        self.condense_stages(weights)
    }

    fn condense_stages(&mut self, weights: &Weights) -> Result<(), CondenseError> {
        self.weights = *weights;
        feedback::design(&self.dynamics, weights, &mut self.feedback).ok_or(CondenseError)?;
        self.write_response();
        self.write_prices();
        Ok(())
    }

    /// Writes the response of the outputs to the normalised controls. It follows the response of the state
    /// from stage to stage, with a column for each control so far.
    // Not inlined, so that its columns do not lie on the stack beneath the design of the feedback.
    #[inline(never)]
    fn write_response(&mut self) {
        let mut columns = [SVector::zeros(); CONTROLS];
        let stages = self.dynamics.iter().zip(&self.feedback).enumerate();
        for (stage, (dynamics, feedback)) in stages {
            let so_far = 2 * stage;
            let attitude = ATTITUDE_OUTPUT + so_far;
            let outputs = [so_far, so_far + 1, attitude, attitude + 1];
            let thrusts = self.response.row_mut(THRUST_OUTPUT + stage);
            thrusts.fill(0.0);
            let gain = feedback.gain.row(1);
            let closed = feedback.closed(dynamics);
            for (thrust, column) in thrusts.iter_mut().zip(&mut columns).take(so_far) {
                *thrust = -(gain * *column).x;
                *column = closed * *column;
            }
            if let Some([by_first, by_second, ..]) = thrusts.get_mut(so_far..) {
                [*by_first, *by_second] = feedback.scale.row(1).into_owned().into();
            }
            if let Some(own) = columns.as_chunks_mut::<2>().0.get_mut(stage) {
                let first = dynamics.b * feedback.scale;
                *own = [first.column(0).into_owned(), first.column(1).into_owned()];
            }
            let [x, z, pitch, flight_path] = self.response.rows_mut(outputs);
            let entries = x.iter_mut().zip(z).zip(pitch).zip(flight_path);
            for ((((x, z), pitch), flight_path), column) in entries.zip(&columns) {
                *x = column[0];
                *z = column[1];
                *pitch = column[PITCH];
                *flight_path = column[STATES - 1];
            }
        }
    }

    /// Writes the price of each row.
    fn write_prices(&mut self) {
        let Self {
            response, prices, ..
        } = self;
        prices.fill(0.0);
        let (positions, attitudes, thrusts) = parts_mut(prices);
        // No control can change the rows of boundary 0.
        let stages = positions.iter_mut().skip(1).zip(attitudes).zip(thrusts);
        for (stage, ((position, attitude), thrust)) in stages.enumerate() {
            let pair = response.pair(2 * stage);
            for (price, [up, forward]) in position.iter_mut().zip(&DIRECTION_VECTORS) {
                *price = price_of(pair.norm_squared([*forward, *up]));
            }
            let pair = response.pair(ATTITUDE_OUTPUT + 2 * stage);
            let attack = price_of(pair.norm_squared([1.0, -1.0]));
            let flight_path = price_of(pair.norm_squared([0.0, 1.0]));
            *attitude = [attack, flight_path, attack, flight_path];
            let row = response.row(THRUST_OUTPUT + stage);
            *thrust = [price_of(dot(row, row)); 2];
        }
    }

    /// The condensed dynamics of every stage.
    #[must_use]
    pub fn stages(&self) -> &[Dynamics; STAGES] {
        &self.dynamics
    }

    /// Computes the feedforward of every stage for a target.
    pub(super) fn feedforward(&self, target: &StageState) -> ControlVector {
        feedback::feedforward(&self.dynamics, &self.weights, &self.feedback, target)
    }

    /// Adds the normalised controls `weight Y' c` for the pattern `c` of a row. The squared norm of a sum of such
    /// terms keeps its digits where a product with a Gram matrix would cancel them.
    pub(super) fn add_normal(&self, sum: &mut ControlVector, row: &RowPattern, weight: f64) {
        for (output, factor) in [row.first, row.second] {
            if factor != 0.0 {
                add_scaled(sum, self.response.row(output), weight * factor);
            }
        }
    }

    /// Number of controls, rounded up, that can change a row.
    pub(super) fn reach(&self, row: &RowPattern) -> usize {
        self.response
            .row(row.first.0)
            .len()
            .max(self.response.row(row.second.0).len())
    }

    /// Change of a row's left-hand side with normalised controls.
    pub(super) fn change(&self, row: &RowPattern, normalised: &ControlVector) -> f64 {
        let by = |(output, factor): (usize, f64)| {
            if factor == 0.0 {
                0.0
            } else {
                factor * dot(normalised, self.response.row(output))
            }
        };
        by(row.first) + by(row.second)
    }

    /// The positions and thrusts at normalised controls, from those without. Two rows at a time, which are equally long.
    #[inline(never)]
    pub(super) fn respond(
        &self,
        free: &[f64; OUTPUTS],
        normalised: &ControlVector,
        outputs: &mut [f64; OUTPUTS],
    ) {
        self.response.products(normalised, |output, by| {
            if let (Some(to), Some(free)) = (outputs.get_mut(output), free.get(output)) {
                *to = free + by;
            }
        });
    }

    /// Computes states and controls from the normalised controls.
    pub(super) fn roll_out(
        &self,
        initial: &StageState,
        feedforward: &ControlVector,
        normalised: &ControlVector,
        solution: &mut Solution,
    ) {
        let [first, later @ ..] = &mut solution.states;
        *first = *initial;
        let mut state: &StageState = first;
        let feedforward = feedforward.as_chunks::<2>().0.iter();
        let pushes = feedforward.zip(normalised.as_chunks::<2>().0);
        let stages = self.dynamics.iter().zip(&self.feedback).zip(pushes);
        let places = solution.controls.iter_mut().zip(later);
        for (stage, (control, next)) in stages.zip(places) {
            let ((dynamics, feedback), (feedforward, normalised)) = stage;
            *control = feedback.control(state, feedforward, normalised);
            *next = dynamics.step(state, control);
            state = next;
        }
    }

    /// Cost of a trajectory without penalties.
    pub(super) fn cost(&self, solution: &Solution, target: &StageState) -> f64 {
        let [first, second] = self.weights.control;
        let efforts = solution
            .controls
            .iter()
            .map(|u| first * (u[0] * u[0]) + second * (u[1] * u[1]));
        let missing = solution.states[KNOTS - 1]
            .iter()
            .zip(target)
            .map(|(x, goal)| (x - goal) * (x - goal));
        0.5 * (efforts.sum::<f64>() + self.weights.terminal * missing.sum::<f64>())
    }
}

impl Default for Condensed {
    fn default() -> Self {
        Self::new()
    }
}

/// Price of a row with this squared norm of its response.
fn price_of(squared: f64) -> f64 {
    if squared > UNCHANGEABLE {
        1.0 / squared
    } else {
        0.0
    }
}

/// The outputs of a trajectory.
pub(super) fn outputs(solution: &Solution) -> [f64; OUTPUTS] {
    let mut outputs = [0.0; OUTPUTS];
    let (motion, rest) = outputs.split_at_mut(THRUST_OUTPUT);
    let (thrusts, attitudes) = rest.split_at_mut(STAGES);
    let places = motion.as_chunks_mut::<2>().0.iter_mut().zip(thrusts);
    let places = places.zip(attitudes.as_chunks_mut::<2>().0);
    let stages = solution.controls.iter().zip(solution.states.iter().skip(1));
    for (((motion, thrust), attitude), (control, state)) in places.zip(stages) {
        *motion = [state[0], state[1]];
        *thrust = control[1];
        *attitude = [state[PITCH], state[STATES - 1]];
    }
    outputs
}
