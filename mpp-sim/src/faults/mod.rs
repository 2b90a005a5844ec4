//! Faults and disturbances of a flight. Without any of them, a flight is byte for byte that of an
//! ideal aircraft in still air.
//!
//! Each random fault draws from its own stream of the flight's seed (see [`crate::random`]). An
//! additional fault therefore does not change the noise of the sensors.

mod actuators;
mod gusts;
mod lidar;
mod model_error;

pub use actuators::{ActuatorLimits, Actuators};
pub use gusts::{GustConfig, Gusts, HEIGHT, longitudinal_ratio};
pub use lidar::{FaultyLidar, LidarFaultConfig, LidarFaults};
pub use model_error::{ModelError, Signs};
use serde::{Deserialize, Serialize};

/// All faults of a flight. The default value has no fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Faults {
    /// Limits of the actuators.
    pub actuators: ActuatorLimits,
    /// Turbulence.
    pub gusts: GustConfig,
    /// Difference between the true airframe and the one that the core knows.
    pub model_error: ModelError,
    /// Beams that return nothing or nonsense.
    pub lidar: LidarFaultConfig,
}

impl Faults {
    /// Returns the first invalid value: the name of its key and what to give instead. Returns
    /// `None` if all values are valid.
    #[must_use]
    pub fn flaw(&self) -> Option<(&'static str, &'static str)> {
        let positive =
            |value: Option<f64>| value.is_none_or(|value| value > 0.0 && value.is_finite());
        let share = |value: f64| (0.0..=1.0).contains(&value);
        let error = |value: f64| value.abs() < 1.0;
        let (actuators, model) = (&self.actuators, &self.model_error);
        [
            (
                positive(actuators.thrust_max),
                "faults.actuators.thrust_max",
                "give a thrust above 0 N",
            ),
            (
                positive(actuators.thrust_lag),
                "faults.actuators.thrust_lag",
                "give a time above 0 s",
            ),
            (
                positive(actuators.elevator_range),
                "faults.actuators.elevator_range",
                "give a number above 0",
            ),
            (
                positive(actuators.elevator_rate),
                "faults.actuators.elevator_rate",
                "give a rate above 0 per second",
            ),
            (
                (0.0..=10.0).contains(&self.gusts.intensity),
                "faults.gusts.intensity",
                "give 0 to 10 m/s",
            ),
            (
                error(model.mass),
                "faults.model_error.mass",
                "give a share between -1 and 1",
            ),
            (
                error(model.lift_slope),
                "faults.model_error.lift_slope",
                "give a share between -1 and 1",
            ),
            (
                error(model.pitch_stiffness),
                "faults.model_error.pitch_stiffness",
                "give a share between -1 and 1",
            ),
            (
                share(self.lidar.dropouts),
                "faults.lidar.dropouts",
                "give a share from 0 to 1",
            ),
            (
                share(self.lidar.false_hits),
                "faults.lidar.false_hits",
                "give a share from 0 to 1",
            ),
        ]
        .into_iter()
        .find_map(|(sound, key, advice)| (!sound).then_some((key, advice)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_fault_has_no_flaw_and_nonsense_is_named() {
        assert_eq!(Faults::default().flaw(), None);
        let mut faults = Faults::default();
        faults.lidar.dropouts = f64::NAN;
        assert_eq!(
            faults.flaw().map(|flaw| flaw.0),
            Some("faults.lidar.dropouts")
        );
        faults.actuators.thrust_lag = Some(0.0);
        assert_eq!(
            faults.flaw().map(|flaw| flaw.0),
            Some("faults.actuators.thrust_lag")
        );
    }
}
