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

mod contradiction;
mod step;

use super::condense::Condensed;
use super::dense::CONTROLS;
use super::factor::Factor;
use super::rows::{Bounds, OUTPUTS, RowKind, RowPattern, excesses, split_soft};
use super::{Problem, Solution, Status};
use crate::config::KNOTS;

/// Rows that can be active at a time: as many as controls, and some more when rows yield.
pub(super) const CAPACITY: usize = CONTROLS + 28;

/// Bound of the iterations of one solve.
pub const MAX_ITERATIONS: usize = 400;

/// A row counts as violated beyond this [m, rad or N].
const TOLERANCE: f64 = 1e-9;

/// Opposite faces that cross by less than this [m] are left to the method: the directions are
/// opposite to 1e-8 only.
const CROSSING: f64 = 1e-5;

/// Worst violation of a hard row in an accepted solution.
const ACCEPTED: f64 = 1e-6;

/// Rows contradict each other where keeping them costs as much as missing the target by this [m] and
/// this many times the optimum without rows.
const ABSURD_MISS: f64 = 1000.0;
const ABSURD_FACTOR: f64 = 1e3;

/// A row with a multiplier.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Active {
    row: usize,
    pattern: RowPattern,
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
    /// The bounds of rows that may enter, with their tolerance; infinite for those that are active.
    open: Bounds,
    /// Whether the program has attitude rows; without, their outputs are not followed.
    attitude_rows: bool,
    entering: Option<Active>,
    factor: Factor,
    dual: f64,
    /// The rise of the cost above the optimum without rows that no flight is worth; infinite where
    /// rows are soft, which every flight keeps.
    absurd_rise: f64,
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
            open: Bounds::none(),
            attitude_rows: false,
            entering: None,
            factor: Factor::new(),
            dual: 0.0,
            absurd_rise: 0.0,
            iterations: 0,
            status: None,
            certificate: heapless::Vec::new(),
        }
    }

    /// Takes up a problem: its optimum without rows, and the rows that no control can change.
    pub fn start(&mut self, shared: &Condensed, problem: &Problem) {
        self.problem = *problem;
        self.active.clear();
        let rows = problem.bounds.0.iter().zip(&shared.pricing);
        let mut numbers = true;
        for (open, (bound, price)) in self.open.0.iter_mut().zip(rows) {
            numbers &= !bound.is_nan();
            // An infinite bound times no weight would not be a number.
            *open = if *price > 0.0 { bound + TOLERANCE } else { 0.0 };
        }
        self.attitude_rows = problem.bounds.has_attitude();
        self.entering = None;
        self.factor.clear();
        self.iterations = 0;
        self.certificate.clear();
        let optimum = shared.unconstrained(&problem.initial, &problem.target);
        self.unconstrained = optimum.controls;
        self.outputs = optimum.outputs;
        self.dual = optimum.cost;
        self.absurd_rise = if problem.penalty.is_some() {
            f64::INFINITY
        } else {
            0.5 * shared.weights.terminal * ABSURD_MISS * ABSURD_MISS + ABSURD_FACTOR * optimum.cost
        };
        self.status = if self.dual.is_finite() && numbers {
            self.check_constant_rows(shared)
                .or_else(|| self.check_opposite_faces())
                .or_else(|| (self.dual > problem.cost_limit).then_some(Status::Dominated))
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
    /// [`Status::Infeasible`] those whose sum of rows reads `0 <= negative`, for all controls but
    /// absurdly expensive ones.
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
        let mut pushes = [0.0; OUTPUTS];
        for active in &self.active {
            for (output, factor) in [active.pattern.first, active.pattern.second] {
                if let Some(push) = pushes.get_mut(output) {
                    *push += factor * active.multiplier;
                }
            }
        }
        let mut controls = self.unconstrained;
        for (control, push) in controls.iter_mut().zip(shared.push_back(&pushes)) {
            *control -= push;
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
        let excess = excesses(outputs, &self.problem.bounds);
        let worst = |(rows, prices): (&[f64], &[f64])| {
            let changeable = rows.iter().zip(prices).filter(|(_, price)| **price > 0.0);
            changeable.fold(
                0.0,
                |worst, (row, _)| if *row > worst { *row } else { worst },
            )
        };
        let (soft, hard) = split_soft(&excess);
        let (soft_prices, hard_prices) = split_soft(&shared.pricing);
        let (soft, hard) = (worst((soft, soft_prices)), worst((hard, hard_prices)));
        if self.problem.penalty.is_some() {
            (soft, hard)
        } else {
            (0.0, soft.max(hard))
        }
    }

    fn is_soft(&self, row: usize) -> bool {
        self.problem.penalty.is_some() && !matches!(RowKind::of(row), RowKind::Thrust(_))
    }

    /// Hard rows that no control can change hold, or the problem is infeasible at once.
    fn check_constant_rows(&mut self, shared: &Condensed) -> Option<Status> {
        for row in shared.constant_rows.iter().copied() {
            let Some(bound) = self.problem.bounds.0.get(row) else {
                continue;
            };
            if self.is_soft(row) {
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

    /// Opposite faces of a corridor that cross by more than rounding leave no room for a position:
    /// two rows are the whole proof.
    fn check_opposite_faces(&mut self) -> Option<Status> {
        if self.problem.penalty.is_some() {
            return None;
        }
        let (first, second) = self.problem.bounds.crossing_faces(CROSSING)?;
        let _ = self.certificate.push((first, 1.0));
        let _ = self.certificate.push((second, 1.0));
        Some(Status::Infeasible)
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self::new()
    }
}
