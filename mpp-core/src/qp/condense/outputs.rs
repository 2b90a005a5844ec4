//! Effect of controls and inputs on states and outputs.

use super::super::Dynamics;
use super::super::dense::CONTROLS;
use super::super::rows::{ATTITUDE_OUTPUT, OUTPUTS, THRUST_OUTPUT};
use super::roll_out::{add_scaled, roll_out};
use super::{Condensed, INPUTS, States};
use crate::config::{KNOTS, STAGES};
use nalgebra::Vector6;

// Indices of the outputs in a state.
const X: usize = 0;
const Z: usize = 1;
const PITCH: usize = 3;
const PATH: usize = 5;

impl Condensed {
    /// Writes the coefficients of the outputs in the controls (`Y`) and in the inputs. At the end `states`
    /// holds the coefficients of the last state.
    pub(super) fn write_outputs(&mut self, states: &mut States) {
        let States {
            by_controls,
            by_inputs,
        } = states;
        for (index, row) in by_inputs.iter_mut().enumerate() {
            // The first six inputs are the first state.
            row[index] = 1.0;
        }
        for (stage, dynamics) in self.dynamics.iter().enumerate() {
            advance(dynamics, by_controls);
            advance(dynamics, by_inputs);
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
                    self.half_response.set_row(output, &by_controls[state]);
                    for (outputs, input) in self.outputs_by_input.iter_mut().zip(&by_inputs[state])
                    {
                        if let Some(place) = outputs.get_mut(output) {
                            *place = *input;
                        }
                    }
                }
            }
        }
        for stage in 0..STAGES {
            let row = self.half_response.row_mut(THRUST_OUTPUT + stage);
            row.fill(0.0);
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
    }

    /// Writes the optimum without rows, `u = w H^-1 G' (target - free last state)`, for each input.
    pub(super) fn write_unconstrained(&mut self, last: &mut States) {
        let States {
            by_controls: steering,
            by_inputs: free,
        } = last;
        for row in steering.iter_mut() {
            self.factor.solve(CONTROLS, row);
            self.factor.solve_transposed(row);
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
            self.add_outputs(input, missing);
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

    /// Adds the effect of an input's controls to the outputs of this input, and subtracts their effect on the
    /// last state from `missing`.
    fn add_outputs(&mut self, input: usize, missing: &mut [f64; 6]) {
        let mut states = [[0.0; 6]; KNOTS];
        let mut outputs = [0.0; OUTPUTS];
        let (still, no_offset) = ([0.0; 6], Vector6::zeros());
        let stages = self.dynamics.iter().map(|stage| (stage, &no_offset));
        let controls = &self.controls_by_input[input];
        roll_out(stages, &still, controls, &mut states, &mut outputs);
        for (sum, output) in self.outputs_by_input[input].iter_mut().zip(&outputs) {
            *sum += output;
        }
        for (missing, last) in missing.iter_mut().zip(&states[KNOTS - 1]) {
            *missing -= last;
        }
    }
}

/// `s = a s`
fn advance<const N: usize>(dynamics: &Dynamics, s: &mut [[f64; N]; 6]) {
    let mut product = [[0.0; N]; 6];
    for (row, sum) in product.iter_mut().enumerate() {
        for (col, term) in s.iter().enumerate() {
            add_scaled(sum, term, dynamics.a[(row, col)]);
        }
    }
    *s = product;
}
