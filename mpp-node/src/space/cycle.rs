//! A cycle of the planner in space, and the plan that is flown.

use crate::{duration, ticks};
use hil_protocol::SpaceTrajectory;
use mpp_core::config::STAGE_PERIOD;
use mpp_core::planner::space::SpacePlan;
use mpp_core::vehicle::{SPACE_STATES, SpaceModel, SpacePath};

/// A cycle under way.
#[derive(Clone, Copy)]
pub(super) struct Cycle {
    /// The tick at which it began, and that at which its plan is due.
    pub(super) begun: u32,
    pub(super) due: u32,
    /// The tick of the first knot, and by how much this knot lies beside the plan before.
    pub(super) start: u32,
    pub(super) moved: [f64; SPACE_STATES],
    pub(super) slices: u32,
    pub(super) complete: bool,
}

/// A plan that is flown.
#[derive(Clone, Copy)]
pub(super) struct Flown {
    pub(super) plan: SpacePlan,
    /// The aircraft with the wind for which the plan was made.
    pub(super) model: SpaceModel,
    /// The cycle that made it.
    pub(super) cycle: Cycle,
    /// The plan before it and the tick of its first knot: what is followed until this plan begins.
    pub(super) before: Option<(SpacePlan, u32)>,
}

impl Flown {
    /// Time since the first knot \[s\].
    pub(super) fn age(&self, tick: u32) -> f64 {
        age(self.cycle.start, tick)
    }

    /// State that is followed at a tick.
    pub(super) fn reference(&self, tick: u32) -> SpacePath {
        let (plan, age) = match &self.before {
            Some((plan, start)) if self.age(tick) < 0.0 => (plan, age(*start, tick)),
            _ => (&self.plan, self.age(tick)),
        };
        plan.at(&self.model, age).0
    }

    /// Deviation of the aircraft from the plan of which the next one is a part: from what is followed, and what this plan takes
    /// up of it once it begins.
    pub(super) fn deviation(&self, tick: u32, here: &SpacePath) -> [f64; SPACE_STATES] {
        let (here, now) = (here.numbers(), self.reference(tick).numbers());
        let begins = self.age(tick) < 0.0;
        core::array::from_fn(|number| {
            let taken = if begins {
                self.cycle.moved[number]
            } else {
                0.0
            };
            here[number] - now[number] - taken
        })
    }

    /// The message of the plan.
    pub(super) fn told(&self) -> SpaceTrajectory {
        let knot = |it: &SpacePath| {
            let [x, y, z] = it.position;
            [x, y, z, it.bank, it.course].map(|number| number as f32)
        };
        SpaceTrajectory {
            scan_tick: self.cycle.begun,
            period: STAGE_PERIOD as f32,
            knots: self.plan.knots.iter().map(knot).collect(),
        }
    }
}

/// Time from a tick to another one \[s\].
fn age(from: u32, to: u32) -> f64 {
    f64::from(ticks(from, to)) * duration(1)
}
