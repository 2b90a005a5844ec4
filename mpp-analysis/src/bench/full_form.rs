//! A program in full form, as general solvers take it. States and controls (and slacks) are
//! variables, and the dynamics are equality rows; nothing is eliminated.

use crate::instance::Instance;
use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, SolverError};
use mpp_core::config::{KNOTS, STAGES};
use mpp_core::qp::Solution;

const X: usize = 0;
const Z: usize = 1;
const PITCH: usize = 3;
const FLIGHT_PATH: usize = 5;
const CONTROLS_START: usize = 6 * KNOTS;
/// Variables without slacks: the states, then the controls.
pub(super) const VARIABLES: usize = CONTROLS_START + 2 * STAGES;

fn state(knot: usize, index: usize) -> usize {
    6 * knot + index
}

fn control(stage: usize, index: usize) -> usize {
    CONTROLS_START + 2 * stage + index
}

/// The question about a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The program's optimum. Soft rows get slacks, and soft rows that no control can change are
    /// left out.
    Optimum,
    /// The least `t` [m, rad, N] by which all rows must be relaxed to hold. It is negative where
    /// there is room and positive where rows contradict each other.
    Margin,
}

/// `sum of factor * variable <= bound`.
#[derive(Clone)]
struct Row {
    terms: Vec<(usize, f64)>,
    bound: f64,
    softens: bool,
    constant: bool,
}

/// Sparse rows under construction.
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
}

/// The program for a general conic solver: `min x'Px/2 + q'x, A x + s = b`, first equalities, then
/// inequalities.
pub struct FullForm {
    quadratic: CscMatrix<f64>,
    linear: Vec<f64>,
    matrix: CscMatrix<f64>,
    right: Vec<f64>,
    equalities: usize,
    /// Rows by which a solution is judged.
    rows: Vec<Row>,
    penalty: Option<[f64; 2]>,
    /// Part of the cost that the objective leaves out.
    pub constant: f64,
}

impl FullForm {
    /// Writes a program in full form.
    #[must_use]
    pub fn new(instance: &Instance, form: Form) -> Self {
        let (mut diagonal, mut linear, constant) = cost(instance, form);
        let mut rows = Rows::default();
        push_dynamics(&mut rows, instance);
        let equalities = rows.right.len();
        let judged = inequalities(instance);
        for row in &judged {
            let mut row = row.clone();
            match (form, instance.penalty) {
                (Form::Margin, _) => row.terms.push((VARIABLES, -1.0)),
                (Form::Optimum, Some(_)) if row.constant => continue,
                (Form::Optimum, Some([price, curvature])) if row.softens => {
                    let slack = diagonal.len();
                    diagonal.push(curvature);
                    linear.push(price);
                    row.terms.push((slack, -1.0));
                    rows.push(&[(slack, -1.0)], 0.0);
                }
                (Form::Optimum, _) => {}
            }
            rows.push(&row.terms, row.bound);
        }
        let variables = diagonal.len();
        let all: Vec<usize> = (0..variables).collect();
        Self {
            quadratic: CscMatrix::new_from_triplets(
                variables,
                variables,
                all.clone(),
                all,
                diagonal,
            ),
            linear,
            matrix: CscMatrix::new_from_triplets(
                rows.right.len(),
                variables,
                rows.row,
                rows.col,
                rows.value,
            ),
            right: rows.right,
            equalities,
            rows: judged,
            penalty: instance.penalty,
            constant,
        }
    }

    /// A Clarabel solver for the program. It is set up and ready, with Clarabel's own default
    /// settings.
    ///
    /// # Errors
    /// [`SolverError`] when Clarabel finds the data inconsistent.
    pub fn clarabel(&self) -> Result<DefaultSolver<f64>, SolverError> {
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .build()
            .unwrap_or_default();
        let inequalities = self.right.len() - self.equalities;
        let cones = [ZeroConeT(self.equalities), NonnegativeConeT(inequalities)];
        DefaultSolver::new(
            &self.quadratic,
            &self.linear,
            &self.matrix,
            &self.right,
            &cones,
            settings,
        )
    }
}

impl FullForm {
    /// Cost of one of our solutions, with penalties, and its worst row error.
    #[must_use]
    pub fn evaluate(&self, solution: &Solution) -> (f64, f64) {
        let states = solution.states.iter().flatten();
        let variables: Vec<f64> = states
            .chain(solution.controls.iter().flatten())
            .copied()
            .collect();
        let mut cost = solution.cost;
        if let Some([linear, quadratic]) = self.penalty {
            for row in self.rows.iter().filter(|row| row.softens && !row.constant) {
                let slack = row.excess(&variables).max(0.0);
                cost += linear * slack + 0.5 * quadratic * slack * slack;
            }
        }
        (cost, self.row_error(&variables))
    }

    /// Worst violation of a hard row by a solution's variables, without slacks.
    #[must_use]
    pub fn row_error(&self, variables: &[f64]) -> f64 {
        let hard = self
            .rows
            .iter()
            .filter(|row| self.penalty.is_none() || !row.softens);
        hard.map(|row| row.excess(variables)).fold(0.0, f64::max)
    }
}

impl Row {
    fn excess(&self, variables: &[f64]) -> f64 {
        let value: f64 = self
            .terms
            .iter()
            .map(|(at, factor)| factor * variables[*at])
            .sum();
        value - self.bound
    }
}

/// Diagonal and linear part of the cost, and its constant.
fn cost(instance: &Instance, form: Form) -> (Vec<f64>, Vec<f64>, f64) {
    if form == Form::Margin {
        let mut linear = vec![0.0; VARIABLES + 1];
        linear[VARIABLES] = 1.0;
        return (vec![0.0; VARIABLES + 1], linear, 0.0);
    }
    let (mut diagonal, mut linear) = (vec![0.0; VARIABLES], vec![0.0; VARIABLES]);
    let mut constant = 0.0;
    for stage in 0..STAGES {
        for (index, weight) in instance.control_weight.iter().enumerate() {
            diagonal[control(stage, index)] = *weight;
        }
    }
    for (index, target) in instance.target.iter().enumerate() {
        diagonal[state(STAGES, index)] = instance.terminal_weight;
        linear[state(STAGES, index)] = -instance.terminal_weight * target;
        constant += 0.5 * instance.terminal_weight * target * target;
    }
    (diagonal, linear, constant)
}

/// Adds the rows of the given `x_0`, and of `a x_k + b u_k - x_{k+1} = -offset`.
fn push_dynamics(rows: &mut Rows, instance: &Instance) {
    for (index, initial) in instance.initial.iter().enumerate() {
        rows.push(&[(state(0, index), 1.0)], *initial);
    }
    for stage in 0..STAGES {
        let at = instance.place(stage);
        for index in 0..6 {
            let mut terms = vec![(state(stage + 1, index), -1.0)];
            terms.extend((0..6).map(|col| (state(stage, col), instance.a[at][index][col])));
            terms.extend((0..2).map(|col| (control(stage, col), instance.b[at][index][col])));
            rows.push(&terms, -instance.offset[at][index]);
        }
    }
}

fn inequalities(instance: &Instance) -> Vec<Row> {
    let mut rows = Vec::new();
    let moves = |row: usize| instance.b[0][row].iter().any(|gain| gain.abs() > 0.0);
    let first_moves = moves(X) || moves(Z);
    for (knot, bounds) in instance.position_bounds.iter().enumerate() {
        for ([forward, up], bound) in instance.directions.iter().zip(bounds) {
            rows.push(Row {
                terms: vec![(state(knot, X), *forward), (state(knot, Z), *up)],
                bound: *bound,
                softens: true,
                // The first position is given, and the second one may follow from the first state alone.
                constant: knot == 0 || knot == 1 && !first_moves,
            });
        }
    }
    if let Some([upper, lower]) = instance.attitude {
        for knot in 1..KNOTS {
            let path = state(knot, FLIGHT_PATH);
            let angle_of_attack = vec![(state(knot, PITCH), 1.0), (path, -1.0)];
            for (which, terms) in [angle_of_attack, vec![(path, 1.0)]].into_iter().enumerate() {
                let [hard_up, hard_down] = instance.hard_angle_of_attack;
                let sides = [
                    (1.0, upper[which], hard_up),
                    (-1.0, -lower[which], hard_down),
                ];
                for (sign, bound, hard) in sides {
                    rows.push(Row {
                        terms: terms
                            .iter()
                            .map(|(at, factor)| (*at, sign * factor))
                            .collect(),
                        bound,
                        softens: which == 1 || !hard,
                        constant: false,
                    });
                }
            }
        }
    }
    let rise = instance.thrust_rise.unwrap_or(f64::INFINITY);
    for stage in 0..STAGES {
        for (sign, bound) in [(1.0, rise), (-1.0, instance.thrust_reserve)] {
            rows.push(Row {
                terms: vec![(control(stage, 1), sign)],
                bound,
                softens: false,
                constant: false,
            });
        }
    }
    rows.retain(|row| row.bound.is_finite());
    rows
}
