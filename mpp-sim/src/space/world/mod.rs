//! Worlds in space: the ground and solid bodies over it, with the questions that sensors and judges ask of them.
//!
//! Places are those of [`SpaceState`](super::SpaceState): x ahead, y to the *right*, z up \[m\]. A flight starts at x = y = 0.
//! The ground is level, at z = 0.
//!
//! Bodies stand in a grid of their own instead of a tree of `rstar` or `parry3d`: they are upright and evenly spread over the
//! ground, it takes 150 lines, and it needs no package.

mod body;
mod figures;
mod gap;
mod generator;
mod grid;
mod stems;
#[cfg(test)]
mod tests;

pub use body::{Body, Vector};
pub use generator::{WorldConfig, WorldName};
pub use stems::{StemError, stems};

use body::plus;
use grid::Grid;

/// Greatest coordinate of a body \[m\]: that of field files.
pub const FARTHEST: f64 = 1e5;

/// Distance within which the nearest body is looked for first \[m\]; then within twice as much, and so on. More looks at bodies
/// in vain, less looks more often. Source: chosen, half of a cell.
const FIRST_REACH: f64 = 2.0;

/// Where an aircraft is to fly. Nothing solid stands at these limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Way ahead \[m\].
    pub length: f64,
    /// Greatest distance to either side \[m\].
    pub half_width: f64,
    /// Greatest height \[m\].
    pub ceiling: f64,
}

impl Extent {
    /// 240 m ahead, 30 m to either side, 15 m up.
    pub const USUAL: Self = Self {
        length: 240.0,
        half_width: 30.0,
        ceiling: 15.0,
    };
}

/// The reason why there is no world.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A body is unsound.
    #[error("body {number}, {key}: {advice}")]
    Body {
        /// Its number, from 1.
        number: usize,
        /// The value at fault.
        key: &'static str,
        /// What to do.
        advice: String,
    },
    /// A parameter of a generator or of the extent is unsound.
    #[error("{key}: {advice}")]
    Value {
        /// The parameter.
        key: &'static str,
        /// What to do.
        advice: String,
    },
    /// The aircraft would start in a body.
    #[error("the aircraft touches a body or the ground at its start: move the bodies or the start")]
    Start,
}

/// The ground, bodies, and where to fly among them.
#[derive(Clone, Debug)]
pub struct World {
    bodies: Vec<Body>,
    extent: Extent,
    grid: Grid,
}

impl World {
    /// The world of these bodies.
    ///
    /// # Errors
    /// [`WorldError`] for the first body that is not finite in x and y, or has no size, and for an extent without size.
    pub fn new(bodies: Vec<Body>, extent: Extent) -> Result<Self, WorldError> {
        let Extent {
            length,
            half_width,
            ceiling,
        } = extent;
        for (key, value) in [
            ("length", length),
            ("half width", half_width),
            ("ceiling", ceiling),
        ] {
            if !(value > 0.0 && value <= FARTHEST) {
                let advice = format!("give more than 0 and at most {FARTHEST} m");
                return Err(WorldError::Value { key, advice });
            }
        }
        for (number, body) in (1..).zip(&bodies) {
            if let Some((key, advice)) = body.flaw(FARTHEST) {
                return Err(WorldError::Body {
                    number,
                    key,
                    advice,
                });
            }
        }
        let outlines: Vec<_> = bodies.iter().map(Body::outline).collect();
        Ok(Self {
            grid: Grid::new(&outlines),
            bodies,
            extent,
        })
    }

    /// The world of a stem map: as long and as wide as its trunks reach.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_stems(bodies: Vec<Body>) -> Result<Self, WorldError> {
        let axes = bodies.iter().filter_map(|body| match body {
            Body::Cylinder { x, y, .. } => Some([*x, y.abs()]),
            _ => None,
        });
        let [length, half_width] = axes.fold([1.0_f64; 2], |most, at| {
            [most[0].max(at[0]), most[1].max(at[1])]
        });
        let extent = Extent {
            length,
            half_width,
            ..Extent::USUAL
        };
        Self::new(bodies, extent)
    }

    /// This world and one more body.
    ///
    /// # Errors
    /// [`WorldError::Body`], as [`Self::new`].
    pub fn with(&self, body: Body) -> Result<Self, WorldError> {
        let bodies = self.bodies.iter().copied().chain([body]);
        Self::new(bodies.collect(), self.extent)
    }

    /// Its bodies.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Where to fly.
    #[must_use]
    pub fn extent(&self) -> &Extent {
        &self.extent
    }

    /// Height of the ground \[m\].
    #[must_use]
    pub fn ground(&self, _x: f64, _y: f64) -> f64 {
        0.0
    }

    /// Way along a ray to the first body or the ground \[m\], if it is at most `most`. The direction has unit length.
    #[must_use]
    pub fn ray(&self, from: Vector, direction: Vector, most: f64) -> Option<f64> {
        let ([x, y, z], [ahead, right, up]) = (from, direction);
        let height = z - self.ground(x, y);
        let ground = if height <= 0.0 {
            Some(0.0)
        } else {
            (up < 0.0).then(|| height / -up)
        };
        let most = ground.map_or(most, |ground| ground.min(most));
        let hit = |number: usize| self.bodies[number].hit(from, direction);
        let body = self.grid.along([x, y], [ahead, right], most, hit);
        body.or(ground.filter(|way| *way <= most))
    }

    /// Distance of a point from the nearest body or the ground \[m\], at most `most`; 0 inside.
    #[must_use]
    pub fn clearance(&self, point: Vector, most: f64) -> f64 {
        let [x, y, z] = point;
        let ground = (z - self.ground(x, y)).max(0.0);
        self.nearest(point, point, ground.min(most), |body| body.clearance(point))
    }

    /// Least distance of a segment from the nearest body or the ground \[m\], at most `most`; 0 where they meet.
    #[must_use]
    pub fn clearance_of_segment(&self, a: Vector, b: Vector, most: f64) -> f64 {
        let height = |[x, y, z]: Vector| (z - self.ground(x, y)).max(0.0);
        let ground = height(a).min(height(b));
        let half = 0.5 * body::length(body::minus(b, a));
        let middle = plus(a, body::minus(b, a), 0.5);
        self.nearest(a, b, ground.min(most), |body| {
            // No point of the segment is nearer than this; most bodies need no more.
            let least = body.clearance(middle) - half;
            if least >= most {
                most
            } else {
                body.clearance_of_segment(a, b)
            }
        })
    }

    /// The least of `most` and the distances of the bodies from something between two points. Looks near first.
    fn nearest(&self, a: Vector, b: Vector, most: f64, distance: impl Fn(&Body) -> f64) -> f64 {
        let mut reach = FIRST_REACH;
        loop {
            let reached = reach.min(most);
            let least = [0, 1].map(|axis| a[axis].min(b[axis]) - reached);
            let far = [0, 1].map(|axis| a[axis].max(b[axis]) + reached);
            let near = self.grid.near(least, far);
            let found = near.map(|number| distance(&self.bodies[number]));
            let nearest = found.fold(most, f64::min);
            if nearest <= reached {
                return nearest;
            }
            reach *= 2.0;
        }
    }
}
