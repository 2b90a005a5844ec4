//! The part of the program that all candidates share: states eliminated, Hessian factored, kernel
//! of the outputs formed.

use super::rows::{OUTPUTS, ROWS, RowPattern, STAGE_OUTPUTS, THRUST_OUTPUT};
use super::{StageControl, StageModel, StageState, Weights};
use crate::config::{KNOTS, STAGES};
use crate::vehicle::{AirState, Trim};
use nalgebra::Vector6;

/// Controls of the whole horizon, stage by stage.
pub(super) const CONTROLS: usize = 2 * STAGES;

/// Rows whose `c' K c` is below this are constants but for rounding: positions follow the controls
/// two stages later.
const UNCHANGEABLE: f64 = 1e-20;

type ControlVector = [f64; CONTROLS];

/// Everything that candidates share.
#[derive(Clone, Debug)]
pub struct Condensed {
    pub(super) model: StageModel,
    pub(super) weights: Weights,
    /// `K = Y H^-1 Y'`.
    pub(super) kernel: [[f64; OUTPUTS]; OUTPUTS],
    /// `H^-1 Y'`, one row an output.
    pub(super) response: [ControlVector; OUTPUTS],
    /// `w H^-1 G'`, one row a state: controls per unit of missing terminal state.
    steering: [ControlVector; 6],
    /// `1 / sqrt(c' K c)` of each row; 0 where the controls cannot change the row.
    pub(super) inverse_norm: [f64; ROWS],
    /// Lower Cholesky factor of `H`: only needed while condensing.
    factor: [ControlVector; CONTROLS],
}

/// The Hessian is not positive definite: a weight is not positive, or the model not finite. The
/// planner does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CondenseError;

impl Condensed {
    /// An empty workspace.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            model: StageModel::at_rest(),
            weights: Weights::PAPER,
            kernel: [[0.0; OUTPUTS]; OUTPUTS],
            response: [[0.0; CONTROLS]; OUTPUTS],
            steering: [[0.0; CONTROLS]; 6],
            inverse_norm: [0.0; ROWS],
            factor: [[0.0; CONTROLS]; CONTROLS],
        }
    }

    /// Condenses a model: `H = R + w G'G`, its Cholesky factor, and the kernel.
    ///
    /// # Errors
    /// [`CondenseError`] as described there.
    pub fn condense(&mut self, model: &StageModel, weights: &Weights) -> Result<(), CondenseError> {
        self.model = *model;
        self.weights = *weights;
        let markov = markov_parameters(model);
        self.factor_hessian(&markov)?;

        for (state, steering) in self.steering.iter_mut().enumerate() {
            *steering = terminal_row(&markov, state);
            solve(&self.factor, steering);
            steering
                .iter_mut()
                .for_each(|value| *value *= weights.terminal);
        }
        for (output, response) in self.response.iter_mut().enumerate() {
            *response = output_row(&markov, output);
            solve(&self.factor, response);
        }
        for output in 0..OUTPUTS {
            let row = output_row(&markov, output);
            for (kernel, response) in self.kernel[output].iter_mut().zip(&self.response) {
                *kernel = dot(&row, response);
            }
        }
        for row in 0..ROWS {
            let squared = RowPattern::of(row).map_or(0.0, |row| self.between(&row, &row));
            self.inverse_norm[row] = if squared > UNCHANGEABLE {
                1.0 / libm::sqrt(squared)
            } else {
                0.0
            };
        }
        Ok(())
    }

    /// `c_i' K c_j` of two rows.
    pub(super) fn between(&self, i: &RowPattern, j: &RowPattern) -> f64 {
        let at = |output: usize, other: usize| {
            self.kernel
                .get(output)
                .and_then(|row| row.get(other))
                .copied()
                .unwrap_or(0.0)
        };
        i.first.1 * (at(i.first.0, j.first.0) * j.first.1 + at(i.first.0, j.second.0) * j.second.1)
            + i.second.1
                * (at(i.second.0, j.first.0) * j.first.1 + at(i.second.0, j.second.0) * j.second.1)
    }

    /// The model that was condensed.
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

    /// Controls of the optimum without rows.
    pub(super) fn unconstrained(&self, initial: &StageState, target: &StageState) -> ControlVector {
        let mut state = *initial;
        for _ in 0..STAGES {
            state = self.model.step(&state, &[0.0; 2]);
        }
        let mut controls = [0.0; CONTROLS];
        for (index, steering) in self.steering.iter().enumerate() {
            let missing = target[index] - state[index];
            for (control, gain) in controls.iter_mut().zip(steering) {
                *control += gain * missing;
            }
        }
        controls
    }

    /// States and outputs under controls.
    pub(super) fn roll_out(
        &self,
        initial: &StageState,
        controls: &ControlVector,
        states: &mut [StageState; KNOTS],
        outputs: &mut [f64; OUTPUTS],
    ) {
        let mut state = *initial;
        let [first, later @ ..] = states;
        *first = state;
        let (motion, thrusts) = outputs.split_at_mut(THRUST_OUTPUT);
        let motion = motion.as_chunks_mut::<{ STAGE_OUTPUTS.len() }>().0;
        let stages = later.iter_mut().zip(motion).zip(thrusts);
        for (control, ((next, motion), thrust)) in controls.as_chunks::<2>().0.iter().zip(stages) {
            state = self.model.step(&state, control);
            *next = state;
            // The STAGE_OUTPUTS.
            let [x, z, _, pitch, _, flight_path] = state;
            *motion = [x, z, pitch, flight_path];
            *thrust = control[1];
        }
    }

    /// Cost of controls that end in a state.
    pub(super) fn cost(
        &self,
        controls: &[StageControl],
        last: &StageState,
        target: &StageState,
    ) -> f64 {
        let effort: f64 = controls
            .iter()
            .map(|u| {
                self.weights.control[0] * (u[0] * u[0]) + self.weights.control[1] * (u[1] * u[1])
            })
            .sum();
        let missing: f64 = last
            .iter()
            .zip(target)
            .map(|(x, goal)| (x - goal) * (x - goal))
            .sum();
        0.5 * (effort + self.weights.terminal * missing)
    }

    fn factor_hessian(&mut self, markov: &MarkovParameters) -> Result<(), CondenseError> {
        let terminal: [ControlVector; 6] = core::array::from_fn(|row| terminal_row(markov, row));
        for row in 0..CONTROLS {
            for col in 0..row + 1 {
                let coupling: f64 = terminal.iter().map(|state| state[row] * state[col]).sum();
                let own = if row == col {
                    self.weights.control[row % 2]
                } else {
                    0.0
                };
                let mut value = own + self.weights.terminal * coupling;
                for inner in 0..col {
                    value -= self.factor[row][inner] * self.factor[col][inner];
                }
                self.factor[row][col] = if row > col {
                    value / self.factor[col][col]
                } else if value > 0.0 && value.is_finite() {
                    libm::sqrt(value)
                } else {
                    return Err(CondenseError);
                };
            }
        }
        Ok(())
    }
}

impl Default for Condensed {
    fn default() -> Self {
        Self::new()
    }
}

/// `A^i B`, `i` = 0 to N - 1: the state `i + 1` stages after a unit control.
type MarkovParameters = [[StageControl; 6]; STAGES];

fn markov_parameters(model: &StageModel) -> MarkovParameters {
    let mut power = model.b;
    core::array::from_fn(|_| {
        let rows = core::array::from_fn(|row| [power[(row, 0)], power[(row, 1)]]);
        power = model.a * power;
        rows
    })
}

/// How a state at boundary `boundary` depends on the controls.
fn state_row(markov: &MarkovParameters, boundary: usize, state: usize) -> ControlVector {
    let mut row = [0.0; CONTROLS];
    for (pair, response) in row
        .as_chunks_mut::<2>()
        .0
        .iter_mut()
        .take(boundary)
        .rev()
        .zip(markov)
    {
        *pair = response.get(state).copied().unwrap_or_default();
    }
    row
}

fn terminal_row(markov: &MarkovParameters, state: usize) -> ControlVector {
    state_row(markov, STAGES, state)
}

/// How an output depends on the controls: a row of `Y`.
fn output_row(markov: &MarkovParameters, output: usize) -> ControlVector {
    if output < THRUST_OUTPUT {
        let boundary = output / STAGE_OUTPUTS.len() + 1;
        state_row(
            markov,
            boundary,
            STAGE_OUTPUTS[output % STAGE_OUTPUTS.len()],
        )
    } else {
        let mut row = [0.0; CONTROLS];
        row[(2 * (output - THRUST_OUTPUT) + 1) % CONTROLS] = 1.0;
        row
    }
}

/// Solves `L L' x = b` in place.
fn solve(factor: &[ControlVector; CONTROLS], b: &mut ControlVector) {
    for row in 0..CONTROLS {
        let mut value = b[row];
        for col in 0..row {
            value -= factor[row][col] * b[col];
        }
        b[row] = value / factor[row][row];
    }
    for row in (0..CONTROLS).rev() {
        let mut value = b[row];
        for col in row + 1..CONTROLS {
            value -= factor[col][row] * b[col];
        }
        b[row] = value / factor[row][row];
    }
}

fn dot(a: &ControlVector, b: &ControlVector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
