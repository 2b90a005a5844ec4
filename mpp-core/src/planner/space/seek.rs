//! The search of ways out, and what becomes of the one that is flown.

use super::candidate::tracking;
use super::judge::{Judge, SpaceJudgement};
use super::way_out::{MOST_STAGES, SLICE_STAGES, TURNS, Turn, WayOut, leaves};
use super::{Candidate, Phase, SpacePlanner};
use crate::config::{STAGE_PERIOD, STAGES};
use crate::map::VoxelGrid;
use crate::vehicle::{Loiter, SpacePath, between, within_half_turn};
use core::f64::consts::TAU;

/// Distance of the points that are looked at \[m\]: one and a half cells.
const APART: f64 = 0.75;
/// A time that rounding stays below \[s\].
const SHORT: f64 = 1e-6;
/// Most points of a stage.
const MOST_POINTS: f64 = 16.0;
/// Places on half a circle that are looked at again.
const PLACES: usize = 90;
/// Least lift across the flight path of a stage that is flown on until its circle [m/s^2]. With little lift a bank has no effect, and
/// the regulator loses the plan. Source: decision 76.
const LEAST_PULL: f64 = 5.0;
/// Share of the margin that may be missing before the way out counts as lost [-]: errors of map and estimate need some.
const LOST: f64 = 0.5;

impl SpacePlanner {
    /// Begins a cycle: nothing is found yet.
    pub(super) fn forget_ways_out(&mut self) {
        // In place: a step has no time to copy the one that is held.
        (self.ways.turn, self.ways.found) = (None, None);
        (self.ways.clear, self.ways.looked) = (0, false);
    }

    /// The way out of the best plan, if the cycle has found one.
    #[must_use]
    pub fn way_out(&self) -> Option<&WayOut> {
        self.ways.found.as_ref()
    }

    /// The way out that is flown, as it goes on from the start of the cycle; `None` if something is known on it, or the cycle has not
    /// come so far.
    #[must_use]
    pub fn held(&self) -> Option<&WayOut> {
        self.ways.held.as_ref().filter(|_| self.ways.looked)
    }

    /// Tells that the best plan is flown with its way out, if it has one.
    pub fn hold(&mut self) {
        self.ways.held = self.ways.found;
    }

    /// Drops the best plan: the way out before it is [held](Self::held).
    pub fn refuse(&mut self) {
        // Nobody asks what it is worth: it is the previous plan of the next cycle.
        let judgement = SpaceJudgement {
            price: f64::INFINITY,
            missing: f64::INFINITY,
        };
        self.best = self.held().map(|held| Candidate {
            plan: held.plan,
            judgement,
        });
    }

    /// Looks again at the way out that is flown.
    pub(super) fn look_again(&mut self, map: &VoxelGrid) -> Phase {
        let held = self.ways.held;
        let free = held.filter(|held| self.is_clear(held) && self.is_passable(held, map));
        self.ways.looked = true;
        self.ways.held = free.map(|held| self.renewed(&held));
        Phase::WaysOut
    }

    /// A way out from the start of this cycle on, so that it begins where the aircraft is.
    fn renewed(&self, held: &WayOut) -> WayOut {
        let (model, loiter, since) = (&self.model, held.loiter, self.since);
        let mut plan = self.new_plan();
        plan.fly(model, &self.start, |stage, state| {
            let period = self.grid.period(stage);
            let times = [0, 1].map(|more| since + self.grid.time(stage + more));
            // At its end a plan is level; that is not the circle.
            let [now, next] = if times[1] < held.plan.length() - SHORT {
                times.map(|time| held.plan.at(model, time))
            } else {
                let angle = loiter.angle(&state.position);
                [angle, loiter.later(model, angle, period)].map(|angle| {
                    let at = loiter.at(model, angle);
                    (at, loiter.control(model, &at))
                })
            };
            tracking(model, state, &now.0, (&next.0, &now.1), period)
        });
        WayOut {
            plan,
            holds: held.holds - since,
            ..*held
        }
    }

    /// Whether the rest of the plan up to the circle keeps some of its margin.
    fn is_clear(&self, held: &WayOut) -> bool {
        let (plan, judge) = (&held.plan, self.judge());
        let judge = Judge {
            grid: plan.grid,
            ..judge
        };
        let mut tally = judge.begin(plan);
        for (stage, knots) in plan.knots.windows(2).enumerate() {
            let [from, to] = knots else { break };
            if plan.grid.time(stage) >= held.holds {
                break;
            }
            if plan.grid.time(stage + 1) > self.since {
                judge.add([from, to], stage, &mut tally);
            } else {
                judge.pass([from, to], stage, &mut tally);
            }
        }
        tally.missing() <= LOST * self.keep.margin
    }

    /// Whether the map knows nothing within the wing on the way to the circle and on its next half.
    fn is_passable(&self, held: &WayOut, map: &VoxelGrid) -> bool {
        let (plan, loiter) = (&held.plan, &held.loiter);
        let after = self.since.max(held.holds);
        let met = |point: &[f64; 3], wide: f64| map.is_met(point, wide);
        let mut stages = (plan.knots.windows(2).enumerate())
            .filter(|(stage, _)| plan.grid.time(*stage) >= after);
        let joins = stages.all(|(stage, knots)| match knots {
            [from, to] => {
                let wide = self.wide(from, to);
                let mut points = self.points(from, to, plan.grid.period(stage));
                points.all(|point| !met(&point, wide))
            }
            _ => true,
        });
        let from = match &plan.knots {
            [.., last] if self.since < plan.length() => last,
            _ => &self.start,
        };
        let here = loiter.angle(&from.position);
        joins
            && (0..PLACES).all(|place| {
                let by = 0.5 * TAU * place as f64 / PLACES as f64;
                let at = loiter.at(&self.model, here + loiter.side * by);
                !met(&at.position, self.wide(&at, &at))
            })
    }

    /// Counts the first stages of the best plan that are clear, in voxels that have been seen.
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
            let mut points = self.points(from, to, self.grid.period(stage));
            let seen = points.all(|point| map.has_seen(&point));
            if tally.missing() > 0.0 || !seen || !self.pulls(to) {
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
        if let Some(mut turn) = begun.or_else(|| self.begin_turn(number)) {
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

    /// Begins a circle; `None` where its plan is not clear so far, or another circle is flown.
    fn begin_turn(&self, number: usize) -> Option<Turn> {
        let knot = leaves(number);
        if knot > self.ways.clear || (knot == 0 && self.ways.held.is_some()) {
            return None;
        }
        let plan = self.best.as_ref()?.plan;
        let state = *plan.knots.get(knot)?;
        let side = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        Some(Turn {
            plan,
            loiter: Loiter::joined(&self.model, &state, side, self.keep.altitude)?,
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
        let angle = loiter.angle(&from.position);
        let now = loiter.at(model, angle);
        let next = loiter.at(model, loiter.later(model, angle, period));
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
        let by = within_half_turn(loiter.angle(&to.position) - angle);
        turn.swept += loiter.side * by;
        turn.state = to;
        turn.stage += 1;
        let (reach, [low, high]) = (self.reach(&from, &to), self.keep.heights);
        let free = |point: [f64; 3]| (low..=high).contains(&point[2]) && map.is_free(&point, reach);
        self.pulls(&to) && self.points(&from, &to, period).all(free)
    }

    fn pulls(&self, at: &SpacePath) -> bool {
        let thrust = self.model.trim.control.thrust;
        self.model.pull(at.airspeed, at.angle_of_attack, thrust) >= LEAST_PULL
    }

    /// Distance that the body with its wing takes up to either side of a stage \[m\].
    fn reach(&self, from: &SpacePath, to: &SpacePath) -> f64 {
        let bank = libm::fabs(from.bank).min(libm::fabs(to.bank));
        self.keep.margin + self.keep.half_span * libm::cos(bank)
    }

    /// The same without what may be missing.
    fn wide(&self, from: &SpacePath, to: &SpacePath) -> f64 {
        self.reach(from, to) - self.keep.margin
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
            Judge::point([from, to], &velocities, at as f64 / count, period)
        })
    }
}
