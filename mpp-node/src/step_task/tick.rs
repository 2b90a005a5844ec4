//! One tick: the step takes over a plan that is due, makes the 100 Hz step, and starts a cycle.

use super::{Cycle, Pace, Session, StepTask};
use crate::convert;
use crate::mail::PlanRequest;
use crate::out::Out;
use crate::{duration, ticks};
use hil_protocol::SensorFrame as WireFrame;
use hil_protocol::{ActuatorCommand, HealthReport, PlanOutcome, PlanReport, RejectionCause};
use mpp_core::estimate::{Innovation, MeasurementStatus, PositionVerdict};
use mpp_core::planner::PlanSummary;
use mpp_core::tuning::sensors::SUSPECTED_AFTER;
use mpp_core::vehicle::ScanPoses;

/// Time between two scans of the slowest lidar whose rate is no fault, in periods of the planner [-].
const SLOWEST_LIDAR: u32 = 4;

/// Ticks from one report of the counters to the next.
const HEALTH_PERIOD: u32 = 100;

impl StepTask {
    /// Makes one tick. The crate's documentation describes it.
    pub(super) fn tick(&mut self, frame: &WireFrame, send: &mut impl Out) {
        self.tell_plan(send);
        if self.plan_is_due(frame.tick) {
            if self.plan.is_none() && self.pace == Pace::Lockstep {
                // The planner may use the slices of all ticks before this one.
                self.clock = frame.tick.wrapping_sub(1);
                self.held = Some(*frame);
                return;
            }
            self.take_over(frame.tick, send);
        }
        self.step(frame, send);
        self.start_cycle(frame.tick, send);
        self.clock = frame.tick;
    }

    fn plan_is_due(&self, tick: u32) -> bool {
        self.session
            .as_ref()
            .is_some_and(|session| (session.cycle).is_some_and(|cycle| ticks(cycle.due, tick) >= 0))
    }

    /// Takes over the result of a cycle, if it has ended.
    fn take_over(&mut self, tick: u32, send: &mut impl Out) {
        let (Some(session), Some(plan)) = (&mut self.session, &self.plan) else {
            return;
        };
        let Some(cycle) = session.cycle.take() else {
            return;
        };
        let scan_tick = cycle.scan;
        let time = session.time(tick);
        let adoption = session.control.adopt(time, plan.verdict, &plan.trajectory);
        session.control.count_cycle(&plan.summary);
        let outcome = convert::outcome(adoption);
        if session.control.trajectory().is_none() {
            session.plan_tick = None;
        } else if outcome != PlanOutcome::KeptPrevious {
            session.plan_tick = Some(scan_tick);
        }
        let PlanSummary {
            candidates,
            feasible,
            tree_runs,
            slices,
            complete,
            blind,
            leaves,
            aged,
            cost,
            violation,
            ..
        } = plan.summary;
        if !cycle.without_scan {
            session.lidar_good = Some(!blind && !aged && !session.spoilt);
        }
        session.untold = Some(PlanReport {
            scan_tick,
            used_from_tick: tick,
            outcome,
            candidates: candidates as u16,
            feasible: feasible as u16,
            tree_runs: tree_runs as u16,
            slices: slices as u32,
            cost,
            violation,
            complete,
        });
        self.plan = None;
        let cause = match (aged, blind && !cycle.without_scan, leaves) {
            (true, _, _) => RejectionCause::ScanAged,
            (_, true, true) => RejectionCause::ScanSilentBelow,
            (_, true, false) => RejectionCause::ScanBlind,
            _ => return,
        };
        self.reject(cause, send);
    }

    /// Tells the plan that the tick before has taken over, and a tick later its commands. The tick that takes over has enough
    /// to do.
    #[inline(never)]
    fn tell_plan(&mut self, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return;
        };
        let steered = session.unsteered.take();
        if let Some(scan_tick) = steered.filter(|tick| session.plan_tick == Some(*tick)) {
            if let Some(controls) = convert::controls(scan_tick, &session.control) {
                self.emit(&controls, send);
            }
            return;
        }
        let Some(report) = session.untold.take() else {
            return;
        };
        let is_new = report.outcome.is_new();
        let new = session.control.trajectory().filter(|_| is_new);
        let told = new.map(|trajectory| convert::trajectory(report.scan_tick, trajectory));
        session.unsteered = told.as_ref().map(|trajectory| trajectory.scan_tick);
        self.emit(&report, send);
        if let Some(trajectory) = told {
            self.emit(&trajectory, send);
        }
    }

    fn step(&mut self, frame: &WireFrame, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return;
        };
        session.first_tick.get_or_insert(frame.tick);
        session.last_tick = Some(frame.tick);
        let time = session.time(frame.tick);
        let output = session.control.step(time, &convert::sensor_frame(frame));
        if output.moved {
            // The plan under way counts from estimates that are no more.
            session.cycle = None;
            session.forget = true;
            self.plan = None;
        }
        session.lidar.tick(session.lidar_good.take());
        let sensors = convert::sensor_states(session.control.sensors(), session.lidar.trust());
        let age = session
            .plan_tick
            .map_or(0, |plan| frame.tick.wrapping_sub(plan));
        let report = convert::step_report(
            frame.tick,
            age,
            &session.control.state(),
            &session.control.conditions(),
            sensors,
            &output,
        );
        let command = ActuatorCommand {
            tick: frame.tick,
            thrust: output.control.thrust,
            elevator: output.control.elevator,
            mode: convert::mode(output.mode),
        };
        if let Some(cause) = measurement_rejection(output.innovation, output.position) {
            self.reject(cause, send);
        }
        self.emit(&report, send);
        self.report_health(frame.tick, send);
        self.emit(&command, send);
    }

    /// Sends the counters once a second, at a tick at which scans and plans are rare.
    fn report_health(&mut self, tick: u32, send: &mut impl Out) {
        if tick % HEALTH_PERIOD != HEALTH_PERIOD / 2 + 13 {
            return;
        }
        if let Some(health) = self.health() {
            let counters = health.counters();
            self.emit(&HealthReport { tick, counters }, send);
        }
    }

    /// Starts a cycle from the scan that has come, if one is due, or without a scan if the lidar has fallen silent. Both wait
    /// while the place of the aircraft is in doubt.
    fn start_cycle(&mut self, tick: u32, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return;
        };
        if self.planner_off || session.control.is_lost() {
            return;
        }
        match session.scan_tick.take() {
            Some(scan_tick) => self.plan_from_scan(tick, scan_tick, send),
            None if session.is_due_without_scan(tick) && self.request.is_none() => {
                if let Some(poses) = session.control.poses_at(0) {
                    self.request_cycle(tick, tick, &poses, true);
                }
            }
            None => {}
        }
    }

    fn plan_from_scan(&mut self, tick: u32, scan_tick: u32, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return;
        };
        let age = tick.wrapping_sub(scan_tick);
        let again = session
            .last_scan
            .is_some_and(|last| ticks(last, scan_tick) <= 0);
        let Some(poses) = session.control.poses_at(age).filter(|_| !again) else {
            let cause = RejectionCause::TickOrder {
                expected: tick,
                found: scan_tick,
            };
            return self.reject(cause, send);
        };
        if !session.is_due(tick, scan_tick) {
            return;
        }
        if session.cycle.is_some_and(|cycle| cycle.without_scan) {
            // The scan tells more than the cycle knows. Its request may still wait, or its plan.
            session.cycle = None;
            self.plan = None;
            if let Some(PlanRequest::Begin { forget, .. }) = self.request.take() {
                session.forget |= forget;
            }
        }
        if session.cycle.is_some() || self.request.is_some() {
            return self.reject(RejectionCause::PlannerBusy, send);
        }
        session.note_scan(scan_tick);
        self.request_cycle(tick, scan_tick, &poses, false);
    }

    fn request_cycle(&mut self, tick: u32, scan_tick: u32, poses: &ScanPoses, without_scan: bool) {
        let Some(session) = &mut self.session else {
            return;
        };
        // The planner gets the same latency with the request. A later change applies to the next cycle.
        session.cycle = Some(Cycle {
            begun: tick,
            scan: scan_tick,
            due: tick.wrapping_add(session.tuning.configure.latency_ticks),
            without_scan,
        });
        session.last_cycle = Some(tick);
        session.blind_from = session.blind_after(tick);
        self.request = Some(PlanRequest::Begin {
            tick,
            time: session.time(tick),
            forget: session.forget,
            poses: *poses,
            state: session.control.planned_from(),
            conditions: session.control.conditions(),
            scan: (!without_scan).then(|| self.scan.clone()),
            planner: session.tuning.settings.planner,
            latency_ticks: session.tuning.configure.latency_ticks,
            slices_per_tick: session.tuning.configure.slices_per_tick,
        });
        session.forget = false;
    }
}

impl Session {
    /// Whether the next cycle is due, and the planner has to do without a scan.
    fn is_due_without_scan(&self, tick: u32) -> bool {
        let silent = self.blind_from.is_some_and(|from| ticks(from, tick) >= 0);
        silent && self.cycle.is_none()
    }

    /// The tick from which the planner does without a scan: the next cycle is due, and the scan that it waits for is late. Only
    /// the flight planner remembers what earlier scans showed.
    fn blind_after(&self, begun: u32) -> Option<u32> {
        self.tuning.settings.planner.plane()?;
        let interval = self.scan_interval?.saturating_add(SUSPECTED_AFTER.into());
        let late = self.last_scan?.wrapping_add(interval);
        let due = begun.wrapping_add(self.tuning.configure.replan_period_ticks);
        Some(if ticks(due, late) >= 0 { late } else { due })
    }

    /// Takes note of a scan that starts a cycle. A longer time between two scans was an outage.
    fn note_scan(&mut self, scan_tick: u32) {
        let longest = SLOWEST_LIDAR.saturating_mul(self.tuning.configure.replan_period_ticks);
        if let Some(last) = self.last_scan.replace(scan_tick) {
            let interval = scan_tick.wrapping_sub(last);
            if interval <= longest {
                self.scan_interval = Some(interval);
            }
        }
    }

    /// Whether a cycle is due: a period after the last one, or from a scan that was taken a period after the last
    /// one's.
    fn is_due(&self, tick: u32, scan_tick: u32) -> bool {
        let period = self.tuning.configure.replan_period_ticks;
        let passed =
            |last: Option<u32>, now: u32| last.is_none_or(|last| now.wrapping_sub(last) >= period);
        passed(self.last_cycle, tick) || passed(self.last_scan, scan_tick)
    }

    /// Time of a tick since the first step \[s\].
    fn time(&self, tick: u32) -> f64 {
        let first = self.first_tick.unwrap_or(tick);
        duration(tick.wrapping_sub(first))
    }
}

fn measurement_rejection(
    innovation: Innovation,
    position: Option<PositionVerdict>,
) -> Option<RejectionCause> {
    let Innovation { airspeed, pitch } = innovation;
    if position == Some(PositionVerdict::NotFinite)
        || airspeed == MeasurementStatus::NotFinite
        || pitch == MeasurementStatus::NotFinite
    {
        Some(RejectionCause::NonFiniteSensor)
    } else if airspeed == MeasurementStatus::Gated || pitch == MeasurementStatus::Gated {
        Some(RejectionCause::InnovationGate {
            airspeed: airspeed == MeasurementStatus::Gated,
            pitch: pitch == MeasurementStatus::Gated,
        })
    } else {
        None
    }
}
