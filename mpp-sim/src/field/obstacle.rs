//! One obstacle: a shape that stands still or moves at a constant velocity.

use super::geometry::Point;
use super::shape::Shape;

/// An obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape, where it stands at the start of the flight.
    pub shape: Shape,
    /// Its velocity, downrange and up [m/s].
    pub velocity: Point,
}

impl Obstacle {
    /// An obstacle that does not move.
    #[must_use]
    pub fn at_rest(shape: Shape) -> Self {
        Self {
            shape,
            velocity: (0.0, 0.0),
        }
    }

    /// A circle that does not move: its centre and its radius \[m\].
    #[must_use]
    pub fn circle(x: f64, z: f64, radius: f64) -> Self {
        let centre = (x, z);
        Self::at_rest(Shape::Circle { centre, radius })
    }

    /// The obstacle in a world whose lengths are `scale` times as long, about downrange 0 and an altitude \[m\].
    /// Its speed is the root of `scale` times as fast.
    #[must_use]
    pub fn scaled(&self, scale: f64, altitude: f64) -> Self {
        let (x, z) = self.velocity;
        let time = scale.sqrt();
        Self {
            shape: self.shape.scaled(scale, altitude),
            velocity: (x * time, z * time),
        }
    }

    /// Distance from a point to the edge at a time \[s\] since the start \[m\], negative inside.
    #[must_use]
    pub fn clearance(&self, point: Point, time: f64) -> f64 {
        let point = self.seen_from(point, time);
        self.shape.clearance_of_segment(point, point)
    }

    /// Least distance to the edge \[m\] during a straight motion at a constant speed, between two
    /// times \[s\] since the start. It is negative if the motion enters. It is exact: seen from the
    /// obstacle, such a motion is straight as well.
    #[must_use]
    pub fn clearance_of_motion(&self, from: Point, to: Point, times: [f64; 2]) -> f64 {
        let (from, to) = (self.seen_from(from, times[0]), self.seen_from(to, times[1]));
        self.shape.clearance_of_segment(from, to)
    }

    /// At most what [`Self::clearance_of_motion`] gives, up to rounding, and cheaper \[m\].
    #[inline]
    pub(super) fn least_clearance_of_motion(&self, from: Point, to: Point, times: [f64; 2]) -> f64 {
        let [from, to] =
            [(from.0, times[0]), (to.0, times[1])].map(|(x, time)| x - self.velocity.0 * time);
        self.shape.least_clearance_along(from, to)
    }

    /// Distance along a ray at which it enters the obstacle at a time \[s\] since the start \[m\];
    /// see [`Shape::range`].
    #[must_use]
    pub fn range(&self, from: Point, direction: Point, time: f64) -> Option<f64> {
        self.shape.range(self.seen_from(from, time), direction)
    }

    /// Shortens the ranges along rays from one place to where they enter the obstacle; see [`Self::range`].
    pub(super) fn shorten(
        &self,
        from: Point,
        directions: &[Point],
        time: f64,
        ranges: &mut [Option<f64>],
    ) {
        let from = self.seen_from(from, time);
        self.shape.shorten(from, directions, ranges);
    }

    /// Whether it touches a square at a time \[s\] since the start; see [`Shape::touches_square`].
    #[must_use]
    pub fn touches_square(&self, centre: Point, half: f64, time: f64) -> bool {
        let centre = self.seen_from(centre, time);
        self.shape.touches_square(centre, half)
    }

    /// Middle of its downrange extent at the start \[m\]; infinite of what has no end.
    #[must_use]
    pub fn middle(&self) -> f64 {
        self.shape.middle()
    }

    /// A place as the obstacle would see it if it had not moved.
    fn seen_from(&self, place: Point, time: f64) -> Point {
        let (x, z) = self.velocity;
        (place.0 - x * time, place.1 - z * time)
    }
}
