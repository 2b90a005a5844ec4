//! The planning cycles of a flight, recorded from outside, and a planner to plan them again.

use crate::link::{LinkError, PipeLink};
use crate::run::{FlyError, fly};
use crate::scenario::Scenario;
use flight_node::parameters::Tuning;
use mpp_core::estimate::WindEstimator;
use mpp_core::planner::Planner;
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{VehicleState, Wind};

/// What a cycle begins with.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Time of the scan [s].
    pub time: f64,
    /// The true state.
    pub truth: VehicleState,
    /// The state that the core plans from.
    pub state: VehicleState,
    /// The wind that the core reckons with.
    pub wind: Wind,
    /// The scan, as the core got it.
    pub scan: LidarScan,
}

/// Flies a scenario, and gives the inputs of its planning cycles in their order.
///
/// # Errors
/// [`FlyError`].
pub fn record(scenario: &Scenario) -> Result<Vec<Inputs>, FlyError> {
    let mut inputs = Vec::new();
    let mut wind = WindEstimator::new(settings(scenario)?.wind);
    fly(scenario, &mut PipeLink::of(scenario), |moment| {
        let (truth, air) = (moment.tick.state, moment.tick.estimate);
        wind.update(moment.tick.t, (truth.x, truth.z), &air);
        let Some(wire) = moment.scan else {
            return;
        };
        inputs.push(Inputs {
            time: moment.tick.t,
            truth,
            state: VehicleState { air, ..truth },
            wind: wind.wind(),
            scan: LidarScan {
                angle_min: f64::from(wire.angle_min),
                angle_increment: f64::from(wire.angle_increment),
                ranges: wire.ranges.clone(),
            },
        });
    })?;
    Ok(inputs)
}

/// The settings that the core flies a scenario with.
///
/// # Errors
/// [`FlyError::Link`] when it would refuse them.
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
    use crate::scenario::Preset;

    /// Planned again from what was recorded, every cycle takes the same slices and comes to the same
    /// cost: nothing that goes into a plan is missing.
    #[test]
    fn recorded_cycles_are_those_of_the_flight() {
        for preset in [Preset::Reference, Preset::Paper, Preset::Flight] {
            let scenario = Scenario {
                ticks: 500,
                obstacles: 40,
                ..Scenario::new(preset, 3)
            };
            let log = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap();
            let mut planner = planner(&settings(&scenario).unwrap()).unwrap();
            let recorded = record(&scenario).unwrap();
            assert!(log.plans.len() >= 4 && recorded.len() >= log.plans.len());
            for (inputs, plan) in recorded.iter().zip(&log.plans) {
                planner.begin(inputs.time, &inputs.state, &inputs.wind, &inputs.scan);
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
