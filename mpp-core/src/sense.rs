//! The data of the sensors: the inputs of the flight loop and of the map.

use crate::config::MAX_BEAMS;

/// The measurements that arrived in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorFrame {
    /// New air data, if there are any.
    pub air: Option<AirData>,
    /// A new position, if there is one.
    pub position: Option<Position>,
}

/// Airspeed and pitch at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirData {
    /// Ticks since the measurement.
    pub age: u32,
    /// The measured values.
    pub measurement: Measurement,
}

/// Measured airspeed and pitch. Their errors are independent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Pitch \[rad\].
    pub pitch: f64,
}

/// A position from the navigation source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Ticks since the measurement.
    pub age: u32,
    /// Downrange position \[m\].
    pub x: f64,
    /// Height \[m\].
    pub z: f64,
    /// Declared standard deviation of the white error along an axis \[m\].
    pub sigma: f64,
    /// Velocity over ground at the same time, if the source measures it.
    pub velocity: Option<GroundVelocity>,
}

impl Position {
    /// Whether every value is finite and no declared error is negative.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let error = |sigma: f64| sigma.is_finite() && sigma >= 0.0;
        let velocity = self.velocity.is_none_or(|velocity| {
            velocity.x.is_finite() && velocity.z.is_finite() && error(velocity.sigma)
        });
        self.x.is_finite() && self.z.is_finite() && error(self.sigma) && velocity
    }
}

/// A measured velocity over ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundVelocity {
    /// Downrange component [m/s].
    pub x: f64,
    /// Upward component [m/s].
    pub z: f64,
    /// Declared standard deviation of the error along an axis [m/s].
    pub sigma: f64,
}

/// One sweep of the lidar in the vertical plane.
#[derive(Clone, Debug)]
pub struct LidarScan {
    /// Angle of the first beam against the body axis \[rad\], nose-up positive.
    pub angle_min: f64,
    /// Angle from one beam to the next \[rad\].
    pub angle_increment: f64,
    /// Range of each beam \[m\]; 0 for a beam without a return.
    pub ranges: heapless::Vec<f32, MAX_BEAMS>,
}

impl LidarScan {
    /// A scan without beams, to be filled.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            angle_min: 0.0,
            angle_increment: 0.0,
            ranges: heapless::Vec::new(),
        }
    }

    /// Angle of a beam against the body axis \[rad\], nose-up positive.
    #[must_use]
    pub fn beam_angle(&self, beam: usize) -> f64 {
        self.angle_min + self.angle_increment * beam as f64
    }

    /// Checks a scan against the declared lidar. It may have fewer beams than declared, because it bears its own angles.
    ///
    /// | range | meaning |
    /// |---|---|
    /// | 0, infinite, not a number, beyond the sight | nothing came back |
    /// | negative | the beam is bad: it neither marks nor clears cells |
    ///
    /// # Errors
    /// [`ScanError`]: the caller must not use the scan. The last map and plan stay in force.
    pub fn check(&self, beams: usize) -> Result<(), ScanError> {
        if !(1..=beams).contains(&self.ranges.len()) {
            return Err(ScanError::Length {
                expected: beams,
                found: self.ranges.len(),
            });
        }
        if !self.angle_min.is_finite() || !self.angle_increment.is_finite() {
            return Err(ScanError::AngleNotFinite);
        }
        let bad = |range: &f32| *range < 0.0;
        match self.ranges.iter().position(bad) {
            Some(beam) if 2 * self.bad_beams() > self.ranges.len() => {
                Err(ScanError::BadBeams { beam })
            }
            _ => Ok(()),
        }
    }

    /// Number of bad beams: those with a negative range.
    #[must_use]
    pub fn bad_beams(&self) -> usize {
        self.ranges.iter().filter(|range| **range < 0.0).count()
    }

    /// Whether these ranges of the next scan repeat those of this one to the last bit, returns among them: the lidar is frozen.
    #[must_use]
    pub fn is_repeated_by(&self, ranges: &[f32]) -> bool {
        let same = |(before, now): (&f32, &f32)| before.to_bits() == now.to_bits();
        self.ranges.len() == ranges.len()
            && ranges.iter().any(|range| *range > 0.0)
            && self.ranges.iter().zip(ranges).all(same)
    }
}

/// A scan that cannot be used. The vehicle flies on with the last plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScanError {
    /// The scan has no beam, or more beams than declared.
    #[error("the scan has {found} beams instead of {expected}: declare the lidar as it is")]
    Length {
        /// Declared number of beams, the greatest one.
        expected: usize,
        /// Number of beams in the scan.
        found: usize,
    },
    /// An angle is not a finite number.
    #[error("an angle of the scan is not a finite number: check the lidar")]
    AngleNotFinite,
    /// More than half of the beams are bad.
    #[error("more than half of the ranges are negative, as that of beam {beam}: check the lidar")]
    BadBeams {
        /// The first such beam.
        beam: usize,
    },
}
