//! How a flight in space ends, and the cause of a collision.
//!
//! The first rule that applies gives the [`Cause`]:
//!
//! 1. [`KNOWN`] before, no beam had ended [`NEAR`] where the hull touched: [`Cause::Hidden`];
//! 2. the plan that was flown then lacked its whole [`MARGIN`], so it touched something in the map: [`Cause::NoWay`];
//! 3. at the end the aircraft was farther than this margin to a side of what it followed: [`Cause::Tracking`];
//! 4. otherwise [`Cause::Misjudged`]: map, estimate or a plan since then were wrong by a part of the margin.

use super::scenario::MARGIN;
use super::world::{Vector, World, dot, length, minus};
use super::{SpaceScenario, SpaceState, true_path};
use crate::entries::PlanEntry;
use crate::flight_observer::KNOWN;
use crate::inquest::{Cause, Failure};
use crate::log::FlightLog;
use crate::outcome::Outcome;
use mpp_core::config::TICK_PERIOD;

/// How far beyond the band a flight may stray \[m\].
pub const STRAY: f64 = 0.5;
/// Distance from where the hull touches up to which the end of a beam shows it \[m\]: two voxels, or rings 2 deg apart at 30 m.
const NEAR: f64 = 1.0;

impl SpaceScenario {
    /// How a flight ends whose last tick, of those flown, moved it from one state to another; `None` if it goes on.
    #[must_use]
    pub fn judge(
        &self,
        world: &World,
        before: &SpaceState,
        state: &SpaceState,
        flown: u32,
    ) -> Option<Outcome> {
        let extent = world.extent();
        let sideways = state.lateral.y.abs() > extent.half_width + STRAY;
        let upwards = state.plane.z > extent.ceiling + STRAY;
        if self.hull().first_contact(world, before, state).is_some() {
            Some(Outcome::Collision)
        } else if state.plane.x >= extent.length {
            Some(Outcome::Survived)
        } else {
            (sideways || upwards || flown >= self.plane.ticks).then_some(Outcome::NotArrived)
        }
    }
}

/// Where beams have ended, for the cause of a collision.
#[derive(Clone, Debug, Default)]
pub(super) struct Inquest {
    /// The time of each sweep \[s\], and where its beams ended by true poses.
    sweeps: Vec<(f64, Vec<[f32; 3]>)>,
}

impl Inquest {
    /// Takes the ends of the beams of a sweep.
    pub(super) fn watch(&mut self, time: f64, returns: &[Vector]) {
        let ends = returns.iter().map(|end| end.map(|it| it as f32));
        self.sweeps.push((time, ends.collect()));
    }

    /// Time from the first sweep with an end near a place until some time \[s\].
    fn seen_before(&self, place: Vector, end: f64) -> Option<f64> {
        let near = |at: &[f32; 3]| length(minus(at.map(f64::from), place)) < NEAR;
        let met = self.sweeps.iter().find(|(_, ends)| ends.iter().any(near));
        met.map(|(time, _)| end - time)
    }

    /// The failure of a flight that ended with the hull at a place, `off` what it followed \[m\].
    pub(super) fn collision(
        &self,
        plans: &[PlanEntry],
        place: Vector,
        off: Option<f64>,
        end: f64,
    ) -> Failure {
        let seen_before = self.seen_before(place, end);
        let flown_then = |plan: &&PlanEntry| {
            let used = |tick: u64| tick as f64 * TICK_PERIOD;
            let then = (plan.used_from_tick).is_some_and(|tick| used(tick) <= end - KNOWN);
            then && !plan.had_nothing()
        };
        let plan = plans.iter().rev().find(flown_then);
        let touches = plan
            .and_then(|plan| plan.violation)
            .is_none_or(|it| it >= MARGIN);
        let cause = if seen_before.is_none_or(|time| time <= KNOWN) {
            Cause::Hidden
        } else if touches {
            Cause::NoWay
        } else if off.is_some_and(|off| off > MARGIN) {
            Cause::Tracking
        } else {
            Cause::Misjudged
        };
        Failure {
            cause,
            seen_before,
            plan_clearance: None,
            off_plan: off,
        }
    }
}

/// Distance of a state to the side of what was followed in the last tick of a log, or above or below it \[m\]. No regulator holds the
/// time of a plan.
pub(super) fn off_track(log: &FlightLog, state: &SpaceState) -> Option<f64> {
    let last = |column: &[Option<f64>]| column.last().copied().flatten();
    let (ticks, side) = (&log.ticks, &log.lateral);
    let followed = [last(&ticks.ref_x)?, last(&side.ref_y)?, last(&ticks.ref_z)?];
    let path = true_path(state);
    let off = minus(path.position, followed);
    let [_, up, right] = path.axes();
    Some(libm::hypot(dot(off, up), dot(off, right)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plan that is flown from a tick on, and the clearance that it lacks \[m\].
    fn plan(tick: u64, violation: f64) -> PlanEntry {
        PlanEntry {
            tick,
            used_from_tick: Some(tick + 5),
            outcome: "Adopted".to_owned(),
            candidates: 3,
            feasible: 1,
            tree_runs: 0,
            slices: 100,
            cost: Some(1.0),
            violation: Some(violation),
            way_out: None,
        }
    }

    /// Beams that end 0.8 m aside of the place from 3 s or from 4.5 s on, plans that lack less or more than the margin, near it and off
    /// it at the end, which comes at 5 s. What a plan lacks later than a second before the end is no cause: nobody can avoid it then.
    #[test]
    fn each_collision_has_the_cause_of_the_first_rule_that_applies() {
        let place = [60.0, 1.0, 8.0];
        let of = |met: f64, aside: f64, missing: [f64; 2], off: Option<f64>| {
            let mut inquest = Inquest::default();
            for tenth in 0..50 {
                let time = 0.1 * f64::from(tenth);
                let far = [90.0, 1.0, 8.0];
                let near = [60.0, 1.0 + aside, 8.0];
                inquest.watch(time, &[far, if time < met { far } else { near }]);
            }
            let plans = [plan(300, missing[0]), plan(420, missing[1])];
            inquest.collision(&plans, place, off, 5.0)
        };
        let (free, tight) = ([0.9 * MARGIN, 2.0 * MARGIN], [1.1 * MARGIN, 0.0]);
        let failure = of(2.95, 0.8, free, Some(0.1));
        assert_eq!(failure.cause, Cause::Misjudged);
        assert!((failure.seen_before.unwrap() - 2.0).abs() < 1e-9);
        assert_eq!(failure.off_plan, Some(0.1));
        assert_eq!(of(4.45, 0.8, free, None).cause, Cause::Hidden);
        let unseen = of(0.0, 1.2, tight, Some(1.0));
        assert_eq!((unseen.cause, unseen.seen_before), (Cause::Hidden, None));
        assert_eq!(of(2.95, 0.8, tight, Some(1.0)).cause, Cause::NoWay);
        assert_eq!(of(2.95, 0.8, free, Some(0.5)).cause, Cause::Tracking);
    }
}
