//! The shapes of obstacles: their distances, what a ray meets of them, and which cells they touch.

use super::geometry::{
    Point, between_segments, crossing, edges, is_inside, legs, plus, point_to_segment,
    ray_to_capsule, ray_to_circle, ray_to_segment,
};

/// Distance at which ground and ceiling end, in every direction that has no end \[m\]. No flight
/// gets so far.
const FAR: f64 = 1e6;

/// A shape in the vertical plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A circle.
    Circle {
        /// Its centre.
        centre: Point,
        /// Its radius \[m\].
        radius: f64,
    },
    /// The points within `radius` \[m\] of a line. A line of two points is a capsule.
    Line {
        /// Its points, two at least.
        points: Vec<Point>,
        /// Half its thickness \[m\].
        radius: f64,
    },
    /// A simple polygon.
    Polygon {
        /// Its corners, three at least, in either direction.
        corners: Vec<Point>,
    },
    /// Everything below a line, which goes on level beyond its ends.
    Ground(Sheet),
    /// Everything above a line, which goes on level beyond its ends.
    Ceiling(Sheet),
}

/// Ground or ceiling, as a polygon that reaches far beyond every flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    corners: Vec<Point>,
}

impl Sheet {
    /// The sheet from a line to far below or above it, at the height `end` \[m\].
    fn new(line: &[Point], end: f64) -> Self {
        let first = line.first().map_or(0.0, |point| point.1);
        let last = line.last().map_or(0.0, |point| point.1);
        let mut corners = vec![(-FAR, end), (-FAR, first)];
        corners.extend(line);
        corners.extend([(FAR, last), (FAR, end)]);
        Self { corners }
    }

    /// Its corners as a polygon, some of them far beyond every flight.
    #[must_use]
    pub fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// Its line.
    #[must_use]
    pub fn line(&self) -> &[Point] {
        &self.corners[2..self.corners.len() - 2]
    }
}

impl Shape {
    /// Everything below a line.
    #[must_use]
    pub fn ground(line: &[Point]) -> Self {
        Self::Ground(Sheet::new(line, -FAR))
    }

    /// The shape in a world whose lengths are `scale` times as long, about downrange 0 and an altitude \[m\].
    #[must_use]
    pub fn scaled(&self, scale: f64, altitude: f64) -> Self {
        let place = |(x, z): Point| (x * scale, altitude + (z - altitude) * scale);
        let places = |points: &[Point]| points.iter().copied().map(place).collect::<Vec<Point>>();
        match self {
            Self::Circle { centre, radius } => Self::Circle {
                centre: place(*centre),
                radius: radius * scale,
            },
            Self::Line { points, radius } => Self::Line {
                points: places(points),
                radius: radius * scale,
            },
            Self::Polygon { corners } => Self::Polygon {
                corners: places(corners),
            },
            Self::Ground(sheet) => Self::ground(&places(sheet.line())),
            Self::Ceiling(sheet) => Self::ceiling(&places(sheet.line())),
        }
    }

    /// Everything above a line.
    #[must_use]
    pub fn ceiling(line: &[Point]) -> Self {
        Self::Ceiling(Sheet::new(line, FAR))
    }

    /// Least distance from a straight segment to the edge \[m\]. It is negative where the segment
    /// enters: less the radius than the distance to the centre or the line; of an area, the greatest
    /// depth, which may be short by a quarter of the segment's length.
    #[must_use]
    pub fn clearance_of_segment(&self, from: Point, to: Point) -> f64 {
        match self {
            Self::Circle { centre, radius } => point_to_segment(*centre, from, to) - radius,
            Self::Line { points, radius } => {
                let apart = legs(points).map(|leg| between_segments([from, to], leg));
                apart.fold(f64::INFINITY, f64::min) - radius
            }
            Self::Polygon { corners } => clearance_of_area(corners, from, to),
            Self::Ground(sheet) | Self::Ceiling(sheet) => {
                clearance_of_area(&sheet.corners, from, to)
            }
        }
    }

    /// At most what [`Self::clearance_of_segment`] gives from one place downrange to another, up to rounding \[m\]: how far a
    /// circle is ahead or behind.
    #[inline]
    pub(super) fn least_clearance_along(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Circle { centre, radius } => (centre.0 - from).abs() - (to - from).abs() - radius,
            _ => f64::NEG_INFINITY,
        }
    }

    /// Distance along a ray at which it enters the shape \[m\]. The distance is 0 if the ray starts
    /// inside, where the exit is not visible. Returns `None` if the ray misses the shape.
    /// `direction` is a unit vector.
    #[must_use]
    pub fn range(&self, from: Point, direction: Point) -> Option<f64> {
        match self {
            Self::Circle { centre, radius } => ray_to_circle(from, direction, *centre, *radius),
            Self::Line { points, radius } => legs(points)
                .filter_map(|leg| ray_to_capsule(from, direction, leg, *radius))
                .reduce(f64::min),
            Self::Polygon { corners } => range_to_area(corners, from, direction),
            Self::Ground(sheet) | Self::Ceiling(sheet) => {
                range_to_area(&sheet.corners, from, direction)
            }
        }
    }

    /// Shortens the ranges along rays from one place to where they enter the shape; see [`Self::range`]. What all rays to a
    /// circle share is computed once.
    pub(super) fn shorten(&self, from: Point, directions: &[Point], ranges: &mut [Option<f64>]) {
        match self {
            Self::Circle { centre, radius } => shorten(ranges, directions, |direction| {
                ray_to_circle(from, direction, *centre, *radius)
            }),
            _ => shorten(ranges, directions, |direction| self.range(from, direction)),
        }
    }

    /// Whether the shape touches a square with this centre and half this side \[m\].
    #[must_use]
    pub fn touches_square(&self, centre: Point, half: f64) -> bool {
        let apart = self.clearance_of_segment(centre, centre);
        if apart <= 0.0 || apart > half * core::f64::consts::SQRT_2 {
            return apart <= 0.0;
        }
        let corner = |x: f64, z: f64| (centre.0 + x * half, centre.1 + z * half);
        let square =
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| corner(x, z));
        // A shape without its point in the middle of the square comes in over the edge.
        edges(&square).any(|[from, to]| self.clearance_of_segment(from, to) <= 0.0)
            || self.is_within(&square)
    }

    /// Whether the shape lies within a square that its edge does not cut.
    fn is_within(&self, square: &[Point; 4]) -> bool {
        let place = match self {
            Self::Circle { centre, .. } => Some(centre),
            Self::Line { points, .. } => points.first(),
            Self::Polygon { corners } => corners.first(),
            Self::Ground(_) | Self::Ceiling(_) => None,
        };
        place.is_some_and(|place| is_inside(*place, square))
    }

    /// Moves it by a vector \[m\].
    pub fn shift(&mut self, by: Point) {
        let points = match self {
            Self::Circle { centre, .. } => core::slice::from_mut(centre),
            Self::Line { points, .. } | Self::Polygon { corners: points } => points,
            Self::Ground(sheet) | Self::Ceiling(sheet) => &mut sheet.corners,
        };
        for point in points {
            *point = plus(*point, by);
        }
    }

    /// Middle of its downrange extent \[m\]; infinite of ground and ceiling, which have no end.
    #[must_use]
    pub fn middle(&self) -> f64 {
        match self {
            Self::Circle { centre, .. } => centre.0,
            Self::Line { points, .. } | Self::Polygon { corners: points } => {
                let places = points.iter().map(|point| point.0);
                let low = places.clone().fold(f64::INFINITY, f64::min);
                0.5 * (low + places.fold(f64::NEG_INFINITY, f64::max))
            }
            Self::Ground(_) | Self::Ceiling(_) => f64::INFINITY,
        }
    }

    /// Number of points that describe it.
    #[must_use]
    pub fn vertices(&self) -> usize {
        match self {
            Self::Circle { .. } => 1,
            Self::Line { points, .. } => points.len(),
            Self::Polygon { corners } => corners.len(),
            Self::Ground(sheet) | Self::Ceiling(sheet) => sheet.line().len(),
        }
    }
}

/// Shortens ranges to what `range` gives along their directions.
fn shorten(ranges: &mut [Option<f64>], directions: &[Point], range: impl Fn(Point) -> Option<f64>) {
    for (nearest, direction) in ranges.iter_mut().zip(directions) {
        if let Some(range) = range(*direction) {
            *nearest = Some(nearest.map_or(range, |nearest: f64| nearest.min(range)));
        }
    }
}

/// Signed distance from a point to the edge of an area \[m\], negative inside.
fn depth(corners: &[Point], point: Point) -> f64 {
    let apart = edges(corners).map(|[a, b]| point_to_segment(point, a, b));
    let apart = apart.fold(f64::INFINITY, f64::min);
    if is_inside(point, corners) {
        -apart
    } else {
        apart
    }
}

/// Least distance from a segment to an area \[m\], negative where it enters.
fn clearance_of_area(corners: &[Point], from: Point, to: Point) -> f64 {
    let ends = depth(corners, from).min(depth(corners, to));
    let apart = edges(corners).map(|edge| between_segments([from, to], edge));
    let apart = apart.fold(f64::INFINITY, f64::min);
    if apart > 0.0 {
        // The segment does not cross the edge: it is inside or outside as a whole.
        return if ends < 0.0 { ends } else { apart };
    }
    let mut shares: Vec<f64> = edges(corners)
        .filter_map(|edge| crossing([from, to], edge))
        .chain([0.0, 1.0])
        .collect();
    shares.sort_by(f64::total_cmp);
    // Between two crossings the segment is inside or outside as a whole.
    let middles = shares.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let at = |share: f64| {
        let (x, z) = (to.0 - from.0, to.1 - from.1);
        (from.0 + share * x, from.1 + share * z)
    };
    middles
        .map(|share| depth(corners, at(share)))
        .fold(ends.min(0.0), f64::min)
}

/// Distance along a ray to an area \[m\], 0 inside.
fn range_to_area(corners: &[Point], from: Point, direction: Point) -> Option<f64> {
    if is_inside(from, corners) {
        return Some(0.0);
    }
    edges(corners)
        .filter_map(|edge| ray_to_segment(from, direction, edge))
        .reduce(f64::min)
}
