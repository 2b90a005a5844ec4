//! The reasons why a flight core cannot be set up.

use crate::config::MAX_PATHS;
use crate::control::RiccatiError;
use crate::qp::CondenseError;
use crate::settings::{OutOfRange, PlannerSettings, Setting, Settings};
use crate::vehicle::{Trim, TrimError};

/// The reason why step or planner cannot be set up. The vehicle then does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetupError {
    /// The airframe has no level trim at the cruise airspeed.
    #[error(transparent)]
    Trim(TrimError),
    /// The regulator has no stabilising gain.
    #[error(transparent)]
    Regulator(RiccatiError),
    /// The plan's model has no steady state.
    #[error("the plan's model has no steady state: check the pitch stiffness of the airframe")]
    NoSteadyState,
    /// The program's Hessian is not positive definite.
    #[error(transparent)]
    Condense(CondenseError),
    /// The regulator does not hold the aircraft, because it acts only once in a tick.
    #[error(
        "the regulator is too firm or too soft for a tick of 10 ms: bring its weights, \
         cross_track, airspeed_hold and the airframe nearer to those of a preset"
    )]
    Unstable,
    /// The settings ask for more than [`MAX_PATHS`] paths.
    #[error("there is no room for that many paths: ask for at most {}", MAX_PATHS)]
    TooManyPaths,
    /// A number of the settings is outside of its range, or is not finite.
    #[error("{}", OutOfRange(*.0))]
    OutOfRange(Setting),
    /// The greatest thrust of motor or plans does not carry level flight.
    #[error(
        "the greatest thrust does not carry level flight: raise it, or check cruise and airframe"
    )]
    ThrustTooLow,
    /// The settings ask the plane planner for zero paths.
    #[error("the plane planner refines every path: ask for at least one")]
    NoPaths,
    /// The settings belong to another planning method than the one that is set up.
    #[error("the settings are of another planner than the one that is set up: set it up anew")]
    OtherMethod,
}

/// Checks all settings that step and planner use, and gives the trim of level flight.
pub(crate) fn check(settings: &Settings) -> Result<Trim, SetupError> {
    if let Some(setting) = settings.out_of_range() {
        return Err(SetupError::OutOfRange(setting));
    }
    check_paths(&settings.planner)?;
    let trim = settings
        .cruise
        .trim(&settings.airframe)
        .map_err(SetupError::Trim)?;
    let plans = settings.planner.plane().map(|own| own.thrust_max);
    let most = [settings.actuators.thrust_max, plans];
    if most
        .into_iter()
        .flatten()
        .any(|most| most < trim.control.thrust)
    {
        return Err(SetupError::ThrustTooLow);
    }
    Ok(trim)
}

/// Checks the settings that a planner takes over in flight.
pub(crate) fn check_planner(planner: &PlannerSettings) -> Result<(), SetupError> {
    if let Some(setting) = planner.out_of_range() {
        return Err(SetupError::OutOfRange(setting));
    }
    check_paths(planner)
}

fn check_paths(planner: &PlannerSettings) -> Result<(), SetupError> {
    if planner.paths > MAX_PATHS {
        return Err(SetupError::TooManyPaths);
    }
    if planner.paths == 0 && planner.plane().is_some() {
        return Err(SetupError::NoPaths);
    }
    Ok(())
}
