//! The memory that the phases of a cycle use one after the other.

use crate::lattice::Lattice;
use crate::map::IsolatedHits;
use crate::qp::Condensed;
use crate::sense::LidarScan;

/// What a phase needs for itself. The next phase overwrites it, so that all of them take the memory of the largest
/// alone. What outlives a phase is a field of [`super::PlanePlanner`].
#[derive(Clone, Debug)]
pub(super) enum Workspace {
    /// Phases Faces, Linearise and Improve.
    Program(Condensed),
    /// Phase Map.
    Scan(Intake),
    /// Phase Lattice.
    Lattice(Lattice),
}

/// The scan on its way into the map.
#[derive(Clone, Debug)]
pub(super) struct Intake {
    /// The scan, with ranges in own units.
    pub(super) scan: LidarScan,
    /// Number of beams that the map has taken in.
    pub(super) beams: usize,
    pub(super) lone: IsolatedHits,
}

impl Workspace {
    /// The memory before the first program. It is a constant of zeros: the compiler writes zeros in place, and builds
    /// no such large value on the stack.
    pub(super) const NEW: Self = Self::Program(Condensed::new());
}

impl Intake {
    pub(super) const fn new(scan: LidarScan) -> Self {
        Self {
            scan,
            beams: 0,
            lone: IsolatedHits::none(),
        }
    }
}
