//! The reasons why a flight core cannot be set up.

use crate::config::MAX_PATHS;
use crate::control::RiccatiError;
use crate::qp::{CondenseError, ModelError};
use crate::settings::{PlannerSettings, Settings};
use crate::vehicle::{Trim, TrimError};
use core::fmt;

/// The reason why step or planner cannot be set up. The vehicle then does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetupError {
    /// The airframe has no level trim at the cruise airspeed.
    Trim(TrimError),
    /// The regulator has no stabilising gain.
    Regulator(RiccatiError),
    /// The plan's model has no steady state.
    Model(ModelError),
    /// The program's Hessian is not positive definite.
    Condense(CondenseError),
    /// The settings ask for more than [`MAX_PATHS`] paths.
    TooManyPaths,
    /// The altitude is not a finite number.
    Altitude,
    /// The lidar's sight is not a positive, finite number.
    Sight,
    /// A price of the soft rows is not positive.
    Penalty,
    /// The margin is not a positive, finite number.
    Margin,
    /// The altitude band is not a positive, finite number.
    Band,
    /// The greatest thrust of a plan is not a positive, finite number.
    ThrustMax,
    /// The limit of the angle of attack is not a positive, finite number.
    AngleOfAttackLimit,
    /// The limit of the flight path angle is not a positive, finite number.
    FlightPathLimit,
    /// The change of the wind is not a positive, finite number.
    WindChange,
    /// A limit of an actuator is not a positive, finite number.
    ActuatorLimit,
    /// The greatest thrust of the motor does not carry level flight.
    ThrustTooLow,
    /// The settings ask the flight planner for zero paths.
    NoPaths,
    /// The latency of plans is negative or not a finite number.
    Latency,
    /// The settings belong to another planning method than the one that is set up.
    OtherMethod,
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Trim(error) => return error.fmt(f),
            Self::Regulator(error) => return error.fmt(f),
            Self::Model(error) => return error.fmt(f),
            Self::Condense(error) => return error.fmt(f),
            Self::TooManyPaths => {
                return write!(
                    f,
                    "there is no room for that many paths: ask for at most {MAX_PATHS}"
                );
            }
            Self::Altitude => "the altitude is not a finite number: give it in metres",
            Self::Sight => {
                "the lidar's sight is not a positive, finite number: give it in metres"
            }
            Self::Penalty => "a price of the soft rows is not positive: raise it above zero",
            Self::Margin => {
                "the distance to keep from obstacles is not a positive, finite number: give it in metres"
            }
            Self::Band => {
                "the band about the altitude is not a positive, finite number: give it in metres"
            }
            Self::ThrustMax => {
                "the greatest thrust of a plan is not a positive, finite number: give it in newtons"
            }
            Self::AngleOfAttackLimit => {
                "the limit of the angle of attack is not a positive, finite number: give it in radians"
            }
            Self::FlightPathLimit => {
                "the limit of the flight path angle is not a positive, finite number: give it in radians"
            }
            Self::WindChange => {
                "the change of the wind is not a positive, finite number: give it in metres per second"
            }
            Self::ActuatorLimit => {
                "an actuator's limit is not a positive, finite number: correct it, or set no limit"
            }
            Self::ThrustTooLow => {
                "the greatest thrust does not carry level flight: raise it, or check cruise and \
                 airframe"
            }
            Self::NoPaths => "the flight planner refines every path: ask for at least one",
            Self::Latency => {
                "the latency of plans is negative or not a finite number: give it in seconds"
            }
            Self::OtherMethod => {
                "the settings are of another planner than the one that is set up: set it up anew"
            }
        })
    }
}

impl core::error::Error for SetupError {}

/// Checks the settings of actuators and wind, which step and planner use.
pub(crate) fn check_vehicle(settings: &Settings, trim: &Trim) -> Result<(), SetupError> {
    let limits = &settings.actuators;
    let carries = limits
        .thrust_max
        .is_none_or(|most| most >= trim.control.thrust);
    if !limits.is_valid() {
        return Err(SetupError::ActuatorLimit);
    }
    if !carries {
        return Err(SetupError::ThrustTooLow);
    }
    if !settings.wind_change.is_none_or(positive) {
        return Err(SetupError::WindChange);
    }
    Ok(())
}

/// Checks the settings that every planning method reads.
pub(super) fn check_shared(planner: &PlannerSettings) -> Result<(), SetupError> {
    if planner.paths > MAX_PATHS {
        return Err(SetupError::TooManyPaths);
    }
    if !planner.altitude.is_finite() {
        return Err(SetupError::Altitude);
    }
    Ok(())
}

/// Whether a number is positive and finite.
pub(super) fn positive(number: f64) -> bool {
    number > 0.0 && number.is_finite()
}
