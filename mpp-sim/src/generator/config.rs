//! Names and parameters of generators.

use crate::field::Point;
use crate::names::by_name;
use serde::{Deserialize, Serialize};

/// The named generators.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GeneratorName {
    /// The paper's: circles of 1 m radius, evenly spaced, heights uniform within 10 m of the
    /// altitude.
    #[default]
    Paper,
    /// The paper's with heights within 12 m: up to the edge of the band and a radius more, so that
    /// no free lane runs along the edge.
    Sealed,
    /// Circles at random places, heights as in `sealed`, for as long as the flight lasts.
    Endless,
    /// Circles of many sizes in clusters.
    Forest,
    /// A winding way between ground and ceiling. Its bends are what is counted.
    Canyon,
    /// Walls that reach past the middle, from above and from below in turn.
    Slalom,
    /// Walls across the band, each with one gap.
    Walls,
    /// Thin circles, or thin bars if they have a length; heights as in `sealed`.
    Wires,
}

impl GeneratorName {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Paper,
        Self::Sealed,
        Self::Endless,
        Self::Forest,
        Self::Canyon,
        Self::Slalom,
        Self::Walls,
        Self::Wires,
    ];

    /// Its name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Sealed => "sealed",
            Self::Endless => "endless",
            Self::Forest => "forest",
            Self::Canyon => "canyon",
            Self::Slalom => "slalom",
            Self::Walls => "walls",
            Self::Wires => "wires",
        }
    }

    /// Whether it is the paper's.
    #[must_use]
    pub fn is_papers(&self) -> bool {
        *self == Self::Paper
    }

    /// The keys that it takes beside its name.
    #[must_use]
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Paper | Self::Sealed | Self::Endless => &["radius", "velocity"],
            Self::Forest => &["radius", "spread", "cluster", "velocity"],
            Self::Canyon => &["gap"],
            Self::Slalom | Self::Walls => &["radius", "gap"],
            Self::Wires => &["radius", "length", "velocity"],
        }
    }
}

by_name!(GeneratorName, "generator");

/// A generator and its parameters. Those that it does not take have no effect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Generator {
    /// Its name.
    pub name: GeneratorName,
    /// Radius of circles, half thickness of walls and bars \[m\]. Of `forest` it is the greatest.
    pub radius: f64,
    /// Free height \[m\]: of the canyon, of a gap in a wall, or from the end of a slalom's wall to the
    /// edge of the band.
    pub gap: f64,
    /// Standard deviation of the places in a cluster about its middle \[m\], along each axis.
    pub spread: f64,
    /// Obstacles of a cluster.
    pub cluster: usize,
    /// Length of bars \[m\]; 0 makes circles.
    pub length: f64,
    /// Velocity, downrange and up [m/s]; the seed decides for each obstacle whether it goes up or
    /// down. An obstacle is at its drawn place when an aircraft at 12 m/s comes there.
    pub velocity: Point,
}

impl Generator {
    /// The generator of the paper's fields.
    pub const PAPER: Self = Self {
        name: GeneratorName::Paper,
        radius: 1.0,
        gap: 0.0,
        spread: 0.0,
        cluster: 1,
        length: 0.0,
        velocity: (0.0, 0.0),
    };

    /// The generator with this name and its default parameters.
    #[must_use]
    pub fn named(name: GeneratorName) -> Self {
        let usual = Self {
            name,
            ..Self::PAPER
        };
        match name {
            GeneratorName::Paper | GeneratorName::Sealed | GeneratorName::Endless => usual,
            GeneratorName::Forest => Self {
                spread: 3.0,
                cluster: 5,
                ..usual
            },
            GeneratorName::Canyon => Self { gap: 8.0, ..usual },
            GeneratorName::Slalom => Self {
                radius: 0.5,
                gap: 9.0,
                ..usual
            },
            GeneratorName::Walls => Self {
                radius: 0.5,
                gap: 6.0,
                ..usual
            },
            GeneratorName::Wires => Self {
                radius: 0.05,
                ..usual
            },
        }
    }

    /// Whether it is the paper's, with the paper's parameters.
    #[must_use]
    pub fn is_papers(&self) -> bool {
        *self == Self::PAPER
    }
}
