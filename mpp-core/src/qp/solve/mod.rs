//! One candidate's optimum by a dual active set.
//!
//! The unconstrained optimum violates rows. The most violated one *enters*: its multiplier grows,
//! and the multipliers of the active rows change so that those stay tight, until it is tight too.
//! On the way an active row's multiplier may reach zero, and the row leaves. The dual objective only
//! ever rises, which ends the search and bounds the cost from below all the time.
//!
//! A *soft* row's multiplier stops at the linear price: from there on it *yields*, that is, it is
//! violated by `s = (multiplier - linear) / quadratic`, which adds `1 / quadratic` to its diagonal
//! of the Gram matrix. When the multiplier falls back to the linear price it stiffens again.

mod step;

use super::condense::{CONTROLS, Condensed};
use super::factor::Factor;
use super::rows::{Bounds, OUTPUTS, ROWS, RowKind, RowPattern};
use super::{Problem, Solution, Status};
use crate::config::KNOTS;

/// Rows that can be active at a time: as many as controls, and some more when rows yield.
pub(super) const CAPACITY: usize = CONTROLS + 28;

/// Bound of the iterations of one solve.
pub const MAX_ITERATIONS: usize = 400;

/// A row counts as violated beyond this [m, rad or N].
const TOLERANCE: f64 = 1e-9;

/// Worst violation of a hard row in an accepted solution.
const ACCEPTED: f64 = 1e-6;

/// A row with a multiplier.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Active {
    row: usize,
    multiplier: f64,
    yielded: bool,
}

/// Workspace of the solver.
#[derive(Clone, Debug)]
pub struct Solver {
    problem: Problem,
    unconstrained: [f64; CONTROLS],
    outputs: [f64; OUTPUTS],
    active: heapless::Vec<Active, CAPACITY>,
    is_active: [bool; ROWS],
    entering: Option<Active>,
    factor: Factor,
    dual: f64,
    iterations: usize,
    status: Option<Status>,
    certificate: heapless::Vec<(usize, f64), { CAPACITY + 1 }>,
}

impl Solver {
    /// An empty workspace.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            problem: Problem {
                initial: [0.0; 6],
                target: [0.0; 6],
                bounds: Bounds::none(),
                penalty: None,
                cost_limit: f64::INFINITY,
            },
            unconstrained: [0.0; CONTROLS],
            outputs: [0.0; OUTPUTS],
            active: heapless::Vec::new(),
            is_active: [false; ROWS],
            entering: None,
            factor: Factor::new(),
            dual: 0.0,
            iterations: 0,
            status: None,
            certificate: heapless::Vec::new(),
        }
    }

    /// Takes up a problem: its optimum without rows, and the rows that no control can change.
    pub fn start(&mut self, shared: &Condensed, problem: &Problem) {
        self.problem = *problem;
        self.active.clear();
        self.is_active = [false; ROWS];
        self.entering = None;
        self.factor.clear();
        self.iterations = 0;
        self.certificate.clear();
        self.unconstrained = shared.unconstrained(&problem.initial, &problem.target);
        let mut states = [[0.0; 6]; KNOTS];
        shared.roll_out(
            &problem.initial,
            &self.unconstrained,
            &mut states,
            &mut self.outputs,
        );
        let controls = self.unconstrained.as_chunks::<2>().0;
        self.dual = shared.cost(controls, &states[KNOTS - 1], &problem.target);
        self.status = if self.dual.is_finite() && !problem.bounds.0.iter().any(|b| b.is_nan()) {
            self.check_constant_rows(shared)
        } else {
            Some(Status::NumericalFailure)
        };
    }

    /// Runs up to `iterations` steps; the status once there is one.
    pub fn advance(&mut self, shared: &Condensed, iterations: usize) -> Option<Status> {
        for _ in 0..iterations {
            if self.status.is_some() {
                break;
            }
            self.status = if self.iterations >= MAX_ITERATIONS {
                Some(Status::IterationLimit)
            } else {
                self.iterations += 1;
                self.step(shared)
            };
        }
        self.status
    }

    /// Solves to the end.
    pub fn solve(&mut self, shared: &Condensed, problem: &Problem) -> Status {
        self.start(shared, problem);
        self.advance(shared, MAX_ITERATIONS + 1)
            .unwrap_or(Status::IterationLimit)
    }

    /// Steps taken since the start.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Rows and their multipliers: at an optimum those of the active rows, at
    /// [`Status::Infeasible`] those whose sum of rows reads `0 <= negative`.
    pub fn multipliers(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let proof = self.status == Some(Status::Infeasible);
        let optimum = self
            .active
            .iter()
            .map(|active| (active.row, active.multiplier));
        let certificate = self.certificate.iter().copied();
        optimum
            .filter(move |_| !proof)
            .chain(certificate.filter(move |_| proof))
    }

    /// Writes the trajectory of the multipliers found. The status, [`Status::NumericalFailure`] if a
    /// hard row does not hold after all.
    pub fn solution(&self, shared: &Condensed, solution: &mut Solution) -> Status {
        let mut controls = self.unconstrained;
        let mut add = |(output, factor): (usize, f64)| {
            if let Some(response) = shared.response.get(output) {
                for (control, response) in controls.iter_mut().zip(response) {
                    *control -= factor * response;
                }
            }
        };
        for active in &self.active {
            if let Some(pattern) = RowPattern::of(active.row) {
                add((pattern.first.0, pattern.first.1 * active.multiplier));
                add((pattern.second.0, pattern.second.1 * active.multiplier));
            }
        }
        let mut outputs = [0.0; OUTPUTS];
        let initial = &self.problem.initial;
        shared.roll_out(initial, &controls, &mut solution.states, &mut outputs);
        for (stage, control) in solution
            .controls
            .iter_mut()
            .zip(controls.as_chunks::<2>().0)
        {
            *stage = *control;
        }
        let last = &solution.states[KNOTS - 1];
        solution.cost = shared.cost(&solution.controls, last, &self.problem.target);
        let (soft, hard) = self.worst_violations(shared, &outputs);
        solution.violation = soft.max(hard);
        match self.status {
            Some(Status::Optimal) if hard > ACCEPTED || !solution.cost.is_finite() => {
                Status::NumericalFailure
            }
            Some(status) => status,
            None => Status::IterationLimit,
        }
    }

    /// Worst violation of soft and of hard rows that controls can change.
    fn worst_violations(&self, shared: &Condensed, outputs: &[f64; OUTPUTS]) -> (f64, f64) {
        let mut worst = (0.0_f64, 0.0_f64);
        for (row, bound) in self.problem.bounds.0.iter().enumerate() {
            let changeable = shared.inverse_norm.get(row).is_some_and(|norm| *norm > 0.0);
            if changeable && let Some(pattern) = RowPattern::of(row) {
                let violation = pattern.value(outputs) - bound;
                let side = if self.is_soft(row) {
                    &mut worst.0
                } else {
                    &mut worst.1
                };
                *side = side.max(violation);
            }
        }
        worst
    }

    fn is_soft(&self, row: usize) -> bool {
        self.problem.penalty.is_some() && !matches!(RowKind::of(row), RowKind::Thrust(_))
    }

    /// Hard rows that no control can change hold, or the problem is infeasible at once.
    fn check_constant_rows(&mut self, shared: &Condensed) -> Option<Status> {
        for (row, bound) in self.problem.bounds.0.iter().enumerate() {
            if shared.inverse_norm.get(row).is_some_and(|norm| *norm > 0.0) || self.is_soft(row) {
                continue;
            }
            let value = match (RowKind::of(row), RowPattern::of(row)) {
                (RowKind::Position(0, direction), _) => {
                    let [up, forward] = crate::corridor::DIRECTION_VECTORS[direction % 8];
                    forward * self.problem.initial[0] + up * self.problem.initial[1]
                }
                (_, Some(pattern)) => pattern.value(&self.outputs),
                (_, None) => continue,
            };
            if value - bound > TOLERANCE {
                let _ = self.certificate.push((row, 1.0));
                return Some(Status::Infeasible);
            }
        }
        None
    }

    /// The row that is violated most, relative to what it takes to move it.
    fn most_violated(&self, shared: &Condensed) -> Option<usize> {
        let mut worst = None;
        let mut most = 0.0;
        let rows = self
            .problem
            .bounds
            .0
            .iter()
            .zip(&shared.inverse_norm)
            .zip(&self.is_active);
        for (row, ((bound, norm), active)) in rows.enumerate() {
            if *active || *norm == 0.0 || *bound == f64::INFINITY {
                continue;
            }
            let Some(pattern) = RowPattern::of(row) else {
                continue;
            };
            let violation = pattern.value(&self.outputs) - bound;
            if violation > TOLERANCE && violation * norm > most {
                most = violation * norm;
                worst = Some(row);
            }
        }
        worst
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self::new()
    }
}
