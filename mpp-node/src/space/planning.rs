//! The work of the planner in space: where cycles begin, what they may use, and when their plan is taken over.

use super::cycle::{Cycle, Next};
use super::intake::{Intake, IntakeStage};
use super::{Session, SpaceMemory, SpaceSlice, SpaceTask};
use crate::{duration, ticks};
use hil_protocol::{PlanOutcome, PlanReport};
use mpp_core::control::SpaceMotion;
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::{MOST_SPACE_SLICES, SpacePlanner, next_start, next_start_on_circle};
use mpp_core::vehicle::{Nose, SpaceControl, SpacePath};

/// Points that go into the map in one slice.
const SLICE_POINTS: usize = 24;

impl SpaceTask {
    /// After the step at a place and with what it followed: points wait for the map, a cycle begins when its time has come, and
    /// slices are granted.
    pub(super) fn plan(
        &mut self,
        tick: u32,
        (position, followed): ([f64; 3], SpacePath),
        planner: &mut SpacePlanner,
    ) {
        let Some(session) = &mut self.session else {
            return;
        };
        let seen = !self.sweep.is_empty();
        if seen {
            self.intake = Some(Intake {
                tick,
                position,
                course: followed.course,
                stage: IntakeStage::Begin,
            });
        }
        // A silent lidar leaves the map as it is, and plans go on in it.
        let period = session.configure.replan_period_ticks;
        let patience = if seen {
            period
        } else {
            period.saturating_mul(2)
        };
        let due = match session.last_cycle {
            Some(last) => ticks(last, tick).unsigned_abs() >= patience,
            None => seen,
        };
        if due && let Some(motion) = session.estimator.motion() {
            session.begin(planner, tick, (&motion, &followed));
        }
        self.granted = session
            .configure
            .slices_per_tick
            .min(MOST_SPACE_SLICES as u32);
    }

    /// What [`advance`](Self::advance) does next; `None` until the next tick.
    #[must_use]
    pub fn slice(&self, planner: &SpacePlanner) -> Option<SpaceSlice> {
        if let Some(intake) = self.intake {
            return Some(match intake.stage {
                IntakeStage::Begin => SpaceSlice::Sweep,
                IntakeStage::Mark(_) | IntakeStage::Pass(_) => SpaceSlice::Map,
            });
        }
        self.session.as_ref()?.cycle.filter(|it| !it.complete)?;
        let stage = planner.stage().filter(|_| self.granted > 0);
        stage.map(SpaceSlice::Planner)
    }

    /// Does a slice of the work between two ticks, or a part of one. Returns false if there is none.
    pub fn advance(&mut self, memory: &mut SpaceMemory<'_>) -> bool {
        let (Some(_), Some(session)) = (self.slice(memory.planner), &mut self.session) else {
            return false;
        };
        if let Some(intake) = self.intake.take() {
            self.take_in(intake, memory.map);
        } else if let Some(cycle) = &mut session.cycle {
            cycle.complete = memory.planner.advance(memory.map);
            if memory.planner.is_between_slices() {
                self.granted = self.granted.saturating_sub(1);
                cycle.slices = cycle.slices.saturating_add(1);
            }
        }
        true
    }

    /// The tick of the first knot of the plan that is under way.
    pub(super) fn begins(&self) -> Option<u32> {
        Some(self.session.as_ref()?.cycle?.start)
    }

    /// Takes some points into the map: first all hits, then what the beams passed.
    fn take_in(&mut self, intake: Intake, map: &mut VoxelGrid) {
        let Some(session) = &self.session else {
            return;
        };
        let end = |first: usize| (first + SLICE_POINTS).min(self.sweep.len());
        let beams = |first, hits| {
            let points = first..end(first);
            self.sweep
                .beams(intake.tick, &session.estimator, points, hits)
        };
        let stage = match intake.stage {
            IntakeStage::Begin => {
                map.begin(&intake.position, intake.course);
                IntakeStage::Mark(0)
            }
            IntakeStage::Mark(first) => {
                beams(first, true).for_each(|beam| map.mark(&beam));
                if end(first) < self.sweep.len() {
                    IntakeStage::Mark(end(first))
                } else {
                    IntakeStage::Pass(0)
                }
            }
            IntakeStage::Pass(first) => {
                let sight = f64::from(session.configure.range_max);
                beams(first, false).for_each(|beam| map.pass(&beam, sight));
                if end(first) == self.sweep.len() {
                    self.sweep.clear_points();
                    return;
                }
                IntakeStage::Pass(end(first))
            }
        };
        self.intake = Some(Intake { stage, ..intake });
    }
}

impl Session {
    /// Begins a cycle from where the aircraft will be when the plan begins.
    fn begin(
        &mut self,
        planner: &mut SpacePlanner,
        tick: u32,
        (motion, followed): (&SpaceMotion, &SpacePath),
    ) {
        let model = self.model;
        let configure = &self.configure;
        let due = tick.wrapping_add(configure.latency_ticks);
        let (start, state, shift) = match self.flown.some() {
            Some(flown) => {
                // The regulator looks ahead: a plan begins where it will look when the plan is due, and no more than one waits.
                let most = (configure.replan_period_ticks.saturating_mul(2))
                    .saturating_sub(configure.latency_ticks);
                let lead = (libm::round(self.ahead / duration(1)) as u32).min(most);
                let start = due.wrapping_add(lead);
                let time = flown.age(start);
                let lead = duration(ticks(tick, start).unsigned_abs());
                let planned = match flown.circles(tick, lead, &motion.path.position) {
                    Some((_, [_, then])) => then,
                    None => flown.at(time).0,
                };
                let deviation = flown.deviation(tick, followed, &motion.path);
                let circles = flown.loiter().filter(|_| flown.turns_in(tick) < 0.0);
                let next = match circles {
                    Some(loiter) => next_start_on_circle(&planned, &deviation, loiter),
                    None => next_start(&planned, &deviation),
                };
                (start, next, time)
            }
            None => {
                let level = SpaceControl {
                    thrust: model.trim.control.thrust,
                    ..SpaceControl::default()
                };
                let latency = duration(configure.latency_ticks);
                (due, motion.path.after(&model, &level, latency), 0.0)
            }
        };
        planner.set_wind(model.wind);
        let [roll, _, yaw] = motion.rates;
        let runaway = |nose: &Nose| nose.runaway(motion.sideslip, [roll, yaw], motion.path.bank);
        planner.set_runaway(model.nose.as_ref().map_or(0.0, runaway));
        planner.begin(&state, shift);
        self.last_cycle = Some(tick);
        self.cycle = Some(Cycle {
            begun: tick,
            due,
            start,
            slices: 0,
            complete: false,
        });
    }

    /// Takes over the plan that is due in this tick.
    pub(super) fn take_over(&mut self, planner: &mut SpacePlanner, tick: u32) {
        let Some(cycle) = self.cycle.filter(|cycle| ticks(cycle.due, tick) >= 0) else {
            return;
        };
        self.cycle = None;
        let best = planner.best();
        let (cost, violation) = best.map_or((f64::INFINITY, f64::INFINITY), |(_, judged)| {
            (judged.price, judged.missing)
        });
        let way_out = planner.way_out();
        let later = way_out.is_some_and(|it| it.holds >= self.flown.turns_in(cycle.start));
        // Once there is a way out, a plan without a later one is not flown, and once it is lost a plan without any. A cycle that did
        // not come so far leaves what is flown.
        let held = planner.held();
        let waits = if planner.is_lost() {
            way_out.is_none()
        } else {
            held.is_some() || !cycle.complete
        };
        let kept = self.open && self.flown.loiter().is_some() && waits && !later;
        let outcome = match best {
            Some(_) if kept => PlanOutcome::KeptPrevious,
            Some(_) if violation <= 0.0 => PlanOutcome::Adopted,
            Some(_) => PlanOutcome::LeastViolating,
            None if self.flown.some().is_some() => PlanOutcome::KeptPrevious,
            None => PlanOutcome::TrimHold,
        };
        let next = if kept {
            held.map(|held| Next::on(held, planner.is_lost()))
        } else {
            best.map(|(plan, _)| Next::of(plan, way_out, self.open))
        };
        if let Some(next) = next {
            self.flown.follow(&next, planner.model(), &cycle);
        }
        self.untold = Some(PlanReport {
            scan_tick: cycle.begun,
            used_from_tick: tick,
            outcome,
            candidates: planner.proposed() as u16,
            feasible: u16::from(violation <= 0.0),
            tree_runs: 0,
            slices: cycle.slices,
            cost,
            violation,
            complete: cycle.complete,
        });
        if kept {
            planner.refuse();
        } else if self.open {
            planner.hold();
        }
    }
}
