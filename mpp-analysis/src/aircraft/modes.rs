//! The longitudinal modes of an aircraft in level flight.

use mpp_core::settings::Aircraft;
use mpp_core::vehicle::{JacobianForm, Trim, linearize};
use nalgebra::Complex;
use serde::Serialize;
use std::fmt;

/// One mode: a pair of eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mode {
    /// Natural frequency [rad/s].
    pub frequency: f64,
    /// Damping ratio [-]; above 1 the mode does not oscillate, below 0 it grows.
    pub damping: f64,
}

/// The two modes of the linearised motion through the air.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Modes {
    /// The fast mode, of pitch and angle of attack.
    pub short_period: Mode,
    /// The slow mode, of airspeed and height.
    pub phugoid: Mode,
}

impl Mode {
    /// The mode of two eigenvalues with this product [1/s^2] and this sum [1/s].
    pub(super) fn of(product: f64, sum: f64) -> Self {
        let frequency = product.sqrt();
        Self {
            frequency,
            damping: -0.5 * sum / frequency,
        }
    }
}

impl Modes {
    /// The modes of an aircraft about a trim.
    #[must_use]
    pub fn of(aircraft: &Aircraft, trim: &Trim) -> Self {
        let form = JacobianForm::Exact;
        let linear = linearize(&aircraft.airframe, &trim.state, trim.control, form);
        let mut values: Vec<Complex<f64>> =
            linear.a.complex_eigenvalues().iter().copied().collect();
        values.sort_by(|a, b| b.norm_sqr().total_cmp(&a.norm_sqr()));
        let mode = |pair: &[Complex<f64>]| {
            let product: Complex<f64> = pair.iter().product();
            let sum: Complex<f64> = pair.iter().sum();
            Mode::of(product.norm_sqr().sqrt(), sum.re)
        };
        let (fast, slow) = values.split_at(2);
        Self {
            short_period: mode(fast),
            phugoid: mode(slow),
        }
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frequency, damping } = self;
        write!(f, "{frequency:.2} rad/s, damping ratio {damping:.2}")
    }
}
