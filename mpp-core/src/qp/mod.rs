//! The convex quadratic program that refines a path into a trajectory (paper, section III-C).
//!
//! ```text
//! min  sum_k u_k' R u_k / 2 + w |x_N - target|^2 / 2   (+ penalties of soft rows)
//! s.t. x_{k+1} = A_k x_k + B_k u_k + c_k,  x_0 given
//!      g_i . p_k <= h_ki                                half-planes of the corridor on the position p
//!      attitudes and inputs within limits               where asked for
//! ```
//!
//! The program has two parts. [`Condensed`] depends on the model alone and serves every candidate of that
//! model. [`Solver`] finds the optimum of one candidate. States and controls are deviations from a nominal motion.
//!
//! The method is a dual active set (Goldfarb, Idnani: "A numerically stable dual method for
//! solving strictly convex quadratic programs", 1983). It works on *normalised controls* `v` and *outputs*.
//! The controls are those of the feedback that is optimal without rows, plus a multiple of `v`. The cost is
//! then `v' v / 2` and a constant. The outputs are the quantities that rows bound, `Y v` and a constant.
//!
//! A program has a *shape*: its numbers of states, inputs, outputs and rows, and what its rows are. There are two,
//! [`plane`] and [`space`]. Condensing and active set are written once, in `kernel`, and compiled once for each shape:
//! there a size of an array is a plain constant, and the compiler unrolls what it can
//! (decision 44). The names of this module are those of the plane.

pub mod plane;
pub mod space;

#[cfg(feature = "paper")]
pub(crate) use plane::PITCH;
pub use plane::{
    Bounds, Condensed, Dynamics, MAX_ITERATIONS, MOTION, POSITION, Problem, ROWS, RowKind, STATES,
    Solution, Solver, StageControl, StageState, Weights,
};

/// Price of violating a soft row by `s`: `linear s + quadratic s^2 / 2`. As long as the linear part
/// exceeds a row's multiplier, the row holds exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// Price per metre (or radian).
    pub linear: f64,
    /// Price per square metre (or square radian). It must be positive.
    pub quadratic: f64,
}

/// The result of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The solver found the optimum.
    Optimal,
    /// No controls satisfy every hard row. The solver's multipliers prove it (Farkas): with these weights, none of them
    /// negative, the rows' left-hand sides cancel, and their bounds add up to less than zero.
    Infeasible,
    /// Controls that satisfy every hard row cost more than a miss of a kilometre and a thousand times the optimum without
    /// rows. The solver's multipliers prove it. There may be such controls; they are of no use.
    TooDear,
    /// The optimum costs more than the limit, so the solver stopped early.
    Dominated,
    /// The solve needs more steps than [`MAX_ITERATIONS`], or more active rows than there is room for.
    IterationLimit,
    /// Rounding errors are too large, or the input is not finite. The caller must not use the result.
    NumericalFailure,
}

/// The cost has no single optimum: a weight is not positive, or the model is not finite. The planner then
/// does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the plan's cost has no single optimum: give the controls positive weights, and the terminal \
     state one that is not negative"
)]
pub struct CondenseError;
