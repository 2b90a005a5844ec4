//! The part of the program that all candidates of a model share: states eliminated, Hessian
//! factored, kernel of the outputs formed.

mod outputs;

use super::dense::{CONTROLS, ControlVector, Upper, dot};
use super::response::Response;
use super::rows::{OUTPUTS, ROWS, RowPattern, reach};
use super::{Dynamics, StageControl, StageModel, StageState, Weights};
use crate::config::{KNOTS, STAGES};
use crate::vehicle::{AirState, Trim};
use nalgebra::Vector6;
use outputs::{add_scaled, roll_out};

/// Rows whose `c' K c` is below this are constants but for rounding: positions follow the controls
/// two stages later.
const UNCHANGEABLE: f64 = 1e-20;

/// What a candidate without rows depends on: first state, target, and a one for the offsets.
const INPUTS: usize = 13;

/// `x_k` by controls and by inputs.
struct States {
    by_controls: [ControlVector; 6],
    by_inputs: [[f64; INPUTS]; 6],
}

/// Everything that candidates share.
#[derive(Clone, Debug)]
pub struct Condensed {
    model: StageModel,
    dynamics: [Dynamics; STAGES],
    pub(super) weights: Weights,
    /// `K = Y H^-1 Y'`.
    pub(super) kernel: [[f64; OUTPUTS]; OUTPUTS],
    /// Upper factor of `H = U U'`: from the last control to the first, as outputs come to depend on
    /// them.
    factor: Upper,
    /// `U^-1 Y'`; while condensing, `Y'`.
    half_response: Response,
    /// The optimum without rows by input: outputs and controls.
    outputs_by_input: [[f64; OUTPUTS]; INPUTS],
    controls_by_input: [ControlVector; INPUTS],
    /// Its cost is `z' M z / 2` of the inputs `z`.
    cost_by_inputs: [[f64; INPUTS]; INPUTS],
    /// The last input: 1 where the dynamics have offsets.
    constant: f64,
    /// Weight of each row's violation when the next row to enter is chosen: `(c' K c)^(-1/2)`, and 0
    /// where the controls cannot change the row. Violations count by what it takes to mend them.
    pub(super) pricing: [f64; ROWS],
    /// The same where rows are soft: `(c' K c)^(-1/4)`, which has the shorter tail there.
    pub(super) soft_pricing: [f64; ROWS],
    /// The rows of no price.
    pub(super) constant_rows: heapless::Vec<usize, ROWS>,
}

/// The Hessian is not positive definite: a weight is not positive, or the model not finite. The
/// planner does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CondenseError;

/// A candidate's optimum without rows.
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
    /// [`CondenseError`] as described there.
    pub fn condense(&mut self, model: &StageModel, weights: &Weights) -> Result<(), CondenseError> {
        self.model = *model;
        self.dynamics.fill(model.dynamics());
        self.constant = 0.0;
        self.condense_stages(weights)
    }

    /// Condenses a model of its own for each stage, which `linearise` writes in place: they are large.
    ///
    /// # Errors
    /// [`CondenseError`] as described there.
    pub fn condense_varying(
        &mut self,
        weights: &Weights,
        linearise: impl FnOnce(&mut [Dynamics; STAGES]),
    ) -> Result<(), CondenseError> {
        linearise(&mut self.dynamics);
        self.constant = 1.0;
        self.condense_stages(weights)
    }

    /// `H = R + w G'G`, its Cholesky factor, and from it kernel, responses and the optimum without
    /// rows.
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
                // As many places as rows: the push cannot fail.
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

    /// The model that was condensed, if it is the same in every stage.
    #[must_use]
    pub fn model(&self) -> &StageModel {
        &self.model
    }

    /// The plan's first state for an estimated motion: its deviation from trim, at the origin.
    #[must_use]
    pub fn initial_state(&self, trim: &Trim, estimate: &AirState) -> StageState {
        let d = estimate.to_vector() - trim.state.to_vector();
        (self.model.initial * Vector6::new(0.0, 0.0, d.x, d.y, d.z, d.w)).into()
    }

    /// The optimum without rows.
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

    /// The controls `H^-1 Y' c` that push back by `c`, multipliers by output.
    pub(super) fn push_back(&self, outputs: &[f64; OUTPUTS]) -> ControlVector {
        let mut controls = self.half_push(outputs);
        self.factor.solve_transposed(&mut controls);
        controls
    }

    /// `U^-1 Y' c`; its square is `c' K c`, without the cancellation of that.
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

    /// States and outputs under controls.
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

    /// Cost of controls that end in a state.
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
