//! What a plan reckons with besides where it starts.

use super::{LiftEstimator, WindEstimator};
use crate::settings::Settings;
use crate::vehicle::{AirState, Airframe, Control, Wind};

/// The air, and the aircraft as it flies today.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Motion of the air.
    pub wind: Wind,
    /// Lift coefficient beyond the known airframe's [-].
    pub lift: f64,
}

impl Conditions {
    /// Still air, and the airframe as known.
    pub const STILL: Self = Self {
        wind: Wind::STILL,
        lift: 0.0,
    };

    /// The airframe with its lift as estimated.
    #[must_use]
    pub fn airframe(&self, known: &Airframe) -> Airframe {
        Airframe {
            lift_zero: known.lift_zero + self.lift,
            ..*known
        }
    }
}

/// Estimates [`Conditions`] from positions, if the settings ask for it.
#[derive(Clone, Debug)]
pub struct ConditionsEstimator {
    wind: WindEstimator,
    /// None takes the airframe to be as known.
    lift: Option<LiftEstimator>,
}

impl ConditionsEstimator {
    /// An estimator that starts from [`Conditions::STILL`].
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let lift = LiftEstimator::new(&settings.airframe);
        Self {
            wind: WindEstimator::new(settings.wind),
            lift: settings.wind.is_some().then_some(lift),
        }
    }

    /// The conditions now.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        Conditions {
            wind: self.wind.wind(),
            lift: self.lift.as_ref().map_or(0.0, LiftEstimator::offset),
        }
    }

    /// Takes in a position `(x, z)` [m] at a time [s], the motion through the air then, and what the
    /// actuators gave until then. False when it stands for more wind than is believed.
    pub fn update(
        &mut self,
        time: f64,
        position: (f64, f64),
        air: &AirState,
        given: Control,
    ) -> bool {
        if let Some(lift) = &mut self.lift {
            lift.update(time, position.1, air, given);
        }
        self.wind.update(time, position, air)
    }
}
