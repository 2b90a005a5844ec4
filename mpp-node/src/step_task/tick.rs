//! One tick: the step takes over a plan that is due, makes the 100 Hz step, and starts a cycle.

use super::{Cycle, Pace, StepTask};
use crate::convert;
use crate::mail::Order;
use crate::time;
use hil_protocol::SensorFrame as WireFrame;
use hil_protocol::{ActuatorCommand, Message, PlanOutcome, PlanReport, RejectionCause};
use mpp_core::estimate::{Innovation, Verdict};
use mpp_core::flight::Adoption;
use mpp_core::planner::PlanSummary;

impl StepTask {
    /// Makes one tick. The crate's documentation describes it.
    pub(super) fn tick(&mut self, frame: &WireFrame, send: &mut impl FnMut(&[u8])) {
        if !self.check_values(send) {
            return;
        }
        if self.plan_is_due(frame.tick) {
            if self.plan.is_none() && self.pace == Pace::Lockstep {
                // The planner may use the slices of all ticks before this one.
                self.clock = frame.tick.saturating_sub(1);
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
        self.flight
            .as_ref()
            .is_some_and(|flight| flight.cycle.is_some_and(|cycle| tick >= cycle.due))
    }

    /// Takes over the result of a cycle, if it has ended.
    fn take_over(&mut self, tick: u32, send: &mut impl FnMut(&[u8])) {
        let (Some(flight), Some(plan)) = (&mut self.flight, &self.plan) else {
            return;
        };
        flight.cycle = None;
        let scan_tick = plan.scan_tick;
        let adoption = flight
            .control
            .adopt(time(tick), plan.verdict, &plan.trajectory);
        let outcome = convert::outcome(adoption);
        if flight.control.trajectory().is_none() {
            flight.plan_tick = None;
        } else if outcome != PlanOutcome::KeptPrevious {
            flight.plan_tick = Some(scan_tick);
        }
        let PlanSummary {
            candidates,
            feasible,
            tree_runs,
            slices,
            complete,
            cost,
            violation,
            ..
        } = plan.summary;
        let report = PlanReport {
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
        };
        let flown = matches!(adoption, Adoption::Feasible | Adoption::LeastViolating)
            .then(|| convert::trajectory(scan_tick, &plan.trajectory));
        self.plan = None;
        self.emit(&Message::PlanReport(report), send);
        if let Some(trajectory) = flown {
            self.emit(&Message::PlanTrajectory(trajectory), send);
        }
    }

    fn step(&mut self, frame: &WireFrame, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        flight.last_tick = Some(frame.tick);
        let output = flight
            .control
            .step(time(frame.tick), &convert::sensor_frame(frame));
        let age = flight
            .plan_tick
            .map_or(0, |plan| frame.tick.saturating_sub(plan));
        let report = convert::step_report(frame.tick, age, flight.control.estimate(), &output);
        let command = ActuatorCommand {
            tick: frame.tick,
            thrust: output.control.thrust,
            elevator: output.control.elevator,
            mode: convert::mode(output.mode),
        };
        if let Some(cause) = measurement_rejection(output.innovation, output.position_finite) {
            self.reject(cause, send);
        }
        self.emit(&Message::StepReport(report), send);
        self.emit(&Message::ActuatorCommand(command), send);
    }

    /// Starts a cycle from the scan of this tick, if one is due.
    fn start_cycle(&mut self, tick: u32, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        let Some(scan_tick) = flight.scan_tick.take().filter(|_| !self.planner_off) else {
            return;
        };
        if scan_tick != tick {
            let cause = RejectionCause::TickOrder {
                expected: tick,
                found: scan_tick,
            };
            return self.reject(cause, send);
        }
        let period = flight.tuning.configure.replan_period_ticks;
        if flight
            .last_cycle
            .is_some_and(|last| tick < last.saturating_add(period))
        {
            return;
        }
        if flight.cycle.is_some() || self.order.is_some() {
            return self.reject(RejectionCause::PlannerBusy, send);
        }
        // The planner gets the same latency with its order. A later change applies to the next cycle.
        flight.cycle = Some(Cycle {
            scan: tick,
            due: tick.saturating_add(flight.tuning.configure.latency_ticks),
        });
        flight.last_cycle = Some(tick);
        self.order = Some(Order::Begin {
            tick,
            state: flight.control.state(),
            conditions: flight.control.conditions(),
            scan: self.scan.clone(),
            tuning: flight.tuning,
        });
    }
}

fn measurement_rejection(innovation: Innovation, position_finite: bool) -> Option<RejectionCause> {
    let Innovation { airspeed, pitch } = innovation;
    if !position_finite || airspeed == Verdict::NotFinite || pitch == Verdict::NotFinite {
        Some(RejectionCause::NonFiniteSensor)
    } else if airspeed == Verdict::Gated || pitch == Verdict::Gated {
        Some(RejectionCause::InnovationGate {
            airspeed: airspeed == Verdict::Gated,
            pitch: pitch == Verdict::Gated,
        })
    } else {
        None
    }
}
