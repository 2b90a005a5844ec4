//! The memory that the phases of a cycle use one after the other.

use crate::lattice::Lattice;
use crate::map::{IsolatedHits, Predictions};
use crate::qp::Condensed;
use crate::sense::LidarScan;

/// The memory of one phase. The next phase overwrites it, so that all phases together take the memory of the largest.
/// A value that outlives its phase is a field of [`super::PlanePlanner`].
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
    pub(super) isolated: IsolatedHits,
    /// What the scan should show again.
    pub(super) predictions: Predictions,
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
            isolated: IsolatedHits::none(),
            predictions: Predictions::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::{Phase, PlanePlanner};
    use super::{Intake, Workspace};
    use crate::planner::Verdict;
    use crate::sense::LidarScan;
    use crate::settings::{PlaneSettings, Settings};
    use crate::tuning::scan_match::AGES;
    use crate::vehicle::{Conditions, Pose, VehicleState};
    use std::boxed::Box;

    /// Each phase with a workspace of another phase.
    #[test]
    fn a_phase_without_its_workspace_ends_the_cycle_and_tells_it() {
        let scan = || Workspace::Scan(Intake::new(LidarScan::new()));
        let mixed_up = [
            (Phase::Map, Workspace::NEW),
            (Phase::Lattice, scan()),
            (Phase::Linearise, scan()),
            (Phase::Improve, scan()),
        ];
        let mut planner = Box::new(PlanePlanner::new());
        let set_up = planner.set_up(&Settings::flight(), &PlaneSettings::PRESET);
        assert_eq!(set_up, Ok(()));
        for (phase, workspace) in mixed_up {
            let air = planner.trim.state;
            let state = VehicleState {
                x: 0.0,
                z: 50.0,
                air,
            };
            planner.begin(
                0.0,
                &[Pose::of(&state); AGES],
                &state,
                &Conditions::STILL,
                None,
            );
            assert!(planner.is_working() && !planner.summary.inconsistent);
            let one = planner.cruising();
            planner.propose(one);
            (planner.phase, planner.workspace) = (phase, workspace);
            while planner.advance() {}
            // The gate still offers the straight path, or the one before.
            assert!(matches!(planner.finish(), Verdict::Pursuit | Verdict::Kept));
            let summary = &planner.summary;
            assert!(summary.inconsistent && !summary.complete, "{phase:?}");
        }
    }
}
