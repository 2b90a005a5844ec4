//! Bias of the pitch, seen as a vertical wind that never changes and as a push along the way at once.
//!
//! The filter believes its pitch sensor. A sensor that reads too much by `b` tilts the estimated motion through the air
//! by `b`. The estimate of the wind then takes `-V b` for a downdraught, and the estimated airspeed stays behind the
//! measured one, because the weight seems to pull by `g b` more. A downdraught alone does not push, and a gust that pushes
//! does not tilt by as much. So a tilt that both show alike, and that is beyond its fluctuations, is a bias.

use crate::tuning::pitch_bias::{AGREE, LEAST, MEMORY, SEEN, SETTLED, STEADY, STILL};

/// Watches the estimates of vertical wind and airspeed for a bias of the pitch.
#[derive(Clone, Copy, Debug)]
pub struct PitchBias {
    /// Time since the first estimates \[s\].
    time: f64,
    /// Time over which the tilt was seen \[s\].
    seen: f64,
    /// Mean of the tilt by the wind \[rad\], and its variance [rad^2].
    mean: f64,
    variance: f64,
    /// Mean of the tilt by the airspeed \[rad\].
    by_airspeed: f64,
    /// Greatest variance of the tilt by the wind so far, slowly forgotten [rad^2].
    lively: f64,
    found: bool,
}

impl PitchBias {
    /// A watch without observations.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            time: 0.0,
            seen: 0.0,
            mean: 0.0,
            variance: 0.0,
            by_airspeed: 0.0,
            lively: STILL * STILL,
            found: false,
        }
    }

    /// Takes in the tilt by the wind and that by the airspeed \[rad\] after a further `period` \[s\].
    pub fn update(&mut self, by_wind: f64, by_airspeed: f64, period: f64) {
        if !(by_wind.is_finite() && by_airspeed.is_finite() && period > 0.0) {
            return;
        }
        self.time += period;
        if self.time < SETTLED {
            return;
        }
        self.seen = (self.seen + period).min(MEMORY);
        let share = (period / self.seen).min(1.0);
        let off = by_wind - self.mean;
        self.mean += share * off;
        self.variance += share * (off * off * (1.0 - share) - self.variance);
        self.by_airspeed += share * (by_airspeed - self.by_airspeed);
        let forgotten = period * (2.0 / (10.0 * MEMORY));
        self.lively = self.variance.max(self.lively * (1.0 - forgotten));
        self.found = if self.found {
            // A bias that was found stays found until its mean is small.
            libm::fabs(self.mean) > 0.5 * LEAST
        } else {
            self.seen >= SEEN && self.both_show()
        };
    }

    /// Takes this for the bias \[rad\], because something else has shown it.
    pub fn set_found(&mut self, angle: f64) {
        (self.mean, self.by_airspeed, self.found) = (angle, angle, true);
    }

    /// Whether wind and airspeed show the same tilt, beyond the fluctuations of the wind.
    fn both_show(&self) -> bool {
        let [by_wind, by_airspeed] = [self.mean, self.by_airspeed].map(libm::fabs);
        let (less, more) = (by_wind.min(by_airspeed), by_wind.max(by_airspeed));
        let alike = self.mean * self.by_airspeed > 0.0 && less > AGREE * more;
        alike && less > LEAST && by_wind * by_wind > STEADY * STEADY * self.lively
    }

    /// Whether the pitch is biased.
    #[must_use]
    pub fn found(&self) -> bool {
        self.found
    }

    /// Amount by which the pitch reads too much \[rad\]; 0 if there is no bias.
    #[must_use]
    pub fn angle(&self) -> f64 {
        if self.found { self.mean } else { 0.0 }
    }
}
