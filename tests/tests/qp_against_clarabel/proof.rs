//! Checks the solver's proof that a program has no solution, with the model alone.

use mpp_core::config::{KNOTS, STAGES};
use mpp_core::corridor::DIRECTION_VECTORS;
use mpp_core::paper::StageModel;
use mpp_core::qp::{Problem, RowKind, Solver, StageControl, StageState};

/// The terms `(knot or stage, index, factor)` of the states or of the controls in a row.
enum Terms {
    States(usize, Vec<(usize, f64)>),
    Thrust(usize, f64),
}

fn terms(row: usize) -> Terms {
    match RowKind::of(row) {
        RowKind::Position(knot, direction) => {
            let [up, forward] = DIRECTION_VECTORS[direction];
            Terms::States(knot, vec![(1, up), (0, forward)])
        }
        RowKind::Attitude(knot, which) => {
            let side = if which < 2 { 1.0 } else { -1.0 };
            let angle_of_attack = vec![(3, side), (5, -side)];
            let flight_path = vec![(5, side)];
            Terms::States(
                knot,
                if which % 2 == 0 {
                    angle_of_attack
                } else {
                    flight_path
                },
            )
        }
        RowKind::Thrust(stage, side) => Terms::Thrust(stage, if side == 0 { 1.0 } else { -1.0 }),
    }
}

fn roll_out(
    model: &StageModel,
    initial: &StageState,
    controls: &[StageControl; STAGES],
) -> [StageState; KNOTS] {
    let mut states = [*initial; KNOTS];
    for stage in 0..STAGES {
        states[stage + 1] = model.step(&states[stage], &controls[stage]);
    }
    states
}

/// A row's left-hand side for given controls.
fn value(
    model: &StageModel,
    initial: &StageState,
    controls: &[StageControl; STAGES],
    row: usize,
) -> f64 {
    match terms(row) {
        Terms::States(knot, terms) => {
            let states = roll_out(model, initial, controls);
            terms
                .iter()
                .map(|(index, factor)| factor * states[knot][*index])
                .sum()
        }
        Terms::Thrust(stage, side) => side * controls[stage][1],
    }
}

/// A row's gradient with respect to all controls.
fn gradient(model: &StageModel, row: usize) -> Vec<f64> {
    (0..2 * STAGES)
        .map(|index| {
            let mut controls = [[0.0; 2]; STAGES];
            controls[index / 2][index % 2] = 1.0;
            value(model, &[0.0; 6], &controls, row)
        })
        .collect()
}

/// The weighted sum of rows: `gradient . u <= right`.
pub(crate) struct Sum {
    /// Least weight.
    pub(crate) least_weight: f64,
    /// Largest entry of the gradient, relative to the sum of the weighted rows without signs.
    pub(crate) gradient: f64,
    /// Right-hand side.
    pub(crate) right: f64,
    /// Size that controls would need, as the sum of their absolute values, to satisfy the sum.
    pub(crate) escape: f64,
}

/// Adds up the rows of the solver's proof.
pub(crate) fn add_up(model: &StageModel, problem: &Problem, solver: &Solver) -> Sum {
    let mut sum = vec![0.0; 2 * STAGES];
    let mut absolute = 0.0_f64;
    let (mut right, mut least_weight) = (0.0, f64::INFINITY);
    for (row, weight) in solver.multipliers() {
        least_weight = weight.min(least_weight);
        let gradient = gradient(model, row);
        for (sum, entry) in sum.iter_mut().zip(&gradient) {
            *sum += weight * entry;
        }
        absolute += weight
            * gradient
                .iter()
                .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let free = value(model, &problem.initial, &[[0.0; 2]; STAGES], row);
        right += weight * (problem.bounds.0[row] - free);
    }
    let largest = sum
        .iter()
        .fold(0.0_f64, |most, entry| most.max(entry.abs()));
    Sum {
        least_weight,
        gradient: if absolute > 0.0 {
            largest / absolute
        } else {
            0.0
        },
        right,
        escape: if largest > 0.0 {
            -right / largest
        } else {
            f64::INFINITY
        },
    }
}
