//! `space --world`: how dense a world is, and where a wing hits it first.

use super::answer::{Failure, USAGE};
use super::values::world;
use crate::files::{read_stems, read_terrain};
use mpp_core::config::TICK_PERIOD;
use mpp_sim::space::world::{ALTITUDE, Terrain, World, WorldConfig, WorldName};
use mpp_sim::space::{Hull, SpaceState};
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, clap::Args)]
pub(super) struct WorldArgs {
    /// World to fly through, 240 m long, drawn from the seed
    #[arg(long, value_parser = world())]
    world: Option<WorldName>,
    /// Its density: trunks/m^2, walls or rows per m, or the spheres' share of the volume
    #[arg(long, requires = "world", value_name = "DENSITY")]
    density: Option<f64>,
    /// World to fly through: a CSV table of trunks with the columns x (ahead), y (right), diameter and perhaps height \[m\]
    #[arg(long, value_name = "FILE", conflicts_with = "world")]
    stems: Option<PathBuf>,
    /// World to fly over: an ESRI ASCII grid of heights \[m\], east ahead, coordinates from the start on
    #[arg(long, value_name = "FILE", conflicts_with_all = ["world", "stems"])]
    terrain: Option<PathBuf>,
}

/// What a world is, and what the wing met in it.
#[derive(Debug, Serialize)]
pub(super) struct Flown {
    bodies: usize,
    /// Highest ground \[m\], and the steepest slope along an axis; not of level ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    highest: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    steepest: Option<f64>,
    /// Of a level wing straight ahead; null if nothing is in its way.
    mean_free_path: Option<f64>,
    /// Null if there is no free place.
    traversability: Option<f64>,
    /// Null if the wing hits nothing within the length and the duration of the flight.
    first_hit: Option<Hit>,
}

/// Place of the aircraft and time of flight when the wing touches.
#[derive(Debug, Serialize)]
struct Hit {
    x: f64,
    y: f64,
    z: f64,
    t: f64,
}

impl fmt::Display for Flown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let metres = |value: Option<f64>| {
            value.map_or_else(|| "       -".to_owned(), |it| format!("{it:8.1} m"))
        };
        writeln!(f, "bodies              {:8}", self.bodies)?;
        if let (Some(highest), Some(slope)) = (self.highest, self.steepest) {
            writeln!(
                f,
                "highest ground      {highest:8.1} m, slopes up to {slope:.2}"
            )?;
        }
        writeln!(
            f,
            "mean free path      {}, level wing",
            metres(self.mean_free_path)
        )?;
        writeln!(f, "traversability      {}", metres(self.traversability))?;
        match &self.first_hit {
            None => write!(f, "first hit                  -"),
            Some(Hit { x, y, z, t }) => write!(
                f,
                "first hit           {x:8.1} m ahead, {y:.1} m to the right, {z:.1} m up, after {t:.2} s"
            ),
        }
    }
}

impl WorldArgs {
    /// Whether there is a world.
    pub(super) fn is_given(&self) -> bool {
        self.world.is_some() || self.stems.is_some() || self.terrain.is_some()
    }

    /// The world, if there is one.
    pub(super) fn build(&self, seed: u64) -> Result<Option<World>, Failure> {
        if let Some(path) = &self.stems {
            return of_stems(path).map(Some);
        }
        if let Some(path) = &self.terrain {
            let terrain = read_terrain(path).map_err(|error| Failure::new(USAGE, error))?;
            let world = World::over(terrain, ALTITUDE);
            return world.map(Some).map_err(|error| Failure::new(USAGE, error));
        }
        let Some(name) = self.world else {
            return Ok(None);
        };
        let usual = WorldConfig::usual(name, seed);
        let config = WorldConfig {
            density: self.density.unwrap_or(usual.density),
            ..usual
        };
        config
            .build()
            .map(Some)
            .map_err(|error| Failure::new(USAGE, error))
    }
}

/// The world of a stem map.
fn of_stems(path: &Path) -> Result<World, Failure> {
    let bodies = read_stems(path).map_err(|error| Failure::new(USAGE, error))?;
    World::of_stems(bodies).map_err(|error| Failure::new(USAGE, error))
}

impl Flown {
    /// Flies the wing along these states, from the wanted height on.
    pub(super) fn of(world: &World, span: f64, states: &[SpaceState]) -> Result<Self, Failure> {
        let hull = Hull::wing(span);
        let height = world.altitude();
        let start = states.first().map_or(0.0, |it| it.plane.z);
        let at_height = |state: &SpaceState| {
            let mut state = *state;
            state.plane.z += height - start;
            state
        };
        let states: Vec<SpaceState> = states.iter().map(at_height).collect();
        if let Some(first) = states.first() {
            hull.check_start(world, first)
                .map_err(|error| Failure::new(USAGE, error))?;
        }
        let length = world.extent().length;
        let within = states.iter().take_while(|it| it.plane.x <= length);
        let ticks = (1..).zip(states.windows(2).take(within.count()));
        let first_hit = ticks.into_iter().find_map(|(tick, pair)| {
            let [from, to] = pair else { return None };
            let share = hull.first_contact(world, from, to)?;
            let between = |a: f64, b: f64| a + share * (b - a);
            Some(Hit {
                x: between(from.plane.x, to.plane.x),
                y: between(from.lateral.y, to.lateral.y),
                z: between(from.plane.z, to.plane.z),
                t: (f64::from(tick) + share) * TICK_PERIOD,
            })
        });
        Ok(Self {
            bodies: world.bodies().len(),
            highest: world.terrain().map(|it| it.heights()[1]),
            steepest: world.terrain().map(Terrain::steepest),
            mean_free_path: world.mean_free_path(0.5 * span, height),
            traversability: world.traversability(height),
            first_hit,
        })
    }
}
