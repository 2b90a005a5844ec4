//! Worlds by name, density and seed.

use super::body::Body;
use super::hills::{ALTITUDE, hills};
use super::{Extent, World, WorldError};
use crate::names::{self, UnknownName};
use crate::random::{self, Draws, Stream, uniform};
use core::f64::consts::PI;
use core::fmt;
use core::str::FromStr;

/// Distance around the start without a trunk or a sphere \[m\]. Less leaves no room for a first turn. Source: chosen.
const FREE: f64 = 15.0;
/// How far bodies stand beyond the extent \[m\]: behind the start, beyond the end, and to either side. With less the forest has
/// an edge that a sensor sees. Source: chosen, the sight of the lidars beyond the end.
const BEHIND: f64 = 10.0;
const BEYOND: f64 = 60.0;
const BESIDE: f64 = 10.0;
/// Least and greatest radius of a trunk \[m\]. Source: chosen, as trunks of 60-year-old pines and spruces.
const TRUNK: [f64; 2] = [0.15, 0.4];
/// Radius of a sphere \[m\]: that of the paper's circles.
const SPHERE: f64 = 1.0;
/// Least distance of the trunks of `disc` as a share of the side of the square that each has. The places of random discs run
/// out at 0.83. Source: chosen, so that the least distances of AvoidBench's forests, 2.1 to 5.3 m, are densities of 0.13 to 0.02.
const DISC_SHARE: f64 = 0.75;
/// Places drawn for each trunk of `disc` before fewer must do.
const TRIES: usize = 100;
/// Half of the thickness of a wall, and the usual side of its window and its limits \[m\]. Source: chosen.
const HALF_THICKNESS: f64 = 0.25;
const WINDOW: f64 = 5.0;
const WINDOWS: [f64; 2] = [0.5, 10.0];
/// Most that a window is moved from the one before, sideways and in height \[m\]. More asks for steeper turns. Source: chosen.
const MOVES: [f64; 2] = [6.0, 3.0];
/// Distance of the trunks in a row of `slalom` \[m\]: no wing fits between. Their radius is 0.3 m.
const ROW: f64 = 0.8;
/// How far a row of `slalom` reaches past the middle \[m\], least and greatest. Source: chosen.
const PAST: [f64; 2] = [0.0, 4.0];
/// Most bodies of a world. They take 64 MB.
const MOST_BODIES: f64 = 1e6;

/// The named generators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WorldName {
    /// Trunks at places that know nothing of each other (Poisson).
    Forest,
    /// Trunks in a square grid, each moved by at most half of the spacing.
    Grid,
    /// Trunks with a least distance from each other (Poisson disc).
    Disc,
    /// Spheres of 1 m radius.
    Spheres,
    /// Walls across the way, each with one window.
    Walls,
    /// Rows of trunks from the right and from the left in turn, past the middle.
    Slalom,
    /// Hills, and nothing else.
    Hills,
}

impl WorldName {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Forest,
        Self::Grid,
        Self::Disc,
        Self::Spheres,
        Self::Walls,
        Self::Slalom,
        Self::Hills,
    ];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forest => "forest",
            Self::Grid => "grid",
            Self::Disc => "disc",
            Self::Spheres => "spheres",
            Self::Walls => "walls",
            Self::Slalom => "slalom",
            Self::Hills => "hills",
        }
    }

    /// What its density counts.
    #[must_use]
    pub fn density_unit(self) -> &'static str {
        match self {
            Self::Forest | Self::Grid | Self::Disc => "trunks/m^2",
            Self::Spheres => "share of the volume",
            Self::Walls => "walls/m",
            Self::Slalom => "rows/m",
            Self::Hills => "steepest slope",
        }
    }

    /// The usual density: a trunk in 25 m^2, the paper's share, a wall every 40 m, slopes of 27 deg.
    #[must_use]
    pub fn usual_density(self) -> f64 {
        match self {
            Self::Forest | Self::Grid | Self::Disc => 0.04,
            Self::Spheres => 0.029,
            Self::Walls | Self::Slalom => 0.025,
            Self::Hills => 0.5,
        }
    }

    /// The greatest density: beyond it nothing flies, or the bodies of neighbours meet.
    fn most_density(self) -> f64 {
        match self {
            Self::Forest | Self::Grid | Self::Disc => 1.0,
            Self::Spheres => 0.5,
            Self::Walls | Self::Slalom => 0.2,
            Self::Hills => 1.5,
        }
    }
}

impl fmt::Display for WorldName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for WorldName {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        names::find("world", &Self::ALL, Self::name, text)
    }
}

/// What a world is drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldConfig {
    /// Its generator.
    pub name: WorldName,
    /// How dense it is, in the unit of the generator.
    pub density: f64,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Where to fly.
    pub extent: Extent,
    /// Side of the window of a wall \[m\].
    pub window: f64,
    /// Wanted height over hills, above the ground at the start \[m\].
    pub altitude: f64,
}

impl WorldConfig {
    /// The world of this name with its usual density and extent.
    #[must_use]
    pub fn usual(name: WorldName, seed: u64) -> Self {
        Self {
            name,
            density: name.usual_density(),
            seed,
            extent: Extent::USUAL,
            window: WINDOW,
            altitude: ALTITUDE,
        }
    }

    /// Draws the world.
    ///
    /// # Errors
    /// [`WorldError::Value`] for a density, a window or an extent that no world has.
    pub fn build(&self) -> Result<World, WorldError> {
        let most = self.name.most_density();
        if !(self.density > 0.0 && self.density <= most) {
            let unit = self.name.density_unit();
            let advice = format!("give more than 0 and at most {most} ({unit})");
            return Err(WorldError::Value {
                key: "density",
                advice,
            });
        }
        let [least, most] = WINDOWS;
        if !(least..=most).contains(&self.window) {
            let (key, advice) = ("window", format!("give {least} to {most} m"));
            return Err(WorldError::Value { key, advice });
        }
        // An unsound extent is refused before anything is drawn over it.
        World::new(Vec::new(), self.extent)?;
        if self.expected() > MOST_BODIES {
            let advice = format!("it would have more than {MOST_BODIES} bodies: give less");
            return Err(WorldError::Value {
                key: "density",
                advice,
            });
        }
        let mut draws = random::generator(self.seed, Stream::Bodies);
        if self.name == WorldName::Hills {
            let wanted = [self.density, self.altitude];
            return hills(wanted, self.extent, self.area(), FREE, &mut draws);
        }
        World::new(self.bodies(&mut draws), self.extent)
    }

    /// Where bodies stand: the least and the greatest x, and the greatest y.
    fn area(&self) -> [f64; 3] {
        let Extent {
            length, half_width, ..
        } = self.extent;
        [-BEHIND, length + BEYOND, half_width + BESIDE]
    }

    /// About how many bodies there will be.
    fn expected(&self) -> f64 {
        let [first, last, half] = self.area();
        match self.name {
            WorldName::Forest | WorldName::Grid | WorldName::Disc => {
                self.density * (last - first) * 2.0 * half
            }
            WorldName::Spheres => self.spheres_per_metre() * (last - first),
            WorldName::Walls => self.density * last * 4.0,
            WorldName::Slalom => self.density * last * 2.0 * half / ROW,
            WorldName::Hills => 0.0,
        }
    }

    /// Independent spheres overlap; their number is that which fills the share.
    fn spheres_per_metre(&self) -> f64 {
        let volume = 4.0 / 3.0 * PI * SPHERE * SPHERE * SPHERE;
        let [.., half] = self.area();
        -libm::log(1.0 - self.density) / volume * 2.0 * half * (self.extent.ceiling + SPHERE)
    }

    fn bodies(&self, draws: &mut Draws) -> Vec<Body> {
        match self.name {
            WorldName::Forest => {
                let [.., half] = self.area();
                let places = self.along(self.density * 2.0 * half, draws);
                places
                    .into_iter()
                    .filter_map(|at| trunk(at, draws))
                    .collect()
            }
            WorldName::Grid => self.grid(draws),
            WorldName::Disc => self.disc(draws),
            WorldName::Spheres => self.spheres(draws),
            WorldName::Walls => self.walls(draws),
            WorldName::Slalom => self.slalom(draws),
            WorldName::Hills => Vec::new(),
        }
    }

    /// Places of a Poisson process, `rate` of them on a metre ahead.
    fn along(&self, rate: f64, draws: &mut Draws) -> Vec<[f64; 2]> {
        let [mut x, last, half] = self.area();
        let mut places = Vec::new();
        loop {
            x -= libm::log(1.0 - uniform(draws)) / rate;
            if x > last {
                return places;
            }
            places.push([x, between([-half, half], draws)]);
        }
    }

    fn grid(&self, draws: &mut Draws) -> Vec<Body> {
        let [first, last, half] = self.area();
        let spacing = 1.0 / self.density.sqrt();
        let (columns, rows) = ((last - first) / spacing, 2.0 * half / spacing);
        let mut bodies = Vec::new();
        for column in 0..columns as usize {
            for row in 0..rows as usize {
                // Each stands anywhere in its square.
                let x = first + spacing * (column as f64 + uniform(draws));
                let y = spacing * (row as f64 + uniform(draws)) - half;
                bodies.extend(trunk([x, y], draws));
            }
        }
        bodies
    }

    fn disc(&self, draws: &mut Draws) -> Vec<Body> {
        let [first, last, half] = self.area();
        let distance = DISC_SHARE / self.density.sqrt();
        let count = self.expected() as usize;
        // Strips as wide as the distance, so that only three of them can hold a neighbour.
        let strips = ((last - first) / distance) as usize + 3;
        let mut taken: Vec<Vec<[f64; 2]>> = vec![Vec::new(); strips];
        let mut places = Vec::new();
        for _ in 0..TRIES * count {
            let x = between([first, last], draws);
            let at = [x, between([-half, half], draws)];
            let strip = ((x - first) / distance) as usize + 1;
            let near = |other: &[f64; 2]| {
                let [x, y] = [at[0] - other[0], at[1] - other[1]];
                x * x + y * y < distance * distance
            };
            if taken[strip - 1..=strip + 1].iter().flatten().any(near) {
                continue;
            }
            taken[strip].push(at);
            places.push(at);
            if places.len() >= count {
                break;
            }
        }
        places
            .into_iter()
            .filter_map(|at| trunk(at, draws))
            .collect()
    }

    fn spheres(&self, draws: &mut Draws) -> Vec<Body> {
        let top = self.extent.ceiling + SPHERE;
        let places = self.along(self.spheres_per_metre(), draws);
        let spheres = places.into_iter().filter_map(|[x, y]| {
            let centre = [x, y, between([0.0, top], draws)];
            is_free([x, y], SPHERE).then_some(Body::Sphere {
                centre,
                radius: SPHERE,
            })
        });
        spheres.collect()
    }

    fn walls(&self, draws: &mut Draws) -> Vec<Body> {
        let [_, last, side] = self.area();
        let Extent {
            half_width,
            ceiling,
            ..
        } = self.extent;
        let half = 0.5 * self.window;
        // The window stays within the extent, and a quarter of it above the ground.
        let most = (half_width - half).max(0.0);
        let heights = [1.5 * half, (ceiling - half).max(1.5 * half)];
        let (mut y, mut z) = (0.0, (0.5 * ceiling).max(heights[0]));
        let mut bodies = Vec::new();
        for number in 1..=(last * self.density) as usize {
            let x = number as f64 / self.density;
            y = moved(y, MOVES[0], [-most, most], draws);
            z = moved(z, MOVES[1], heights, draws);
            let part = |[left, right]: [f64; 2], [low, high]: [f64; 2]| Body::Box {
                least: [x - HALF_THICKNESS, left, low],
                most: [x + HALF_THICKNESS, right, high],
            };
            let (across, up) = ([y - half, y + half], [0.0, f64::INFINITY]);
            bodies.extend([
                part([-side, across[0]], up),
                part([across[1], side], up),
                part(across, [0.0, z - half]),
                part(across, [z + half, f64::INFINITY]),
            ]);
        }
        bodies
    }

    fn slalom(&self, draws: &mut Draws) -> Vec<Body> {
        let [_, last, side] = self.area();
        let first_side = if uniform(draws) < 0.5 { 1.0 } else { -1.0 };
        let mut bodies = Vec::new();
        for number in 1..=(last * self.density) as usize {
            let sign = if number % 2 == 0 {
                -first_side
            } else {
                first_side
            };
            let past = between(PAST, draws);
            let trunks = ((side + past) / ROW) as usize + 1;
            bodies.extend((0..trunks).map(|trunk| Body::Cylinder {
                x: number as f64 / self.density,
                y: sign * (ROW * trunk as f64 - past),
                radius: 0.3,
                height: f64::INFINITY,
            }));
        }
        bodies
    }
}

fn between([least, most]: [f64; 2], draws: &mut Draws) -> f64 {
    least + (most - least) * uniform(draws)
}

/// `from`, moved by at most `by`, within limits.
fn moved(from: f64, by: f64, [least, most]: [f64; 2], draws: &mut Draws) -> f64 {
    (from + between([-by, by], draws)).max(least).min(most)
}

fn is_free([x, y]: [f64; 2], radius: f64) -> bool {
    libm::hypot(x, y) >= FREE + radius
}

/// A trunk of random radius, unless it stands near the start.
fn trunk([x, y]: [f64; 2], draws: &mut Draws) -> Option<Body> {
    let radius = between(TRUNK, draws);
    is_free([x, y], radius).then_some(Body::Cylinder {
        x,
        y,
        radius,
        height: f64::INFINITY,
    })
}
