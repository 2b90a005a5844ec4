//! Turbulence with Dryden's spectra in the low-altitude form of MIL-F-8785C (section 3.7.3.4),
//! which MIL-STD-1797 keeps. Longitudinal and vertical gusts are independent of each other.
//!
//! ```text
//! longitudinal  H_u(s) = sigma_u sqrt(2 L_u / (pi V)) / (1 + s L_u / V)
//! vertical      H_w(s) = sigma_w sqrt(L_w / (pi V)) (1 + sqrt(3) s L_w / V) / (1 + s L_w / V)^2
//! L_w = h,  L_u = h / (0.177 + 0.000823 h)^1.2,  sigma_u = sigma_w / (0.177 + 0.000823 h)^0.4,  h in ft
//! ```
//!
//! The filters are discretised exactly for samples at 100 Hz. From the first sample on, the values
//! have the covariances of the continuous process at any lag. The filters' axes follow the wind,
//! which is taken as level: longitudinal is downrange, vertical is up.

use crate::random::{self, Draws, Stream};
use serde::{Deserialize, Serialize};

/// The height at which the spectra are evaluated \[m\]. It is the height of the flights.
pub const HEIGHT: f64 = 50.0;
/// The airspeed at which the aircraft passes through the frozen gusts [m/s].
pub(crate) const AIRSPEED: f64 = 12.0;
const METRES_PER_FOOT: f64 = 0.3048;

/// The strength of the turbulence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GustConfig {
    /// Standard deviation of the vertical gusts [m/s]; 0 means still air. The longitudinal gusts
    /// are [`longitudinal_ratio`] times as strong.
    pub intensity: f64,
}

/// `0.177 + 0.000823 h` with the height in feet.
fn height_factor() -> f64 {
    0.177 + 0.000_823 * (HEIGHT / METRES_PER_FOOT)
}

/// `sigma_u / sigma_w` at the height of the flights [-]: 1.59.
#[must_use]
pub fn longitudinal_ratio() -> f64 {
    1.0 / libm::pow(height_factor(), 0.4)
}

/// `L_u` at the height of the flights \[m\].
pub(crate) fn longitudinal_length() -> f64 {
    HEIGHT / libm::pow(height_factor(), 1.2)
}

/// The gusts of one flight.
#[derive(Clone, Debug)]
pub struct Gusts {
    sigma: (f64, f64),
    longitudinal: Lag,
    vertical: DoubleLag,
    generator: Draws,
}

impl Gusts {
    /// The gusts of the flight with this seed, sampled every `dt` \[s\]; `None` in still air.
    #[must_use]
    pub fn new(seed: u64, config: GustConfig, dt: f64) -> Option<Self> {
        if config.intensity <= 0.0 {
            return None;
        }
        let mut generator = random::generator(seed, Stream::Gusts);
        let length_w = HEIGHT;
        Some(Self {
            sigma: (config.intensity * longitudinal_ratio(), config.intensity),
            longitudinal: Lag::new(longitudinal_length() / AIRSPEED, dt, &mut generator),
            vertical: DoubleLag::new(length_w / AIRSPEED, dt, &mut generator),
            generator,
        })
    }

    /// Motion of the air now, downrange and up [m/s].
    #[must_use]
    pub fn wind(&self) -> (f64, f64) {
        let (u, w) = (self.longitudinal.value, self.vertical.value());
        (self.sigma.0 * u, self.sigma.1 * w)
    }

    /// Advances by one sample.
    pub fn advance(&mut self) {
        self.longitudinal.advance(&mut self.generator);
        self.vertical.advance(&mut self.generator);
    }
}

/// White noise through `1 / (1 + s tau)`, with unit variance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lag {
    pub(crate) value: f64,
    decay: f64,
}

impl Lag {
    pub(crate) fn new(tau: f64, dt: f64, generator: &mut Draws) -> Self {
        Self {
            value: random::gaussian(generator),
            decay: libm::exp(-dt / tau),
        }
    }

    pub(crate) fn advance(&mut self, generator: &mut Draws) {
        let kick = (1.0 - self.decay * self.decay).sqrt();
        self.value = self.decay * self.value + kick * random::gaussian(generator);
    }
}

/// White noise through `(1 + sqrt(3) s tau) / (1 + s tau)^2`, with unit variance.
///
/// Partial fractions give `sqrt(3) / (1 + s tau) + (1 - sqrt(3)) / (1 + s tau)^2`: two lags in a
/// row. If the first lag has unit variance, the stationary covariance of both is
/// `P = [[1, 1/2], [1/2, 1/2]]`, and the variance of the sum is 2. The noise of a sample has the
/// covariance `P - F P F'`, where `F = exp(-dt/tau) [[1, 0], [dt/tau, 1]]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleLag {
    first: f64,
    second: f64,
    decay: f64,
    ratio: f64,
}

impl DoubleLag {
    pub(crate) fn new(tau: f64, dt: f64, generator: &mut Draws) -> Self {
        let (first, other) = (random::gaussian(generator), random::gaussian(generator));
        Self {
            first,
            second: 0.5 * first + 0.5 * other,
            decay: libm::exp(-dt / tau),
            ratio: dt / tau,
        }
    }

    pub(crate) fn value(&self) -> f64 {
        let root = 3_f64.sqrt();
        (root * self.first + (1.0 - root) * self.second) / 2_f64.sqrt()
    }

    pub(crate) fn advance(&mut self, generator: &mut Draws) {
        let Self { decay, ratio, .. } = *self;
        let squared = decay * decay;
        // P - F P F' and its Cholesky factor.
        let q11 = 1.0 - squared;
        let q12 = 0.5 - squared * (0.5 + ratio);
        let q22 = 0.5 - squared * (0.5 + ratio + ratio * ratio);
        let l11 = q11.sqrt();
        let l21 = q12 / l11;
        let l22 = (q22 - l21 * l21).max(0.0).sqrt();
        let (a, b) = (random::gaussian(generator), random::gaussian(generator));
        let (first, second) = (self.first, self.second);
        self.first = decay * first + l11 * a;
        self.second = decay * (second + ratio * first) + l21 * a + l22 * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 0.01;

    /// Both components of many flights, from their first sample on.
    fn record(samples: usize) -> Vec<Vec<(f64, f64)>> {
        let config = GustConfig { intensity: 1.0 };
        (0..2000)
            .map(|seed| {
                let mut gusts = Gusts::new(seed, config, DT).unwrap();
                (0..samples)
                    .map(|_| {
                        let wind = gusts.wind();
                        gusts.advance();
                        wind
                    })
                    .collect()
            })
            .collect()
    }

    fn covariance(
        flights: &[Vec<(f64, f64)>],
        (from, to): (usize, usize),
        pick: fn(&(f64, f64)) -> f64,
    ) -> f64 {
        let products = flights
            .iter()
            .map(|flight| pick(&flight[from]) * pick(&flight[to]));
        products.sum::<f64>() / flights.len() as f64
    }

    /// Checks the autocovariances of Dryden's spectra: `exp(-t)` and `exp(-t) (1 - t/2)`, with `t`
    /// in time constants.
    #[test]
    fn gusts_have_drydens_strength_and_memory() {
        let flights = record(501);
        let ratio = longitudinal_ratio();
        assert!((ratio - 1.594).abs() < 1e-3, "{ratio}");
        let (tau_u, tau_w) = (202.3 / AIRSPEED, 50.0 / AIRSPEED);
        for lag in [0, 100, 250, 500] {
            let t = lag as f64 * DT;
            let u = covariance(&flights, (0, lag), |wind| wind.0);
            let w = covariance(&flights, (0, lag), |wind| wind.1);
            // The tolerance is at most four standard errors of 2,000 flights.
            let tolerance = 4.0 * (2.0_f64 / 2000.0).sqrt();
            let expected_u = ratio * ratio * libm::exp(-t / tau_u);
            assert!(
                (u - expected_u).abs() < ratio * ratio * tolerance,
                "{u} {expected_u}"
            );
            let expected_w = libm::exp(-t / tau_w) * (1.0 - 0.5 * t / tau_w);
            assert!((w - expected_w).abs() < tolerance, "{w} {expected_w}");
        }
        for at in [0, 500] {
            let variance = covariance(&flights, (at, at), |wind| wind.1);
            assert!((variance - 1.0).abs() < 0.13, "{variance}");
        }
    }

    /// Checks a single step, because a wrong noise covariance shows there first.
    #[test]
    fn a_step_changes_the_wind_as_much_as_drydens_spectrum_says() {
        let flights = record(2);
        let difference = |pick: fn(&(f64, f64)) -> f64| {
            let squares = flights.iter().map(|flight| {
                let change = pick(&flight[1]) - pick(&flight[0]);
                change * change
            });
            squares.sum::<f64>() / flights.len() as f64
        };
        let t = DT * AIRSPEED / 50.0;
        let expected = 2.0 * (1.0 - libm::exp(-t) * (1.0 - 0.5 * t));
        let found = difference(|wind| wind.1);
        assert!((found / expected - 1.0).abs() < 0.13, "{found} {expected}");
    }

    #[test]
    fn still_air_has_no_gusts_and_a_seed_has_its_own() {
        assert!(Gusts::new(1, GustConfig::default(), DT).is_none());
        let wind = |seed, intensity| {
            Gusts::new(seed, GustConfig { intensity }, DT)
                .unwrap()
                .wind()
        };
        assert_eq!(wind(1, 1.0), wind(1, 1.0));
        assert_ne!(wind(1, 1.0), wind(2, 1.0));
        assert!((wind(1, 2.0).1 - 2.0 * wind(1, 1.0).1).abs() < 1e-12);
    }
}
