//! The settings that a user chooses before a flight, and the named presets.

mod aircraft;
mod plane;
mod range;

use crate::control::LqrWeights;
use crate::estimate::EkfTuning;
#[cfg(feature = "paper")]
use crate::paper::PaperSettings;
use crate::qp::Weights;
use crate::units::Units;
use crate::vehicle::{ActuatorLimits, Airframe, JacobianForm, Trim, TrimError};
pub use mpp_data::{Aircraft, OutOfRange, Setting};
pub use plane::{AttitudeLimits, PlaneSettings};

/// The level flight from which plans deviate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cruise {
    /// Steady flight at an airspeed [m/s]; the paper cruises at 12.
    Airspeed(f64),
    /// The operating point of the authors' code, which is not quite steady.
    #[cfg(feature = "paper")]
    Authors,
}

impl Cruise {
    /// The airspeed [m/s], if it is chosen.
    #[must_use]
    pub fn airspeed(&self) -> Option<f64> {
        match *self {
            Self::Airspeed(airspeed) => Some(airspeed),
            #[cfg(feature = "paper")]
            Self::Authors => None,
        }
    }

    /// The trim of this level flight.
    ///
    /// # Errors
    /// [`TrimError`] if the search finds no steady flight at the airspeed.
    pub fn trim(&self, airframe: &Airframe) -> Result<Trim, TrimError> {
        match *self {
            Self::Airspeed(airspeed) => Trim::at_speed(airframe, airspeed, 0.0),
            #[cfg(feature = "paper")]
            Self::Authors => Ok(Trim::of_authors(airframe)),
        }
    }
}

/// The planning method, with the settings that only this method reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The plane planner.
    Plane(PlaneSettings),
    /// The paper's method.
    #[cfg(feature = "paper")]
    Paper(PaperSettings),
}

/// Settings of the planner: those that every method reads, and those of the chosen method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannerSettings {
    /// Number of candidate paths of a cycle, at most [`crate::config::MAX_PATHS`]. For the plane planner it
    /// is an upper limit, and must be at least 1. With 0 the paper's method tracks the shortest path itself
    /// without refinement, which is the paper's baseline "RRT*".
    pub paths: usize,
    /// Height to which plans return \[m\].
    pub altitude: f64,
    /// Seed of the tree's samples.
    pub seed: u64,
    /// Weights of the program's cost.
    pub weights: Weights,
    /// The planning method and its own settings.
    pub method: Method,
}

impl PlannerSettings {
    /// The settings of the plane planner, if it is the chosen method.
    #[must_use]
    pub fn plane(&self) -> Option<&PlaneSettings> {
        match &self.method {
            Method::Plane(settings) => Some(settings),
            #[cfg(feature = "paper")]
            Method::Paper(_) => None,
        }
    }

    /// The settings of the plane planner for changes, if it is the chosen method.
    pub fn plane_mut(&mut self) -> Option<&mut PlaneSettings> {
        match &mut self.method {
            Method::Plane(settings) => Some(settings),
            #[cfg(feature = "paper")]
            Method::Paper(_) => None,
        }
    }

    /// The settings of the paper's method, if it is the chosen method.
    #[cfg(feature = "paper")]
    #[must_use]
    pub fn paper(&self) -> Option<&PaperSettings> {
        match &self.method {
            Method::Plane(_) => None,
            Method::Paper(settings) => Some(settings),
        }
    }

    /// The settings of the paper's method for changes, if it is the chosen method.
    #[cfg(feature = "paper")]
    pub fn paper_mut(&mut self) -> Option<&mut PaperSettings> {
        match &mut self.method {
            Method::Plane(_) => None,
            Method::Paper(settings) => Some(settings),
        }
    }
}

/// Settings of the whole flight core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The units in which the plane planner computes.
    pub units: Units,
    /// The aircraft as the core knows it.
    pub airframe: Airframe,
    /// Limits of motor and elevator, as far as the core knows them.
    pub actuators: ActuatorLimits,
    /// Straight and level flight. The regulator and the paper's method linearise about it.
    pub cruise: Cruise,
    /// Thrust about which the regulator is designed \[N\]. Without a value the design uses the trim's thrust.
    pub design_thrust: Option<f64>,
    /// Form of the Jacobian in the design of the regulator.
    pub design_jacobian: JacobianForm,
    /// The estimator's tuning.
    pub estimator: EkfTuning,
    /// Standard deviation of the change of the wind in one second [m/s]. Without a value the core assumes
    /// still air and the known airframe and takes each position as it is, as the paper does.
    pub wind_change: Option<f64>,
    /// The regulator's weights.
    pub regulator: LqrWeights,
    /// Angle by which the regulator's reference turns back, per metre of distance from the trajectory
    /// [rad/m]. With 0 the regulator controls the motion alone, as the paper does.
    pub cross_track: f64,
    /// Additional thrust per lack of airspeed against the trajectory [N s/m]. With 0 the vehicle flies with
    /// the planned thrust, as the paper does.
    pub airspeed_hold: f64,
    /// Settings of the planner.
    pub planner: PlannerSettings,
}

impl Settings {
    /// Preset `reference`: parameters, rules and faults of the authors' code, for comparison.
    #[cfg(feature = "paper")]
    #[must_use]
    pub const fn reference() -> Self {
        Self {
            cruise: Cruise::Authors,
            // The two values differ in their code: the authors trim at 4.3 N and linearise with 4.0 N.
            design_thrust: Some(4.0),
            design_jacobian: JacobianForm::Authors,
            estimator: EkfTuning::AUTHORS,
            wind_change: None,
            cross_track: 0.0,
            airspeed_hold: 0.0,
            planner: PlannerSettings {
                weights: Weights::PAPER,
                method: Method::Paper(PaperSettings::AUTHORS),
                ..Self::flight().planner
            },
            ..Self::flight()
        }
    }

    /// Preset `paper`: the paper's text with its errors corrected.
    #[cfg(feature = "paper")]
    #[must_use]
    pub const fn paper() -> Self {
        Self {
            cruise: Cruise::Airspeed(12.0),
            design_thrust: None,
            design_jacobian: JacobianForm::Exact,
            estimator: EkfTuning::EXACT,
            planner: PlannerSettings {
                method: Method::Paper(PaperSettings::CORRECTED),
                ..Self::reference().planner
            },
            ..Self::reference()
        }
    }

    /// Preset `flight`, the best that we know: the plane planner, an estimate of wind and lift, and a
    /// regulator that returns to the trajectory.
    #[must_use]
    pub const fn flight() -> Self {
        Self {
            units: Units::SI,
            airframe: Airframe::REFERENCE,
            actuators: ActuatorLimits::NONE,
            cruise: Cruise::Airspeed(12.0),
            design_thrust: None,
            design_jacobian: JacobianForm::Exact,
            estimator: EkfTuning::SENSORS,
            wind_change: Some(1.0),
            regulator: LqrWeights::PAPER,
            cross_track: 0.08,
            airspeed_hold: 10.0,
            planner: PlannerSettings {
                paths: 25,
                altitude: 50.0,
                seed: 0,
                weights: Weights {
                    control: [1.0, 0.05],
                    terminal: 1.0,
                },
                method: Method::Plane(PlaneSettings::PRESET),
            },
        }
    }
}
