//! Everything that can be chosen before a flight, and the named presets.

use crate::Rules;
use crate::control::LqrWeights;
use crate::corridor::Padding;
use crate::estimate::EkfTuning;
use crate::qp::{Initial, Penalty, SteadyState, Weights};
use crate::vehicle::{ActuatorLimits, Airframe, JacobianForm, Trim, TrimError};

/// Limits of the attitude rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeLimits {
    /// Of the angle of attack, either side of trim [rad]: lift, and so how tightly a path may bend.
    pub angle_of_attack: f64,
    /// Of the flight path angle, absolute [rad].
    pub flight_path: f64,
}

/// What rounds of linearisation go by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Rounds that the best candidates get.
    pub rounds: u8,
    /// How many candidates get more than the first.
    pub deepened: usize,
    /// Distance to keep from the centres of occupied cells [m].
    pub margin: f64,
    /// Greatest distance from the altitude [m].
    pub band: f64,
    /// Greatest thrust of a plan [N].
    pub thrust_max: f64,
}

/// What the planner plans by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannerSettings {
    /// Rules of map, path search and raytracing.
    pub rules: Rules,
    /// Jacobian of the plan's model.
    pub jacobian: JacobianForm,
    /// Steady state of the plan's rotation.
    pub steady_state: SteadyState,
    /// First state of the plan.
    pub initial: Initial,
    /// Weights of the cost.
    pub weights: Weights,
    /// Price of corridor and attitude rows; none makes them hard.
    pub penalty: Option<Penalty>,
    /// Attitude rows, if any.
    pub attitude: Option<AttitudeLimits>,
    /// Distance from obstacles.
    pub padding: Padding,
    /// Rounds of linearisation in a map with memory; none plans as the paper does. Needs attitude
    /// rows and a penalty.
    pub iteration: Option<Iteration>,
    /// Candidate paths of a cycle (with an iteration: at most that many), at most [`crate::config::MAX_PATHS`]; 0 tracks the shortest path
    /// itself, without refinement (the paper's baseline "RRT*").
    pub paths: usize,
    /// Height to return to [m].
    pub altitude: f64,
    /// How far the lidar sees [m]; for the map with memory.
    pub sight: f64,
    /// Seed of the path search.
    pub seed: u64,
}

/// The level flight that plans deviate from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cruise {
    /// Steady flight at an airspeed [m/s]; the paper cruises at 12.
    Airspeed(f64),
    /// The authors' point, which is not quite steady.
    Authors,
}

impl Cruise {
    /// The trim.
    ///
    /// # Errors
    /// [`TrimError`] when no steady flight is found at the airspeed.
    pub fn trim(&self, airframe: &Airframe) -> Result<Trim, TrimError> {
        match *self {
            Self::Airspeed(airspeed) => Trim::at_speed(airframe, airspeed, 0.0),
            Self::Authors => Ok(Trim::of_authors(airframe)),
        }
    }
}

/// The whole flight core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The aircraft as the core knows it.
    pub airframe: Airframe,
    /// What its motor and elevator can do, as far as the core knows.
    pub actuators: ActuatorLimits,
    /// Straight and level flight, about which everything is linearised.
    pub cruise: Cruise,
    /// Thrust about which the regulator is designed [N]; none takes that of the trim.
    pub design_thrust: Option<f64>,
    /// Jacobian of the regulator's design.
    pub design_jacobian: JacobianForm,
    /// The estimator's tuning.
    pub estimator: EkfTuning,
    /// Time constant of the wind's estimate [s]; none takes the air to stand still and the airframe to be
    /// as known, as the paper does.
    pub wind: Option<f64>,
    /// The regulator's weights.
    pub regulator: LqrWeights,
    /// Flight path angle by which the regulator's reference turns back per metre off the trajectory
    /// [rad/m]; 0 regulates the motion alone, as the paper does.
    pub cross_track: f64,
    /// Thrust per lack of airspeed against the trajectory [N s/m]; 0 flies its thrust as planned, as the
    /// paper does.
    pub airspeed_hold: f64,
    /// The planner.
    pub planner: PlannerSettings,
}

impl Settings {
    /// The authors' code: parameters, rules and faults, to compare with it.
    #[must_use]
    pub const fn reference() -> Self {
        Self {
            airframe: Airframe::REFERENCE,
            actuators: ActuatorLimits::NONE,
            cruise: Cruise::Authors,
            // Sic: the authors trim at 4.3 N and linearise with 4.0 N.
            design_thrust: Some(4.0),
            design_jacobian: JacobianForm::Authors,
            estimator: EkfTuning::AUTHORS,
            wind: None,
            regulator: LqrWeights::PAPER,
            cross_track: 0.0,
            airspeed_hold: 0.0,
            planner: PlannerSettings {
                rules: Rules::Authors,
                jacobian: JacobianForm::Authors,
                steady_state: SteadyState::ZeroPitchRate,
                initial: Initial::ThroughSteadyState,
                weights: Weights::PAPER,
                penalty: None,
                attitude: None,
                padding: Padding::AUTHORS,
                iteration: None,
                paths: 25,
                altitude: 50.0,
                sight: 45.0,
                seed: 0,
            },
        }
    }

    /// The paper's text, its slips corrected.
    #[must_use]
    pub const fn paper() -> Self {
        let reference = Self::reference();
        Self {
            cruise: Cruise::Airspeed(12.0),
            design_thrust: None,
            design_jacobian: JacobianForm::Exact,
            estimator: EkfTuning::EXACT,
            planner: PlannerSettings {
                rules: Rules::Corrected,
                jacobian: JacobianForm::Exact,
                initial: Initial::Estimate,
                ..reference.planner
            },
            ..reference
        }
    }

    /// The best we know: a map with memory, distinct candidates, soft rows, rounds of linearisation
    /// about the trajectory itself, and a reference that the aircraft can fly.
    #[must_use]
    pub const fn flight() -> Self {
        let paper = Self::paper();
        Self {
            estimator: EkfTuning::SENSORS,
            wind: Some(0.02),
            cross_track: 0.08,
            airspeed_hold: 10.0,
            planner: PlannerSettings {
                steady_state: SteadyState::MomentBalance,
                weights: Weights {
                    control: [1.0, 0.05],
                    terminal: 1.0,
                },
                penalty: Some(Penalty {
                    linear: 1e3,
                    quadratic: 1e3,
                }),
                attitude: Some(AttitudeLimits {
                    angle_of_attack: 0.2,
                    flight_path: 0.6,
                }),
                iteration: Some(Iteration {
                    rounds: 3,
                    deepened: 2,
                    margin: 0.8,
                    band: 10.3,
                    thrust_max: 20.0,
                }),
                ..paper.planner
            },
            ..paper
        }
    }
}
