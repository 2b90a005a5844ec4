//! Faults and disturbances of a flight. Without any of them, a flight is byte for byte that of an
//! ideal aircraft in still air.
//!
//! Each random fault draws from its own stream of the flight's seed (see [`crate::random`]). An
//! additional fault therefore does not change the noise of the sensors.

mod actuators;
mod delivery;
mod gusts;
mod lidar;
mod line;
mod model_error;
mod scan;
mod signal;
mod window;

pub use actuators::{ActuatorLimits, Actuators};
pub use delivery::{Delivery, DeliveryFault};
pub use gusts::{GustConfig, Gusts, HEIGHT, longitudinal_ratio};
pub use lidar::{FaultyLidar, LidarFaultConfig, LidarFaults};
pub use line::{ClockFault, Line, LinkFault, Passage};
pub use model_error::{ModelError, Signs};
pub use scan::{ScanFault, Scans, Show};
use serde::{Deserialize, Serialize};
pub use signal::{Signal, SignalFault};
use window::is_absent;

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
    /// The airspeed sensor [m/s].
    #[serde(skip_serializing_if = "is_absent")]
    pub airspeed: SignalFault,
    /// The pitch sensor \[deg\].
    #[serde(skip_serializing_if = "is_absent")]
    pub pitch: SignalFault,
    /// The way of the air data.
    #[serde(skip_serializing_if = "is_absent")]
    pub air: DeliveryFault,
    /// The navigation source's position downrange \[m\].
    #[serde(skip_serializing_if = "is_absent")]
    pub x: SignalFault,
    /// The navigation source's height \[m\].
    #[serde(skip_serializing_if = "is_absent")]
    pub z: SignalFault,
    /// The way of the positions.
    #[serde(skip_serializing_if = "is_absent")]
    pub position: DeliveryFault,
    /// Whole scans.
    #[serde(skip_serializing_if = "is_absent")]
    pub scan: ScanFault,
    /// The elevator, as its distance from trim [-]. The core is not told of it.
    #[serde(skip_serializing_if = "is_absent")]
    pub elevator: SignalFault,
    /// The thrust \[N\]. The core is not told of it.
    #[serde(skip_serializing_if = "is_absent")]
    pub thrust: SignalFault,
    /// The link to the core.
    #[serde(skip_serializing_if = "is_absent")]
    pub link: LinkFault,
    /// The tick counter that the core sees.
    #[serde(skip_serializing_if = "is_absent")]
    pub clock: ClockFault,
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
        .or_else(|| self.table_flaw())
    }

    /// The first tick at which a fault with a time acts; 0 if no fault has one.
    #[must_use]
    pub fn onset(&self) -> u32 {
        let windows = [
            (self.airspeed.window(), is_absent(&self.airspeed)),
            (self.pitch.window(), is_absent(&self.pitch)),
            (self.air.window(), is_absent(&self.air)),
            (self.x.window(), is_absent(&self.x)),
            (self.z.window(), is_absent(&self.z)),
            (self.position.window(), is_absent(&self.position)),
            (self.scan.window(), is_absent(&self.scan)),
            (self.elevator.window(), is_absent(&self.elevator)),
            (self.thrust.window(), is_absent(&self.thrust)),
            (self.link.window(), is_absent(&self.link)),
            (self.clock.window(), is_absent(&self.clock)),
        ];
        let present = windows.into_iter().filter(|(_, absent)| !absent);
        present.map(|(window, _)| window.first()).min().unwrap_or(0)
    }

    /// The same for the tables that [`is_absent`] may leave out. The advice names the key of the table.
    fn table_flaw(&self) -> Option<(&'static str, &'static str)> {
        [
            ("faults.airspeed", self.airspeed.flaw()),
            ("faults.pitch", self.pitch.flaw()),
            ("faults.air", self.air.flaw()),
            ("faults.x", self.x.flaw()),
            ("faults.z", self.z.flaw()),
            ("faults.position", self.position.flaw()),
            ("faults.scan", self.scan.flaw()),
            ("faults.elevator", self.elevator.flaw()),
            ("faults.thrust", self.thrust.flaw()),
            ("faults.link", self.link.flaw()),
            ("faults.clock", self.clock.flaw()),
        ]
        .into_iter()
        .find_map(|(table, flaw)| flaw.map(|advice| (table, advice)))
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
