//! The estimated conditions of a plan: the wind and the lift of the aircraft.

use super::{LiftEstimator, WindEstimator};
use crate::settings::Settings;
use crate::vehicle::{AirState, Airframe, Control, Wind};

/// Estimated wind, and estimated difference of the aircraft from the known airframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Velocity of the air over ground.
    pub wind: Wind,
    /// Amount by which the lift coefficient exceeds that of the known airframe [-].
    pub lift: f64,
}

impl Conditions {
    /// Still air and the known airframe.
    pub const STILL: Self = Self {
        wind: Wind::STILL,
        lift: 0.0,
    };

    /// The known airframe with the estimated lift.
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
    /// Estimator of the lift. Without it the lift is that of the known airframe.
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

    /// The present estimate.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        Conditions {
            wind: self.wind.wind(),
            lift: self.lift.as_ref().map_or(0.0, LiftEstimator::offset),
        }
    }

    /// Takes in a position `(x, z)` \[m\] at a time \[s\], the motion through the air at that time, and the
    /// controls that the actuators gave until then. Returns false if the position implies more wind than the
    /// estimator believes.
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
