//! Condensing and the active-set method, written once for programs of every shape. Each shape compiles these files as a
//! module of its own. `super` is the shape: it has the sizes, and it knows what the rows are.

mod condense;
mod controls;
mod factor;
mod model;
mod response;
mod row;
pub(in crate::qp) mod shortlist;
mod solve;
mod triangle;

use super::{INPUTS, STATES, StageControl, StageState, Weights};
use crate::config::{KNOTS, STAGES};
pub use condense::Condensed;
pub(in crate::qp) use controls::{CONTROLS, ControlVector, dot};
pub use model::Dynamics;
pub(in crate::qp) use response::Response;
pub(in crate::qp) use row::RowPattern;
pub use solve::{MAX_ITERATIONS, Solver};

/// The refined trajectory of one candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// States at the stage boundaries.
    pub states: [StageState; KNOTS],
    /// Controls of the stages.
    pub controls: [StageControl; STAGES],
    /// Cost without penalties.
    pub cost: f64,
    /// Worst violation \[m or rad\] of a row that the controls can change. It is 0 if all these rows hold.
    pub violation: f64,
}

impl Solution {
    /// A solution of zeros, to be filled.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            states: [[0.0; STATES]; KNOTS],
            controls: [[0.0; INPUTS]; STAGES],
            cost: 0.0,
            violation: 0.0,
        }
    }
}

/// Value of `|y|^2` below which a row with the response `y` is constant up to rounding. In the paper's model the
/// first position rows are constant, because a control changes the position only two stages later.
const UNCHANGEABLE: f64 = 1e-20;

/// Price of a row with this squared norm of its response.
pub(in crate::qp) fn price_of(squared: f64) -> f64 {
    if squared > UNCHANGEABLE {
        1.0 / squared
    } else {
        0.0
    }
}
