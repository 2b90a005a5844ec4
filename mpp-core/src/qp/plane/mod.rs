//! Programs in the vertical plane, of two inputs.
//!
//! In the paper's method the state is `(x, z, v, theta, theta', gamma)` and the control `(elevator, thrust)`. The programs
//! of the planner in the plane have no pitch rate; the thrust that the motor gives stands in its place. They have no
//! elevator; the rate of the angle of attack stands in its place. `theta - gamma` is the angle of attack.
//!
//! States and controls are deviations from level trim. The plane planner linearises about a candidate, so each stage has
//! its own `A`, `B` and offset `c`. In the paper's method all stages have the same `A` and `B`, and `c` is zero.

mod excess;
#[path = "../kernel/mod.rs"]
mod kernel;
mod layout;
mod outputs;
mod rows;

pub use kernel::{Condensed, Dynamics, MAX_ITERATIONS, Solution, Solver};
pub use layout::{INPUTS, MOTION, POSITION, ROWS, RowKind, STATES, StageControl, StageState};
pub use rows::Bounds;

use super::Penalty;
#[cfg(feature = "paper")]
pub(crate) use layout::PITCH;

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
    /// No cost at all.
    const NONE: Self = Self {
        control: [0.0; INPUTS],
        terminal: 0.0,
    };

    /// Weights of the squared misses of the last state.
    fn of_misses(&self) -> StageState {
        [self.terminal; STATES]
    }

    /// Cost of a last state, twice.
    fn miss(&self, last: &StageState, target: &StageState) -> f64 {
        let missing = last.iter().zip(target);
        self.terminal
            * missing
                .map(|(x, goal)| (x - goal) * (x - goal))
                .sum::<f64>()
    }

    /// Greatest weight of a squared miss of a position.
    fn of_position(&self) -> f64 {
        self.terminal
    }
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

impl Problem {
    /// A program without rows, from zero to zero.
    pub const EMPTY: Self = Self {
        initial: [0.0; STATES],
        target: [0.0; STATES],
        bounds: Bounds::none(),
        penalty: None,
        hard_angle_of_attack: [false; 2],
        cost_limit: f64::INFINITY,
    };

    /// Whether the program has a price that softens rows of a kind, at any boundary or stage.
    fn softens(&self, kind: RowKind) -> bool {
        let [hard_up, hard_down] = self.hard_angle_of_attack;
        self.penalty.is_some()
            && match kind {
                RowKind::Attitude(_, 0) => !hard_up,
                RowKind::Attitude(_, 2) => !hard_down,
                RowKind::Position(..) | RowKind::Attitude(..) => true,
                RowKind::Thrust(..) => false,
            }
    }
}
