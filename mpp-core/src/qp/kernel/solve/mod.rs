//! The optimum of one candidate by a dual active set method.
//!
//! The unconstrained optimum violates rows. The most violated row *enters*: its multiplier grows until
//! the row is tight. At the same time the multipliers of the active rows change so that these rows stay
//! tight. If the multiplier of an active row reaches zero on the way, that row leaves. The dual objective
//! only rises. Therefore the search ends, and the objective is always a lower bound of the cost.
//!
//! When the multiplier of a *soft* row reaches the linear price, the row *yields*: from there on the
//! solution violates it by `s = (multiplier - linear) / quadratic`. This adds `1 / quadratic` to the row's
//! diagonal entry of the Gram matrix. When the multiplier falls back to the linear price, the row becomes
//! stiff again.

mod block;
mod contradiction;
mod direction;
mod select;
mod step;
mod working_set;

use super::super::excess::worst_excess;
use super::super::layout::{LAST_ROWS, OUTPUTS, ROWS};
use super::super::outputs::outputs;
use super::super::{Bounds, Problem, RowKind};
use super::factor::{CAPACITY, Direction as Aligned, Factor};
use super::shortlist::Shortlist;
use super::{CONTROLS, Condensed, ControlVector, RowPattern, Solution};
use crate::config::STAGES;
use crate::qp::Status;

/// Greatest number of iterations of one solve.
pub const MAX_ITERATIONS: usize = 400;

/// Greatest number of rows in a block: one of each of the last pairs.
const PAIRED: usize = (ROWS - LAST_ROWS) / 2;

/// Excess above which a row counts as violated [m, rad or N].
const TOLERANCE: f64 = 1e-9;

/// Worst violation of a hard row in an accepted solution.
const ACCEPTED: f64 = 1e-6;

/// Miss of the target \[m\] whose cost is absurd. Rows contradict each other if a solution that keeps them
/// costs as much as this miss and [`ABSURD_FACTOR`] times the optimum without rows together.
const ABSURD_MISS: f64 = 1000.0;
/// Factor of the cost of the optimum without rows in the absurd cost.
const ABSURD_FACTOR: f64 = 1e3;
/// Control [-, N] whose cost in every stage is absurd: terminal weights may be so small that a miss costs nothing.
const ABSURD_CONTROL: f64 = 200.0;

/// A row with a multiplier.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Active {
    row: usize,
    pattern: RowPattern,
    multiplier: f64,
    yielded: bool,
    /// The linear price of a soft row; infinite for a hard row.
    price: f64,
    /// Whether the row is part of a block that enters, and not tight yet.
    fresh: bool,
}

/// The row that enters.
#[derive(Clone, Copy, Debug)]
struct Entering {
    row: Active,
    /// Excess of the row over its bound, less the amount by which it yields.
    violation: f64,
    /// Squared norm of the row's response, `|Y' c_p|^2`.
    norm: f64,
}

/// Where the solver stands between two parts of its work.
// A number of its own, zero at the beginning of a solve: memory of zeros is a solver that waits.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
enum Stands {
    /// Between two steps: no row enters.
    Free,
    /// Between two steps: a row enters, and has not done so in the last one.
    Entering(Entering),
    /// Within a step: rows of a block are taken up, from one on. The row that counts most, and its violation, wait.
    TakingUp(Active, f64, usize),
    /// Within a step: the multipliers of a block move.
    Settling(Active),
}

/// Workspace of the solver.
///
/// # Example
///
/// A program with one face: at knot 10 the aircraft has to be 2 m above its start.
///
/// ```
/// use mpp_core::corridor::Corridor;
/// use mpp_core::paper::{Initial, StageModel};
/// use mpp_core::qp::{Condensed, Problem, Solution, Solver, Status, Weights};
/// use mpp_core::vehicle::{Airframe, JacobianForm, Trim};
///
/// let airframe = Airframe::REFERENCE;
/// let trim = Trim::at_speed(&airframe, 12.0, 0.0)?;
/// let mut shared = Box::new(Condensed::new());
/// let model = StageModel::new(&airframe, &trim, JacobianForm::Exact, Initial::Estimate)?;
/// shared.condense(&model.dynamics(), &Weights::PAPER)?;
///
/// let mut corridor = Corridor::new();
/// // Direction 4 points down: `-z <= -2`.
/// corridor.bounds[10][4] = -2.0;
/// let mut problem = Problem::EMPTY;
/// problem.bounds.set_corridor(&corridor);
/// problem.bounds.set_thrust([f64::INFINITY, trim.control.thrust]);
///
/// let mut solver = Box::new(Solver::new());
/// let mut solution = Solution::new();
/// assert_eq!(solver.solve(&shared, &problem), Status::Optimal);
/// assert_eq!(solver.solution(&shared, &mut solution), Status::Optimal);
/// // The optimum goes no higher than it has to, and returns to where it started.
/// assert!((solution.states[10][1] - 2.0).abs() < 1e-6);
/// assert!(solution.states[18][1].abs() < 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solver {
    /// The program. Its owner may change it between the end of one and the beginning of the next.
    pub(crate) problem: Problem,
    /// The feedforward of the optimum without rows.
    feedforward: ControlVector,
    /// The present normalised controls, their trajectory, and the outputs of the trajectory.
    normalised: ControlVector,
    trajectory: Solution,
    outputs: [f64; OUTPUTS],
    /// Whether the multipliers have changed since the controls were computed.
    stale: bool,
    /// Number of steps since the controls were computed from the multipliers.
    drift: usize,
    /// Whether the trajectory is that of the present controls.
    rolled: bool,
    /// Rows that may enter next.
    list: Shortlist,
    /// What the first of the list counted when it was made.
    listed: f64,
    /// Outputs of the optimum without rows, and its cost.
    free: [f64; OUTPUTS],
    free_cost: f64,
    active: heapless::Vec<Active, CAPACITY>,
    /// Bounds of the rows that may enter, with the tolerance added; infinite for rows that must not enter.
    pub(crate) open: Bounds,
    /// Whether the program has attitude rows.
    attitude_rows: bool,
    stands: Stands,
    /// While a block is taken up its rows, later the places of those that leave.
    block: heapless::Vec<usize, PAIRED>,
    /// The vector `L^-1 C_A Y Y' c_p` of the entering row, and the rest of its response.
    products: [f64; CAPACITY],
    rest: Aligned,
    /// Decrease of the active rows' multipliers with that of the entering row.
    rates: [f64; CAPACITY],
    factor: Factor,
    dual: f64,
    /// Absurd rise of the cost above the optimum without rows. It is infinite if rows are soft, because the hard rows
    /// of such a program do not contradict each other.
    absurd_rise: f64,
    iterations: usize,
    pub(crate) status: Option<Status>,
    certificate: heapless::Vec<(usize, f64), { CAPACITY + 1 }>,
}

impl Solver {
    /// An empty workspace.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            problem: Problem::EMPTY,
            feedforward: [0.0; CONTROLS],
            normalised: [0.0; CONTROLS],
            trajectory: Solution::new(),
            outputs: [0.0; OUTPUTS],
            stale: false,
            drift: 0,
            rolled: false,
            list: Shortlist::new(),
            listed: 0.0,
            free: [0.0; OUTPUTS],
            free_cost: 0.0,
            active: heapless::Vec::new(),
            open: Bounds::none(),
            attitude_rows: false,
            stands: Stands::Free,
            block: heapless::Vec::new(),
            products: [0.0; CAPACITY],
            rest: Aligned([0.0; CONTROLS]),
            rates: [0.0; CAPACITY],
            factor: Factor::new(),
            dual: 0.0,
            absurd_rise: 0.0,
            iterations: 0,
            status: None,
            certificate: heapless::Vec::new(),
        }
    }

    /// Starts on a problem: computes the optimum without rows, and checks the rows that no control can change
    /// and the opposite faces.
    pub fn start(&mut self, shared: &Condensed, problem: &Problem) {
        self.problem = *problem;
        self.begin(shared);
    }

    /// Starts on the problem that is here already.
    pub(crate) fn begin(&mut self, shared: &Condensed) {
        self.active.clear();
        self.iterations = 0;
        self.certificate.clear();
        self.normalised = [0.0; CONTROLS];
        self.stale = false;
        self.rolled = false;
        // Most programs of dense fields end here, so this comes before all that costs something.
        self.status = self.check_opposite_faces();
        if self.status.is_some() {
            return;
        }
        self.stands = Stands::Free;
        self.factor.clear();
        self.list.clear();
        self.drift = 0;
        self.feedforward = shared.feedforward(&self.problem.target);
        let problem = &self.problem;
        let rows = problem.bounds.0.iter().zip(&shared.prices);
        let mut numbers = true;
        for (open, (bound, price)) in self.open.0.iter_mut().zip(rows) {
            numbers &= !bound.is_nan();
            *open = if *price > 0.0 {
                bound + TOLERANCE
            } else {
                f64::INFINITY
            };
        }
        self.attitude_rows = problem.bounds.has_attitude();
        self.follow(shared);
        self.rolled = true;
        self.dual = shared.cost(&self.trajectory, &self.problem.target);
        self.free = self.outputs;
        self.free_cost = self.dual;
        self.absurd_rise = if self.problem.penalty.is_some() {
            f64::INFINITY
        } else {
            let miss = shared.weights.of_position() * ABSURD_MISS * ABSURD_MISS;
            let effort: f64 = shared.weights.control.iter().sum();
            let control = STAGES as f64 * effort * ABSURD_CONTROL * ABSURD_CONTROL;
            0.5 * miss.max(control) + ABSURD_FACTOR * self.dual
        };
        self.status = if self.dual.is_finite() && numbers {
            self.check_constant_rows(shared)
                .or_else(|| (self.dual > self.problem.cost_limit).then_some(Status::Dominated))
        } else {
            Some(Status::NumericalFailure)
        };
        if self.status.is_none() && self.problem.penalty.is_some() {
            self.start_between_crossing_faces(shared);
            if self.dual > self.problem.cost_limit {
                self.status = Some(Status::Dominated);
            }
        }
    }

    /// Computes trajectory and outputs of the present normalised controls.
    fn follow(&mut self, shared: &Condensed) {
        let initial = &self.problem.initial;
        shared.roll_out(
            initial,
            &self.feedforward,
            &self.normalised,
            &mut self.trajectory,
        );
        self.outputs = outputs(&self.trajectory);
    }

    /// Makes up to `iterations` steps. Returns the status as soon as there is one.
    pub fn advance(&mut self, shared: &Condensed, iterations: usize) -> Option<Status> {
        for _ in 0..iterations {
            // Rows and iterations bound the parts of a step.
            while !self.advance_part(shared) {}
            if self.status.is_some() {
                break;
            }
        }
        self.status
    }

    /// Does a part of a step. Returns true at the end of the step.
    // Not inlined, so that the steps do not lie on the stack beneath what follows the last of them.
    #[inline(never)]
    pub(crate) fn advance_part(&mut self, shared: &Condensed) -> bool {
        let begins = self.is_between_steps();
        if self.status.is_none() {
            self.status = if begins && self.iterations >= MAX_ITERATIONS {
                Some(Status::IterationLimit)
            } else {
                self.iterations += usize::from(begins);
                self.step(shared)
            };
        }
        self.status.is_some() || self.is_between_steps()
    }

    /// Whether the last part was the last one of its step.
    pub(crate) fn is_between_steps(&self) -> bool {
        matches!(self.stands, Stands::Free | Stands::Entering(_))
    }

    /// Solves to the end.
    pub fn solve(&mut self, shared: &Condensed, problem: &Problem) -> Status {
        self.start(shared, problem);
        self.advance(shared, MAX_ITERATIONS + 1)
            .unwrap_or(Status::IterationLimit)
    }

    /// Number of steps since the start.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Rows and their multipliers. At an optimum these are the active rows. At [`Status::Infeasible`] they
    /// are a proof: the weighted sum of these rows reads `0 <= negative` for all controls. At [`Status::TooDear`] it
    /// does so for all controls except absurdly expensive ones.
    pub fn multipliers(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let proof = matches!(self.status, Some(Status::Infeasible | Status::TooDear));
        let optimum = self
            .active
            .iter()
            .map(|active| (active.row, active.multiplier));
        let certificate = self.certificate.iter().copied();
        optimum
            .filter(move |_| !proof)
            .chain(certificate.filter(move |_| proof))
    }

    /// Writes the trajectory that follows from the multipliers. Returns the status, or
    /// [`Status::NumericalFailure`] if the trajectory violates a hard row or its cost is not finite.
    #[inline(never)]
    pub fn solution(&self, shared: &Condensed, solution: &mut Solution) -> Status {
        if !self.rolled {
            let normalised = if self.stale {
                self.controls(shared, None)
            } else {
                self.normalised
            };
            let (initial, target) = (&self.problem.initial, &self.problem.target);
            let feedforward = if self.iterations == 0 {
                // Faces that cross ended this program before it had one.
                shared.feedforward(target)
            } else {
                self.feedforward
            };
            shared.roll_out(initial, &feedforward, &normalised, solution);
        } else {
            solution.clone_from(&self.trajectory);
        }
        solution.cost = shared.cost(solution, &self.problem.target);
        let outputs = outputs(solution);
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
        let (mut soft, mut hard) = (0.0_f64, 0.0_f64);
        for (kind, excess) in worst_excess(shared, outputs, &self.problem.bounds) {
            let worst = if self.problem.softens(kind) {
                &mut soft
            } else {
                &mut hard
            };
            *worst = worst.max(excess);
        }
        (soft, hard)
    }

    /// The normalised controls of the present multipliers, `-Y' (C_A' lambda_A + c_p lambda_p)`.
    fn controls(&self, shared: &Condensed, entering: Option<&Active>) -> ControlVector {
        let mut normalised = [0.0; CONTROLS];
        for row in self.active.iter().chain(entering) {
            shared.add_normal(&mut normalised, &row.pattern, -row.multiplier);
        }
        normalised
    }

    pub(super) fn is_soft(&self, row: usize) -> bool {
        self.problem.softens(RowKind::of(row))
    }
}
