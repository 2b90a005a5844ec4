//! The end of a cycle: what the gate lets through is offered, by a ladder. First comes the plan; then the previous plan; then
//! a path of the lattice, flown out by pursuit; then a reserve. If nothing passes, what strikes latest is flown on.
//!
//! Each slice offers one trajectory to the [gate](crate::gate). The ladder's slices are not counted as those of planning.

use super::pursuit::Course;
use super::rungs::{Ladder, Reserve, Rung};
use super::{Candidate, Phase, PlanePlanner};
use crate::gate::{Cause, GateVerdict, Space};
use crate::planner::summary::Verdict;

impl PlanePlanner {
    /// Ends the cycle and returns its verdict. A cycle that is cut short still goes through the gate: nothing else is offered.
    pub fn finish(&mut self) -> Verdict {
        let planned = matches!(self.phase, Phase::Gate | Phase::Done);
        self.summary.complete = planned && !self.summary.inconsistent;
        if self.is_working() && !planned {
            self.climb_down();
        }
        while self.advance() {}
        self.phase = Phase::Idle;
        self.ladder.verdict
    }

    /// Begins the ladder. Planning ends.
    pub(super) fn climb_down(&mut self) {
        self.order = super::refine::order(&self.candidates);
        self.ladder = Ladder::NEW;
        self.phase = Phase::Gate;
    }

    /// Offers one trajectory to the gate.
    #[inline(never)]
    pub(super) fn offer_next(&mut self) {
        let rung = self.ladder.rung;
        if self.write_rung(rung) {
            // A plan that leaves the band upwards may do what a climb may.
            let space = match rung.space() {
                Space::NotOccupied if self.summary.leaves => Space::Above,
                space => space,
            };
            match self.gate.check(&self.map, &self.best, space) {
                GateVerdict::Passes => return self.take(rung),
                GateVerdict::Refused(cause, after) => self.refuse(rung, cause, after),
            }
        }
        match rung.below() {
            Some(below) => self.ladder.rung = below,
            None => self.end_of_ladder(),
        }
    }

    /// Writes the trajectory of a rung into [`Self::best`]. False if there is none.
    fn write_rung(&mut self, rung: Rung) -> bool {
        let candidate = match rung {
            // It is there already.
            Rung::Best => return self.best_price.is_finite(),
            Rung::Previous => {
                self.best.clone_from(&self.previous);
                return self.lasts();
            }
            Rung::Other(place) => self.priced(place),
            Rung::Pursuit(index) => (self.candidates.get(index).copied())
                .filter(|it| it.price.is_infinite())
                .map(|path| self.pursue(&Course::Path(&path.flown.knots))),
            Rung::Reserve(kind) => Reserve::ALL.get(kind).map(|kind| self.manoeuvre(*kind)),
        };
        let Some(candidate) = candidate else {
            return false;
        };
        let judgement = self.judge(&candidate.flown);
        (self.summary.cost, self.summary.violation) = (judgement.effort, judgement.lack);
        self.keep(&candidate.flown);
        true
    }

    /// The roll-out at a place in the order of prices.
    fn priced(&self, place: usize) -> Option<Candidate> {
        let candidate = self
            .order
            .get(place)
            .and_then(|it| self.candidates.get(*it))?;
        candidate.price.is_finite().then_some(*candidate)
    }

    /// The roll-out of a reserve.
    fn manoeuvre(&self, kind: Reserve) -> Candidate {
        self.pursue(&match kind {
            Reserve::Level => Course::Level(self.trim),
            Reserve::Slow => Course::Level(self.slowest().unwrap_or(self.trim)),
            Reserve::Climb => Course::Climb(self.limits.flight_path),
        })
    }

    /// Whether the previous plan lasts long enough to be flown on.
    fn lasts(&self) -> bool {
        let until = self.time + crate::tuning::gate::REST * self.units.time;
        self.best.sample(self.time).is_some() && self.best.sample(until).is_some()
    }

    fn refuse(&mut self, rung: Rung, cause: Cause, after: f64) {
        if rung == Rung::Best {
            self.summary.refused = Some(cause);
        }
        // What is no motion of this aircraft is never flown.
        let is_motion = matches!(cause, Cause::Obstacle | Cause::Altitude);
        if is_motion && self.ladder.latest.is_none_or(|(_, latest)| after > latest) {
            // Later rounds may have replaced the roll-out with the lowest price.
            let again = if rung == Rung::Best {
                Rung::Other(0)
            } else {
                rung
            };
            self.ladder.latest = Some((again, after));
        }
    }

    fn take(&mut self, rung: Rung) {
        self.end_with(match rung {
            Rung::Best | Rung::Other(_) => self.summary.verdict(),
            Rung::Previous => Verdict::Kept,
            Rung::Pursuit(_) => Verdict::Pursuit,
            Rung::Reserve(_) => Verdict::Reserve,
        });
    }

    /// Nothing passes.
    fn end_of_ladder(&mut self) {
        let latest = self.ladder.latest.map(|(rung, _)| rung);
        if latest.is_some_and(|rung| self.write_rung(rung)) {
            self.end_with(Verdict::Latest);
        } else {
            self.best.clone_from(&self.previous);
            self.end_with(Verdict::Nothing);
        }
    }

    fn end_with(&mut self, verdict: Verdict) {
        if matches!(verdict, Verdict::Kept | Verdict::Nothing) {
            (self.summary.cost, self.summary.violation) = (f64::INFINITY, f64::INFINITY);
        }
        self.ladder.verdict = verdict;
        self.ladder.seal = self.best.seal();
        self.phase = Phase::Done;
    }
}
