//! From an aircraft file to the numbers of core and plant.

use super::{AircraftFile, Lateral};
use crate::file_error::{ScenarioError, ensure};
use mpp_core::config::TICK_PERIOD;
use mpp_core::flight::FlightLoop;
use mpp_core::settings::{Aircraft, Settings};
use mpp_core::units::Units;
use mpp_core::vehicle::{ActuatorLimits, Trim};

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
        check(&file)?;
        let airframe = file.airframe();
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
        };
        let stalls = file.lift.stall.is_some_and(|stall| alpha >= stall);
        let advice = format!(
            "level flight at `cruise` has an angle of attack of {alpha:.3} rad: fly faster or give a larger wing"
        );
        ensure(!stalls, "aircraft.lift.stall", advice)?;
        let known = Aircraft {
            airframe,
            cruise: file.cruise,
            body_radius: file.body_radius,
            stall: file.lift.stall.map(|stall| stall - alpha),
        };
        let model = Self {
            file,
            known,
            actuators,
            trim,
        };
        let flies = FlightLoop::new(&model.settings());
        flies.map_err(|error| ScenarioError::Value("aircraft", error.to_string()))?;
        Ok(model)
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

/// Checks each key by itself.
fn check(file: &AircraftFile) -> Result<(), ScenarioError> {
    check_name(&file.name)?;
    let positive = [
        (file.mass, "aircraft.mass"),
        (file.pitch_inertia, "aircraft.pitch_inertia"),
        (file.wing_area, "aircraft.wing_area"),
        (file.chord, "aircraft.chord"),
        (file.air_density, "aircraft.air_density"),
        (file.cruise, "aircraft.cruise"),
        (file.lift.alpha, "aircraft.lift.alpha"),
        (-file.moment.alpha, "aircraft.moment.alpha"),
        (file.lift.stall.unwrap_or(1.0), "aircraft.lift.stall"),
        (file.thrust.max.unwrap_or(1.0), "aircraft.thrust.max"),
        (file.thrust.lag.unwrap_or(1.0), "aircraft.thrust.lag"),
        (file.elevator.rate.unwrap_or(1.0), "aircraft.elevator.rate"),
    ];
    for (value, key) in positive {
        let advice = if key == "aircraft.moment.alpha" {
            "give a negative number: the planner flies aircraft that are stable in pitch"
        } else {
            "give a number above 0"
        };
        ensure(value > 0.0 && value.is_finite(), key, advice)?;
    }
    let not_negative = [
        (file.body_radius, "aircraft.body_radius"),
        (file.drag.zero, "aircraft.drag.zero"),
        (file.drag.induced, "aircraft.drag.induced"),
        (-file.moment.pitch_rate, "aircraft.moment.pitch_rate"),
        (-file.moment.alpha_rate, "aircraft.moment.alpha_rate"),
        (
            -file.moment.alpha_rate_time,
            "aircraft.moment.alpha_rate_time",
        ),
    ];
    for (value, key) in not_negative {
        let advice = if key.starts_with("aircraft.moment") {
            "give 0 or a negative number: a damping"
        } else {
            "give 0 or more"
        };
        ensure(value >= 0.0 && value.is_finite(), key, advice)?;
    }
    let finite = [
        (file.lift.zero, "aircraft.lift.zero"),
        (file.moment.zero, "aircraft.moment.zero"),
        (file.elevator.lift, "aircraft.elevator.lift"),
        (file.elevator.min.unwrap_or(0.0), "aircraft.elevator.min"),
        (file.elevator.max.unwrap_or(0.0), "aircraft.elevator.max"),
    ];
    for (value, key) in finite {
        ensure(value.is_finite(), key, "give a finite number")?;
    }
    let moves = file.elevator.moment != 0.0 && file.elevator.moment.is_finite();
    ensure(
        moves,
        "aircraft.elevator.moment",
        "give a finite number other than 0",
    )?;
    let slow = file.thrust.lag.is_none_or(|lag| lag >= 0.1 * TICK_PERIOD);
    ensure(
        slow,
        "aircraft.thrust.lag",
        "give at least 0.001 s, or leave it out",
    )?;
    file.lateral.as_ref().map_or(Ok(()), Lateral::check)
}
