//! The planning cycles of a flight, recorded from outside, and a planner to plan them again.

use crate::link::{LinkError, PipeLink};
use crate::log::Tick;
use crate::run::{FlyError, fly};
use crate::scenario::Scenario;
use flight_node::parameters::Tuning;
use mpp_core::estimate::{Conditions, ConditionsEstimator};
use mpp_core::planner::{Planner, SetupError};
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{ActuatorLimits, Control, VehicleState};

/// What a cycle begins with.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Time of the scan [s].
    pub time: f64,
    /// The true state.
    pub truth: VehicleState,
    /// The state that the core plans from.
    pub state: VehicleState,
    /// What the core reckons with besides.
    pub conditions: Conditions,
    /// The scan, as the core got it.
    pub scan: LidarScan,
}

/// Flies a scenario, and gives the inputs of its planning cycles in their order.
///
/// # Errors
/// [`FlyError`].
pub fn record(scenario: &Scenario) -> Result<Vec<Inputs>, FlyError> {
    let mut inputs = Vec::new();
    let mut reckoning = Reckoning::new(&settings(scenario)?).map_err(FlyError::SetUp)?;
    fly(scenario, &mut PipeLink::of(scenario), |moment| {
        let (truth, air) = (moment.tick.state, moment.tick.estimate);
        reckoning.update(moment.tick);
        let Some(wire) = moment.scan else {
            return;
        };
        inputs.push(Inputs {
            time: moment.tick.t,
            truth,
            state: VehicleState { air, ..truth },
            conditions: reckoning.conditions(),
            scan: LidarScan {
                angle_min: f64::from(wire.angle_min),
                angle_increment: f64::from(wire.angle_increment),
                ranges: wire.ranges.clone(),
            },
        });
    })?;
    Ok(inputs)
}

/// What the core reckons with besides the state, found again from what is logged.
pub struct Reckoning {
    estimator: ConditionsEstimator,
    limits: ActuatorLimits,
    /// What the actuators gave, as far as the core knows, and the command since.
    given: Control,
    last: Option<(f64, Control)>,
}

impl Reckoning {
    /// Of a flight with these settings, before its first tick.
    ///
    /// # Errors
    /// When the core could not be set up either.
    pub fn new(settings: &Settings) -> Result<Self, SetupError> {
        let trim = settings.cruise.trim(&settings.airframe);
        Ok(Self {
            estimator: ConditionsEstimator::new(settings),
            limits: settings.actuators,
            given: trim.map_err(SetupError::Trim)?.control,
            last: None,
        })
    }

    /// Takes in a tick.
    pub fn update(&mut self, tick: &Tick) {
        if let Some((before, command)) = self.last.replace((tick.t, tick.control)) {
            self.given = self.limits.given(command, self.given, tick.t - before);
        }
        let position = (tick.state.x, tick.state.z);
        self.estimator
            .update(tick.t, position, &tick.estimate, self.given);
    }

    /// The conditions now.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        self.estimator.conditions()
    }
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
    use crate::faults::Faults;
    use crate::scenario::Preset;

    /// Planned again from what was recorded, every cycle takes the same slices and comes to the same
    /// cost: nothing that goes into a plan is missing.
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
