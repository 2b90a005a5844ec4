//! The convex quadratic program that refines a path into a trajectory (paper, section III-C).
//!
//! ```text
//! min  sum_k u_k' R u_k / 2 + w |x_N - target|^2 / 2   (+ penalties of soft rows)
//! s.t. x_{k+1} = A x_k + B u_k,  x_0 given
//!      g_i . (z_k, x_k) <= h_ki                         half-planes of the corridor
//!      |theta_k|, |gamma_k| within limits               attitude rows, where asked for
//!      thrust_k >= 0
//! ```
//!
//! Two parts: [`Condensed`] depends on the model alone and serves every candidate; [`Solver`]
//! finds one candidate's optimum. States and controls are deviations from level trim, in the order
//! `(x, z, v, theta, theta', gamma)` and `(elevator, thrust)`.
//!
//! The method is a dual active set (Goldfarb, Idnani: "A numerically stable dual method for
//! solving strictly convex quadratic programs", 1983) on the *outputs* that rows touch. With
//! `H` the condensed Hessian and `Y` the map from controls to outputs, all it needs is the kernel
//! `K = Y H^-1 Y'`, formed once.

mod condense;
mod dense;
mod factor;
mod model;
mod response;
mod rows;
mod solve;
mod triangle;

use crate::config::{KNOTS, STAGES};
pub use condense::{CondenseError, Condensed};
pub use model::{Dynamics, Initial, ModelError, StageModel, SteadyState};
pub use rows::{Bounds, ROWS, RowKind};
pub use solve::{MAX_ITERATIONS, Solver};

/// Planner state `(x, z, v, theta, theta', gamma)`, a deviation from level trim.
pub type StageState = [f64; 6];
/// Planner control `(elevator, thrust)`, a deviation from level trim.
pub type StageControl = [f64; 2];

/// Weights of the cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// On `(elevator^2, thrust^2)` of each stage.
    pub control: StageControl,
    /// On the squared distance of the last state from the target.
    pub terminal: f64,
}

impl Weights {
    /// The paper's.
    pub const PAPER: Self = Self {
        control: [1.0, 3.0],
        terminal: 100.0,
    };
}

/// Price of violating a soft row by `s`: `linear s + quadratic s^2 / 2`. As long as the linear part
/// exceeds a row's multiplier, the row holds exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// Per metre (or radian).
    pub linear: f64,
    /// Per square metre (or square radian); must be positive.
    pub quadratic: f64,
}

/// One candidate's program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem {
    /// First state.
    pub initial: StageState,
    /// Where the last state should be.
    pub target: StageState,
    /// Right-hand sides of every row; infinite where a row is not there.
    pub bounds: Bounds,
    /// Price of corridor and attitude rows; none makes them hard. Thrust rows are always hard.
    pub penalty: Option<Penalty>,
    /// Cost above which the candidate is of no interest; infinite to solve to the end.
    pub cost_limit: f64,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// Solved.
    Optimal,
    /// No controls satisfy every hard row; the solver's multipliers prove it.
    Infeasible,
    /// The optimum costs more than the limit; not solved to the end.
    Dominated,
    /// [`MAX_ITERATIONS`] were not enough, or more rows are active than there is room for.
    IterationLimit,
    /// Rounding has the upper hand, or the input is not finite: the result is not to be used.
    NumericalFailure,
}

/// The refined trajectory of one candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// States at the stage boundaries.
    pub states: [StageState; KNOTS],
    /// Controls of the stages.
    pub controls: [StageControl; STAGES],
    /// Cost without penalties.
    pub cost: f64,
    /// Worst violation [m or rad] of a row that the controls can change; 0 when all hold.
    pub violation: f64,
}

impl Solution {
    /// A place for a solution.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            states: [[0.0; 6]; KNOTS],
            controls: [[0.0; 2]; STAGES],
            cost: 0.0,
            violation: 0.0,
        }
    }
}

impl Default for Solution {
    fn default() -> Self {
        Self::new()
    }
}
