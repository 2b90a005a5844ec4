//! Bias of the pitch, seen as a vertical wind that never changes.
//!
//! The filter believes its pitch sensor. A sensor that reads too much by `b` therefore tilts the estimated
//! motion through the air by `b`, and the estimate of the wind takes `-V b` for a downdraught. Gusts change
//! within seconds, a bias does not. So a mean vertical wind that is far beyond its fluctuations is a bias.
//!
//! Speeds are in the planner's [unit](crate::units::Units), so that one angle counts the same at every speed. For
//! the reference aircraft they are in m/s.

use crate::tuning::bias::{LEAST_WIND, MEMORY, SEEN, STEADY, STILL_WIND};

/// Watches the estimated vertical wind for a bias of the pitch.
#[derive(Clone, Copy, Debug)]
pub struct PitchBias {
    /// Time over which the wind was seen \[s\].
    seen: f64,
    /// Mean of the vertical wind [m/s], and its variance [(m/s)^2].
    mean: f64,
    variance: f64,
    /// Greatest standard deviation of the vertical wind so far, slowly forgotten [m/s].
    lively: f64,
    found: bool,
}

impl PitchBias {
    /// A watch that has seen no wind.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            seen: 0.0,
            mean: 0.0,
            variance: 0.0,
            lively: STILL_WIND,
            found: false,
        }
    }

    /// Takes in the estimated vertical wind [m/s] after a further `period` \[s\].
    pub fn update(&mut self, wind: f64, period: f64) {
        if !(wind.is_finite() && period > 0.0) {
            return;
        }
        self.seen = (self.seen + period).min(MEMORY);
        let share = (period / self.seen).min(1.0);
        let off = wind - self.mean;
        self.mean += share * off;
        self.variance += share * (off * off * (1.0 - share) - self.variance);
        let now = libm::sqrt(self.variance.max(0.0));
        self.lively = now.max(self.lively * (1.0 - period / (10.0 * MEMORY)));
        let size = libm::fabs(self.mean);
        // A bias that was found stays found until its mean is small.
        let least = if self.found {
            0.5 * LEAST_WIND
        } else {
            LEAST_WIND
        };
        self.found = self.seen >= SEEN && size > least && size > STEADY * self.lively;
    }

    /// Whether the pitch is biased.
    #[must_use]
    pub fn found(&self) -> bool {
        self.found
    }

    /// Amount by which the pitch reads too much at an airspeed [m/s] \[rad\]; 0 if there is no bias.
    #[must_use]
    pub fn angle(&self, airspeed: f64) -> f64 {
        if self.found && airspeed > 1.0 {
            -self.mean / airspeed
        } else {
            0.0
        }
    }
}

impl Default for PitchBias {
    fn default() -> Self {
        Self::new()
    }
}
