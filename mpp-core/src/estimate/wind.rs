//! Estimate of the wind from the position over ground and the motion through the air.

use crate::tuning::wind::{LONGEST_GAP, MOST};
use crate::vehicle::{AirState, Wind};

/// Estimator of the wind: the low-passed difference between the velocity over ground and the estimated
/// velocity through the air. An error of the estimated velocity also counts as wind. Plans move with the
/// sum of wind and velocity through the air, and this sum is then right.
#[derive(Clone, Debug)]
pub struct WindEstimator {
    /// Time constant of the low-pass filter \[s\]. Without it the estimator assumes still air.
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

    /// The present estimate of the wind.
    #[must_use]
    pub fn wind(&self) -> Wind {
        self.wind
    }

    /// Takes in a position `(x, z)` \[m\] at a time \[s\], and the motion through the air at that time.
    /// Returns false if this and the last position imply more wind than the estimator believes. The estimate
    /// then stays as it was.
    pub fn update(&mut self, time: f64, position: (f64, f64), air: &AirState) -> bool {
        let (Some(time_constant), Some((before, from))) = (self.time_constant, self.last) else {
            self.last = Some((time, position));
            return true;
        };
        let period = time - before;
        self.last = Some((time, position));
        // A clock that has jumped tells no velocity. Not a number is in no range.
        if !(f64::MIN_POSITIVE..=LONGEST_GAP).contains(&period) {
            return true;
        }
        let share = period / (time_constant + period);
        let (x, z) = Wind::STILL.ground_velocity(air);
        let seen = Wind {
            x: (position.0 - from.0) / period - x,
            z: (position.1 - from.1) / period - z,
        };
        // The range test also refuses NaN.
        let believed = (-MOST..=MOST).contains(&seen.x) && (-MOST..=MOST).contains(&seen.z);
        if believed {
            self.wind.x += share * (seen.x - self.wind.x);
            self.wind.z += share * (seen.z - self.wind.z);
        }
        believed
    }
}
