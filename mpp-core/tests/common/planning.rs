//! Planners that are set up, and whole cycles of them.

use crate::common::world::{Disc, scan};
use mpp_core::planner::{Planner, Verdict};
use mpp_core::settings::{PlannerSettings, Settings};
use mpp_core::vehicle::{Conditions, VehicleState};

pub(crate) fn planner(settings: &Settings) -> Box<Planner> {
    let mut planner = Box::new(Planner::new());
    planner.set_up(settings).unwrap();
    planner
}

/// Level flight at trim and at the altitude to keep.
pub(crate) fn level(planner: &Planner) -> VehicleState {
    VehicleState {
        x: 100.0,
        z: 50.0,
        air: planner.trim().state,
    }
}

/// Plans one whole cycle.
pub(crate) fn plan(planner: &mut Planner, state: &VehicleState, discs: &[Disc]) -> Verdict {
    planner.begin(3.0, state, &Conditions::STILL, &scan(discs, state));
    while planner.advance() {}
    planner.finish()
}

pub(crate) fn presets() -> [Settings; 3] {
    [Settings::reference(), Settings::paper(), Settings::flight()]
}

pub(crate) fn with_planner(settings: Settings, planner: PlannerSettings) -> Settings {
    Settings {
        planner,
        ..settings
    }
}

/// A trajectory within this violation counts as feasible [m, rad].
pub(crate) const FEASIBLE: f64 = 1e-6;

pub(crate) const SCATTERED: [Disc; 5] = [
    (118.0, 51.0, 1.0),
    (128.0, 46.0, 1.5),
    (131.0, 55.0, 1.0),
    (140.0, 50.0, 1.0),
    (146.0, 57.0, 1.0),
];
