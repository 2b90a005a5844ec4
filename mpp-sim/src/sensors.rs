//! Airspeed and pitch sensors: truth plus Gaussian noise.

use crate::random::{self, Draws, Stream};
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};

/// The values that the air data sensors report at one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Pitch \[rad\], nose-up positive.
    pub pitch: f64,
}

/// Standard deviations of the sensors' white Gaussian noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AirDataNoise {
    /// Airspeed [m/s].
    pub airspeed_sigma: f64,
    /// Pitch \[rad\].
    pub pitch_sigma: f64,
}

impl AirDataNoise {
    /// The noise in the authors' code: 0.5 m/s and 0.25 deg. The paper names no figures.
    pub const PAPER: Self = Self {
        airspeed_sigma: 0.5,
        pitch_sigma: 0.25_f64.to_radians(),
    };
    /// Perfect sensors.
    pub const NONE: Self = Self {
        airspeed_sigma: 0.0,
        pitch_sigma: 0.0,
    };
}

/// The air data sensors of one flight, each with its own stream of noise.
#[derive(Clone, Debug)]
pub struct AirDataSensors {
    noise: AirDataNoise,
    airspeed: Draws,
    pitch: Draws,
}

impl AirDataSensors {
    /// The sensors of the flight with this seed.
    #[must_use]
    pub fn new(seed: u64, noise: AirDataNoise) -> Self {
        Self {
            noise,
            airspeed: random::generator(seed, Stream::AirspeedSensor),
            pitch: random::generator(seed, Stream::PitchSensor),
        }
    }

    /// One measurement of the true state.
    pub fn measure(&mut self, state: &VehicleState) -> Measurement {
        let airspeed_noise = self.noise.airspeed_sigma * random::gaussian(&mut self.airspeed);
        let pitch_noise = self.noise.pitch_sigma * random::gaussian(&mut self.pitch);
        Measurement {
            airspeed: state.air.airspeed + airspeed_noise,
            pitch: state.air.pitch + pitch_noise,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_core::vehicle::AirState;

    const STATE: VehicleState = VehicleState {
        x: 3.0,
        z: 50.0,
        air: AirState {
            airspeed: 12.0,
            pitch: 0.15,
            pitch_rate: 0.1,
            flight_path: -0.05,
        },
    };

    fn errors(seed: u64, noise: AirDataNoise, count: usize) -> Vec<(f64, f64)> {
        let mut sensors = AirDataSensors::new(seed, noise);
        (0..count)
            .map(|_| {
                let measured = sensors.measure(&STATE);
                (
                    measured.airspeed - STATE.air.airspeed,
                    measured.pitch - STATE.air.pitch,
                )
            })
            .collect()
    }

    #[test]
    fn perfect_sensors_tell_the_truth() {
        assert_eq!(errors(1, AirDataNoise::NONE, 10), vec![(0.0, 0.0); 10]);
    }

    #[test]
    fn noise_has_the_stated_spread_and_no_bias() {
        const COUNT: usize = 50_000;
        let noise = AirDataNoise::PAPER;
        let errors = errors(2, noise, COUNT);
        let spread = |pick: fn(&(f64, f64)) -> f64, sigma: f64| {
            let mean = errors.iter().map(pick).sum::<f64>() / COUNT as f64;
            let square = errors.iter().map(|e| pick(e) * pick(e)).sum::<f64>() / COUNT as f64;
            assert!(mean.abs() < 0.02 * sigma, "{mean}");
            assert!((square.sqrt() / sigma - 1.0).abs() < 0.02, "{square}");
        };
        spread(|e| e.0, noise.airspeed_sigma);
        spread(|e| e.1, noise.pitch_sigma);
    }

    #[test]
    fn a_seed_is_a_noise() {
        let noise = AirDataNoise::PAPER;
        assert_eq!(errors(4, noise, 5), errors(4, noise, 5));
        assert_ne!(errors(4, noise, 5), errors(5, noise, 5));
    }

    #[test]
    fn one_sensor_does_not_move_the_other() {
        let quiet_pitch = AirDataNoise {
            pitch_sigma: 0.0,
            ..AirDataNoise::PAPER
        };
        let both = errors(6, AirDataNoise::PAPER, 5);
        for (a, b) in both.iter().zip(errors(6, quiet_pitch, 5)) {
            assert_eq!(a.0.to_bits(), b.0.to_bits());
        }
    }
}
