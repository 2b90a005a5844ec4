//! The navigation source: positions, and velocities over ground, with rate, errors and delay.

use crate::random::{self, Draws, Stream};
use hil_protocol::{GroundVelocity, Position};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The errors of a navigation source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NavigationConfig {
    /// Ticks from one position to the next.
    pub period_ticks: u32,
    /// Ticks from a measurement until the core gets it.
    pub delay_ticks: u32,
    /// Standard deviation of the white error along an axis \[m\]. The source declares this error.
    pub sigma: f64,
    /// Standard deviation of the wandering error along an axis \[m\]. The source does not declare it.
    pub wander: f64,
    /// Correlation time of the wandering error \[s\].
    pub wander_time: f64,
    /// Error of the downrange position as a share of the distance flown [-]. Its sign is drawn.
    pub drift: f64,
    /// Standard deviation of the velocity over ground along an axis [m/s]; absent if the source measures no
    /// velocity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_sigma: Option<f64>,
}

impl NavigationConfig {
    /// The true position in every tick, as in the authors' code. It declares an error of 1 mm.
    pub const IDEAL: Self = Self {
        period_ticks: 1,
        delay_ticks: 0,
        sigma: 0.0,
        wander: 0.0,
        wander_time: 30.0,
        drift: 0.0,
        velocity_sigma: None,
    };
    /// Satellite navigation with carrier phase corrections (RTK).
    pub const RTK: Self = Self {
        period_ticks: 10,
        delay_ticks: 5,
        sigma: 0.02,
        wander: 0.05,
        ..Self::IDEAL
    };
    /// Satellite navigation without corrections, with the velocity from Doppler shifts.
    pub const GNSS_INS: Self = Self {
        period_ticks: 10,
        delay_ticks: 10,
        sigma: 0.1,
        wander: 0.5,
        wander_time: 60.0,
        velocity_sigma: Some(0.1),
        ..Self::IDEAL
    };
    /// Odometry from lidar scans.
    pub const LIDAR_ODOMETRY: Self = Self {
        period_ticks: 5,
        sigma: 0.03,
        drift: 0.01,
        ..Self::IDEAL
    };
}

/// The true motion over ground at one tick.
#[derive(Clone, Copy, Debug)]
pub struct GroundTruth {
    /// Position `(x, z)` \[m\].
    pub position: (f64, f64),
    /// Velocity over ground `(x, z)` [m/s].
    pub velocity: (f64, f64),
}

/// The navigation source of one flight.
#[derive(Clone, Debug)]
pub struct NavigationSensor {
    config: NavigationConfig,
    generator: Draws,
    /// The wandering error `(x, z)` \[m\].
    wander: (f64, f64),
    /// Sign of the drift.
    sign: f64,
    /// Positions on their way to the core.
    under_way: VecDeque<Position>,
}

impl NavigationSensor {
    /// The source of the flight with this seed.
    #[must_use]
    pub fn new(seed: u64, config: NavigationConfig) -> Self {
        let mut generator = random::generator(seed, Stream::Navigation);
        let mut draw = || config.wander * random::gaussian(&mut generator);
        let wander = (draw(), draw());
        let sign = if random::uniform(&mut generator) < 0.5 {
            -1.0
        } else {
            1.0
        };
        Self {
            config,
            generator,
            wander,
            sign,
            under_way: VecDeque::new(),
        }
    }

    /// Measures the truth at a tick, if it is due, and gives the position that arrives at this tick.
    pub fn measure(&mut self, tick: u32, truth: &GroundTruth) -> Option<Position> {
        if tick.is_multiple_of(self.config.period_ticks) {
            let position = self.position(tick, truth);
            self.under_way.push_back(position);
        }
        let arrives = |position: &Position| position.tick + self.config.delay_ticks <= tick;
        self.under_way.pop_front_if(|position| arrives(position))
    }

    fn position(&mut self, tick: u32, truth: &GroundTruth) -> Position {
        let config = self.config;
        let period = f64::from(config.period_ticks) * mpp_core::config::TICK_PERIOD;
        let kept = libm::exp(-period / config.wander_time);
        let fresh = config.wander * (1.0 - kept * kept).sqrt();
        let mut draw = || random::gaussian(&mut self.generator);
        self.wander = (
            kept * self.wander.0 + fresh * draw(),
            kept * self.wander.1 + fresh * draw(),
        );
        let (x, z) = truth.position;
        Position {
            tick,
            x: x * (1.0 + self.sign * config.drift) + self.wander.0 + config.sigma * draw(),
            z: z + self.wander.1 + config.sigma * draw(),
            sigma: config.sigma as f32,
            velocity: config.velocity_sigma.map(|sigma| GroundVelocity {
                x: (truth.velocity.0 + sigma * draw()) as f32,
                z: (truth.velocity.1 + sigma * draw()) as f32,
                sigma: sigma as f32,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(tick: u32) -> GroundTruth {
        GroundTruth {
            position: (0.12 * f64::from(tick), 50.0),
            velocity: (12.0, 0.0),
        }
    }

    fn positions(seed: u64, config: NavigationConfig, ticks: u32) -> Vec<(u32, Position)> {
        let mut sensor = NavigationSensor::new(seed, config);
        (0..ticks)
            .filter_map(|tick| Some((tick, sensor.measure(tick, &at(tick))?)))
            .collect()
    }

    #[test]
    fn an_ideal_source_tells_the_truth_at_once() {
        let all = positions(1, NavigationConfig::IDEAL, 100);
        assert_eq!(all.len(), 100);
        for (tick, position) in all {
            let truth = at(tick).position;
            assert_eq!(
                (position.tick, position.x, position.z),
                (tick, truth.0, truth.1)
            );
        }
    }

    #[test]
    fn positions_come_at_their_rate_and_late_by_their_delay() {
        let all = positions(2, NavigationConfig::RTK, 200);
        let ticks: Vec<u32> = all.iter().map(|(tick, _)| *tick).collect();
        assert_eq!(ticks, (0..20).map(|n| 10 * n + 5).collect::<Vec<_>>());
        assert!(
            all.iter()
                .all(|(tick, position)| position.tick + 5 == *tick)
        );
    }

    #[test]
    fn errors_have_the_declared_size() {
        let config = NavigationConfig {
            wander: 0.0,
            ..NavigationConfig::GNSS_INS
        };
        let all = positions(3, config, 200_000);
        let count = all.len() as f64;
        let mean_square = |error: &dyn Fn(&Position) -> f64| {
            let sum: f64 = all.iter().map(|(_, p)| error(p) * error(p)).sum();
            (sum / count).sqrt()
        };
        let z = mean_square(&|position| position.z - 50.0);
        let x = mean_square(&|position| position.x - at(position.tick).position.0);
        let velocity = mean_square(&|position| position.velocity.map_or(9.0, |v| f64::from(v.z)));
        assert!((z / 0.1 - 1.0).abs() < 0.03, "{z}");
        assert!((x / 0.1 - 1.0).abs() < 0.03, "{x}");
        assert!((velocity / 0.1 - 1.0).abs() < 0.03, "{velocity}");
    }

    #[test]
    fn a_wandering_error_keeps_its_size_and_changes_slowly() {
        let config = NavigationConfig {
            sigma: 0.0,
            ..NavigationConfig::GNSS_INS
        };
        let mut square = 0.0;
        let mut step = 0.0;
        let mut count = 0.0;
        for seed in 0..200 {
            let all = positions(seed, config, 6000);
            for pair in all.windows(2) {
                let [(_, a), (_, b)] = pair else { continue };
                square += (a.z - 50.0) * (a.z - 50.0);
                step += (b.z - a.z) * (b.z - a.z);
                count += 1.0;
            }
        }
        let (size, step) = ((square / count).sqrt(), (step / count).sqrt());
        assert!((size / 0.5 - 1.0).abs() < 0.1, "{size}");
        // Square root of two periods over the correlation time.
        assert!(
            (step / (0.5 * (2.0_f64 * 0.1 / 60.0).sqrt()) - 1.0).abs() < 0.05,
            "{step}"
        );
    }

    #[test]
    fn a_seed_is_a_source() {
        let some = |seed| positions(seed, NavigationConfig::RTK, 50);
        assert_eq!(some(4), some(4));
        assert_ne!(some(4), some(5));
    }
}
