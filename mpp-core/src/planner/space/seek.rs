//! The search of ways out, and what becomes of the one that is flown.

use super::candidate::{SpacePlan, tracking};
use super::judge::position;
use super::way_out::{MOST_STAGES, SLICE_STAGES, TURNS, Turn, WayOut, leaves};
use super::{Candidate, Phase, SpacePlanner};
use crate::config::{STAGE_PERIOD, STAGES};
use crate::map::VoxelGrid;
use crate::vehicle::{Loiter, SpacePath, between, within_half_turn};
use core::f64::consts::TAU;
use core::ops::Range;

/// Distance of the points that are looked at \[m\]: one and a half cells.
const APART: f64 = 0.75;
/// A time that rounding stays below \[s\].
const SHORT: f64 = 1e-6;
/// Most points of a stage.
const MOST_POINTS: f64 = 16.0;
/// Places on a circle that are looked at before it is flown.
const RING: usize = 48;
/// Time for which a circle on which the aircraft is must be free \[s\]. With more it is given up for plans that turn back where nobody has
/// looked, with less there is no time to avoid what has come up. Source: decision 76.
const AHEAD: f64 = 2.0;
/// Share of the margin that may be missing before the way out counts as lost [-]: errors of map and estimate need some.
const LOST: f64 = 0.5;

impl SpacePlanner {
    /// Takes over what was told of the last cycle: a step has no time to copy ways out.
    pub(super) fn settle_ways_out(&mut self) {
        if self.ways.holds {
            self.ways.held = self.ways.found;
        }
        (self.ways.turn, self.ways.found) = (None, None);
        (self.ways.holds, self.ways.looked) = (false, false);
    }

    /// The way out of the best plan, if the cycle has found one.
    #[must_use]
    pub fn way_out(&self) -> Option<&WayOut> {
        let settled = !matches!(self.phase, Phase::Begin | Phase::LookAgain);
        self.ways.found.as_ref().filter(|_| settled)
    }

    /// The way out that is flown, as it goes on from the start of the cycle; `None` if it is given up, or the cycle has not come so far.
    #[must_use]
    pub fn held(&self) -> Option<&WayOut> {
        let looked = self.ways.looked && self.phase != Phase::Begin;
        self.ways.held.as_ref().filter(|_| looked)
    }

    /// Whether something is known on the way out that is [held](Self::held). Such a one is flown as long as the best plan meets
    /// something as early.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.held().is_some() && self.ways.lost
    }

    /// Tells that the best plan is flown with its way out, if it has one.
    pub fn hold(&mut self) {
        (self.ways.holds, self.ways.flown) = (true, true);
    }

    /// Drops the best plan: the way out before it is [held](Self::held).
    pub fn refuse(&mut self) {
        self.best = None;
    }

    /// The plan that the last cycle has made the one that is flown, if it has.
    pub(super) fn taken(&self) -> Option<&SpacePlan> {
        let kept = || Some(&self.held()?.plan);
        self.best.as_ref().map(|best| &best.plan).or_else(kept)
    }

    /// Lets the way out that is flown begin where the aircraft is. Until it was looked at it is kept aside: a cycle that ends before
    /// leaves what is flown as it was.
    pub(super) fn renew(&mut self) -> Phase {
        self.ways.found = self.ways.held.map(|held| self.renewed(&held));
        Phase::LookAgain
    }

    /// Looks again at the way out that is flown. What is lost is given up over terrain, or for a best plan that meets nothing, or
    /// that keeps its margin for longer than the plan up to the circle does.
    pub(super) fn look_again(&mut self, map: &VoxelGrid) -> Phase {
        let mut held = self.ways.found;
        let lacks_at = (held.as_ref()).and_then(|it| self.lacks_at(&it.plan, it.holds));
        let passable = |held: &WayOut| self.is_passable(held, map);
        let lost = lacks_at.is_some() || held.as_ref().is_some_and(|held| !passable(held));
        let later = || lacks_at.is_some_and(|time| self.best_lasts(time));
        let over_terrain = VoxelGrid::follows(&self.keep.heights);
        if lost && (over_terrain || self.best_passes(map) || later()) {
            held = None;
        }
        self.ways.lost = lost;
        (self.ways.held, self.ways.found) = (held, None);
        self.ways.looked = true;
        Phase::WaysOut
    }

    /// A way out from the start of this cycle on.
    fn renewed(&self, held: &WayOut) -> WayOut {
        let (model, loiter, since) = (&self.model, held.loiter, self.since);
        let mut plan = self.new_plan();
        plan.fly(model, &self.start, |stage, state| {
            let period = self.grid.period(stage);
            let times = [0, 1].map(|more| since + self.grid.time(stage + more));
            // On the circle it converges to it, and not to how it was flown so far.
            let ((now, control), next) = if times[1] < held.holds + SHORT {
                let [now, (next, _)] = times.map(|time| held.plan.at(model, time));
                (now, next)
            } else {
                let [now, next] = loiter.ahead(model, &state.position, period);
                ((now, loiter.control(model, &now)), next)
            };
            tracking(model, state, &now, (&next, &control), period)
        });
        WayOut {
            plan,
            holds: held.holds - since,
            ..*held
        }
    }

    /// Time at which the first stage of a plan begins that lacks a share of the margin \[s\], if one before some time does.
    fn lacks_at(&self, plan: &SpacePlan, until: f64) -> Option<f64> {
        let judge = self.judge();
        let mut tally = judge.begin(plan);
        for (stage, knots) in plan.knots.windows(2).enumerate() {
            let ([from, to], time) = (knots, plan.grid.time(stage)) else {
                break;
            };
            if time >= until {
                break;
            }
            judge.add([from, to], stage, &mut tally);
            if tally.missing() > LOST * self.keep.margin {
                return Some(time);
            }
        }
        None
    }

    /// Whether the level of flight has something within the wing and a share of the margin, in stages of a plan that begin in a span of
    /// time \[s\]; `None` if it has not, and they leave the window.
    fn meets(
        &self,
        plan: &SpacePlan,
        times: Range<f64>,
        share: f64,
        map: &VoxelGrid,
    ) -> Option<bool> {
        let mut met = Some(false);
        for (stage, knots) in plan.knots.windows(2).enumerate() {
            let ([from, to], true) = (knots, times.contains(&plan.grid.time(stage))) else {
                continue;
            };
            let wide = self.reach(from, to, share);
            for point in self.points(from, to, plan.grid.period(stage)) {
                match map.is_met(&point, wide) {
                    Some(true) => return Some(true),
                    Some(false) => {}
                    None => met = None,
                }
            }
        }
        met
    }

    /// Whether the map knows nothing within the wing on the way to the circle and on its next half; on the circle, in what comes next.
    fn is_passable(&self, held: &WayOut, map: &VoxelGrid) -> bool {
        let (plan, loiter) = (&held.plan, &held.loiter);
        let circles = held.holds <= 0.0;
        let until = if circles { AHEAD } else { plan.length() };
        let met = self.meets(plan, held.holds..until, 1.0 - LOST, map);
        let [.., last] = &plan.knots;
        let from = loiter.angle(&last.position);
        let at = loiter.at(&self.model, from);
        let wide = self.reach(&at, &at, 1.0 - LOST);
        let mut places = (0..RING / 2).map(|place| TAU * place as f64 / RING as f64);
        let free = |place: &[f64; 3]| map.is_met(place, wide) == Some(false);
        met == Some(false)
            && (circles || places.all(|by| free(&loiter.place(from + loiter.side * by))))
    }

    /// Whether the best plan keeps its distances, and nothing is known within its wing on the level of flight.
    fn best_passes(&self, map: &VoxelGrid) -> bool {
        self.best
            .as_ref()
            .is_some_and(|Candidate { plan, judgement }| {
                let met = self.meets(plan, 0.0..plan.length(), 0.0, map);
                judgement.missing <= 0.0 && met != Some(true)
            })
    }

    /// Whether the best plan lacks no share of the margin up to the stage of some time \[s\].
    fn best_lasts(&self, time: f64) -> bool {
        let lacks = |best: &Candidate| self.lacks_at(&best.plan, time + STAGE_PERIOD);
        (self.best.as_ref()).is_some_and(|best| lacks(best).is_none())
    }

    /// Counts the first stages of the best plan that are clear, in voxels that have been seen, and that meet nothing known on the
    /// level of flight: it remembers what the window of voxels has left behind.
    pub(super) fn begin_ways_out(&mut self, map: &VoxelGrid) -> Phase {
        let Some(best) = &self.best else {
            return Phase::Idle;
        };
        let (plan, judge) = (&best.plan, self.judge());
        let mut tally = judge.begin(plan);
        let mut clear = 0;
        for (stage, knots) in plan.knots.windows(2).enumerate() {
            let [from, to] = knots else { break };
            judge.add([from, to], stage, &mut tally);
            let wide = self.reach(from, to, 0.0);
            let mut points = self.points(from, to, self.grid.period(stage));
            let free =
                points.all(|point| map.has_seen(&point) && map.is_met(&point, wide) != Some(true));
            if tally.missing() > 0.0 || !free {
                break;
            }
            clear = stage + 1;
        }
        self.ways.clear = clear;
        Phase::WayOut(0)
    }

    /// Flies some stages of a circle, until one is not free or it is closed.
    pub(super) fn seek_way_out(&mut self, map: &VoxelGrid, number: usize) -> Phase {
        let begun = self.ways.turn.take();
        if let Some(mut turn) = begun.or_else(|| self.begin_turn(map, number)) {
            let mut free = true;
            for _ in 0..SLICE_STAGES {
                free = free && self.fly_turn(&mut turn, map);
                if free && turn.swept >= TAU && turn.stage >= STAGES {
                    self.ways.found = Some(WayOut {
                        plan: turn.plan,
                        loiter: turn.loiter,
                        holds: self.grid.time(leaves(number)),
                    });
                    return Phase::Idle;
                }
            }
            if free && turn.stage < MOST_STAGES {
                self.ways.turn = Some(turn);
                return Phase::WayOut(number);
            }
        }
        if number + 1 < TURNS {
            Phase::WayOut(number + 1)
        } else {
            Phase::Idle
        }
    }

    /// Begins a circle; `None` where its plan is not clear so far, or places on it are not free, or another circle is flown.
    fn begin_turn(&self, map: &VoxelGrid, number: usize) -> Option<Turn> {
        let knot = leaves(number);
        let holds = self.ways.held.is_some() && !self.ways.lost;
        if knot > self.ways.clear || (knot == 0 && holds) {
            return None;
        }
        let plan = self.best.as_ref()?.plan;
        let state = *plan.knots.get(knot)?;
        let side = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let loiter = Loiter::joined(&self.model, &state, side, self.keep.altitude)?;
        let at = loiter.at(&self.model, loiter.angle(&state.position));
        let reach = self.reach(&at, &at, 1.0);
        let mut places = (0..RING).map(|at| loiter.place(TAU * at as f64 / RING as f64));
        let free = places.all(|place| self.is_free(&place, reach, map));
        free.then_some(Turn {
            plan,
            loiter,
            state,
            stage: knot,
            swept: 0.0,
        })
    }

    /// Flies a stage of a circle as the regulator does. Returns whether it is free.
    fn fly_turn(&self, turn: &mut Turn, map: &VoxelGrid) -> bool {
        let (model, loiter, from) = (&self.model, turn.loiter, turn.state);
        let period = match turn.stage {
            0 => self.grid.period(0),
            _ => STAGE_PERIOD,
        };
        let [now, next] = loiter.ahead(model, &from.position, period);
        let control = loiter.control(model, &now);
        let control = tracking(model, &from, &now, (&next, &control), period);
        let to = from.after(model, &control, period);
        let plan = &mut turn.plan;
        if let (Some(kept), Some(knot)) = (
            plan.controls.get_mut(turn.stage),
            plan.knots.get_mut(turn.stage + 1),
        ) {
            (*kept, *knot) = (control, to);
        }
        let [before, after] = [from, to].map(|it| loiter.angle(&it.position));
        turn.swept += loiter.side * within_half_turn(after - before);
        turn.state = to;
        turn.stage += 1;
        let reach = self.reach(&from, &to, 1.0);
        let mut points = self.points(&from, &to, period);
        points.all(|point| self.is_free(&point, reach, map))
    }

    /// Whether a point lies in the band, and all within a distance of it \[m\] was seen free.
    fn is_free(&self, point: &[f64; 3], reach: f64, map: &VoxelGrid) -> bool {
        self.keep.outside(point) <= 0.0 && map.is_free(point, reach)
    }

    /// Distance that the body with its wing, and a share of its margin, take up to either side of a stage \[m\].
    fn reach(&self, from: &SpacePath, to: &SpacePath, share: f64) -> f64 {
        let bank = libm::fabs(from.bank).min(libm::fabs(to.bank));
        share * self.keep.margin + self.keep.half_span * libm::cos(bank)
    }

    /// Points of a stage of some length \[s\].
    fn points(
        &self,
        from: &SpacePath,
        to: &SpacePath,
        period: f64,
    ) -> impl Iterator<Item = [f64; 3]> {
        let velocities = [from, to].map(|it| it.ground_velocity(&self.model.wind));
        let apart = APART / self.model.trim.state.airspeed.max(1.0);
        let count = between(libm::ceil(period / apart), [1.0, MOST_POINTS]);
        let knots = [*from, *to];
        (1..=count as usize).map(move |at| {
            let [from, to] = &knots;
            position([from, to], &velocities, at as f64 / count, period)
        })
    }
}
