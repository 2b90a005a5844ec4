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
pub(crate) use gusts::{AIRSPEED as GUST_AIRSPEED, DoubleLag, Lag, longitudinal_length};
pub use gusts::{GustConfig, Gusts, HEIGHT, longitudinal_ratio};
pub use lidar::{FaultyLidar, LidarFaultConfig, LidarFaults};
pub use line::{ClockFault, Line, LinkFault, Passage};
pub use model_error::{ModelError, Signs};
pub use scan::{MOST_AGE_MS, ScanFault, Scans, Show};
use serde::{Deserialize, Serialize};
pub use signal::{Signal, SignalFault};
use window::{Timed, Window, is_absent};

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
        let delay = |value: Option<f64>| value.is_none_or(|value| (1e-3..=0.3).contains(&value));
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
                delay(actuators.elevator_delay),
                "faults.actuators.elevator_delay",
                "give 0.001 to 0.3 s",
            ),
            (
                delay(actuators.thrust_delay),
                "faults.actuators.thrust_delay",
                "give 0.001 to 0.3 s",
            ),
            (
                delay(actuators.untold_delay),
                "faults.actuators.untold_delay",
                "give 0.001 to 0.3 s",
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
        let tables = self.tables().into_iter().filter(|table| !table.absent);
        tables.map(|table| table.window.first()).min().unwrap_or(0)
    }

    /// Returns the first table whose fault cannot act in a flight of so many ticks: its name and what to do.
    #[must_use]
    pub fn idle(&self, ticks: u32) -> Option<(&'static str, &'static str)> {
        self.tables().into_iter().find_map(|table| {
            let advice = table.window.idle(table.acts, ticks);
            advice.map(|advice| (table.name, advice))
        })
    }

    /// These faults without the tables that cannot act in a flight of so many ticks.
    #[must_use]
    pub fn within(mut self, ticks: u32) -> Self {
        fn keep<T: Timed>(fault: &mut T, ticks: u32) {
            let table = table("", fault);
            if table.window.idle(table.acts, ticks).is_some() {
                *fault = T::default();
            }
        }
        keep(&mut self.airspeed, ticks);
        keep(&mut self.pitch, ticks);
        keep(&mut self.air, ticks);
        keep(&mut self.x, ticks);
        keep(&mut self.z, ticks);
        keep(&mut self.position, ticks);
        keep(&mut self.scan, ticks);
        keep(&mut self.elevator, ticks);
        keep(&mut self.thrust, ticks);
        keep(&mut self.link, ticks);
        keep(&mut self.clock, ticks);
        self
    }

    /// The first flaw of a table with times. The advice names the key of the table.
    fn table_flaw(&self) -> Option<(&'static str, &'static str)> {
        let mut tables = self.tables().into_iter();
        tables.find_map(|table| table.flaw.map(|advice| (table.name, advice)))
    }

    /// The tables that may have times.
    fn tables(&self) -> [Table; 11] {
        [
            table("faults.airspeed", &self.airspeed),
            table("faults.pitch", &self.pitch),
            table("faults.air", &self.air),
            table("faults.x", &self.x),
            table("faults.z", &self.z),
            table("faults.position", &self.position),
            table("faults.scan", &self.scan),
            table("faults.elevator", &self.elevator),
            table("faults.thrust", &self.thrust),
            table("faults.link", &self.link),
            table("faults.clock", &self.clock),
        ]
    }
}

/// What a table with times says.
struct Table {
    name: &'static str,
    absent: bool,
    acts: bool,
    window: Window,
    flaw: Option<&'static str>,
}

fn table(name: &'static str, fault: &impl Timed) -> Table {
    Table {
        name,
        absent: is_absent(fault),
        acts: !is_absent(&fault.timeless()),
        window: fault.window(),
        flaw: fault.window().flaw().or(fault.wrong_key()),
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
    /// What a flight of 20 s does not show is refused: times without a fault, and times that it does not reach.
    #[test]
    fn a_fault_that_cannot_act_is_named() {
        let of = |table: &str| -> Faults { toml::from_str(table).unwrap() };
        assert_eq!(Faults::default().idle(2000), None);
        for (table, name, advice) in [
            ("[scan]\nfrom = 5.0", "faults.scan", "nothing fails"),
            (
                "[air]\nuntil = 5.0\nmissing = false",
                "faults.air",
                "nothing",
            ),
            ("[clock]\nfrom = 5.0\nstart = 9", "faults.clock", "nothing"),
            (
                "[z]\nfrom = 20.0\nbias = 1.0",
                "faults.z",
                "it begins after",
            ),
            (
                "[link]\nfrom = 30.0\nuntil = 50.0\nsilent = true",
                "faults.link",
                "it begins after",
            ),
            (
                "[pitch]\nfrom = 5.001\nuntil = 5.002\nfrozen = true",
                "faults.pitch",
                "it acts in no tick",
            ),
        ] {
            let (found, why) = of(table).idle(2000).unwrap();
            assert!(found == name && why.starts_with(advice), "{found}: {why}");
            assert_eq!(of(table).within(2000), Faults::default(), "{table}");
        }
        for table in [
            "[scan]\nfrom = 19.99\nshow = \"zeros\"",
            "[thrust]\nscale = 0.0",
            "[clock]\nstart = 9",
        ] {
            assert_eq!(of(table).idle(2000), None, "{table}");
            assert_eq!(of(table).within(2000), of(table), "{table}");
        }
    }
}
