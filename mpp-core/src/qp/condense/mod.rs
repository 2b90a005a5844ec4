//! The part of the program that all candidates of a model share. It eliminates the states, factors the
//! Hessian, and computes the kernel of the outputs.

mod outputs;
mod roll_out;

use super::dense::{CONTROLS, ControlVector, Upper, dot};
use super::response::Response;
use super::rows::{OUTPUTS, ROWS, RowPattern, reach};
use super::{Dynamics, StageControl, StageModel, StageState, Weights};
use crate::config::{KNOTS, STAGES};
use crate::vehicle::{AirState, Trim};
use core::fmt;
use nalgebra::Vector6;
use roll_out::{add_scaled, roll_out};

/// Value of `c' K c` below which a row is constant up to rounding. In the paper's model the first position
/// rows are constant, because a control changes the position only two stages later.
const UNCHANGEABLE: f64 = 1e-20;

/// Number of inputs of a program without rows: the first state, the target, and a 1 for the offsets.
const INPUTS: usize = 13;

/// Coefficients of the state `x_k` in the controls and in the inputs.
struct States {
    by_controls: [ControlVector; 6],
    by_inputs: [[f64; INPUTS]; 6],
}

/// The part of the program that all candidates of a model share.
#[derive(Clone, Debug)]
pub struct Condensed {
    model: StageModel,
    dynamics: [Dynamics; STAGES],
    pub(super) weights: Weights,
    /// `K = Y H^-1 Y'`.
    pub(super) kernel: [[f64; OUTPUTS]; OUTPUTS],
    /// Upper factor of `H = U U'`. It goes from the last control to the first, because early outputs do not
    /// depend on late controls: the solves then keep these zeros.
    factor: Upper,
    /// `U^-1 Y'`. During condensing it first holds `Y'`.
    half_response: Response,
    /// Outputs of the optimum without rows, for each input.
    outputs_by_input: [[f64; OUTPUTS]; INPUTS],
    /// Controls of the optimum without rows, for each input.
    controls_by_input: [ControlVector; INPUTS],
    /// Matrix `M` of the cost of the optimum without rows, `z' M z / 2` for the inputs `z`.
    cost_by_inputs: [[f64; INPUTS]; INPUTS],
    /// The last input: 1 if the dynamics have offsets, otherwise 0.
    constant: f64,
    /// Weight of each row's violation in the choice of the next row to enter: `(c' K c)^(-1/2)`, and 0 if the
    /// controls cannot change the row. It scales a violation by the effort of its correction.
    pub(super) pricing: [f64; ROWS],
    /// Weight of each row's violation in that choice if rows are soft: `(c' K c)^(-1/4)`. It shortens the
    /// longest solves of programs with soft rows.
    pub(super) soft_pricing: [f64; ROWS],
    /// The rows with weight 0, which the controls cannot change.
    pub(super) constant_rows: heapless::Vec<usize, ROWS>,
}

/// The Hessian is not positive definite: a weight is not positive, or the model is not finite. The
/// planner then does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CondenseError;

impl fmt::Display for CondenseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "the plan's cost has no single optimum: give the controls positive weights, and the \
             terminal state one that is not negative",
        )
    }
}

impl core::error::Error for CondenseError {}

/// The optimum of a candidate without rows.
pub(super) struct Unconstrained {
    pub(super) controls: ControlVector,
    pub(super) outputs: [f64; OUTPUTS],
    pub(super) cost: f64,
}

impl Condensed {
    /// An empty workspace.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            model: StageModel::at_rest(),
            dynamics: [Dynamics::at_rest(); STAGES],
            weights: Weights::PAPER,
            kernel: [[0.0; OUTPUTS]; OUTPUTS],
            factor: Upper::new(),
            half_response: Response::new(),
            outputs_by_input: [[0.0; OUTPUTS]; INPUTS],
            controls_by_input: [[0.0; CONTROLS]; INPUTS],
            cost_by_inputs: [[0.0; INPUTS]; INPUTS],
            constant: 0.0,
            pricing: [0.0; ROWS],
            soft_pricing: [0.0; ROWS],
            constant_rows: heapless::Vec::new(),
        }
    }

    /// Condenses a model that is the same in every stage.
    ///
    /// # Errors
    /// [`CondenseError`] if the Hessian is not positive definite.
    pub fn condense(&mut self, model: &StageModel, weights: &Weights) -> Result<(), CondenseError> {
        self.model = *model;
        self.dynamics.fill(model.dynamics());
        self.constant = 0.0;
        self.condense_stages(weights)
    }

    /// Condenses a different model for each stage. `linearise` writes the models in place, because they are
    /// large.
    ///
    /// # Errors
    /// [`CondenseError`] if the Hessian is not positive definite.
    pub fn condense_varying(
        &mut self,
        weights: &Weights,
        linearise: impl FnOnce(&mut [Dynamics; STAGES]),
    ) -> Result<(), CondenseError> {
        linearise(&mut self.dynamics);
        self.constant = 1.0;
        self.condense_stages(weights)
    }

    /// Computes `H = R + w G'G`, its Cholesky factor, and from the factor the kernel, the responses and the
    /// optimum without rows.
    fn condense_stages(&mut self, weights: &Weights) -> Result<(), CondenseError> {
        self.weights = *weights;
        let mut last = States {
            by_controls: [[0.0; CONTROLS]; 6],
            by_inputs: [[0.0; INPUTS]; 6],
        };
        self.write_outputs(&mut last);
        self.factor
            .factor(&last.by_controls, weights)
            .ok_or(CondenseError)?;

        for output in 0..OUTPUTS {
            let row = self.half_response.row_mut(output);
            self.factor.solve(reach(output), row);
        }
        for (output, row) in self.half_response.rows().enumerate() {
            let others = self.half_response.rows_within(reach(output));
            for (other, known) in others.take(output + 1).enumerate() {
                let product = dot(row, known);
                self.kernel[output % OUTPUTS][other % OUTPUTS] = product;
                self.kernel[other % OUTPUTS][output % OUTPUTS] = product;
            }
        }
        self.constant_rows.clear();
        for (row, price) in self.pricing.iter_mut().enumerate() {
            let squared = RowPattern::of(row).map_or(0.0, |row| row.norm_squared(&self.kernel));
            *price = if squared > UNCHANGEABLE {
                1.0 / libm::sqrt(squared)
            } else {
                // The list has as many places as there are rows, so the push cannot fail.
                let _ = self.constant_rows.push(row);
                0.0
            };
        }
        for (soft, price) in self.soft_pricing.iter_mut().zip(&self.pricing) {
            *soft = libm::sqrt(*price);
        }
        self.write_unconstrained(&mut last);
        Ok(())
    }

    /// The condensed dynamics of every stage.
    #[must_use]
    pub fn stages(&self) -> &[Dynamics; STAGES] {
        &self.dynamics
    }

    /// The condensed model. It is valid only if the model is the same in every stage.
    #[must_use]
    pub fn model(&self) -> &StageModel {
        &self.model
    }

    /// The plan's first state for an estimated motion: the deviation from trim, at the origin.
    #[must_use]
    pub fn initial_state(&self, trim: &Trim, estimate: &AirState) -> StageState {
        let d = estimate.to_vector() - trim.state.to_vector();
        (self.model.initial * Vector6::new(0.0, 0.0, d.x, d.y, d.z, d.w)).into()
    }

    /// Computes the optimum without rows.
    pub(super) fn unconstrained(&self, initial: &StageState, target: &StageState) -> Unconstrained {
        let mut inputs = [self.constant; INPUTS];
        for (input, value) in inputs.iter_mut().zip(initial.iter().chain(target)) {
            *input = *value;
        }
        let mut optimum = Unconstrained {
            controls: [0.0; CONTROLS],
            outputs: [0.0; OUTPUTS],
            cost: 0.0,
        };
        for (index, input) in inputs.iter().enumerate() {
            add_scaled(
                &mut optimum.controls,
                &self.controls_by_input[index],
                *input,
            );
            add_scaled(&mut optimum.outputs, &self.outputs_by_input[index], *input);
            let costs = self.cost_by_inputs[index].iter().zip(&inputs);
            optimum.cost += 0.5 * input * costs.map(|(cost, other)| cost * other).sum::<f64>();
        }
        optimum
    }

    /// The controls `H^-1 Y' c` for the multipliers `c` by output. A solution subtracts them from the optimum
    /// without rows.
    pub(super) fn push_back(&self, outputs: &[f64; OUTPUTS]) -> ControlVector {
        let mut controls = self.half_push(outputs);
        self.factor.solve_transposed(&mut controls);
        controls
    }

    /// `U^-1 Y' c`. Its squared norm is `c' K c`, without the cancellation of digits in that product.
    pub(super) fn half_push(&self, outputs: &[f64; OUTPUTS]) -> ControlVector {
        let mut half = [0.0; CONTROLS];
        for (output, factor) in outputs.iter().enumerate() {
            if *factor != 0.0 {
                add_scaled(&mut half, self.half_response.row(output), *factor);
            }
        }
        half
    }

    /// The outputs `K c` of `U^-1 Y' c`.
    pub(super) fn outputs_of_half(&self, half: &ControlVector) -> [f64; OUTPUTS] {
        let mut outputs = [0.0; OUTPUTS];
        for (output, row) in outputs.iter_mut().zip(self.half_response.rows()) {
            *output = dot(half, row);
        }
        outputs
    }

    /// Computes states and outputs under controls.
    pub(super) fn roll_out(
        &self,
        initial: &StageState,
        controls: &ControlVector,
        states: &mut [StageState; KNOTS],
        outputs: &mut [f64; OUTPUTS],
    ) {
        let stages = self.dynamics.iter();
        roll_out(
            stages.map(|stage| (stage, &stage.offset)),
            initial,
            controls,
            states,
            outputs,
        );
    }

    /// Cost of controls that lead to the last state `last`.
    pub(super) fn cost(
        &self,
        controls: &[StageControl],
        last: &StageState,
        target: &StageState,
    ) -> f64 {
        let [elevator, thrust] = self.weights.control;
        let efforts = controls
            .iter()
            .map(|u| elevator * (u[0] * u[0]) + thrust * (u[1] * u[1]));
        let missing = last
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

const _: () = assert!(INPUTS == 2 * 6 + 1);
