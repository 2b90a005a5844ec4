//! Lidar faults: beams that return nothing, and beams that return a wrong range.

use crate::disturbance::Disturbance;
use crate::field::Field;
use crate::lidar::{FanLidar, Lidar, LidarConfig, RANGE_MIN};
use crate::random::{self, Draws, Stream};
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};

/// The shares of the beams that fail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LidarFaultConfig {
    /// Share of beams without return [-].
    pub dropouts: f64,
    /// Share of beams that return a uniformly random range, whatever they met [-]. A false hit
    /// takes precedence over a dropout.
    pub false_hits: f64,
}

/// The failing beams of one flight.
#[derive(Clone, Debug)]
pub struct LidarFaults {
    config: LidarFaultConfig,
    range_max: f64,
    generator: Draws,
}

impl LidarFaults {
    /// The failing beams of the flight with this seed, for a lidar with this greatest range \[m\].
    #[must_use]
    pub fn new(seed: u64, config: LidarFaultConfig, range_max: f64) -> Self {
        Self {
            config,
            range_max,
            generator: random::generator(seed, Stream::LidarFaults),
        }
    }

    /// Applies the faults to a scan's ranges \[m\]; 0 means no return.
    pub fn spoil(&mut self, ranges: &mut [f32]) {
        for range in ranges {
            // Every beam draws the same number of values, so that a fault of one beam does not
            // change another beam's faults.
            let [hit, drop, place] = [(); 3].map(|()| random::uniform(&mut self.generator));
            if hit < self.config.false_hits {
                *range = (RANGE_MIN + place * (self.range_max - RANGE_MIN)) as f32;
            } else if drop < self.config.dropouts {
                *range = 0.0;
            }
        }
    }
}

/// A fan of beams, some of which fail.
#[derive(Clone, Debug)]
pub struct FaultyLidar {
    lidar: FanLidar,
    faults: LidarFaults,
}

impl FaultyLidar {
    /// The lidar of the flight with this seed, and its failing beams.
    #[must_use]
    pub fn new(seed: u64, config: LidarConfig, faults: LidarFaultConfig) -> Self {
        Self {
            lidar: FanLidar::new(seed, config),
            faults: LidarFaults::new(seed, faults, config.range_max),
        }
    }
}

impl Lidar for FaultyLidar {
    fn scan(&mut self, state: &VehicleState, field: &dyn Field) -> Vec<f32> {
        let mut ranges = self.lidar.scan(state, field);
        self.faults.spoil(&mut ranges);
        ranges
    }

    fn disturb(&mut self, disturbance: &Disturbance) -> bool {
        let config = &mut self.faults.config;
        config.dropouts = disturbance.dropouts.unwrap_or(config.dropouts);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spoilt(config: LidarFaultConfig) -> Vec<f32> {
        let mut ranges = vec![20.0; 100_000];
        LidarFaults::new(3, config, 45.0).spoil(&mut ranges);
        ranges
    }

    fn share(ranges: &[f32], is: impl Fn(f32) -> bool) -> f64 {
        ranges.iter().filter(|range| is(**range)).count() as f64 / ranges.len() as f64
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "a range is untouched or it is not")]
    fn the_shares_are_as_stated() {
        assert!(
            spoilt(LidarFaultConfig::default())
                .iter()
                .all(|range| *range == 20.0)
        );
        let config = LidarFaultConfig {
            dropouts: 0.1,
            false_hits: 0.01,
        };
        let ranges = spoilt(config);
        let dropped = share(&ranges, |range| range == 0.0);
        let invented = share(&ranges, |range| range != 0.0 && range != 20.0);
        assert!((dropped - 0.1 * 0.99).abs() < 0.004, "{dropped}");
        assert!((invented - 0.01).abs() < 0.0015, "{invented}");
    }

    #[test]
    fn false_hits_fill_the_range() {
        let ranges = spoilt(LidarFaultConfig {
            dropouts: 1.0,
            false_hits: 1.0,
        });
        assert!(ranges.iter().all(|range| *range > 0.0 && *range <= 45.0));
        let near = share(&ranges, |range| range < 15.0);
        assert!((near - 1.0 / 3.0).abs() < 0.01, "{near}");
    }
}
