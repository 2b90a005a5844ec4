//! The obstacles of a flight: circles in the vertical plane, or a field of another kind.

use crate::random::{self, Stream};
use serde::{Deserialize, Serialize};

/// A point in the vertical plane: downrange and height, `(x, z)` \[m\].
pub type Point = (f64, f64);

/// Distance of the first obstacle from the start, downrange \[m\] (the authors' code).
const FIRST_AHEAD: f64 = 25.0;
/// Distance of the last obstacle from the start, downrange \[m\] (the authors' code).
const LAST_AHEAD: f64 = 240.0;
/// Half height of the band that holds the centres \[m\] (the authors' code).
const HALF_BAND: f64 = 10.0;
/// Radius of every obstacle \[m\] (paper, section IV).
const RADIUS: f64 = 1.0;

/// A circular obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Centre, downrange \[m\].
    pub x: f64,
    /// Centre, height \[m\].
    pub z: f64,
    /// Radius \[m\].
    pub radius: f64,
}

impl Obstacle {
    /// The obstacle in a world whose lengths are `scale` times as long, about downrange 0 and an altitude \[m\].
    #[must_use]
    pub fn scaled(&self, scale: f64, altitude: f64) -> Self {
        Self {
            x: self.x * scale,
            z: altitude + (self.z - altitude) * scale,
            radius: self.radius * scale,
        }
    }

    /// Distance from a point to the edge \[m\], negative inside.
    #[must_use]
    pub fn clearance(&self, point: Point) -> f64 {
        self.clearance_of_segment(point, point)
    }

    /// Least distance from a straight segment to the edge \[m\], negative where the segment enters.
    #[must_use]
    pub fn clearance_of_segment(&self, from: Point, to: Point) -> f64 {
        let (along_x, along_z) = (to.0 - from.0, to.1 - from.1);
        let (centre_x, centre_z) = (self.x - from.0, self.z - from.1);
        let length_squared = along_x * along_x + along_z * along_z;
        // Share of the segment at which it is nearest to the centre. A segment of length 0 has no
        // direction.
        let share = if length_squared > 0.0 {
            ((centre_x * along_x + centre_z * along_z) / length_squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (miss_x, miss_z) = (centre_x - share * along_x, centre_z - share * along_z);
        (miss_x * miss_x + miss_z * miss_z).sqrt() - self.radius
    }

    /// Distance along a ray at which it enters the circle \[m\]. The distance is 0 if the ray
    /// starts inside, where the exit is not visible. Returns `None` if the ray misses the circle.
    /// `direction` is a unit vector.
    #[must_use]
    pub fn range(&self, from: Point, direction: Point) -> Option<f64> {
        let (dx, dz) = (self.x - from.0, self.z - from.1);
        if dx * dx + dz * dz < self.radius * self.radius {
            return Some(0.0);
        }
        let ahead = dx * direction.0 + dz * direction.1;
        let aside = dx * direction.1 - dz * direction.0;
        let half_chord_squared = self.radius * self.radius - aside * aside;
        (ahead > 0.0 && half_chord_squared >= 0.0)
            .then(|| (ahead - half_chord_squared.sqrt()).max(0.0))
    }
}

/// The obstacles of one flight.
pub trait Field {
    /// Least distance from a straight segment to an obstacle's edge \[m\]. It is negative inside an
    /// obstacle and infinite without obstacles.
    fn clearance_of_segment(&self, from: Point, to: Point) -> f64;

    /// Distance along a ray to the first obstacle \[m\]. It is 0 if the ray starts inside an
    /// obstacle. Returns `None` if no obstacle is in the way. `direction` is a unit vector.
    fn range(&self, from: Point, direction: Point) -> Option<f64>;

    /// The circles that form the field, or that approximate it. The log, the inquest, the oracle
    /// and the authors' lidar know a field only by these circles.
    fn obstacles(&self) -> &[Obstacle];
}

/// All obstacles of one flight. Each is a circle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObstacleField {
    /// The obstacles. Generated obstacles are in the order of their downrange distance.
    pub obstacles: Vec<Obstacle>,
}

impl ObstacleField {
    /// The field of the paper's flights: `count` circles of 1 m radius, evenly spaced from 25 m to
    /// 240 m after `start_x` \[m\] (both ends included), heights uniform within 10 m of `altitude`
    /// \[m\]. A single obstacle stands at 25 m.
    #[must_use]
    pub fn generate(seed: u64, count: usize, start_x: f64, altitude: f64) -> Self {
        let mut generator = random::generator(seed, Stream::Field);
        let obstacles = evenly_spaced(start_x + FIRST_AHEAD, start_x + LAST_AHEAD, count)
            .map(|x| Obstacle {
                x,
                z: altitude + HALF_BAND * (2.0 * random::uniform(&mut generator) - 1.0),
                radius: RADIUS,
            })
            .collect();
        Self { obstacles }
    }
}

impl Field for ObstacleField {
    fn clearance_of_segment(&self, from: Point, to: Point) -> f64 {
        self.obstacles
            .iter()
            .map(|obstacle| obstacle.clearance_of_segment(from, to))
            .fold(f64::INFINITY, f64::min)
    }

    fn range(&self, from: Point, direction: Point) -> Option<f64> {
        self.obstacles
            .iter()
            .filter_map(|obstacle| obstacle.range(from, direction))
            .reduce(f64::min)
    }

    fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }
}

/// Returns `count` values from `first` to `last`, both included; a single value is `first`.
pub(crate) fn evenly_spaced(first: f64, last: f64, count: usize) -> impl Iterator<Item = f64> {
    let intervals = count.saturating_sub(1).max(1) as f64;
    (0..count).map(move |index| first + (last - first) * (index as f64 / intervals))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_field_is_the_papers() {
        let field = ObstacleField::generate(5, 20, 10.0, 50.0);
        assert_eq!(field.obstacles.len(), 20);
        assert!((field.obstacles[0].x - 35.0).abs() < 1e-12);
        assert!((field.obstacles[19].x - 250.0).abs() < 1e-12);
        for pair in field.obstacles.windows(2) {
            assert!((pair[1].x - pair[0].x - 215.0 / 19.0).abs() < 1e-12);
        }
        for obstacle in &field.obstacles {
            assert!((obstacle.z - 50.0).abs() <= 10.0);
            assert!((obstacle.radius - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn heights_fill_the_band() {
        let field = ObstacleField::generate(0, 10_000, 0.0, 50.0);
        let heights = field.obstacles.iter().map(|obstacle| obstacle.z);
        let mean = heights.clone().sum::<f64>() / 10_000.0;
        assert!((mean - 50.0).abs() < 0.25, "{mean}");
        assert!(heights.clone().fold(f64::INFINITY, f64::min) < 40.02);
        assert!(heights.fold(0.0, f64::max) > 59.98);
    }

    #[test]
    fn a_seed_is_a_field() {
        let field = |seed| ObstacleField::generate(seed, 20, 0.0, 50.0);
        assert_eq!(field(1), field(1));
        assert_ne!(field(1), field(2));
    }

    #[test]
    fn one_obstacle_stands_first_and_none_is_far_away() {
        let one = ObstacleField::generate(0, 1, 0.0, 50.0);
        assert!((one.obstacles[0].x - 25.0).abs() < 1e-12);
        let none = ObstacleField::generate(0, 0, 0.0, 50.0);
        assert!(
            none.clearance_of_segment((0.0, 0.0), (1.0, 1.0))
                .is_infinite()
        );
    }

    #[test]
    fn a_fast_step_cannot_jump_over_an_obstacle() {
        let obstacle = Obstacle {
            x: 0.0,
            z: 0.0,
            radius: 1.0,
        };
        let clearance = obstacle.clearance_of_segment((-50.0, 0.5), (50.0, 0.5));
        assert!((clearance + 0.5).abs() < 1e-12);
        assert!((obstacle.clearance((3.0, 4.0)) - 4.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn clearance_is_the_least_over_the_points_of_the_segment(
            seed in 0_u64..1000,
            from in (0.0_f64..260.0, 35.0_f64..65.0),
            step in (-20.0_f64..20.0, -20.0_f64..20.0),
        ) {
            const POINTS: usize = 2000;
            let field = ObstacleField::generate(seed, 20, 0.0, 50.0);
            let to = (from.0 + step.0, from.1 + step.1);
            let sampled = evenly_spaced(0.0, 1.0, POINTS + 1)
                .flat_map(|s| {
                    let (x, z): Point = (from.0 + s * step.0, from.1 + s * step.1);
                    field.obstacles.iter().map(move |o| {
                        ((o.x - x) * (o.x - x) + (o.z - z) * (o.z - z)).sqrt() - o.radius
                    })
                })
                .fold(f64::INFINITY, f64::min);
            let clearance = field.clearance_of_segment(from, to);
            // No sample is nearer, and the nearest is within half a sampling interval.
            let interval = (step.0 * step.0 + step.1 * step.1).sqrt() / POINTS as f64;
            prop_assert!(clearance <= sampled + 1e-9);
            prop_assert!(sampled <= clearance + 0.5 * interval + 1e-9);
        }
    }
}
