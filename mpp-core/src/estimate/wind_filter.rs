//! Kalman filter on position and wind, for one assumption on how much the wind changes.
//!
//! The model of an axis: `p' = a + w` and `w' = noise`, with the position `p`, the estimated velocity
//! through the air `a` as the known input, and the wind `w`. An error of the estimated velocity also counts
//! as wind. Plans move with the sum of wind and velocity through the air, and this sum is then right. Both
//! axes have the same errors, so one covariance serves both. Source: Bar-Shalom, Li and Kirubarajan,
//! "Estimation with Applications to Tracking and Navigation", 6.2 (white noise acceleration).

use crate::tuning::navigation::{FIRST_WIND, GATE, MOST_WIND};
use crate::vehicle::Wind;

/// Covariance of position and wind of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Covariance {
    /// Variance of the position [m^2].
    position: f64,
    /// Covariance of position and wind [m^2/s].
    both: f64,
    /// Variance of the wind [(m/s)^2].
    wind: f64,
}

/// A fix on each axis: the measured scalar `h0 p + h1 w`, with an error.
#[derive(Clone, Copy, Debug)]
pub struct Observation {
    /// `h0` [-] and `h1` \[s\]; for a velocity `h0` is 0 and `h1` is 1 [-].
    h: [f64; 2],
    /// The value of each axis, `(x, z)`.
    value: (f64, f64),
    /// Variance of the error that the source declares.
    variance: f64,
    /// Variance that a change of the wind by 1 m/s in a second since the measurement adds.
    drift: f64,
}

impl Observation {
    /// A position that the way through the air has brought up to now, `(x, z)` \[m\], measured `delay` \[s\] ago with the
    /// standard deviation `sigma` \[m\].
    #[must_use]
    pub fn position(now: (f64, f64), delay: f64, sigma: f64) -> Self {
        Self {
            h: [1.0, -delay],
            value: now,
            variance: sigma * sigma,
            drift: delay * delay * delay / 3.0,
        }
    }

    /// A wind `(x, z)` [m/s] as it was `delay` \[s\] ago, measured with the standard deviation `sigma` [m/s].
    #[must_use]
    pub fn wind(then: (f64, f64), delay: f64, sigma: f64) -> Self {
        Self {
            h: [0.0, 1.0],
            value: then,
            variance: sigma * sigma,
            drift: delay,
        }
    }
}

/// The filter of both axes.
#[derive(Clone, Copy, Debug)]
pub struct WindFilter {
    /// Position `(x, z)` \[m\].
    position: (f64, f64),
    wind: Wind,
    covariance: Covariance,
}

impl WindFilter {
    /// A filter that starts at downrange 0 and an altitude \[m\] in still air.
    #[inline(always)]
    #[must_use]
    pub const fn new(altitude: f64) -> Self {
        Self {
            position: (0.0, altitude),
            wind: Wind::STILL,
            covariance: Covariance {
                position: 0.0,
                both: 0.0,
                wind: FIRST_WIND * FIRST_WIND,
            },
        }
    }

    /// The estimated position `(x, z)` \[m\].
    #[must_use]
    pub fn position(&self) -> (f64, f64) {
        self.position
    }

    /// The estimated wind.
    #[must_use]
    pub fn wind(&self) -> Wind {
        self.wind
    }

    /// Variance of the wind along each axis [(m/s)^2].
    #[must_use]
    pub fn wind_variance(&self) -> f64 {
        self.covariance.wind
    }

    /// Replaces the position `(x, z)` \[m\].
    pub fn set_position(&mut self, position: (f64, f64)) {
        self.position = position;
    }

    /// Replaces the wind.
    pub fn set_wind(&mut self, wind: Wind) {
        self.wind = wind;
    }

    /// Doubts the position by this distance \[m\].
    pub fn doubt(&mut self, distance: f64) {
        self.covariance.position += distance * distance;
    }

    /// Moves the estimate on by a period \[s\] with its way through the air `(x, z)` \[m\]. `noise` is the variance of the
    /// change of the wind in one second [(m/s)^2].
    pub fn predict(&mut self, way: (f64, f64), period: f64, noise: f64) {
        self.position.0 += way.0 + self.wind.x * period;
        self.position.1 += way.1 + self.wind.z * period;
        let c = &mut self.covariance;
        let square = period * period;
        c.position += 2.0 * period * c.both + square * c.wind + noise * square * period / 3.0;
        c.both += period * c.wind + 0.5 * noise * square;
        c.wind += noise * period;
    }

    /// Starts from a position.
    pub fn start(&mut self, observed: &Observation, noise: f64) {
        let (now, delay) = (observed.value, -observed.h[1]);
        self.position = (now.0 + self.wind.x * delay, now.1 + self.wind.z * delay);
        let wind = FIRST_WIND * FIRST_WIND;
        self.covariance = Covariance {
            position: observed.variance + noise * observed.drift + delay * delay * wind,
            both: delay * wind,
            wind,
        };
    }

    /// Corrects both axes. Returns false, and corrects nothing, if the innovation of an axis is beyond the gate.
    #[must_use]
    pub fn correct(&mut self, observed: &Observation, noise: f64) -> bool {
        let [h0, h1] = observed.h;
        let off = (
            observed.value.0 - h0 * self.position.0 - h1 * self.wind.x,
            observed.value.1 - h0 * self.position.1 - h1 * self.wind.z,
        );
        let c = &mut self.covariance;
        let position = c.position * h0 + c.both * h1;
        let wind = c.both * h0 + c.wind * h1;
        let variance = h0 * position + h1 * wind + observed.variance + noise * observed.drift;
        let most = GATE * GATE * variance;
        let (x, z) = (off.0 * off.0, off.1 * off.1);
        // The tests are false for values that are not numbers.
        if !(x <= most && z <= most && variance > 0.0) {
            return false;
        }
        let gain = (position / variance, wind / variance);
        self.position.0 += gain.0 * off.0;
        self.position.1 += gain.0 * off.1;
        self.wind.x = (self.wind.x + gain.1 * off.0).clamp(-MOST_WIND, MOST_WIND);
        self.wind.z = (self.wind.z + gain.1 * off.1).clamp(-MOST_WIND, MOST_WIND);
        c.position -= gain.0 * position;
        c.both -= gain.0 * wind;
        c.wind -= gain.1 * wind;
        true
    }
}
