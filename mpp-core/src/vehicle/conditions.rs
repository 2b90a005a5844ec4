//! The estimated conditions of a plan: the wind and the lift of the aircraft.

use super::{Airframe, Wind};

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
