//! Lidars: the interface of a sensor that scans a field, and a fan of beams in the vertical plane
//! that is fixed to the body axis.

use crate::disturbance::Disturbance;
use crate::field::{Field, Point, Shape, evenly_spaced};
use crate::random::{self, Draws, Stream};
use hil_protocol::LidarScan;
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};

/// Least range that is reported \[m\], because 0 means no return. A sensor inside an obstacle
/// reports this range.
pub const RANGE_MIN: f64 = 0.01;

/// A sensor that measures distances to a field.
pub trait Lidar {
    /// One scan from the true state. It holds one range \[m\] for each beam of the scenario's
    /// [`LidarConfig`], from the lowest to the highest; 0 means no return.
    fn scan(&mut self, state: &VehicleState, field: &dyn Field) -> Vec<f32>;

    /// Changes the share of beams that fail. Returns `false` if this lidar cannot be disturbed so.
    fn disturb(&mut self, disturbance: &Disturbance) -> bool {
        let _ = disturbance;
        false
    }
}

/// The rule by which a beam returns a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LidarRule {
    /// The beam returns the nearest point of any obstacle on the beam, within range.
    Nearest,
    /// The rule of the authors' code, for comparison with it. The lidar sees only obstacles whose
    /// *centre* is ahead (`x >=` the aircraft's), within range and inside the fan. Of the two
    /// points where the beam's infinite line cuts an obstacle, the one nearer to the *world origin*
    /// counts.
    Authors,
}

/// Geometry and error of a lidar.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LidarConfig {
    /// Number of beams, evenly spaced over the field of view, both edges included.
    pub beams: usize,
    /// Field of view \[rad\], centred on the body axis.
    pub field_of_view: f64,
    /// Greatest range \[m\].
    pub range_max: f64,
    /// Standard deviation of the range error, as a share of the range [-].
    pub range_error: f64,
    /// Rule by which a beam returns a range.
    pub rule: LidarRule,
}

impl LidarConfig {
    /// The paper's lidar: 45 m (section IV) and an error proportional to the range (section II-C).
    /// The paper does not name the size of the error; 1 % is our choice. Number of beams and field
    /// of view come from the authors' code.
    pub const PAPER: Self = Self {
        beams: 100,
        field_of_view: 100_f64.to_radians(),
        range_max: 45.0,
        range_error: 0.01,
        rule: LidarRule::Nearest,
    };
    /// The lidar of the authors' code: 50 m, no error.
    pub const AUTHORS: Self = Self {
        range_max: 50.0,
        range_error: 0.0,
        rule: LidarRule::Authors,
        ..Self::PAPER
    };

    /// Greatest range that a beam may return \[m\].
    #[must_use]
    pub fn farthest(&self) -> f64 {
        // The authors' lidar may return the far side of an obstacle whose centre is at the greatest
        // range.
        let beyond = match self.rule {
            LidarRule::Authors => 1.0,
            LidarRule::Nearest => 0.0,
        };
        self.range_max + beyond
    }

    /// Ranges of all beams without error \[m\], 0 = no return; from the lowest beam to the highest.
    #[must_use]
    pub fn exact_ranges(&self, state: &VehicleState, field: &dyn Field) -> Vec<f64> {
        let from = (state.x, state.z);
        let half_fan = 0.5 * self.field_of_view;
        let directions = evenly_spaced(-half_fan, half_fan, self.beams).map(|angle| {
            let (up, ahead) = libm::sincos(state.air.pitch + angle);
            (ahead, up)
        });
        match self.rule {
            LidarRule::Nearest => {
                let directions: Vec<Point> = directions.collect();
                let ranges = field.ranges(from, &directions, self.range_max);
                ranges.into_iter().map(|it| self.returned(it)).collect()
            }
            LidarRule::Authors => {
                let seen = self.seen_by_authors(state, field);
                directions
                    .map(|direction| authors_range(from, direction, &seen))
                    .collect()
            }
        }
    }

    /// What a beam reports of the range to the nearest obstacle on it \[m\], 0 = none within `range_max`.
    fn returned(&self, range: Option<f64>) -> f64 {
        let range = range.map(|range| range.max(RANGE_MIN));
        range.filter(|it| *it <= self.range_max).unwrap_or(0.0)
    }

    /// The circles that the authors' code passes on to its beams: centre and radius \[m\]. It knows
    /// nothing else, and nothing that moves.
    fn seen_by_authors(&self, state: &VehicleState, field: &dyn Field) -> Vec<(Point, f64)> {
        let half_fan = 0.5 * self.field_of_view;
        let upper = libm::tan(state.air.pitch + half_fan);
        let lower = libm::tan(state.air.pitch - half_fan);
        let seen = |&((x, z), _): &(Point, f64)| {
            let (dx, dz) = (x - state.x, z - state.z);
            let in_range = (dx * dx + dz * dz).sqrt() <= self.range_max;
            dx >= 0.0 && in_range && lower * dx <= dz && dz <= upper * dx
        };
        let circles = field.obstacles().iter().filter_map(|one| match one.shape {
            Shape::Circle { centre, radius } => Some((centre, radius)),
            _ => None,
        });
        circles.filter(seen).collect()
    }

    /// A scan of this lidar as it goes over the link.
    #[must_use]
    pub fn wire_scan(&self, tick: u32, ranges: &[f32]) -> LidarScan {
        let gaps = self.beams.saturating_sub(1).max(1);
        LidarScan {
            tick,
            angle_min: (-0.5 * self.field_of_view) as f32,
            angle_increment: (self.field_of_view / gaps as f64) as f32,
            ranges: ranges
                .iter()
                .copied()
                .take(hil_protocol::MAX_BEAMS)
                .collect(),
        }
    }
}

/// Range by the authors' rule \[m\], 0 = none.
fn authors_range(from: Point, direction: Point, seen: &[(Point, f64)]) -> f64 {
    seen.iter()
        .filter_map(|(centre, radius)| authors_hit(from, direction, *centre, *radius))
        .map(|(x, z)| ((x - from.0) * (x - from.0) + (z - from.1) * (z - from.1)).sqrt())
        .reduce(f64::min)
        .unwrap_or(0.0)
}

/// The point where the infinite line of a beam cuts an obstacle. Of the two points it is the one
/// nearer to the world origin; at a tie it is the lower one. `direction` is a unit vector.
fn authors_hit(from: Point, direction: Point, centre: Point, radius: f64) -> Option<Point> {
    let aside = (centre.0 - from.0) * direction.1 - (centre.1 - from.1) * direction.0;
    let half_chord_squared = radius * radius - aside * aside;
    if half_chord_squared < 0.0 {
        return None;
    }
    // In the reference a level beam has the sign 0. Both points are then the middle of the chord.
    let upwards = if direction.1 == 0.0 {
        0.0
    } else {
        direction.1.signum()
    };
    let along = upwards * half_chord_squared.sqrt();
    let middle = (
        centre.0 - aside * direction.1,
        centre.1 + aside * direction.0,
    );
    let upper = (
        middle.0 + along * direction.0,
        middle.1 + along * direction.1,
    );
    let lower = (
        middle.0 - along * direction.0,
        middle.1 - along * direction.1,
    );
    let from_origin = |(x, z): Point| x * x + z * z;
    Some(if from_origin(upper) >= from_origin(lower) {
        lower
    } else {
        upper
    })
}

/// A fan of beams and its stream of noise. A range with an error stays within `(0, range_max]`.
#[derive(Clone, Debug)]
pub struct FanLidar {
    config: LidarConfig,
    generator: Draws,
}

impl FanLidar {
    /// The lidar of the flight with this seed.
    #[must_use]
    pub fn new(seed: u64, config: LidarConfig) -> Self {
        Self {
            config,
            generator: random::generator(seed, Stream::Lidar),
        }
    }
}

impl Lidar for FanLidar {
    fn scan(&mut self, state: &VehicleState, field: &dyn Field) -> Vec<f32> {
        let mut ranges = self.config.exact_ranges(state, field);
        if self.config.range_error > 0.0 {
            for range in &mut ranges {
                // Every beam draws a value, so that an additional obstacle does not shift the noise
                // of other beams.
                let error = self.config.range_error * random::gaussian(&mut self.generator);
                if *range > 0.0 {
                    *range = (*range * (1.0 + error)).clamp(RANGE_MIN, self.config.range_max);
                }
            }
        }
        ranges.into_iter().map(|range| range as f32).collect()
    }
}

#[cfg(test)]
mod tests;
