//! What a log notes of a tick and of a plan.

use super::session::StepReply;
use crate::entries::{PlanEntry, Tick, finite};
use crate::scenario::Scenario;
use crate::sensors::Measurement;
use hil_protocol::{ControlMode, HealthReport, PlanReport};
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
    }
}

/// A tick before the plant has flown it.
pub(super) fn logged(
    number: u32,
    state: &VehicleState,
    measured: Measurement,
    reply: &StepReply,
) -> Tick {
    let air = |values: [f64; 4]| AirState::from_vector(&Vector4::from(values));
    let tracking = reply.command.mode == ControlMode::Tracking;
    let reference = reply.step.filter(|_| tracking).map(|step| {
        let [x, z, rest @ ..] = step.reference;
        VehicleState {
            x,
            z,
            air: air(rest),
        }
    });
    Tick {
        t: Scenario::time(number),
        state: *state,
        measured,
        estimate: reply.step.map_or(*state, |step| VehicleState {
            x: step.position[0],
            z: step.position[1],
            air: air(step.estimate),
        }),
        conditions: reply.step.map_or(Conditions::STILL, |step| Conditions {
            wind: Wind {
                x: step.wind[0],
                z: step.wind[1],
            },
            lift: step.lift,
        }),
        reference,
        control: control(reply),
        applied: control(reply),
        wind: (0.0, 0.0),
    }
}

/// The control that the core commands.
pub(super) fn control(reply: &StepReply) -> Control {
    Control {
        thrust: reply.command.thrust,
        elevator: reply.command.elevator,
    }
}
