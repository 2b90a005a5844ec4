//! The work of the planner in space: where cycles begin, what they may use, and when their plan is taken over.

use super::cycle::{Cycle, Flown};
use super::{Session, SpaceNode};
use crate::{duration, ticks};
use hil_protocol::{PlanOutcome, PlanReport};
use mpp_core::control::SpaceMotion;
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::MOST_SPACE_SLICES;
use mpp_core::vehicle::SpaceControl;

impl SpaceNode {
    /// After the step: the points go into the map, a cycle begins when its time has come, and the planner works.
    pub(super) fn plan(&mut self, tick: u32, motion: &SpaceMotion) {
        let Some(session) = &mut self.session else {
            return;
        };
        let seen = !self.sweep.is_empty();
        if seen {
            let sight = f64::from(session.configure.range_max);
            self.sweep.place(tick, &session.estimator, &mut self.beams);
            self.map.insert(&motion.path.position, &self.beams, sight);
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
        if due {
            session.begin(tick, motion);
        }
        session.work(&self.map);
    }
}

impl Session {
    /// Begins a cycle from where the aircraft will be when the plan is taken over.
    fn begin(&mut self, tick: u32, motion: &SpaceMotion) {
        let model = self.model;
        let latency = duration(self.configure.latency_ticks);
        let (start, shift) = match &self.flown {
            Some(flown) => {
                let age = flown.age(tick);
                let plan = &flown.plan;
                let start = plan.next_start(&flown.model, &motion.path, age, latency);
                (start, age + latency)
            }
            None => {
                let level = SpaceControl {
                    thrust: model.trim.control.thrust,
                    ..SpaceControl::default()
                };
                (motion.path.after(&model, &level, latency), 0.0)
            }
        };
        self.planner.set_wind(model.wind);
        self.planner.begin(&start, shift);
        self.last_cycle = Some(tick);
        self.cycle = Some(Cycle {
            begun: tick,
            due: tick.wrapping_add(self.configure.latency_ticks),
            slices: 0,
            complete: false,
        });
    }

    /// Does the slices of a tick.
    fn work(&mut self, map: &VoxelGrid) {
        let Some(cycle) = &mut self.cycle else {
            return;
        };
        for _ in 0..self.configure.slices_per_tick.min(MOST_SPACE_SLICES as u32) {
            if cycle.complete {
                return;
            }
            cycle.slices = cycle.slices.saturating_add(1);
            cycle.complete = self.planner.advance(map);
        }
    }

    /// Takes over the plan that is due in this tick.
    pub(super) fn take_over(&mut self, tick: u32) {
        let Some(cycle) = self.cycle.filter(|cycle| ticks(cycle.due, tick) >= 0) else {
            return;
        };
        self.cycle = None;
        let best = self.planner.best().map(|(plan, judged)| (*plan, *judged));
        let (cost, violation) = best.map_or((f64::INFINITY, f64::INFINITY), |(_, judged)| {
            (judged.price, judged.missing)
        });
        let outcome = match best {
            Some(_) if violation <= 0.0 => PlanOutcome::Adopted,
            Some(_) => PlanOutcome::LeastViolating,
            None if self.flown.is_some() => PlanOutcome::KeptPrevious,
            None => PlanOutcome::TrimHold,
        };
        if let Some((plan, _)) = best {
            self.flown = Some(Flown {
                plan,
                model: *self.planner.model(),
                start: cycle.due,
                begun: cycle.begun,
            });
        }
        self.untold = Some(PlanReport {
            scan_tick: cycle.begun,
            used_from_tick: tick,
            outcome,
            candidates: self.planner.proposed() as u16,
            feasible: u16::from(violation <= 0.0),
            tree_runs: 0,
            slices: cycle.slices,
            cost,
            violation,
            complete: cycle.complete,
        });
    }
}
