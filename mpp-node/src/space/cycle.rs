//! A cycle of the planner in space, and the plan that is flown.

use crate::{duration, ticks};
use hil_protocol::SpaceTrajectory;
use mpp_core::config::STAGE_PERIOD;
use mpp_core::planner::space::SpacePlan;
use mpp_core::vehicle::{SPACE_STATES, SpaceControl, SpaceModel, SpacePath};

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

/// The plan that is flown, if there is [one](Self::some). The value is made by the set-up: a step has no time for it, or to copy
/// more than the next plan.
pub(super) struct Flown {
    known: bool,
    /// The plan and the one before it, in turn: whether the second is the plan.
    plans: [SpacePlan; 2],
    second: bool,
    /// The aircraft with the wind for which the plan was made.
    pub(super) model: SpaceModel,
    /// The tick of its first knot, and that at which its cycle began.
    start: u32,
    pub(super) begun: u32,
    /// The tick of the first knot of the plan before it, which is followed until this plan begins.
    before: Option<u32>,
}

impl Flown {
    /// No plan yet, of an aircraft.
    pub(super) fn none(model: &SpaceModel) -> Self {
        Self {
            known: false,
            plans: [SpacePlan::new(); 2],
            second: false,
            model: *model,
            start: 0,
            begun: 0,
            before: None,
        }
    }

    /// Itself, if a plan is flown.
    pub(super) fn some(&self) -> Option<&Self> {
        self.known.then_some(self)
    }

    /// Takes over the next plan.
    pub(super) fn follow(&mut self, plan: &SpacePlan, model: &SpaceModel, cycle: &Cycle) {
        self.second = !self.second;
        self.before = self.known.then_some(self.start);
        self.known = true;
        let [first, second] = &mut self.plans;
        *(if self.second { second } else { first }) = *plan;
        self.model = *model;
        (self.start, self.begun) = (cycle.start, cycle.begun);
    }

    /// The plan, and the one before it.
    fn both(&self) -> [&SpacePlan; 2] {
        let [first, second] = &self.plans;
        if self.second {
            [second, first]
        } else {
            [first, second]
        }
    }

    /// State and control of the plan some time after its first knot \[s\].
    pub(super) fn at(&self, time: f64) -> (SpacePath, SpaceControl) {
        let [plan, _] = self.both();
        plan.at(&self.model, time)
    }

    /// Time since the first knot \[s\].
    pub(super) fn age(&self, tick: u32) -> f64 {
        age(self.start, tick)
    }

    /// The plan before and the tick of its first knot, as long as it is followed at a tick.
    fn before(&self, tick: u32) -> Option<(&SpacePlan, u32)> {
        let [_, before] = self.both();
        let start = self.before.filter(|_| self.age(tick) < 0.0)?;
        Some((before, start))
    }

    /// State that is followed at a tick.
    pub(super) fn reference(&self, tick: u32) -> SpacePath {
        let [plan, _] = self.both();
        let (plan, start) = self.before(tick).unwrap_or((plan, self.start));
        plan.at(&self.model, age(start, tick)).0
    }

    /// Deviation of the aircraft from the plan of which the next one is a part: from what is [followed](Self::reference) at a
    /// tick, without what this plan takes up of it once it begins.
    pub(super) fn deviation(
        &self,
        tick: u32,
        followed: &SpacePath,
        here: &SpacePath,
    ) -> [f64; SPACE_STATES] {
        let off = |from: &SpacePath, to: &SpacePath| {
            let (from, to) = (from.numbers(), to.numbers());
            core::array::from_fn(|number| to[number] - from[number])
        };
        let all: [f64; SPACE_STATES] = off(followed, here);
        let [plan, _] = self.both();
        let [first, ..] = &plan.knots;
        let taken = self
            .before(tick)
            .map_or([0.0; SPACE_STATES], |(plan, start)| {
                off(&plan.at(&self.model, age(start, self.start)).0, first)
            });
        core::array::from_fn(|number| all[number] - taken[number])
    }

    /// The message of the plan.
    pub(super) fn told(&self) -> SpaceTrajectory {
        let knot = |it: &SpacePath| {
            let [x, y, z] = it.position;
            [x, y, z, it.bank, it.course].map(|number| number as f32)
        };
        let [plan, _] = self.both();
        SpaceTrajectory {
            scan_tick: self.begun,
            period: STAGE_PERIOD as f32,
            knots: plan.knots.iter().map(knot).collect(),
        }
    }
}

/// Time from a tick to another one \[s\].
fn age(from: u32, to: u32) -> f64 {
    f64::from(ticks(from, to)) * duration(1)
}
