//! The rungs of the ladder, and what it keeps of a cycle.

use crate::gate::Space;
use crate::lattice::MAX_LATTICE_PATHS;
use crate::planner::summary::Verdict;

/// A manoeuvre that needs no plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reserve {
    /// Straight and level at cruise, in cells that beams have seen free.
    Level,
    /// The same at the slowest airspeed of plans.
    Slow,
    /// A climb, out of the altitude band if it has to be.
    Climb,
}

impl Reserve {
    pub(super) const ALL: [Self; 3] = [Self::Level, Self::Slow, Self::Climb];
}

/// The previous plan, and the paths of the lattice.
const CANDIDATES: usize = 1 + MAX_LATTICE_PATHS;

/// A rung of the ladder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rung {
    /// The plan with the lowest price.
    Best,
    /// Another roll-out of a program, by its place in the order of prices.
    Other(usize),
    /// The plan that is flown now.
    Previous,
    /// The path of a candidate without a program, by pursuit.
    Pursuit(usize),
    /// A reserve, by its place in [`Reserve::ALL`].
    Reserve(usize),
}

impl Rung {
    /// The next rung downwards.
    pub(super) fn below(self) -> Option<Self> {
        Some(match self {
            Self::Best => Self::Other(0),
            Self::Other(place) if place + 1 < CANDIDATES => Self::Other(place + 1),
            Self::Other(_) => Self::Previous,
            Self::Previous => Self::Pursuit(0),
            Self::Pursuit(index) if index + 1 < CANDIDATES => Self::Pursuit(index + 1),
            Self::Pursuit(_) => Self::Reserve(0),
            Self::Reserve(kind) if kind + 1 < Reserve::ALL.len() => Self::Reserve(kind + 1),
            Self::Reserve(_) => return None,
        })
    }

    /// The cells that it may lead through.
    pub(super) fn space(self) -> Space {
        match self {
            Self::Best | Self::Other(_) | Self::Previous | Self::Pursuit(_) => Space::NotOccupied,
            Self::Reserve(kind) => match Reserve::ALL.get(kind) {
                Some(Reserve::Climb) | None => Space::Above,
                Some(Reserve::Level | Reserve::Slow) => Space::KnownFree,
            },
        }
    }
}

/// Where a cycle is on the ladder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ladder {
    pub(super) rung: Rung,
    /// The refused rung that strikes latest, and when \[s\].
    pub(super) latest: Option<(Rung, f64)>,
    /// What the cycle has to offer.
    pub(super) verdict: Verdict,
    /// Seal of the trajectory that it offers.
    pub(super) seal: u64,
}

impl Ladder {
    /// The ladder before a cycle.
    pub(super) const NEW: Self = Self {
        rung: Rung::Best,
        latest: None,
        verdict: Verdict::Nothing,
        seal: 0,
    };
}
