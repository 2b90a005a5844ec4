//! What a planner is set up with, and what is wrong with it.

use super::{Phase, Planner};
use crate::config::MAX_PATHS;
use crate::qp::{CondenseError, ModelError, StageModel};
use crate::settings::{PlannerSettings, Settings};
use crate::vehicle::{Trim, TrimError, linearize};
use rand_core::SeedableRng;
use rand_pcg::Pcg64Mcg;

/// Why a planner cannot be set up. The vehicle does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SetupError {
    /// The airframe has no level trim at the cruise thrust.
    Trim(TrimError),
    /// The regulator has no stabilising gain.
    Regulator(crate::control::RiccatiError),
    /// The plan's model has no steady state.
    Model(ModelError),
    /// The program's Hessian is not positive definite.
    Condense(CondenseError),
    /// More paths than [`MAX_PATHS`].
    TooManyPaths,
    /// A number is not finite, or a penalty, the lidar's sight or the wind's time constant not
    /// positive; or an iteration lacks penalty or attitude rows.
    Number,
    /// An actuator's limit is not a positive, finite number, or the thrust does not carry level flight.
    Actuators,
}

impl Planner {
    /// Sets up the model about level trim.
    ///
    /// # Errors
    /// [`SetupError`]: nothing is planned.
    pub fn set_up(&mut self, settings: &Settings) -> Result<(), SetupError> {
        // Whatever fails below: a planner that is half set up plans nothing.
        self.random = None;
        self.phase = Phase::Idle;
        let planner = &settings.planner;
        check(planner)?;
        let airframe = &settings.airframe;
        let trim = settings.cruise.trim(airframe).map_err(SetupError::Trim)?;
        check_vehicle(settings, &trim)?;
        let linear = linearize(airframe, &trim.state, trim.control, planner.jacobian);
        let model = StageModel::new(
            airframe,
            &trim,
            &linear,
            planner.steady_state,
            planner.initial,
        )
        .map_err(SetupError::Model)?;
        self.shared
            .condense(&model, &planner.weights)
            .map_err(SetupError::Condense)?;
        self.settings = *planner;
        if planner.paths == 0 {
            // The baseline tracks paths as they are.
            self.settings.iteration = None;
        }
        self.known = (*airframe, trim);
        self.trim = trim;
        self.airframe = *airframe;
        self.actuators = settings.actuators;
        self.random = Some(Pcg64Mcg::seed_from_u64(planner.seed));
        // Rows that these settings do not have must not stay from others.
        self.problem.bounds.clear();
        self.iterated.forget();
        self.best.clear();
        self.phase = Phase::Idle;
        Ok(())
    }

    /// Takes over, for the cycles to come, what needs no other model: paths (at most
    /// [`MAX_PATHS`]), altitude, padding, penalty and attitude limits.
    ///
    /// # Errors
    /// [`SetupError`]: they stay as they were.
    pub fn retune(&mut self, settings: &PlannerSettings) -> Result<(), SetupError> {
        let PlannerSettings {
            paths,
            altitude,
            padding,
            penalty,
            attitude,
            ..
        } = *settings;
        let retuned = PlannerSettings {
            paths,
            altitude,
            padding,
            penalty,
            attitude,
            ..self.settings
        };
        check(&retuned)?;
        self.settings = retuned;
        Ok(())
    }
}

/// Whether step and planner can go by what is said of actuators and wind.
pub(crate) fn check_vehicle(settings: &Settings, trim: &Trim) -> Result<(), SetupError> {
    let limits = &settings.actuators;
    let carries = limits
        .thrust_max
        .is_none_or(|most| most >= trim.control.thrust);
    if !limits.is_valid() || !carries {
        return Err(SetupError::Actuators);
    }
    if settings
        .wind
        .is_some_and(|constant| !(constant > 0.0 && constant.is_finite()))
    {
        return Err(SetupError::Number);
    }
    Ok(())
}

/// Whether a planner can go by these settings.
fn check(planner: &PlannerSettings) -> Result<(), SetupError> {
    if planner.paths > MAX_PATHS {
        return Err(SetupError::TooManyPaths);
    }
    let priced = planner
        .penalty
        .is_none_or(|p| p.linear > 0.0 && p.quadratic > 0.0);
    let iterable = planner.iteration.is_none_or(|iteration| {
        let numbers = [iteration.margin, iteration.band, iteration.thrust_max];
        numbers
            .iter()
            .all(|number| *number > 0.0 && number.is_finite())
            && planner.penalty.is_some()
            && planner.attitude.is_some()
    });
    let sees = planner.sight > 0.0 && planner.sight.is_finite();
    if !planner.altitude.is_finite() || !sees || !priced || !iterable {
        return Err(SetupError::Number);
    }
    Ok(())
}
