//! What a log notes of a tick and of a plan.

use super::session::StepReply;
use crate::entries::{PlanEntry, Tick, finite};
use crate::scenario::Scenario;
use crate::sensors::Measurement;
use hil_protocol::{ActuatorCommand, ControlMode, HealthReport, PlanReport, StepReport};
use mpp_core::vehicle::{AirState, Conditions, Control, VehicleState, Wind};
use nalgebra::Vector4;
use std::collections::BTreeMap;

/// The counters that are not zero, by name.
pub(super) fn counters(report: &HealthReport) -> BTreeMap<String, u32> {
    let named = HealthReport::NAMES.iter().zip(report.counters);
    named
        .filter(|(_, count)| *count > 0)
        .map(|(name, count)| ((*name).to_owned(), count))
        .collect()
}

pub(crate) fn plan_entry(report: &PlanReport) -> PlanEntry {
    PlanEntry {
        tick: u64::from(report.scan_tick),
        used_from_tick: Some(u64::from(report.used_from_tick)),
        outcome: format!("{:?}", report.outcome),
        candidates: u32::from(report.candidates),
        feasible: u32::from(report.feasible),
        tree_runs: u32::from(report.tree_runs),
        slices: report.slices,
        cost: finite(Some(report.cost)),
        violation: finite(Some(report.violation)),
        way_out: None,
    }
}

/// A tick before the plant has flown it.
pub(super) fn logged(
    number: u32,
    state: &VehicleState,
    measured: Measurement,
    reply: &StepReply,
) -> Tick {
    let step = reply.step.as_ref();
    Tick {
        t: Scenario::time(number),
        state: *state,
        measured,
        estimate: step.map_or(*state, estimate),
        conditions: step.map_or(Conditions::STILL, conditions),
        reference: reference(&reply.command, step),
        control: control(&reply.command),
        applied: control(&reply.command),
        wind: (0.0, 0.0),
    }
}

/// The core's estimate.
pub(crate) fn estimate(step: &StepReport) -> VehicleState {
    let [x, z] = step.position;
    let air = AirState::from_vector(&Vector4::from(step.estimate));
    VehicleState { x, z, air }
}

/// Wind and lift as the core estimates them.
pub(crate) fn conditions(step: &StepReport) -> Conditions {
    let [x, z] = step.wind;
    let wind = Wind { x, z };
    Conditions {
        wind,
        lift: step.lift,
    }
}

/// The state that the core tracks, if it has a plan.
pub(crate) fn reference(
    command: &ActuatorCommand,
    step: Option<&StepReport>,
) -> Option<VehicleState> {
    let step = step.filter(|_| command.mode == ControlMode::Tracking)?;
    let [x, z, rest @ ..] = step.reference;
    let air = AirState::from_vector(&Vector4::from(rest));
    Some(VehicleState { x, z, air })
}

/// The control that the core commands.
pub(crate) fn control(command: &ActuatorCommand) -> Control {
    Control {
        thrust: command.thrust,
        elevator: command.elevator,
    }
}
