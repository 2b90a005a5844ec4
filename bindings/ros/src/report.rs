//! The diagnostics: what the core says of its sensors and plans, and what was wrong with what came in.

use crate::flight::Flight;
use crate::messages::{DiagnosticArray, DiagnosticStatus, Header, KeyValue};
use crate::told::Told;
use hil_protocol::{ControlMode, HealthReport, SensorState};

const OK: u8 = 0;
const WARN: u8 = 1;
const ERROR: u8 = 2;

/// The diagnostics of a moment.
pub(crate) fn diagnostics(
    header: Header,
    name: &str,
    flight: Option<&Flight>,
    told: &mut Told,
) -> DiagnosticArray {
    let complaint = told.lately();
    let inputs = DiagnosticStatus {
        level: if complaint.is_some() { WARN } else { OK },
        name: format!("{name}: inputs"),
        message: complaint.unwrap_or_else(|| "all used".to_owned()),
        hardware_id: String::new(),
        values: told
            .counts()
            .map(|(kind, count, text)| pair(kind, format!("{count}, last: {text}")))
            .collect(),
    };
    DiagnosticArray {
        header,
        status: vec![core(name, flight), inputs],
    }
}

fn core(name: &str, flight: Option<&Flight>) -> DiagnosticStatus {
    let mut values = Vec::new();
    let (mut level, mut message) = (WARN, "waits for goal, scan and odometry".to_owned());
    if let Some(flight) = flight
        && let Some((command, step)) = &flight.last
    {
        let sensors = step.sensors.named();
        let in_state = |state: SensorState| sensors.iter().filter(move |(_, own)| *own == state);
        let excluded: Vec<&str> = in_state(SensorState::Excluded)
            .map(|(name, _)| *name)
            .collect();
        let holds = command.mode == ControlMode::TrimHold;
        (level, message) = if !excluded.is_empty() {
            (ERROR, format!("without {}", excluded.join(", ")))
        } else if holds {
            (WARN, "straight and level, without a plan".to_owned())
        } else if in_state(SensorState::Healthy).count() == sensors.len() {
            (OK, "flies a plan".to_owned())
        } else {
            (WARN, "flies a plan, does not trust all sensors".to_owned())
        };
        values.extend(
            sensors
                .iter()
                .map(|(name, state)| pair(name, state.to_string())),
        );
        values.push(pair(
            "plan_age_s",
            format!("{:.2}", f64::from(step.plan_age_ticks) * 0.01),
        ));
        if let Some(plan) = &flight.plan {
            values.push(pair("outcome", format!("{:?}", plan.outcome)));
            values.push(pair("candidates", plan.candidates.to_string()));
            values.push(pair("feasible", plan.feasible.to_string()));
        }
        if let Some(health) = &flight.health {
            let counters = HealthReport::NAMES.iter().zip(health.counters);
            values.extend(counters.map(|(name, count)| pair(name, count.to_string())));
        }
    }
    DiagnosticStatus {
        level,
        name: format!("{name}: core"),
        message,
        hardware_id: String::new(),
        values,
    }
}

fn pair(key: &str, value: String) -> KeyValue {
    KeyValue {
        key: key.to_owned(),
        value,
    }
}
