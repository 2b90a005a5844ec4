//! The wind, from the position over ground and the motion through the air.

use crate::vehicle::{AirState, Wind};

/// Low-passed difference between the velocity over ground and the estimated velocity through the
/// air. An error of the estimate counts as wind too, so that the sum of the two, by which plans
/// move, is right.
#[derive(Clone, Debug)]
pub struct WindEstimator {
    /// [s]; none: the air is taken to stand still.
    time_constant: Option<f64>,
    wind: Wind,
    last: Option<(f64, (f64, f64))>,
}

impl WindEstimator {
    /// An estimator that starts from still air.
    #[must_use]
    pub const fn new(time_constant: Option<f64>) -> Self {
        Self {
            time_constant,
            wind: Wind::STILL,
            last: None,
        }
    }

    /// The wind now.
    #[must_use]
    pub fn wind(&self) -> Wind {
        self.wind
    }

    /// Takes in a finite position `(x, z)` [m] at a time [s], and the motion through the air since
    /// the last one.
    pub fn update(&mut self, time: f64, position: (f64, f64), air: &AirState) {
        let last = self.last.replace((time, position));
        let (Some(time_constant), Some((before, from))) = (self.time_constant, last) else {
            return;
        };
        let period = time - before;
        if period <= 0.0 {
            return;
        }
        let share = period / (time_constant + period);
        let (x, z) = Wind::STILL.carry(air);
        let seen = Wind {
            x: (position.0 - from.0) / period - x,
            z: (position.1 - from.1) / period - z,
        };
        let wind = Wind {
            x: self.wind.x + share * (seen.x - self.wind.x),
            z: self.wind.z + share * (seen.z - self.wind.z),
        };
        if wind.x.is_finite() && wind.z.is_finite() {
            self.wind = wind;
        }
    }
}
