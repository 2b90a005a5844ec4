//! Ways out: a plan up to one of its knots, and from there a circle in space that the map has seen free (decision 76).

use super::candidate::SpacePlan;
use crate::vehicle::{Loiter, SpacePath};

/// Knots at which circles leave the plan, the latest first, each to both sides. From the first knot they leave only where the way
/// out is lost that was flown.
pub(super) const LEAVES: [usize; 7] = [12, 9, 6, 4, 2, 1, 0];
/// Circles that a cycle tries.
pub(super) const TURNS: usize = 2 * LEAVES.len();
/// Stages of a circle that a slice flies, and the most up to its end, in wind.
pub(super) const SLICE_STAGES: usize = 6;
pub(super) const MOST_STAGES: usize = 72;
/// Most slices of the search.
pub(super) const SLICES: usize = TURNS * MOST_STAGES.div_ceil(SLICE_STAGES) + 3;

/// A plan that ends on a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WayOut {
    /// The plan; its last knot is on the circle or on the way to it.
    pub plan: SpacePlan,
    /// The circle that follows.
    pub loiter: Loiter,
    /// Time from the first knot until the plan turns to the circle \[s\].
    pub holds: f64,
}

/// What a cycle knows of ways out.
#[derive(Clone, Copy, Debug)]
pub(super) struct WaysOut {
    /// First stages of the best plan that are clear, in voxels that have been seen.
    pub(super) clear: usize,
    pub(super) turn: Option<Turn>,
    /// That of the best plan. Before the search it has what is flown, renewed, until that has been looked at.
    pub(super) found: Option<WayOut>,
    /// The one that is flown. Once the cycle has looked at it, it goes on from the start of the cycle, or is given up.
    pub(super) held: Option<WayOut>,
    pub(super) looked: bool,
    /// Whether something is known on it.
    pub(super) lost: bool,
    /// Whether what was found is flown from now on.
    pub(super) holds: bool,
    /// Whether a way out has ever been flown: that of mode open.
    pub(super) flown: bool,
}

/// A circle that is tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) plan: SpacePlan,
    pub(super) loiter: Loiter,
    pub(super) state: SpacePath,
    pub(super) stage: usize,
    /// Angle flown on the circle \[rad\].
    pub(super) swept: f64,
}

impl WaysOut {
    pub(super) const NONE: Self = Self {
        clear: 0,
        turn: None,
        found: None,
        held: None,
        looked: false,
        lost: false,
        holds: false,
        flown: false,
    };
}

/// The knot at which a circle leaves the plan.
pub(super) fn leaves(number: usize) -> usize {
    LEAVES.get(number / 2).copied().unwrap_or(0)
}
