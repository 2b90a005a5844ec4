//! Solid bodies in space: what a ray meets, and how far a point or a segment is from them. All of them are convex.

use serde::Serialize;

/// A place or a direction: ahead, to the right, up \[m\].
pub type Vector = [f64; 3];

/// A solid body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Body {
    /// A trunk, a pier or a mast: a vertical cylinder from below the ground up to its height.
    Cylinder {
        /// Axis, ahead \[m\].
        x: f64,
        /// Axis, to the right \[m\].
        y: f64,
        /// Radius \[m\].
        radius: f64,
        /// Height of its top \[m\]; infinite if nothing flies over it.
        height: f64,
    },
    /// A branch or a wire: every point within the radius of a segment.
    Capsule {
        /// One end of the segment.
        from: Vector,
        /// The other end.
        to: Vector,
        /// Radius \[m\].
        radius: f64,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        centre: Vector,
        /// Radius \[m\].
        radius: f64,
    },
    /// A wall, a house or the deck of a bridge: a box along the axes. Its top may be infinite.
    Box {
        /// Corner with the least coordinates.
        least: Vector,
        /// Corner with the greatest ones.
        most: Vector,
    },
}

/// Halvings of a segment, until its nearest point is known to `2^-50` of its length.
const HALVINGS: usize = 50;
/// Share of a direction [-] below which it has no such component: squares of it vanish beside 1.
const PARALLEL: f64 = 1e-18;

impl Body {
    /// Least and greatest x and y.
    pub(super) fn outline(&self) -> [[f64; 2]; 2] {
        let round = |[x, y]: [f64; 2], r: f64| [[x - r, y - r], [x + r, y + r]];
        match *self {
            Self::Cylinder { x, y, radius, .. } => round([x, y], radius),
            Self::Sphere {
                centre: [x, y, _],
                radius,
            } => round([x, y], radius),
            Self::Box { least, most } => [[least[0], least[1]], [most[0], most[1]]],
            Self::Capsule { from, to, radius } => [
                [0, 1].map(|axis| from[axis].min(to[axis]) - radius),
                [0, 1].map(|axis| from[axis].max(to[axis]) + radius),
            ],
        }
    }

    /// Why it cannot stand in a world: a key, and what to give instead. `farthest` is the greatest coordinate \[m\].
    pub(super) fn flaw(&self, farthest: f64) -> Option<(&'static str, String)> {
        let near = |values: &[f64]| values.iter().all(|it| it.abs() <= farthest);
        let place = |key, sound: bool| {
            (!sound).then(|| (key, format!("give numbers of at most {farthest} m")))
        };
        let size = |key, value: f64| {
            let sound = value > 0.0 && value <= farthest;
            (!sound).then(|| (key, format!("give more than 0 and at most {farthest} m")))
        };
        match *self {
            Self::Cylinder {
                x,
                y,
                radius,
                height,
            } => place("x and y", near(&[x, y]))
                .or_else(|| size("radius", radius))
                .or_else(|| {
                    let advice = || "give more than 0 m, or inf".to_owned();
                    (height.is_nan() || height <= 0.0).then(|| ("height", advice()))
                }),
            Self::Sphere { centre, radius } => {
                place("centre", near(&centre)).or_else(|| size("radius", radius))
            }
            Self::Capsule { from, to, radius } => {
                place("from and to", near(&from) && near(&to)).or_else(|| size("radius", radius))
            }
            Self::Box { least, most } => {
                let sound = near(&least) && near(&most[..2]) && !most[2].is_nan();
                let ordered = (0..3).all(|axis| least[axis] < most[axis]);
                place("least and most", sound).or_else(|| {
                    let advice = "give more than `least` on each axis".to_owned();
                    (!ordered).then_some(("most", advice))
                })
            }
        }
    }

    /// Way along a ray with a direction of unit length until it is in the body \[m\]; 0 if it begins there.
    #[must_use]
    pub fn hit(&self, from: Vector, direction: Vector) -> Option<f64> {
        match *self {
            Self::Cylinder {
                x,
                y,
                radius,
                height,
            } => {
                let flat = |[x, y, _]: Vector| [x, y, 0.0];
                let offset = flat(minus(from, [x, y, 0.0]));
                let round = within_radius(offset, flat(direction), radius)?;
                let below = within_slab(from[2], direction[2], f64::NEG_INFINITY, height)?;
                entry(both(round, below))
            }
            Self::Sphere { centre, radius } => {
                entry(within_radius(minus(from, centre), direction, radius)?)
            }
            Self::Capsule {
                from: one,
                to,
                radius,
            } => {
                let ball = |end| within_radius(minus(from, end), direction, radius).and_then(entry);
                let ends = earlier(ball(one), ball(to));
                earlier(ends, between_ends([one, to], radius, from, direction))
            }
            Self::Box { least, most } => {
                let mut inside = (f64::NEG_INFINITY, f64::INFINITY);
                for axis in 0..3 {
                    let slab = within_slab(from[axis], direction[axis], least[axis], most[axis]);
                    inside = both(inside, slab?);
                }
                entry(inside)
            }
        }
    }

    /// The way from the nearest point of the body to a point; zero inside.
    #[must_use]
    pub fn separation(&self, point: Vector) -> Vector {
        match *self {
            Self::Cylinder {
                x,
                y,
                radius,
                height,
            } => {
                let [x, y, _] = outside(minus(point, [x, y, point[2]]), radius);
                [x, y, (point[2] - height).max(0.0)]
            }
            Self::Sphere { centre, radius } => outside(minus(point, centre), radius),
            Self::Capsule { from, to, radius } => {
                outside(minus(point, nearest_of_segment(from, to, point)), radius)
            }
            Self::Box { least, most } => {
                [0, 1, 2].map(|axis| point[axis] - point[axis].max(least[axis]).min(most[axis]))
            }
        }
    }

    /// Distance of a point from the body \[m\]; 0 inside.
    #[must_use]
    pub fn clearance(&self, point: Vector) -> f64 {
        length(self.separation(point))
    }

    /// Least distance of a segment from the body \[m\]; 0 where they meet.
    #[must_use]
    pub fn clearance_of_segment(&self, a: Vector, b: Vector) -> f64 {
        match *self {
            Self::Cylinder { x, y, height, .. } if a[2].max(b[2]) <= height => {
                let flat = |[x, y, _]: Vector| [x, y, 0.0];
                self.clearance(nearest_of_segment(flat(a), flat(b), [x, y, 0.0]))
            }
            Self::Sphere { centre, .. } => self.clearance(nearest_of_segment(a, b, centre)),
            _ => by_halving(a, b, |point| self.separation(point)),
        }
    }
}

/// Least distance of a segment from a convex body, given the way from its nearest point to a point: the distance is convex along
/// the segment, and its slope is that of the separation.
pub(super) fn by_halving(a: Vector, b: Vector, separation: impl Fn(Vector) -> Vector) -> f64 {
    let along = minus(b, a);
    let (start, end) = (separation(a), separation(b));
    if dot(start, along) >= 0.0 {
        return length(start);
    }
    if dot(end, along) <= 0.0 {
        return length(end);
    }
    let (mut low, mut high) = (0.0, 1.0);
    let mut least = length(start).min(length(end));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let apart = separation(plus(a, along, middle));
        least = least.min(length(apart));
        if dot(apart, along) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    least
}

/// `a + t b`.
pub(in crate::space) fn plus(a: Vector, b: Vector, t: f64) -> Vector {
    [0, 1, 2].map(|axis| a[axis] + t * b[axis])
}

/// `a - b`.
pub(in crate::space) fn minus(a: Vector, b: Vector) -> Vector {
    plus(a, b, -1.0)
}

pub(in crate::space) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Length of a vector.
pub(in crate::space) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// What a vector has beyond a radius.
fn outside(offset: Vector, radius: f64) -> Vector {
    let distance = length(offset);
    let share = if distance > radius {
        (distance - radius) / distance
    } else {
        0.0
    };
    offset.map(|part| share * part)
}

/// The point of a segment that is nearest to a point.
pub(super) fn nearest_of_segment(a: Vector, b: Vector, point: Vector) -> Vector {
    let along = minus(b, a);
    let square = dot(along, along);
    let share = if square > 0.0 {
        (dot(minus(point, a), along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    plus(a, along, share)
}

/// The part of a ray that is in a body: the ways to its two ends.
type Inside = (f64, f64);

fn both(one: Inside, other: Inside) -> Inside {
    (one.0.max(other.0), one.1.min(other.1))
}

/// Where a ray enters, if it does so ahead.
fn entry((enters, leaves): Inside) -> Option<f64> {
    (enters <= leaves && leaves >= 0.0).then_some(enters.max(0.0))
}

fn earlier(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).reduce(f64::min)
}

/// Where `offset + t direction` is not longer than the radius.
fn within_radius(offset: Vector, direction: Vector, radius: f64) -> Option<Inside> {
    let a = dot(direction, direction);
    let c = dot(offset, offset) - radius * radius;
    if a < PARALLEL {
        return (c <= 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let b = dot(offset, direction);
    let square = b * b - a * c;
    if square < 0.0 {
        return None;
    }
    let root = square.sqrt();
    Some(((-b - root) / a, (-b + root) / a))
}

/// Where `from + t direction` is between two values.
fn within_slab(from: f64, direction: f64, low: f64, high: f64) -> Option<Inside> {
    if direction == 0.0 {
        let inside = low <= from && from <= high;
        return inside.then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (one, other) = ((low - from) / direction, (high - from) / direction);
    Some((one.min(other), one.max(other)))
}

/// Where a ray enters the cylinder between the ends of a capsule.
fn between_ends([a, b]: [Vector; 2], radius: f64, from: Vector, direction: Vector) -> Option<f64> {
    let reach = length(minus(b, a));
    if reach == 0.0 {
        return None;
    }
    let axis = minus(b, a).map(|part| part / reach);
    let offset = minus(from, a);
    let (along, pace) = (dot(offset, axis), dot(direction, axis));
    let aside = |vector, along: f64| plus(vector, axis, -along);
    let round = within_radius(aside(offset, along), aside(direction, pace), radius)?;
    entry(both(round, within_slab(along, pace, 0.0, reach)?))
}
