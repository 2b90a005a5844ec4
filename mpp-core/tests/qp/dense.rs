//! Programs in the controls alone, made by rolling out one control after the other. They are dense
//! and slow, and they share nothing with the code that condenses and solves them.

use super::programs::{left_hand_side, softens};
use mpp_core::config::{KNOTS, STAGES};
use mpp_core::qp::{Dynamics, Problem, ROWS, StageControl, StageState, Weights};

/// Number of controls in the horizon.
pub(crate) const CONTROLS: usize = 2 * STAGES;
pub(crate) type Vector = [f64; CONTROLS];
pub(crate) type Stages = [Dynamics; STAGES];

/// A row without an entry above this limit is a constant.
const UNCHANGEABLE: f64 = 1e-12;

/// The row `normal . u <= bound`.
pub(crate) struct DenseRow {
    pub(crate) number: usize,
    pub(crate) normal: Vector,
    pub(crate) bound: f64,
    /// Whether a penalty softens the row.
    pub(crate) softens: bool,
}

impl DenseRow {
    pub(crate) fn excess(&self, controls: &Vector) -> f64 {
        dot(&self.normal, controls) - self.bound
    }

    pub(crate) fn is_constant(&self) -> bool {
        largest(&self.normal) < UNCHANGEABLE
    }
}

/// The program `u' hessian u / 2 + gradient . u`, without a constant, under the rows with a finite
/// bound.
pub(crate) struct DenseProgram {
    pub(crate) hessian: [Vector; CONTROLS],
    pub(crate) gradient: Vector,
    pub(crate) rows: Vec<DenseRow>,
}

impl DenseProgram {
    pub(crate) fn new(stages: &Stages, weights: &Weights, problem: &Problem) -> Self {
        let linear = stages.map(|stage| Dynamics {
            offset: Dynamics::at_rest().offset,
            ..stage
        });
        let responses: Vec<_> = (0..CONTROLS)
            .map(|index| {
                let controls = unit(index);
                (controls, roll_out(&linear, &[0.0; 6], &controls))
            })
            .collect();
        let still = [[0.0; 2]; STAGES];
        let free = roll_out(stages, &problem.initial, &still);

        let last = |index: usize| &responses[index].1[STAGES];
        let product = |a: &StageState, b: &StageState| -> f64 {
            weights.terminal * a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>()
        };
        let missing: StageState =
            core::array::from_fn(|state| free[STAGES][state] - problem.target[state]);
        let mut hessian: [Vector; CONTROLS] =
            core::array::from_fn(|row| core::array::from_fn(|col| product(last(row), last(col))));
        for index in 0..CONTROLS {
            hessian[index][index] += weights.control[index % 2];
        }
        let rows = (0..ROWS).filter(|row| problem.bounds.0[*row].is_finite());
        Self {
            hessian,
            gradient: core::array::from_fn(|index| product(last(index), &missing)),
            rows: rows
                .map(|number| DenseRow {
                    number,
                    softens: softens(problem, number),
                    normal: core::array::from_fn(|index| {
                        let (controls, states) = &responses[index];
                        left_hand_side(number, states, controls)
                    }),
                    bound: problem.bounds.0[number] - left_hand_side(number, &free, &still),
                })
                .collect(),
        }
    }

    /// Gradient of the cost.
    pub(crate) fn slope(&self, controls: &Vector) -> Vector {
        core::array::from_fn(|row| dot(&self.hessian[row], controls) + self.gradient[row])
    }
}

fn unit(index: usize) -> [StageControl; STAGES] {
    let mut controls = [[0.0; 2]; STAGES];
    controls[index / 2][index % 2] = 1.0;
    controls
}

/// Rolls out `x_{k+1} = a_k x_k + b_k u_k + offset_k`.
pub(crate) fn roll_out(
    stages: &Stages,
    initial: &StageState,
    controls: &[StageControl; STAGES],
) -> [StageState; KNOTS] {
    let mut states = [*initial; KNOTS];
    for (k, dynamics) in stages.iter().enumerate() {
        let (a, Dynamics { b, offset, .. }) = (dynamics.a(), dynamics);
        states[k + 1] = core::array::from_fn(|row| {
            let motion: f64 = (0..6).map(|col| a[(row, col)] * states[k][col]).sum();
            let steering: f64 = (0..2).map(|col| b[(row, col)] * controls[k][col]).sum();
            motion + steering + offset[row]
        });
    }
    states
}

/// Cost of controls without penalties.
pub(crate) fn cost(
    stages: &Stages,
    weights: &Weights,
    problem: &Problem,
    controls: &[StageControl; STAGES],
) -> f64 {
    let last = roll_out(stages, &problem.initial, controls)[STAGES];
    let effort: f64 = controls
        .iter()
        .map(|[e, t]| weights.control[0] * e * e + weights.control[1] * t * t)
        .sum();
    let missing: f64 = last
        .iter()
        .zip(&problem.target)
        .map(|(x, goal)| (x - goal) * (x - goal))
        .sum();
    0.5 * (effort + weights.terminal * missing)
}

pub(crate) fn flat(controls: &[StageControl; STAGES]) -> Vector {
    core::array::from_fn(|index| controls[index / 2][index % 2])
}

pub(crate) fn staged(controls: &Vector) -> [StageControl; STAGES] {
    core::array::from_fn(|stage| [controls[2 * stage], controls[2 * stage + 1]])
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Largest absolute entry.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Solves linear equations by Gauss's elimination with full pivoting. Each equation holds its
/// factors, with its right-hand side last. Returns `None` if the equations depend on each other
/// except for rounding.
pub(crate) fn solve_equations(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    const DEPENDENT: f64 = 1e-13;
    let count = rows.len();
    let mut unknowns: Vec<usize> = (0..count).collect();
    let mut scale = 0.0;
    for step in 0..count {
        let (pivot, row, col) = largest_entry(&rows, step);
        if step == 0 {
            scale = pivot;
        }
        if pivot <= DEPENDENT * scale {
            return None;
        }
        rows.swap(step, row);
        rows.iter_mut().for_each(|row| row.swap(step, col));
        unknowns.swap(step, col);
        let (done, rest) = rows.split_at_mut(step + 1);
        for row in rest {
            let factor = row[step] / done[step][step];
            for (value, above) in row.iter_mut().zip(&done[step]).skip(step) {
                *value -= factor * above;
            }
        }
    }
    let mut solution = vec![0.0; count];
    for step in (0..count).rev() {
        let known = (step + 1..count).map(|col| rows[step][col] * solution[unknowns[col]]);
        let rest = rows[step][count] - known.sum::<f64>();
        solution[unknowns[step]] = rest / rows[step][step];
    }
    Some(solution)
}

/// Largest absolute entry among rows and columns from `first` on, without right-hand sides.
fn largest_entry(rows: &[Vec<f64>], first: usize) -> (f64, usize, usize) {
    let mut found = (0.0, first, first);
    for row in first..rows.len() {
        for col in first..rows.len() {
            let size = rows[row][col].abs();
            if size > found.0 {
                found = (size, row, col);
            }
        }
    }
    found
}
