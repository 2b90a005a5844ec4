//! Planners that are set up, and whole cycles of them.

use crate::common::world::{Disc, scan};
use mpp_core::planner::{Planner, Verdict};
use mpp_core::settings::Settings;
use mpp_core::vehicle::Conditions;
use mpp_core::vehicle::VehicleState;

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
