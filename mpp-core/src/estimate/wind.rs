//! The wind, from the position over ground and the motion through the air.

use crate::vehicle::{AirState, Wind};

/// Greatest wind along an axis that is believed [m/s]: beyond it the position is wrong.
const MOST: f64 = 10.0;
/// Longest time between two positions that are compared [s]: the motion through the air is taken to
/// stay over it.
pub(super) const LONGEST: f64 = 0.05;

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

    /// Takes in a position `(x, z)` [m] at a time [s], and the motion through the air then. False when
    /// it stands against the last one for more wind than is believed, which leaves the estimate as it
    /// was.
    pub fn update(&mut self, time: f64, position: (f64, f64), air: &AirState) -> bool {
        let (Some(time_constant), Some((before, from))) = (self.time_constant, self.last) else {
            self.last = Some((time, position));
            return true;
        };
        let period = time - before;
        if period <= 0.0 {
            return true;
        }
        self.last = Some((time, position));
        if period > LONGEST {
            return true;
        }
        let share = period / (time_constant + period);
        let (x, z) = Wind::STILL.ground_velocity(air);
        let seen = Wind {
            x: (position.0 - from.0) / period - x,
            z: (position.1 - from.1) / period - z,
        };
        // Not a number is in no range.
        let believed = (-MOST..=MOST).contains(&seen.x) && (-MOST..=MOST).contains(&seen.z);
        if believed {
            self.wind.x += share * (seen.x - self.wind.x);
            self.wind.z += share * (seen.z - self.wind.z);
        }
        believed
    }
}
