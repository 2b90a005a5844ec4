//! The convex quadratic program that refines a path into a trajectory (paper, section III-C).
//!
//! ```text
//! min  sum_k u_k' R u_k / 2 + w |x_N - target|^2 / 2   (+ penalties of soft rows)
//! s.t. x_{k+1} = A_k x_k + B_k u_k + c_k,  x_0 given
//!      g_i . (z_k, x_k) <= h_ki                         half-planes of the corridor
//!      theta_k - gamma_k, gamma_k within limits         attitude rows, where asked for
//!      0 <= thrust_k <= greatest thrust
//! ```
//!
//! `theta - gamma` is the angle of attack. The plane planner linearises about a candidate, so each stage has its own
//! `A`, `B` and offset `c`. In the paper's method all stages have the same `A` and `B`, and `c` is zero.
//!
//! The program has two parts. [`Condensed`] depends on the model alone and serves every candidate of that
//! model. [`Solver`] finds the optimum of one candidate. States and controls are deviations from level
//! trim. In the paper's method they are `(x, z, v, theta, theta', gamma)` and `(elevator, thrust)`. The programs of the
//! flight planner have no pitch rate; the thrust that the motor gives stands in its place. They have no elevator; the
//! rate of the angle of attack stands in its place.
//!
//! The method is a dual active set (Goldfarb, Idnani: "A numerically stable dual method for
//! solving strictly convex quadratic programs", 1983). It works on *normalised controls* `v` and *outputs*.
//! The controls are those of the feedback that is optimal without rows, plus a multiple of `v`. The cost is
//! then `v' v / 2` and a constant. The outputs are the quantities that rows bound, `Y v` and a constant.

mod condense;
mod controls;
mod excess;
mod factor;
mod model;
mod response;
mod rows;
mod solve;
mod triangle;

use crate::config::{KNOTS, STAGES};
pub use condense::{CondenseError, Condensed};
pub use model::Dynamics;
pub use rows::{Bounds, ROWS, RowKind};
pub use solve::{MAX_ITERATIONS, Solver};

/// Number of states of a program.
pub const STATES: usize = 6;
/// Number of states that are the position `(x, z)`. They stand first.
pub const POSITION: usize = 2;
/// Number of the other states, which are called the motion.
pub const MOTION: usize = STATES - POSITION;
/// State of a program, the deviation from level trim: `(x, z, v, theta, theta', gamma)` in the paper's method, and in the
/// flight planner `(x, z, v, theta, thrust, gamma)`.
pub type StageState = [f64; STATES];
/// Place of the pitch in a state. The flight path stands last.
pub(crate) const PITCH: usize = 3;

/// Control of a program, the deviation from level trim: `(elevator, thrust)` [-, N] in the paper's method, and in the
/// flight planner `(rate of the angle of attack, thrust)` [rad/s, N], which computes in its [own units](crate::units::Units).
pub type StageControl = [f64; 2];

/// Weights of the cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Weights of the squares of both controls in each stage.
    pub control: StageControl,
    /// Weight of the squared distance of the last state from the target.
    pub terminal: f64,
}

impl Weights {
    /// The paper's weights.
    pub const PAPER: Self = Self {
        control: [1.0, 3.0],
        terminal: 100.0,
    };
}

/// Price of violating a soft row by `s`: `linear s + quadratic s^2 / 2`. As long as the linear part
/// exceeds a row's multiplier, the row holds exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// Price per metre (or radian).
    pub linear: f64,
    /// Price per square metre (or square radian). It must be positive.
    pub quadratic: f64,
}

/// The program of one candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem {
    /// First state.
    pub initial: StageState,
    /// Target of the last state.
    pub target: StageState,
    /// Right-hand sides of all rows; infinite for a row that the program does not have.
    pub bounds: Bounds,
    /// Price of violating corridor and attitude rows. Without a price these rows are hard. Thrust rows are
    /// always hard, and [`Self::hard_angle_of_attack`] names others.
    pub penalty: Option<Penalty>,
    /// Whether the upper and the lower rows of the angle of attack are hard although there is a price. A price can make
    /// a program leave its corridor. It cannot make an elevator reach further.
    ///
    /// In a program with a price, hard rows must not contradict each other. The solver then finds no optimum, and
    /// may give no proof.
    pub hard_angle_of_attack: [bool; 2],
    /// Cost above which the solver drops the candidate. With an infinite limit it solves to the end.
    pub cost_limit: f64,
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
    /// The solve needs more than [`MAX_ITERATIONS`] steps, or more active rows than there is room for.
    IterationLimit,
    /// Rounding errors are too large, or the input is not finite. The caller must not use the result.
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
    /// Worst violation [m or rad] of a row that the controls can change. It is 0 if all these rows hold.
    pub violation: f64,
}

impl Solution {
    /// A solution of zeros, to be filled.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            states: [[0.0; STATES]; KNOTS],
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
