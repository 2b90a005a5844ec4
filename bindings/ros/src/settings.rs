//! What the node's parameters set: aircraft, frame of the scans, source of the airspeed, and the core's own under their
//! names.

use hil_protocol::{Configure, ConfigureVerdict, ParameterVerdict};
use mpp_node::parameters::{PARAMETERS, Tuning, number};
use mpp_sim::aircraft_file::AircraftFile;
use mpp_sim::scenario::{ScenarioError, ScenarioFile};
use ros2_client::ParameterValue;

/// The core's parameter that the goal sets.
pub(crate) const ALTITUDE: &str = "MPP_ALT_M";

/// Where airspeeds come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AirspeedFrom {
    /// The odometry's velocity: the air is taken to stand still.
    Odometry,
    /// The topic.
    Topic,
}

/// The settings of a node.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    aircraft: String,
    /// The frame in which scans must be.
    pub(crate) scan_frame: String,
    /// The frame in which point clouds must be.
    pub(crate) cloud_frame: String,
    /// The longest range of a point cloud's lidar \[m\].
    pub(crate) cloud_range: f64,
    /// Where airspeeds come from.
    pub(crate) airspeed_from: AirspeedFrom,
    /// The configuration, but for the goal's height and the lidar's numbers.
    pub(crate) configure: Configure,
    /// Numbers and values of the core's parameters that somebody set.
    pub(crate) tuned: Vec<(u8, f64)>,
    tuning: Tuning,
}

/// Why a parameter cannot be what it was set to.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SettingsError {
    /// No such parameter.
    #[error("there is no parameter `{0}`: --help lists them")]
    Unknown(String),
    /// A value that is none of those there are.
    #[error("{0}: give {1}")]
    Value(&'static str, &'static str),
    /// A value that is no number.
    #[error("{0}: `{1}` is no number")]
    Number(String, String),
    /// The core does not take the value.
    #[error("{0} = {1}: {2}")]
    Refused(String, f64, ParameterVerdict),
    /// The aircraft file cannot be read.
    #[error("aircraft: there is no known one and no file `{0}` ({1})")]
    File(String, #[source] std::io::Error),
    /// The aircraft makes no sense.
    #[error("aircraft: {0}")]
    Aircraft(#[from] ScenarioError),
    /// The core refuses the aircraft.
    #[error("aircraft: {0}")]
    Core(ConfigureVerdict),
}

impl Settings {
    /// The settings of these parameters.
    ///
    /// # Errors
    /// [`SettingsError`] of the first wrong one.
    pub(crate) fn of(parameters: &[(String, String)]) -> Result<Self, SettingsError> {
        let named = parameters.iter().rev().find(|(name, _)| name == "aircraft");
        let aircraft = named.map_or("reference", |(_, value)| value).to_owned();
        let file = match AircraftFile::known(&aircraft) {
            Some(known) => known,
            None => {
                let text = std::fs::read_to_string(&aircraft)
                    .map_err(|error| SettingsError::File(aircraft.clone(), error))?;
                AircraftFile::parse(&aircraft, &text)?
            }
        };
        let scenario = ScenarioFile {
            aircraft: Some(file),
            obstacles: Some(0),
            ..ScenarioFile::default()
        };
        let configure = scenario.build()?.configure();
        let mut settings = Self {
            aircraft,
            scan_frame: "lidar_vertical".to_owned(),
            cloud_frame: "base_link".to_owned(),
            cloud_range: 45.0,
            airspeed_from: AirspeedFrom::Odometry,
            configure,
            tuned: Vec::new(),
            tuning: Tuning::new(&configure).map_err(SettingsError::Core)?,
        };
        for (name, value) in parameters {
            settings.set(name, value)?;
        }
        Ok(settings)
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), SettingsError> {
        match name {
            // ROS gives it to every node; time is that of the odometry here.
            "aircraft" | "use_sim_time" => {}
            "scan_frame" => self.scan_frame = frame("scan_frame", value)?,
            "cloud_frame" => self.cloud_frame = frame("cloud_frame", value)?,
            "cloud_range" => {
                let range = value.parse().ok().filter(|it| (1.0..=1000.0).contains(it));
                self.cloud_range =
                    range.ok_or(SettingsError::Value("cloud_range", "1 to 1000 m"))?;
            }
            "airspeed_from" => {
                self.airspeed_from = match value {
                    "odometry" => AirspeedFrom::Odometry,
                    "topic" => AirspeedFrom::Topic,
                    _ => return Err(SettingsError::Value("airspeed_from", "odometry or topic")),
                }
            }
            _ => {
                let number = core_number(name).ok_or(SettingsError::Unknown(name.to_owned()))?;
                let parsed: f64 = value
                    .parse()
                    .map_err(|_| SettingsError::Number(name.to_owned(), value.to_owned()))?;
                self.tuning = self
                    .tuning
                    .with(number, parsed, false)
                    .map_err(|verdict| SettingsError::Refused(name.to_owned(), parsed, verdict))?;
                self.tuned.push((number, parsed));
            }
        }
        Ok(())
    }

    /// Names and values of all parameters, for the node's services.
    pub(crate) fn declared(&self) -> Vec<(&'static str, ParameterValue)> {
        let text = |text: &str| ParameterValue::String(text.to_owned());
        let from = match self.airspeed_from {
            AirspeedFrom::Odometry => "odometry",
            AirspeedFrom::Topic => "topic",
        };
        let mut all = vec![
            ("aircraft", text(&self.aircraft)),
            ("scan_frame", text(&self.scan_frame)),
            ("cloud_frame", text(&self.cloud_frame)),
            ("cloud_range", ParameterValue::Double(self.cloud_range)),
            ("airspeed_from", text(from)),
        ];
        let core = (0..).zip(PARAMETERS.iter()).filter_map(|(number, it)| {
            let value = self.tuning.value(number)?;
            (it.name != ALTITUDE).then_some((it.name, ParameterValue::Double(value)))
        });
        all.extend(core);
        all
    }

    /// Ticks from a plan to the next.
    pub(crate) fn replan_ticks(&self) -> u32 {
        self.tuning.configure.replan_period_ticks
    }

    /// Takes a new value in flight, as the node's services give it. Gives it as the core takes it.
    ///
    /// # Errors
    /// A sentence if the value cannot be, or not in flight.
    pub(crate) fn change(
        &mut self,
        name: &str,
        value: &ParameterValue,
    ) -> Result<(u8, f64), String> {
        let number = core_number(name).ok_or("set it at the start, by -p")?;
        let ParameterValue::Double(value) = *value else {
            return Err("give a number with a point".to_owned());
        };
        let refused = |verdict: ParameterVerdict| verdict.to_string();
        self.take(number, value).map_err(refused)?;
        Ok((number, value))
    }

    /// Takes a new value of a parameter of the core in flight.
    ///
    /// # Errors
    /// Why the value cannot be, or not in flight.
    pub(crate) fn take(&mut self, number: u8, value: f64) -> Result<(), ParameterVerdict> {
        self.tuning = self.tuning.with(number, value, true)?;
        self.tuned.push((number, value));
        Ok(())
    }
}

fn frame(name: &'static str, value: &str) -> Result<String, SettingsError> {
    let error = SettingsError::Value(name, "the name of a frame");
    (!value.is_empty()).then(|| value.to_owned()).ok_or(error)
}

/// The number of a parameter of the core that a user may set.
fn core_number(name: &str) -> Option<u8> {
    (name != ALTITUDE).then(|| number(name))?
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(parameters: &[(&str, &str)]) -> Result<Settings, SettingsError> {
        let owned = |(name, value): &(&str, &str)| ((*name).to_owned(), (*value).to_owned());
        Settings::of(&parameters.iter().map(owned).collect::<Vec<_>>())
    }

    #[test]
    fn parameters_set_the_core_under_their_names() {
        let settings = of(&[
            ("aircraft", "x8"),
            ("airspeed_from", "topic"),
            ("MPP_REPLAN_S", "0.25"),
        ])
        .unwrap();
        assert_eq!(settings.replan_ticks(), 25);
        let declared = settings.declared();
        let value = |name| declared.iter().find(|(own, _)| *own == name);
        assert_eq!(
            value("MPP_REPLAN_S"),
            Some(&("MPP_REPLAN_S", ParameterValue::Double(0.25)))
        );
        let reference = of(&[]).unwrap();
        assert_ne!(settings.configure.aircraft, reference.configure.aircraft);
        assert_eq!(reference.replan_ticks(), 100);
    }

    #[test]
    fn in_flight_only_some_change() {
        let mut settings = of(&[]).unwrap();
        let number = ParameterValue::Double(0.5);
        assert!(settings.change("MPP_REPLAN_S", &number).is_ok());
        assert_eq!(settings.replan_ticks(), 50);
        for name in ["MPP_MARGIN_M", "aircraft", ALTITUDE, "nope"] {
            assert!(settings.change(name, &number).is_err(), "{name}");
        }
    }

    #[test]
    fn wrong_values_are_told_by_their_names() {
        for (name, value) in [
            ("nope", "1"),
            ("MPP_REPLAN_S", "often"),
            ("MPP_REPLAN_S", "-1"),
            ("MPP_REPLAN_S", "NaN"),
            (ALTITUDE, "50"),
            ("aircraft", "f16"),
            ("scan_frame", ""),
            ("cloud_range", "0"),
            ("airspeed_from", "pitot"),
        ] {
            let error = of(&[(name, value)]).unwrap_err().to_string();
            assert!(error.contains(name), "{error}");
        }
    }
}
