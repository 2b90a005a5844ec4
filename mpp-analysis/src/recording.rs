//! A recording of a flight's planning cycles, made from outside, and a planner to plan them again.

use mpp_core::planner::Planner;
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{Conditions, VehicleState};
use mpp_node::parameters::Tuning;
use mpp_sim::flight::{FlyError, fly};
use mpp_sim::inspector::core_scan;
use mpp_sim::link::LinkError;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::Scenario;

/// The inputs of a planning cycle.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Time of the scan \[s\].
    pub time: f64,
    /// The true state.
    pub truth: VehicleState,
    /// The state that the core plans from.
    pub state: VehicleState,
    /// Conditions that the core takes into account besides the state.
    pub conditions: Conditions,
    /// The scan, as the core got it.
    pub scan: LidarScan,
}

/// Flies a scenario and returns the inputs of its planning cycles in their order.
///
/// # Errors
/// [`FlyError`].
pub fn record(scenario: &Scenario) -> Result<Vec<Inputs>, FlyError> {
    let mut inputs = Vec::new();
    fly(scenario, &mut PipeLink::of(scenario), |record| {
        let Some(wire) = record.scan else {
            return;
        };
        inputs.push(Inputs {
            time: record.tick.t,
            truth: record.tick.state,
            state: record.tick.estimate,
            conditions: record.tick.conditions,
            scan: core_scan(wire),
        });
    })?;
    Ok(inputs)
}

/// The settings with which the core flies a scenario.
///
/// # Errors
/// [`FlyError::Link`] when the core would refuse them.
pub fn settings(scenario: &Scenario) -> Result<Settings, FlyError> {
    let tuning = Tuning::new(&scenario.configure()).map_err(LinkError::Refused)?;
    Ok(tuning.settings)
}

/// A planner with these settings.
///
/// # Errors
/// [`FlyError::SetUp`].
pub fn planner(settings: &Settings) -> Result<Box<Planner>, FlyError> {
    let mut planner = Box::new(Planner::new());
    planner.set_up(settings).map_err(FlyError::SetUp)?;
    Ok(planner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_sim::faults::Faults;
    use mpp_sim::scenario::Preset;

    /// A cycle that is planned again from its recorded inputs takes the same slices and has the
    /// same cost. So the recording holds everything that goes into a plan.
    #[test]
    fn recorded_cycles_are_those_of_the_flight() {
        let mut limited = Faults::default();
        limited.actuators.thrust_max = Some(15.0);
        limited.actuators.thrust_lag = Some(0.2);
        limited.actuators.elevator_range = Some(2.0);
        limited.gusts.intensity = 1.0;
        let free = Faults::default();
        for (preset, faults) in [
            (Preset::Reference, free),
            (Preset::Paper, free),
            (Preset::Flight, free),
            (Preset::Flight, limited),
        ] {
            let scenario = Scenario {
                ticks: 500,
                obstacles: 40,
                faults,
                ..Scenario::new(preset, 3)
            };
            let log = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap();
            let mut planner = planner(&settings(&scenario).unwrap()).unwrap();
            let recorded = record(&scenario).unwrap();
            assert!(log.plans.len() >= 4 && recorded.len() >= log.plans.len());
            for (inputs, plan) in recorded.iter().zip(&log.plans) {
                planner.begin(inputs.time, &inputs.state, &inputs.conditions, &inputs.scan);
                while planner.advance() {}
                planner.finish();
                let summary = planner.summary();
                assert_eq!(summary.slices as u32, plan.slices, "{preset:?}");
                assert_eq!(
                    Some(summary.cost).filter(|cost| cost.is_finite()),
                    plan.cost
                );
            }
        }
    }
}
