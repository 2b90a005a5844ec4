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
    /// The tick of the first knot.
    pub(super) start: u32,
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
    /// The plan before it and the tick of its first knot: what is followed until this plan begins.
    pub(super) before: Option<(SpacePlan, u32)>,
}

impl Flown {
    /// Time since the first knot \[s\].
    pub(super) fn age(&self, tick: u32) -> f64 {
        age(self.start, tick)
    }

    /// The plan before, as long as it is followed at a tick.
    fn before(&self, tick: u32) -> Option<&(SpacePlan, u32)> {
        self.before.as_ref().filter(|_| self.age(tick) < 0.0)
    }

    /// State that is followed at a tick.
    pub(super) fn reference(&self, tick: u32) -> SpacePath {
        let (plan, start) = match self.before(tick) {
            Some((plan, start)) => (plan, *start),
            None => (&self.plan, self.start),
        };
        plan.at(&self.model, age(start, tick)).0
    }

    /// Deviation of the aircraft from the plan of which the next one is a part: from what is followed, without what this plan
    /// takes up of it once it begins.
    pub(super) fn deviation(&self, tick: u32, here: &SpacePath) -> [f64; SPACE_STATES] {
        let off = |from: &SpacePath, to: &SpacePath| {
            let (from, to) = (from.numbers(), to.numbers());
            core::array::from_fn(|number| to[number] - from[number])
        };
        let all: [f64; SPACE_STATES] = off(&self.reference(tick), here);
        let [first, ..] = &self.plan.knots;
        let taken = self
            .before(tick)
            .map_or([0.0; SPACE_STATES], |(plan, start)| {
                off(&plan.at(&self.model, age(*start, self.start)).0, first)
            });
        core::array::from_fn(|number| all[number] - taken[number])
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

/// Time from a tick to another one \[s\].
fn age(from: u32, to: u32) -> f64 {
    f64::from(ticks(from, to)) * duration(1)
}
