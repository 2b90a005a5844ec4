//! A cycle of the planner in space, and the plan that is flown.

use crate::{duration, ticks};
use hil_protocol::SpaceTrajectory;
use mpp_core::config::{STAGE_PERIOD, STAGES};
use mpp_core::planner::space::{SpacePlan, WayOut};
use mpp_core::vehicle::{
    Loiter, SPACE_STATES, SpaceControl, SpaceModel, SpacePath, within_half_turn,
};

/// Length of a plan with even stages \[s\].
const END: f64 = STAGES as f64 * STAGE_PERIOD;

/// What is to be flown.
pub(super) struct Next<'a> {
    plan: &'a SpacePlan,
    loiter: Option<Loiter>,
    /// Time from the first knot for which there is a way out \[s\], and whether that is lost.
    holds: f64,
    lost: bool,
}

impl<'a> Next<'a> {
    /// A way out, lost or not.
    pub(super) fn on(way_out: &'a WayOut, lost: bool) -> Self {
        Self {
            plan: &way_out.plan,
            loiter: Some(way_out.loiter),
            holds: way_out.holds,
            lost,
        }
    }

    /// A plan, or where only plans with a way out are flown the one that ends on it.
    pub(super) fn of(plan: &'a SpacePlan, way_out: Option<&'a WayOut>, open: bool) -> Self {
        match way_out {
            Some(way_out) if open => Self::on(way_out, false),
            _ => Self {
                plan,
                loiter: None,
                holds: way_out.map_or(f64::NEG_INFINITY, |it| it.holds),
                lost: false,
            },
        }
    }
}

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
    /// The circle on which the plan ends.
    loiter: Option<Loiter>,
    /// Time from its first knot for which it has a way out \[s\], and whether that is lost.
    holds: f64,
    lost: bool,
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
            loiter: None,
            holds: f64::NEG_INFINITY,
            lost: false,
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

    /// Takes over the next plan, or its way out.
    pub(super) fn follow(&mut self, next: &Next<'_>, model: &SpaceModel, cycle: &Cycle) {
        self.second = !self.second;
        self.before = self.known.then_some(self.start);
        self.known = true;
        let [first, second] = &mut self.plans;
        *(if self.second { second } else { first }) = *next.plan;
        (self.loiter, self.holds, self.lost) = (next.loiter, next.holds, next.lost);
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

    /// The circle on which the plan ends, if it is flown.
    pub(super) fn loiter(&self) -> Option<&Loiter> {
        self.loiter.as_ref()
    }

    /// The circle, and the states on it at a tick and `lead` \[s\] later for an aircraft at a position \[m\]; `None` until the plan
    /// has come to its end.
    pub(super) fn circles(
        &self,
        tick: u32,
        lead: f64,
        position: &[f64; 3],
    ) -> Option<(&Loiter, [SpacePath; 2])> {
        let loiter = self.loiter.as_ref()?;
        let [plan, _] = self.both();
        if self.age(tick) + lead < plan.length() {
            return None;
        }
        Some((loiter, loiter.ahead(&self.model, position, lead)))
    }

    /// Time from a tick until the plan turns to its way out \[s\]; below zero on the way out.
    pub(super) fn turns_in(&self, tick: u32) -> f64 {
        self.holds - self.age(tick)
    }

    /// Time for which there is a way out \[s\], 0 once it is lost. On it this is the length of a plan.
    pub(super) fn way_out(&self, tick: u32) -> f64 {
        match (&self.loiter, self.turns_in(tick)) {
            _ if self.lost => 0.0,
            (Some(_), left) if left <= 0.0 => END,
            (_, left) => left.max(0.0),
        }
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
            let mut off: [f64; SPACE_STATES] =
                core::array::from_fn(|number| to[number] - from[number]);
            // A circle turns on; the estimate has courses within half a turn.
            let [.., course] = &mut off;
            *course = within_half_turn(*course);
            off
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
