//! Worlds in space: the ground and solid bodies over it, with the questions that sensors and judges ask of them.
//!
//! Places are those of [`SpaceState`](super::SpaceState): x ahead, y to the *right*, z up \[m\]. A flight starts at x = y = 0.
//! The ground is level, at z = 0, or a [`Terrain`] that has this height at the start.
//!
//! Bodies stand in a grid of their own instead of a tree of `rstar` or `parry3d`: they are upright and evenly spread over the
//! ground, it takes 150 lines, and it needs no package.

mod asc;
mod body;
mod error;
mod figures;
mod gap;
mod generator;
mod grid;
mod hills;
mod stems;
mod terrain;
#[cfg(test)]
mod tests;

pub use asc::{GridError, ascii_grid};
pub use body::{Body, Vector};
pub use error::{FARTHEST, WorldError};
pub use generator::{WorldConfig, WorldName};
pub use hills::ALTITUDE;
pub use stems::{StemError, stems};
pub use terrain::Terrain;

pub(super) use body::{dot, length, minus, plus};
use grid::Grid;

/// Distance within which the nearest body is looked for first \[m\]; then within twice as much, and so on. More looks at bodies
/// in vain, less looks more often. Source: chosen, half of a cell.
const FIRST_REACH: f64 = 2.0;
/// Height of the start and of plans over level ground, as a share of the ceiling [-].
const LEVEL_ALTITUDE: f64 = 0.5;
/// Room between the highest ground, or the wanted height, and the ceiling \[m\]. Source: chosen.
const ABOVE: f64 = 20.0;
/// Greatest wanted height over terrain, above the start \[m\].
const HIGHEST: f64 = 1000.0;

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

/// The ground, bodies, and where to fly among them.
#[derive(Clone, Debug)]
pub struct World {
    bodies: Vec<Body>,
    extent: Extent,
    grid: Grid,
    ground: Option<Ground>,
}

/// Terrain, its greatest height, and the wanted one \[m\].
#[derive(Clone, Debug)]
struct Ground {
    terrain: Terrain,
    top: f64,
    altitude: f64,
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
            ground: None,
        })
    }

    /// The world of a height map: as long and as wide as the map, with the wanted height `altitude` above the ground at the
    /// start \[m\]. Heights count from there.
    ///
    /// # Errors
    /// [`WorldError::Value`] for a map that is none, or does not hold the start, and for a wanted height of 0 or less.
    pub fn over(terrain: Terrain, altitude: f64) -> Result<Self, WorldError> {
        terrain.check()?;
        if !(altitude > 0.0 && altitude <= HIGHEST) {
            let advice = format!("give more than 0 and at most {HIGHEST} m");
            let key = "altitude";
            return Err(WorldError::Value { key, advice });
        }
        let terrain = {
            let start = terrain.height(0.0, 0.0);
            terrain.lowered(start)
        };
        let ([length, right], [_, top]) = (terrain.far(), terrain.heights());
        let [_, left] = terrain.corner;
        let extent = Extent {
            length,
            half_width: right.min(-left),
            ceiling: top.max(altitude) + ABOVE,
        };
        let ground = Some(Ground {
            terrain,
            top,
            altitude,
        });
        let level = Self::new(Vec::new(), extent)?;
        Ok(Self { ground, ..level })
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
        let level = Self::new(bodies.collect(), self.extent)?;
        let ground = self.ground.clone();
        Ok(Self { ground, ..level })
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

    /// The ground, if it is not level.
    #[must_use]
    pub fn terrain(&self) -> Option<&Terrain> {
        self.ground.as_ref().map(|ground| &ground.terrain)
    }

    /// Height of the start and of plans \[m\].
    #[must_use]
    pub fn altitude(&self) -> f64 {
        let level = || LEVEL_ALTITUDE * self.extent.ceiling;
        (self.ground.as_ref()).map_or_else(level, |ground| ground.altitude)
    }

    /// Height of the ground \[m\].
    #[must_use]
    pub fn ground(&self, x: f64, y: f64) -> f64 {
        self.terrain().map_or(0.0, |terrain| terrain.height(x, y))
    }

    /// Way along a ray to the first body or the ground \[m\], if it is at most `most`. The direction has unit length.
    #[must_use]
    pub fn ray(&self, from: Vector, direction: Vector, most: f64) -> Option<f64> {
        let ([x, y, z], [ahead, right, up]) = (from, direction);
        let ground = match &self.ground {
            Some(Ground { terrain, top, .. }) => terrain.ray(from, direction, most, *top),
            None if z <= 0.0 => Some(0.0),
            None => (up < 0.0).then(|| z / -up),
        };
        let most = ground.map_or(most, |ground| ground.min(most));
        let hit = |number: usize| self.bodies[number].hit(from, direction);
        let body = self.grid.along([x, y], [ahead, right], most, hit);
        body.or(ground.filter(|way| *way <= most))
    }

    /// Distance of a point from the nearest body or the ground \[m\], at most `most`; 0 inside.
    #[must_use]
    pub fn clearance(&self, point: Vector, most: f64) -> f64 {
        let ground = self.clearance_of_ground(point, point, most);
        self.nearest(point, point, ground.min(most), |body| body.clearance(point))
    }

    /// Least distance of a segment from the ground \[m\]. Over terrain it is at most `most`.
    fn clearance_of_ground(&self, a: Vector, b: Vector, most: f64) -> f64 {
        match &self.ground {
            Some(Ground { terrain, top, .. }) => terrain.clearance(a, b, most, *top),
            None => a[2].max(0.0).min(b[2].max(0.0)),
        }
    }

    /// Least distance of a segment from the nearest body or the ground \[m\], at most `most`; 0 where they meet.
    #[must_use]
    pub fn clearance_of_segment(&self, a: Vector, b: Vector, most: f64) -> f64 {
        let ground = self.clearance_of_ground(a, b, most);
        let half = 0.5 * length(minus(b, a));
        let middle = plus(a, minus(b, a), 0.5);
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
