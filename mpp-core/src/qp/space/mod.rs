//! Programs in space, of three inputs.
//!
//! The state is the position `(x, y, z)` and the motion `(v, alpha, bank, path, course)`, the control is `(rate of the bank,
//! rate of the angle of attack, thrust)`. Both are deviations from straight and level flight. Each stage has its own
//! `A`, `B` and offset `c`, because the planner linearises about a banked candidate.
//!
//! The faces of the corridor have normals of their own, which the program brings. Faces and attitudes have a price,
//! inputs are hard.

mod excess;
mod faces;
#[path = "../kernel/mod.rs"]
mod kernel;
mod layout;
mod outputs;
mod rows;

pub use faces::Faces;
pub use kernel::{Condensed, Dynamics, MAX_ITERATIONS, Solution, Solver};
pub use layout::{
    FACES, INPUTS, MOTION, POSITION, ROWS, RowKind, STATES, StageControl, StageState,
};
pub use rows::Bounds;

use super::Penalty;

/// Weights of the cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Weights of the squares of the controls in each stage.
    pub control: StageControl,
    /// Weights of the squared misses of the last state.
    pub terminal: StageState,
}

impl Weights {
    /// No cost at all.
    const NONE: Self = Self {
        control: [0.0; INPUTS],
        terminal: [0.0; STATES],
    };

    fn of_misses(&self) -> StageState {
        self.terminal
    }

    /// Cost of a last state, twice.
    fn miss(&self, last: &StageState, target: &StageState) -> f64 {
        let missing = last.iter().zip(target).zip(&self.terminal);
        missing
            .map(|((x, goal), weight)| weight * (x - goal) * (x - goal))
            .sum()
    }

    /// Greatest weight of a squared miss of a position.
    fn of_position(&self) -> f64 {
        let [x, y, z, ..] = self.terminal;
        x.max(y).max(z)
    }
}

/// The program of one candidate. The normals of its faces are in [`Condensed`], see [`Condensed::set_faces`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem {
    /// First state.
    pub initial: StageState,
    /// Target of the last state.
    pub target: StageState,
    /// Right-hand sides of all rows; infinite for a row that the program does not have.
    pub bounds: Bounds,
    /// Price of violating faces and attitude rows. Without a price these rows are hard. Rows of inputs are always hard.
    pub penalty: Option<Penalty>,
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
        cost_limit: f64::INFINITY,
    };

    /// Whether the program has a price that softens rows of a kind, at any boundary or stage.
    fn softens(&self, kind: RowKind) -> bool {
        self.penalty.is_some() && !matches!(kind, RowKind::Input(..))
    }
}
