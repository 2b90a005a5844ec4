//! What the sensors deliver: the inputs of the flight loop and of the map.

use crate::config::MAX_BEAMS;
use crate::estimate::Measurement;

/// One reading of the 100 Hz sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorFrame {
    /// Airspeed and pitch.
    pub measurement: Measurement,
    /// Downrange position from the navigation source [m].
    pub x: f64,
    /// Height from the navigation source [m].
    pub z: f64,
}

/// One sweep of the lidar in the vertical plane.
#[derive(Clone, Debug)]
pub struct LidarScan {
    /// Angle of the first beam against the body axis [rad], nose-up positive.
    pub angle_min: f64,
    /// Angle from a beam to the next [rad].
    pub angle_increment: f64,
    /// Range of each beam [m]; 0 where nothing came back.
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

    /// Checks a scan against the lidar that was declared: number of beams and sight [m].
    ///
    /// # Errors
    /// [`ScanError`]: the scan is not to be used, the last map and plan stay.
    pub fn check(&self, beams: usize, range_max: f64) -> Result<(), ScanError> {
        if self.ranges.len() != beams {
            return Err(ScanError::Length {
                expected: beams,
                found: self.ranges.len(),
            });
        }
        if !self.angle_min.is_finite() || !self.angle_increment.is_finite() {
            return Err(ScanError::AngleNotFinite);
        }
        for (beam, range) in self.ranges.iter().enumerate() {
            if !range.is_finite() {
                return Err(ScanError::NotFinite { beam });
            }
            if *range < 0.0 || f64::from(*range) > range_max {
                return Err(ScanError::OutOfRange { beam });
            }
        }
        Ok(())
    }
}

impl Default for LidarScan {
    fn default() -> Self {
        Self::new()
    }
}

/// A scan that cannot be used. The vehicle flies on with the last plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ScanError {
    /// Another number of beams than declared.
    Length {
        /// Beams declared.
        expected: usize,
        /// Beams found.
        found: usize,
    },
    /// An angle is not a finite number.
    AngleNotFinite,
    /// A range is not a finite number.
    NotFinite {
        /// The first such beam.
        beam: usize,
    },
    /// A range is negative or beyond the declared sight.
    OutOfRange {
        /// The first such beam.
        beam: usize,
    },
}
