//! How a flight in space ends, and the cause of a collision.
//!
//! The first rule that applies gives the [`Cause`]:
//!
//! 1. no beam had ended [`NEAR`] where the hull touched, [`KNOWN`] before: [`Cause::Hidden`];
//! 2. of the plan that was flown then, distances were missing in the map: [`Cause::NoWay`];
//! 3. at the end the aircraft was off what it followed by more than [`OFF`]: [`Cause::Tracking`];
//! 4. otherwise [`Cause::Misjudged`]: a plan since then led into it.

use super::world::{Vector, World};
use super::{SpaceScenario, SpaceState};
use crate::entries::PlanEntry;
use crate::inquest::{Cause, Failure};
use crate::outcome::Outcome;
use crate::scenario::Scenario;

/// How far beyond the band a flight may stray \[m\].
pub const STRAY: f64 = 0.5;
/// Time for which an obstacle must be known to be avoided \[s\], as a known collision in the plane has it.
const KNOWN: f64 = 1.0;
/// Distance from where the hull touches up to which the end of a beam shows it \[m\]: two voxels, or rings 2 deg apart at 30 m.
const NEAR: f64 = 1.0;
/// Distance from what is followed beyond which it is the regulator that failed \[m\]: the margin of plans.
const OFF: f64 = 0.3;

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
        let near = |at: &[f32; 3]| {
            let square = |axis: usize| (f64::from(at[axis]) - place[axis]).powi(2);
            (0..3).map(square).sum::<f64>() < NEAR * NEAR
        };
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
            let used = plan.used_from_tick.map_or(f64::INFINITY, |tick| {
                Scenario::time(u32::try_from(tick).unwrap_or(u32::MAX))
            });
            !plan.had_nothing() && used <= end - KNOWN
        };
        let plan = plans.iter().rev().find(flown_then);
        let tight = plan.is_none_or(|plan| plan.violation.is_none_or(|missing| missing > 0.0));
        let cause = if seen_before.is_none_or(|time| time < KNOWN) {
            Cause::Hidden
        } else if tight {
            Cause::NoWay
        } else if off.is_some_and(|off| off > OFF) {
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

    /// Beams that end 0.8 m aside of the place from 3 s or from 4.5 s on, plans with and without room, near it and off it at the end,
    /// which comes at 5 s. What lacks room later than a second before the end is no cause: nobody can avoid it then.
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
        let (free, tight) = ([0.0, 0.3], [0.2, 0.0]);
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
