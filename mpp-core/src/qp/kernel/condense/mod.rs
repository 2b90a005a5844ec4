//! The part of the program that all candidates of a model share. It eliminates the states: under the feedback
//! that is optimal without rows, the outputs follow from normalised controls whose Hessian is the identity.

mod feedback;

use super::super::layout::{OUTPUTS, input_outputs, state_outputs};
use super::super::outputs::{respond, write_prices};
use super::super::rows::{NO_NORMALS, Normals, pattern};
use super::super::{INPUTS, ROWS, STATES, StageControl, StageState};
use super::controls::{ControlVector, add_scaled, dot};
use super::{Dynamics, Response, RowPattern, Solution, Weights};
use crate::config::{KNOTS, STAGES};
use crate::qp::CondenseError;
use feedback::Feedback;
use nalgebra::{RowSVector, SMatrix, SVector};

/// The part of the program that all candidates of a model share.
#[derive(Clone, Debug)]
pub struct Condensed {
    dynamics: [Dynamics; STAGES],
    pub(super) weights: Weights,
    feedback: [Feedback; STAGES],
    /// Response of the outputs to the normalised controls.
    pub(in crate::qp) response: Response,
    /// The normals of the faces, which the programs of some shapes bring themselves.
    pub(in crate::qp) normals: Normals,
    /// Price of each row: `1 / |y|^2` for the row's response `y`, and 0 if the controls cannot change the row. A
    /// violation `s` takes a cost of `s^2 / 2` times the price to correct.
    pub(in crate::qp) prices: [f64; ROWS],
}

impl Condensed {
    /// An empty workspace. All of it is zero, so that whoever needs a new one writes zeros in place.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            dynamics: [Dynamics::at_rest(); STAGES],
            weights: Weights::NONE,
            feedback: [Feedback::none(); STAGES],
            response: Response::new(),
            normals: NO_NORMALS,
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
        self.linearise(linearise);
        self.condense_stages(weights)
    }

    fn condense_stages(&mut self, weights: &Weights) -> Result<(), CondenseError> {
        self.design(weights)?;
        self.respond_to_controls();
        Ok(())
    }

    /// Writes models in place. All of them written, [`design`](Self::design) is the next part of condensing.
    pub fn linearise(&mut self, write: impl FnOnce(&mut [Dynamics; STAGES])) {
        write(&mut self.dynamics);
    }

    /// Computes the feedback of the models. Then comes [`respond_to_controls`](Self::respond_to_controls), the last part.
    ///
    /// # Errors
    /// [`CondenseError`] if the cost has no single optimum.
    pub fn design(&mut self, weights: &Weights) -> Result<(), CondenseError> {
        self.weights = *weights;
        feedback::design(&self.dynamics, weights, &mut self.feedback).ok_or(CondenseError)
    }

    /// Writes responses and prices.
    pub fn respond_to_controls(&mut self) {
        self.write_response();
        write_prices(&self.response, &self.normals, &mut self.prices);
    }

    /// Writes the response of the outputs to the normalised controls. It follows the response of the state
    /// from stage to stage, with a column for each control so far. The entries that fill up a row stay zero.
    // Not inlined, so that its columns do not lie on the stack beneath the design of the feedback.
    #[inline(never)]
    fn write_response(&mut self) {
        let mut columns = [[SVector::zeros(); INPUTS]; STAGES];
        let stages = self.dynamics.iter().zip(&self.feedback).enumerate();
        for (stage, (dynamics, feedback)) in stages {
            let closed = feedback.closed(dynamics);
            let inputs = input_outputs(stage);
            let rows = self.response.rows_mut(inputs.map(|(output, _)| output));
            let mut rows = rows.map(|row| row.as_chunks_mut::<INPUTS>().0.iter_mut());
            let gains = inputs.map(|(_, input)| {
                RowSVector::<f64, STATES>::from_fn(|_, state| at(&feedback.gain, input, state))
            });
            for columns in columns.iter_mut().take(stage) {
                for (row, gain) in rows.iter_mut().zip(&gains) {
                    if let Some(entries) = row.next() {
                        *entries = columns.each_ref().map(|column| -(gain * column).x);
                    }
                }
                for column in columns {
                    *column = closed * *column;
                }
            }
            for (row, (_, input)) in rows.iter_mut().zip(inputs) {
                if let Some(entries) = row.next() {
                    *entries = core::array::from_fn(|column| at(&feedback.scale, input, column));
                }
            }
            let own = dynamics.b * feedback.scale;
            if let Some(columns) = columns.get_mut(stage) {
                for (column, own) in columns.iter_mut().zip(own.column_iter()) {
                    *column = own.into_owned();
                }
            }
            let states = state_outputs(stage);
            let rows = self.response.rows_mut(states.map(|(output, _)| output));
            let mut rows = rows.map(|row| row.as_chunks_mut::<INPUTS>().0.iter_mut());
            for columns in columns.iter().take(stage + 1) {
                for (row, (_, state)) in rows.iter_mut().zip(states) {
                    if let Some(entries) = row.next() {
                        *entries = columns.each_ref().map(|column| at(column, state, 0));
                    }
                }
            }
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
        for (output, factor) in row.0 {
            if factor != 0.0 {
                add_scaled(sum, self.response.row(output), weight * factor);
            }
        }
    }

    /// Number of controls, rounded up, that can change a row.
    pub(super) fn reach(&self, row: &RowPattern) -> usize {
        let lengths = row.0.map(|(output, _)| self.response.row(output).len());
        lengths.into_iter().fold(0, usize::max)
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
        let [first, rest @ ..] = row.0.map(by);
        rest.iter().fold(first, |sum, term| sum + term)
    }

    /// The pattern of a row. It is `None` for a row that no control can change.
    pub(super) fn pattern(&self, row: usize) -> Option<RowPattern> {
        pattern(row, &self.normals)
    }

    /// The outputs that rows bound at normalised controls, from those without.
    pub(super) fn respond(
        &self,
        free: &[f64; OUTPUTS],
        normalised: &ControlVector,
        outputs: &mut [f64; OUTPUTS],
    ) {
        respond(&self.response, free, normalised, outputs);
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
        let feedforward = feedforward.as_chunks::<INPUTS>().0.iter();
        let pushes = feedforward.zip(normalised.as_chunks::<INPUTS>().0);
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
        let effort = |u: &StageControl| {
            let terms = self.weights.control.iter().zip(u);
            terms.map(|(weight, u)| weight * (u * u)).sum::<f64>()
        };
        let efforts = solution.controls.iter().map(effort);
        let miss = self.weights.miss(&solution.states[KNOTS - 1], target);
        0.5 * (efforts.sum::<f64>() + miss)
    }
}

/// An entry of a matrix; 0 outside of it. An index would have a panic path.
fn at<const R: usize, const C: usize>(
    matrix: &SMatrix<f64, R, C>,
    row: usize,
    column: usize,
) -> f64 {
    matrix.get((row, column)).copied().unwrap_or(0.0)
}
