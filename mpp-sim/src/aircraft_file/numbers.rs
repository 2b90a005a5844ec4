//! From an aircraft file to the numbers of core and plant.

use super::AircraftFile;
use super::ranges::check_turns;
use crate::file_error::{ScenarioError, ensure};
use mpp_core::flight::FlightLoop;
use mpp_core::planner::SetupError;
use mpp_core::settings::{Aircraft, Settings};
use mpp_core::units::Units;
use mpp_core::vehicle::{ActuatorLimits, Trim};

/// Greatest bank of plans, and its rate [rad, rad/s]: 60 deg and 90 deg/s. Source: decision 46.
const BANK: [f64; 2] = [60_f64.to_radians(), 90_f64.to_radians()];
impl AircraftFile {
    /// Greatest bank of plans in space, and its rate [rad, rad/s]: those of the roll loop, if they are less.
    #[must_use]
    pub fn plan_bank(&self) -> [f64; 2] {
        let [bank, rate] = BANK;
        let roll_loop = self.lateral.as_ref().and_then(|it| it.roll_loop);
        roll_loop.map_or(BANK, |it| [bank.min(it.max_bank), rate.min(it.max_rate)])
    }
}

/// An aircraft as core and plant need it.
#[derive(Clone, Debug, PartialEq)]
pub struct AircraftModel {
    /// The file.
    pub file: AircraftFile,
    /// What the core is told.
    pub known: Aircraft,
    /// The limits that the core is told.
    pub actuators: ActuatorLimits,
    /// Level flight.
    pub trim: Trim,
}

impl AircraftModel {
    /// The aircraft of flights in the vertical plane: a scenario and its log have no lateral part.
    #[must_use]
    pub fn plane(self) -> Self {
        let file = AircraftFile {
            lateral: None,
            ..self.file
        };
        Self { file, ..self }
    }

    /// The aircraft of a file.
    ///
    /// # Errors
    /// [`ScenarioError::Value`] with the key of the first number that makes no sense.
    pub fn new(file: AircraftFile) -> Result<Self, ScenarioError> {
        check_name(&file.name)?;
        if let Some(lateral) = &file.lateral {
            check_turns(lateral)?;
            lateral.check()?;
        }
        let airframe = file.airframe();
        let known = Aircraft {
            airframe,
            cruise: file.cruise,
            body_radius: file.body_radius,
            stall: None,
        };
        // There is no level flight to look for while a number makes no sense.
        let numbers = Settings::flight_of(&known, &ActuatorLimits::NONE).out_of_range();
        numbers.map_or(Ok(()), |setting| Err(file.refusal(setting)))?;
        let trim = Trim::at_speed(&airframe, file.cruise, 0.0)
            .map_err(|error| ScenarioError::Value("aircraft", error.to_string()))?;
        let (elevator, alpha) = (trim.control.elevator, trim.state.angle_of_attack());
        let outside = |key, limit: f64| {
            let advice = format!(
                "level flight at `cruise` needs {elevator:.4}, which {limit} does not allow"
            );
            ScenarioError::Value(key, advice)
        };
        let side = |key, limit: Option<f64>, room: fn(f64, f64) -> f64| match limit {
            Some(limit) if room(limit, elevator) <= 0.0 => Err(outside(key, limit)),
            limit => Ok(limit.map(|limit| room(limit, elevator))),
        };
        let actuators = ActuatorLimits {
            thrust_max: file.thrust.max,
            thrust_lag: file.thrust.lag,
            elevator_below: side("aircraft.elevator.min", file.elevator.min, |least, trim| {
                trim - least
            })?,
            elevator_above: side("aircraft.elevator.max", file.elevator.max, |most, trim| {
                most - trim
            })?,
            elevator_rate: file.elevator.rate,
            elevator_delay: file.elevator.delay,
            thrust_delay: file.thrust.delay,
        };
        let stalls = file.lift.stall.is_some_and(|stall| alpha >= stall);
        let advice = format!(
            "level flight at `cruise` has an angle of attack of {alpha:.3} rad: fly faster or give a larger wing"
        );
        ensure(!stalls, "aircraft.lift.stall", advice)?;
        let known = Aircraft {
            stall: file.lift.stall.map(|stall| stall - alpha),
            ..known
        };
        let model = Self {
            file,
            known,
            actuators,
            trim,
        };
        match FlightLoop::new(&model.settings()) {
            Ok(_) => Ok(model),
            Err(error) => Err(model.refusal(error)),
        }
    }

    /// Why the core cannot fly the aircraft, by the key from which it comes.
    fn refusal(&self, error: SetupError) -> ScenarioError {
        match error {
            SetupError::OutOfRange(setting) => self.file.refusal(setting),
            SetupError::ThrustTooLow => {
                let needed = self.trim.control.thrust;
                let advice = format!(
                    "level flight at `cruise` needs {needed:.2} N: give at least that, or check drag and cruise"
                );
                ScenarioError::Value("aircraft.thrust.max", advice)
            }
            error => ScenarioError::Value("aircraft", error.to_string()),
        }
    }

    /// Preset `flight` for the aircraft.
    #[must_use]
    pub fn settings(&self) -> Settings {
        Settings::flight_of(&self.known, &self.actuators)
    }

    /// The units in which the planner reckons for this aircraft.
    #[must_use]
    pub fn units(&self) -> Units {
        Units::of(self.known.cruise, self.known.airframe.mass)
    }

    /// The aircraft of the authors' code.
    #[must_use]
    #[expect(
        clippy::missing_panics_doc,
        clippy::expect_used,
        reason = "a test reads every known file"
    )]
    pub fn reference() -> Self {
        let file = AircraftFile::known("reference").expect("it is a known aircraft");
        Self::new(file).expect("it flies")
    }
}

/// Greatest length of a name \[bytes\]. A file system takes names of files up to 255 bytes, and those of a flight's
/// files hold more than the aircraft.
const LONGEST_NAME: usize = 64;

/// Checks whether a name can stand in the name of a file.
fn check_name(name: &str) -> Result<(), ScenarioError> {
    let fits = (1..=LONGEST_NAME).contains(&name.len());
    let splits = name.contains(|c: char| c == '/' || c == '\\' || c.is_control());
    let advice = format!(
        "give 1 to {LONGEST_NAME} bytes without slashes and control characters: files of flights have it in their names"
    );
    ensure(fits && !splits, "aircraft.name", advice)
}
