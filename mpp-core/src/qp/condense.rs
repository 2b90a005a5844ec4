//! The part of the program that all candidates of a model share: states eliminated, Hessian
//! factored, kernel of the outputs formed.

use super::dense::{CONTROLS, ControlVector, dot, factor, solve_transposed, solve_upper};
use super::rows::{ATTITUDE_OUTPUT, OUTPUTS, ROWS, RowPattern, THRUST_OUTPUT, reach};
use super::{Dynamics, StageControl, StageModel, StageState, Weights};
use crate::config::{KNOTS, STAGES};
use crate::vehicle::{AirState, Trim};
use nalgebra::Vector6;

/// Rows whose `c' K c` is below this are constants but for rounding: positions follow the controls
/// two stages later.
const UNCHANGEABLE: f64 = 1e-20;

/// What a candidate without rows depends on: first state, target, and a one for the offsets.
const INPUTS: usize = 13;

/// `x_k` by controls, 6 x 36, and by inputs, 6 x 13.
type Sensitivity = [ControlVector; 6];
type FreeResponse = [[f64; INPUTS]; 6];

/// Where the outputs stand in a state.
const X: usize = 0;
const Z: usize = 1;
const PITCH: usize = 3;
const PATH: usize = 5;

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
    factor: [ControlVector; CONTROLS],
    /// `U^-1 Y'`, one row an output; while condensing, `Y'`.
    half_response: [ControlVector; OUTPUTS],
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
            factor: [[0.0; CONTROLS]; CONTROLS],
            half_response: [[0.0; CONTROLS]; OUTPUTS],
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

    /// Condenses a model of its own for each stage, as linearised about a trajectory.
    ///
    /// # Errors
    /// [`CondenseError`] as described there.
    pub fn condense_varying(
        &mut self,
        dynamics: &[Dynamics; STAGES],
        weights: &Weights,
    ) -> Result<(), CondenseError> {
        self.dynamics = *dynamics;
        self.constant = 1.0;
        self.condense_stages(weights)
    }

    /// `H = R + w G'G`, its Cholesky factor, and from it kernel, responses and the optimum without
    /// rows.
    fn condense_stages(&mut self, weights: &Weights) -> Result<(), CondenseError> {
        self.weights = *weights;
        let (last, free) = self.write_outputs();
        factor(&mut self.factor, &last, weights).ok_or(CondenseError)?;

        for (output, row) in self.half_response.iter_mut().enumerate() {
            solve_upper(&self.factor, reach(output), row);
        }
        for output in 0..OUTPUTS {
            for other in 0..output + 1 {
                let len = reach(output).min(reach(other));
                let rows = [output, other]
                    .map(|row| self.half_response[row].split_at(len.min(CONTROLS)).0);
                let product = dot(rows[0], rows[1]);
                self.kernel[output][other] = product;
                self.kernel[other][output] = product;
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
        self.soft_pricing = self.pricing.map(libm::sqrt);
        self.write_unconstrained(last, &free);
        Ok(())
    }

    /// Writes the outputs by controls (`Y`) and by inputs, and gives
    /// the last state by both.
    fn write_outputs(&mut self) -> (Sensitivity, FreeResponse) {
        let mut by_controls = [[0.0; CONTROLS]; 6];
        let mut by_inputs = [[0.0; INPUTS]; 6];
        for (index, row) in by_inputs.iter_mut().enumerate() {
            // The first inputs are the first state.
            row[index] = 1.0;
        }
        for (stage, dynamics) in self.dynamics.iter().enumerate() {
            by_controls = product(dynamics, &by_controls);
            by_inputs = product(dynamics, &by_inputs);
            for index in 0..6 {
                by_inputs[index][INPUTS - 1] += dynamics.offset[index];
                let pairs = by_controls[index].as_chunks_mut::<2>().0;
                if let Some([elevator, thrust]) = pairs.get_mut(stage) {
                    *elevator += dynamics.b[(index, 0)];
                    *thrust += dynamics.b[(index, 1)];
                }
            }
            let places = [2 * stage, ATTITUDE_OUTPUT + 2 * stage];
            for (place, states) in places.into_iter().zip([[X, Z], [PITCH, PATH]]) {
                for (output, state) in (place..).zip(states) {
                    if let Some(row) = self.half_response.get_mut(output) {
                        *row = by_controls[state];
                    }
                    for (outputs, input) in self.outputs_by_input.iter_mut().zip(&by_inputs[state])
                    {
                        if let Some(place) = outputs.get_mut(output) {
                            *place = *input;
                        }
                    }
                }
            }
        }
        let thrusts = self
            .half_response
            .iter_mut()
            .skip(THRUST_OUTPUT)
            .take(STAGES);
        for (stage, row) in thrusts.enumerate() {
            *row = [0.0; CONTROLS];
            if let Some([_, thrust]) = row.as_chunks_mut::<2>().0.get_mut(stage) {
                *thrust = 1.0;
            }
        }
        for outputs in &mut self.outputs_by_input {
            outputs
                .iter_mut()
                .skip(THRUST_OUTPUT)
                .take(STAGES)
                .for_each(|thrust| *thrust = 0.0);
        }
        (by_controls, by_inputs)
    }

    /// The optimum without rows, `u = w H^-1 G' (target - free last state)`, by input.
    fn write_unconstrained(&mut self, last: [ControlVector; 6], free: &FreeResponse) {
        let linear = self.dynamics.map(|dynamics| Dynamics {
            offset: Vector6::zeros(),
            ..dynamics
        });
        let mut steering = last;
        for row in &mut steering {
            solve_upper(&self.factor, CONTROLS, row);
            solve_transposed(&self.factor, row);
        }
        let mut missing = [[0.0; 6]; INPUTS];
        for (input, missing) in missing.iter_mut().enumerate() {
            for (state, missing) in missing.iter_mut().enumerate() {
                // Inputs 6 to 11 are the target.
                let wanted = if input == state + 6 { 1.0 } else { 0.0 };
                *missing = wanted
                    - if (6..12).contains(&input) {
                        0.0
                    } else {
                        free[state][input]
                    };
            }
        }
        for (input, missing) in missing.iter_mut().enumerate() {
            let mut controls = [0.0; CONTROLS];
            for (steering, missing) in steering.iter().zip(missing.iter()) {
                add_scaled(&mut controls, steering, self.weights.terminal * missing);
            }
            self.controls_by_input[input] = controls;
            self.add_outputs(&linear, input, &controls, missing);
        }
        for (i, costs) in self.cost_by_inputs.iter_mut().enumerate() {
            for (j, cost) in costs.iter_mut().enumerate() {
                let pairs = self.controls_by_input[i].as_chunks::<2>().0.iter();
                let effort: f64 = pairs
                    .zip(self.controls_by_input[j].as_chunks::<2>().0)
                    .map(|(a, b)| {
                        self.weights.control[0] * (a[0] * b[0])
                            + self.weights.control[1] * (a[1] * b[1])
                    })
                    .sum();
                let terminal: f64 = missing[i].iter().zip(&missing[j]).map(|(a, b)| a * b).sum();
                *cost = effort + self.weights.terminal * terminal;
            }
        }
    }

    /// Adds what controls do to the outputs of an input, and takes what they do to the last state
    /// from what is missing there.
    fn add_outputs(
        &mut self,
        linear: &[Dynamics; STAGES],
        input: usize,
        controls: &ControlVector,
        missing: &mut [f64; 6],
    ) {
        let mut states = [[0.0; 6]; KNOTS];
        let mut outputs = [0.0; OUTPUTS];
        let still = [0.0; 6];
        roll_out(linear, &still, controls, &mut states, &mut outputs);
        for (sum, output) in self.outputs_by_input[input].iter_mut().zip(&outputs) {
            *sum += output;
        }
        for (missing, last) in missing.iter_mut().zip(&states[KNOTS - 1]) {
            *missing -= last;
        }
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
        solve_transposed(&self.factor, &mut controls);
        controls
    }

    /// `U^-1 Y' c`; its square is `c' K c`, without the cancellation of that.
    pub(super) fn half_push(&self, outputs: &[f64; OUTPUTS]) -> ControlVector {
        let mut half = [0.0; CONTROLS];
        for (row, factor) in self.half_response.iter().zip(outputs) {
            if *factor != 0.0 {
                add_scaled(&mut half, row, *factor);
            }
        }
        half
    }

    /// The outputs `K c` of `U^-1 Y' c`.
    pub(super) fn outputs_of_half(&self, half: &ControlVector) -> [f64; OUTPUTS] {
        self.half_response.each_ref().map(|row| dot(row, half))
    }

    /// States and outputs under controls.
    pub(super) fn roll_out(
        &self,
        initial: &StageState,
        controls: &ControlVector,
        states: &mut [StageState; KNOTS],
        outputs: &mut [f64; OUTPUTS],
    ) {
        roll_out(&self.dynamics, initial, controls, states, outputs);
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

/// `a s`
fn product<const N: usize>(dynamics: &Dynamics, s: &[[f64; N]; 6]) -> [[f64; N]; 6] {
    let mut product = [[0.0; N]; 6];
    for (row, sum) in product.iter_mut().enumerate() {
        for (col, term) in s.iter().enumerate() {
            add_scaled(sum, term, dynamics.a[(row, col)]);
        }
    }
    product
}

fn add_scaled<const N: usize>(sum: &mut [f64; N], term: &[f64; N], factor: f64) {
    for (sum, term) in sum.iter_mut().zip(term) {
        *sum += factor * term;
    }
}

fn roll_out(
    dynamics: &[Dynamics; STAGES],
    initial: &StageState,
    controls: &ControlVector,
    states: &mut [StageState; KNOTS],
    outputs: &mut [f64; OUTPUTS],
) {
    let mut state = *initial;
    let [first, later @ ..] = states;
    *first = state;
    let (motion, rest) = outputs.split_at_mut(THRUST_OUTPUT);
    let (thrusts, attitudes) = rest.split_at_mut(STAGES);
    let places = motion.as_chunks_mut::<2>().0.iter_mut().zip(thrusts);
    let places = places.zip(attitudes.as_chunks_mut::<2>().0).zip(later);
    let stages = dynamics.iter().zip(controls.as_chunks::<2>().0);
    for ((dynamics, control), (((motion, thrust), attitude), next)) in stages.zip(places) {
        state = dynamics.step(&state, control);
        *next = state;
        let [x, z, _, pitch, _, flight_path] = state;
        *motion = [x, z];
        *attitude = [pitch, flight_path];
        *thrust = control[1];
    }
}

const _: () = assert!(INPUTS == 2 * 6 + 1);
