//! The obstacles of a flight: shapes in the vertical plane, or a field of another kind.

mod check;
mod file;
mod geometry;
mod obstacle;
mod shape;

pub use check::{FieldError, MAX_VERTICES};
pub use file::{Capsule, Circle, FieldFile, Line, Polygon, Polyline};
pub use geometry::Point;
pub use obstacle::Obstacle;
pub use shape::{Shape, Sheet};

/// The obstacles of one flight.
pub trait Field {
    /// Moves what moves to a time \[s\] since the start. A field without motion does nothing.
    fn move_to(&mut self, _time: f64) {}

    /// Adds obstacles. Returns `false` if this field takes none.
    fn add(&mut self, obstacles: Vec<Obstacle>) -> bool {
        let _ = obstacles;
        false
    }

    /// Least distance to an obstacle's edge \[m\] during a straight motion that begins at the
    /// field's time and lasts for `lasting` \[s\]. It is negative inside an obstacle and infinite
    /// without obstacles.
    fn clearance_of_motion(&self, from: Point, to: Point, lasting: f64) -> f64;

    /// Distance along a ray to the first obstacle at the field's time \[m\]. It is 0 if the ray
    /// starts inside an obstacle. Returns `None` if no obstacle is in the way. `direction` is a unit
    /// vector.
    fn range(&self, from: Point, direction: Point) -> Option<f64>;

    /// What [`Self::range`] gives along each of several rays from one place, up to a distance \[m\]; a ray that meets nothing
    /// so near may have any greater range, or none.
    fn ranges(&self, from: Point, directions: &[Point], _within: f64) -> Vec<Option<f64>> {
        let rays = directions.iter();
        rays.map(|direction| self.range(from, *direction)).collect()
    }

    /// The obstacles that form the field, or that stand for it. The log, the inquest, the oracle and
    /// the authors' lidar know a field only by these.
    fn obstacles(&self) -> &[Obstacle];
}

/// All obstacles of one flight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObstacleField {
    /// The obstacles, where they are at the start. Generated obstacles are in the order of their
    /// downrange distance.
    pub obstacles: Vec<Obstacle>,
    /// The field's time \[s\].
    time: f64,
}

impl ObstacleField {
    /// The field of these obstacles at the start of a flight.
    #[must_use]
    pub fn new(obstacles: Vec<Obstacle>) -> Self {
        Self {
            obstacles,
            time: 0.0,
        }
    }
}

impl Field for ObstacleField {
    fn move_to(&mut self, time: f64) {
        self.time = time;
    }

    fn add(&mut self, obstacles: Vec<Obstacle>) -> bool {
        self.obstacles.extend(obstacles);
        true
    }

    fn clearance_of_motion(&self, from: Point, to: Point, lasting: f64) -> f64 {
        let times = [self.time, self.time + lasting];
        let clearance = |it: &Obstacle| it.clearance_of_motion(from, to, times);
        // Where the obstacles are in the order of their downrange distance, this one is near, and most others surely farther.
        let near = (self.obstacles).partition_point(|it| it.middle() < from.0);
        let near = self.obstacles.get(near).or(self.obstacles.last());
        let near = near.map_or(f64::INFINITY, clearance);
        let may_be_least =
            |it: &&Obstacle| it.least_clearance_of_motion(from, to, times) <= near + BEYOND;
        let least = self.obstacles.iter().filter(may_be_least).map(clearance);
        least.fold(near, f64::min)
    }

    fn range(&self, from: Point, direction: Point) -> Option<f64> {
        self.obstacles
            .iter()
            .filter_map(|obstacle| obstacle.range(from, direction, self.time))
            .reduce(f64::min)
    }

    /// Most obstacles of a long field are beyond the reach of a lidar.
    fn ranges(&self, from: Point, directions: &[Point], within: f64) -> Vec<Option<f64>> {
        let near = |it: &&Obstacle| it.clearance(from, self.time) <= within + BEYOND;
        let mut ranges = vec![None; directions.len()];
        for obstacle in self.obstacles.iter().filter(near) {
            obstacle.shorten(from, directions, self.time, &mut ranges);
        }
        ranges
    }

    fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }
}

/// How much farther than asked obstacles count, so that no rounding leaves one out \[m\].
const BEYOND: f64 = 1e-3;

/// Returns `count` values from `first` to `last`, both included; a single value is `first`.
pub(crate) fn evenly_spaced(first: f64, last: f64, count: usize) -> impl Iterator<Item = f64> {
    let intervals = count.saturating_sub(1).max(1) as f64;
    (0..count).map(move |index| first + (last - first) * (index as f64 / intervals))
}

#[cfg(test)]
mod tests;
