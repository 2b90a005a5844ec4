//! The same programs for Clarabel, nothing eliminated: states, controls and slacks are variables,
//! the dynamics are equality rows.

use crate::instances::{Instance, Preset};
use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus};
use mpp_core::config::{KNOTS, STAGES};
use mpp_core::corridor::DIRECTION_VECTORS;
use mpp_core::qp::{Penalty, Solution};

const X: usize = 0;
const Z: usize = 1;
const PITCH: usize = 3;
const FLIGHT_PATH: usize = 5;
const CONTROLS_START: usize = 6 * KNOTS;
const VARIABLES: usize = CONTROLS_START + 2 * STAGES;

fn state(knot: usize, index: usize) -> usize {
    6 * knot + index
}

fn control(stage: usize, index: usize) -> usize {
    CONTROLS_START + 2 * stage + index
}

/// `sum of factor * variable <= bound`.
pub(crate) struct Row {
    terms: Vec<(usize, f64)>,
    bound: f64,
    /// Whether a penalty softens it.
    softens: bool,
    /// Positions of boundaries 0 and 1 follow from the first state alone.
    constant: bool,
}

impl Row {
    fn left_hand_side(&self, variables: &[f64]) -> f64 {
        self.terms
            .iter()
            .map(|(variable, factor)| factor * variables[*variable])
            .sum()
    }
}

/// Every finite inequality of a program.
pub(crate) fn rows(instance: &Instance) -> Vec<Row> {
    let mut rows = Vec::new();
    for knot in 0..KNOTS {
        for (direction, [up, forward]) in DIRECTION_VECTORS.iter().enumerate() {
            rows.push(Row {
                terms: vec![(state(knot, Z), *up), (state(knot, X), *forward)],
                bound: instance.corridor.bounds[knot][direction],
                softens: true,
                constant: knot < 2,
            });
        }
    }
    for knot in 1..KNOTS {
        let Some((upper, lower)) = instance.attitude else {
            break;
        };
        let angle_of_attack = vec![(state(knot, PITCH), 1.0), (state(knot, FLIGHT_PATH), -1.0)];
        let flight_path = vec![(state(knot, FLIGHT_PATH), 1.0)];
        for (which, terms) in [angle_of_attack, flight_path].into_iter().enumerate() {
            for (sign, bound) in [(1.0, upper[which]), (-1.0, -lower[which])] {
                rows.push(Row {
                    terms: terms
                        .iter()
                        .map(|(variable, factor)| (*variable, sign * factor))
                        .collect(),
                    bound,
                    softens: true,
                    constant: false,
                });
            }
        }
    }
    for stage in 0..STAGES {
        rows.push(Row {
            terms: vec![(control(stage, 1), -1.0)],
            bound: instance.thrust_reserve,
            softens: false,
            constant: false,
        });
    }
    rows.retain(|row| row.bound.is_finite());
    rows
}

/// A sparse matrix under construction, with its right-hand side.
#[derive(Default)]
struct Rows {
    row: Vec<usize>,
    col: Vec<usize>,
    value: Vec<f64>,
    right: Vec<f64>,
}

impl Rows {
    fn push(&mut self, terms: &[(usize, f64)], right: f64) {
        for (variable, factor) in terms {
            self.row.push(self.right.len());
            self.col.push(*variable);
            self.value.push(*factor);
        }
        self.right.push(right);
    }

    /// `x_0` given, and `a x_k + b u_k - x_{k+1} = 0`.
    fn push_dynamics(&mut self, preset: &Preset, instance: &Instance) {
        for index in 0..6 {
            self.push(&[(state(0, index), 1.0)], instance.initial[index]);
        }
        for stage in 0..STAGES {
            for index in 0..6 {
                let mut terms = vec![(state(stage + 1, index), -1.0)];
                terms.extend((0..6).map(|col| (state(stage, col), preset.model.a[(index, col)])));
                terms.extend((0..2).map(|col| (control(stage, col), preset.model.b[(index, col)])));
                self.push(&terms, 0.0);
            }
        }
    }
}

/// Diagonal and linear part of the cost, and its constant.
fn tracking_cost(preset: &Preset, instance: &Instance) -> (Vec<f64>, Vec<f64>, f64) {
    let weights = &preset.settings.planner.weights;
    let (mut diagonal, mut linear) = (vec![0.0; VARIABLES], vec![0.0; VARIABLES]);
    let mut constant = 0.0;
    for stage in 0..STAGES {
        for index in 0..2 {
            diagonal[control(stage, index)] = weights.control[index];
        }
    }
    for (index, target) in instance.target.iter().enumerate() {
        diagonal[state(STAGES, index)] = weights.terminal;
        linear[state(STAGES, index)] = -weights.terminal * target;
        constant += 0.5 * weights.terminal * target * target;
    }
    (diagonal, linear, constant)
}

/// What Clarabel says.
pub(crate) struct Answer {
    pub(crate) status: SolverStatus,
    pub(crate) cost: f64,
}

fn ask(diagonal: &[f64], linear: &[f64], equalities: &Rows, inequalities: &Rows) -> Answer {
    let variables = diagonal.len();
    let all: Vec<usize> = (0..variables).collect();
    let quadratic =
        CscMatrix::new_from_triplets(variables, variables, all.clone(), all, diagonal.to_vec());
    let equal = equalities.right.len();
    let offset = inequalities.row.iter().map(|row| row + equal);
    let matrix = CscMatrix::new_from_triplets(
        equal + inequalities.right.len(),
        variables,
        equalities.row.iter().copied().chain(offset).collect(),
        [equalities.col.as_slice(), &inequalities.col].concat(),
        [equalities.value.as_slice(), &inequalities.value].concat(),
    );
    let right = [equalities.right.as_slice(), &inequalities.right].concat();
    let cones = [ZeroConeT(equal), NonnegativeConeT(inequalities.right.len())];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .build()
        .unwrap();
    let mut solver =
        DefaultSolver::new(&quadratic, linear, &matrix, &right, &cones, settings).unwrap();
    solver.solve();
    Answer {
        status: solver.solution.status,
        cost: solver.solution.obj_val,
    }
}

/// The program with hard rows.
pub(crate) fn solve_hard(preset: &Preset, instance: &Instance) -> Answer {
    let (diagonal, linear, constant) = tracking_cost(preset, instance);
    let (mut equalities, mut inequalities) = (Rows::default(), Rows::default());
    equalities.push_dynamics(preset, instance);
    for row in rows(instance) {
        inequalities.push(&row.terms, row.bound);
    }
    let answer = ask(&diagonal, &linear, &equalities, &inequalities);
    Answer {
        cost: answer.cost + constant,
        ..answer
    }
}

/// The program with a slack for each soft row that the controls can change.
pub(crate) fn solve_soft(preset: &Preset, instance: &Instance, penalty: &Penalty) -> Answer {
    let (mut diagonal, mut linear, constant) = tracking_cost(preset, instance);
    let (mut equalities, mut inequalities) = (Rows::default(), Rows::default());
    equalities.push_dynamics(preset, instance);
    for mut row in rows(instance).into_iter().filter(|row| !row.constant) {
        if row.softens {
            let slack = diagonal.len();
            diagonal.push(penalty.quadratic);
            linear.push(penalty.linear);
            row.terms.push((slack, -1.0));
            inequalities.push(&[(slack, -1.0)], 0.0);
        }
        inequalities.push(&row.terms, row.bound);
    }
    let answer = ask(&diagonal, &linear, &equalities, &inequalities);
    Answer {
        cost: answer.cost + constant,
        ..answer
    }
}

/// The least `t` [m, rad, N] for which all rows, relaxed by `t`, can hold: negative
/// where the program has room, positive where rows contradict each other.
pub(crate) fn margin(preset: &Preset, instance: &Instance) -> f64 {
    let relaxed = VARIABLES;
    let (mut equalities, mut inequalities) = (Rows::default(), Rows::default());
    equalities.push_dynamics(preset, instance);
    for mut row in rows(instance) {
        row.terms.push((relaxed, -1.0));
        inequalities.push(&row.terms, row.bound);
    }
    let mut linear = vec![0.0; VARIABLES + 1];
    linear[relaxed] = 1.0;
    let answer = ask(
        &vec![0.0; VARIABLES + 1],
        &linear,
        &equalities,
        &inequalities,
    );
    assert_eq!(
        answer.status,
        SolverStatus::Solved,
        "the relaxed program always has an optimum"
    );
    answer.cost
}

fn variables(solution: &Solution) -> Vec<f64> {
    let states = solution.states.iter().flatten();
    states
        .chain(solution.controls.iter().flatten())
        .copied()
        .collect()
}

/// Worst violation of any row by a solution.
pub(crate) fn worst_violation(instance: &Instance, solution: &Solution) -> f64 {
    let variables = variables(solution);
    rows(instance)
        .iter()
        .map(|row| row.left_hand_side(&variables) - row.bound)
        .fold(0.0, f64::max)
}

/// Cost of a solution with the price of what it violates, and its worst violation of a hard row.
pub(crate) fn priced(
    preset: &Preset,
    instance: &Instance,
    solution: &Solution,
    penalty: &Penalty,
) -> (f64, f64) {
    let variables = variables(solution);
    let (diagonal, linear, mut cost) = tracking_cost(preset, instance);
    for ((value, diagonal), linear) in variables.iter().zip(&diagonal).zip(&linear) {
        cost += 0.5 * diagonal * value * value + linear * value;
    }
    let mut hard = 0.0_f64;
    for row in rows(instance).iter().filter(|row| !row.constant) {
        let slack = (row.left_hand_side(&variables) - row.bound).max(0.0);
        if row.softens {
            cost += penalty.linear * slack + 0.5 * penalty.quadratic * slack * slack;
        } else {
            hard = hard.max(slack);
        }
    }
    (cost, hard)
}
