//! A cycle of the planner in space, and the plan that is flown.

use crate::{duration, ticks};
use hil_protocol::SpaceTrajectory;
use mpp_core::config::STAGE_PERIOD;
use mpp_core::planner::space::SpacePlan;
use mpp_core::vehicle::{SpaceModel, SpacePath};

/// A cycle under way.
#[derive(Clone, Copy)]
pub(super) struct Cycle {
    /// The tick at which it began, and that at which its plan is due.
    pub(super) begun: u32,
    pub(super) due: u32,
    pub(super) slices: u32,
    pub(super) complete: bool,
}

/// A plan that is flown.
#[derive(Clone, Copy)]
pub(super) struct Flown {
    pub(super) plan: SpacePlan,
    /// The aircraft with the wind for which the plan was made.
    pub(super) model: SpaceModel,
    /// The tick of its first knot, and that at which its cycle began.
    pub(super) start: u32,
    pub(super) begun: u32,
}

impl Flown {
    /// Time since the first knot \[s\].
    pub(super) fn age(&self, tick: u32) -> f64 {
        f64::from(ticks(self.start, tick)) * duration(1)
    }

    /// The message of the plan.
    pub(super) fn told(&self) -> SpaceTrajectory {
        let knot = |it: &SpacePath| {
            let [x, y, z] = it.position;
            [x, y, z, it.bank, it.course].map(|number| number as f32)
        };
        SpaceTrajectory {
            scan_tick: self.begun,
            period: STAGE_PERIOD as f32,
            knots: self.plan.knots.iter().map(knot).collect(),
        }
    }
}
