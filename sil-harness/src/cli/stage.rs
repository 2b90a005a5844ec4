//! Who flies in space, and through what: the flags that all commands there share.

use super::answer::Failure;
use super::help::{PLANNER, WORLD};
use super::values::{number, world};
use crate::files::read_aircraft;
use mpp_sim::space::world::WorldName;
use mpp_sim::space::{SPACE, SpaceFile};

#[derive(Clone, Debug, clap::Args)]
pub(super) struct Stage {
    /// Fly in space
    #[arg(long, help_heading = PLANNER, value_parser = [SPACE])]
    preset: Option<String>,
    /// Aircraft with a lateral table: a name or a file [default: ultrastick at 13 m/s]
    #[arg(long, help_heading = WORLD, value_name = "NAME|FILE")]
    aircraft: Option<String>,
    /// Airspeed of level flight [m/s] [default: that of the aircraft's file]
    #[arg(long, help_heading = WORLD, value_name = "M/S", value_parser = number)]
    airspeed: Option<f64>,
    /// World of 240 m, drawn from the seed [default: forest]
    #[arg(long, help_heading = WORLD, value_parser = world())]
    world: Option<WorldName>,
    /// Radius of a sphere that stands for wing and fuselage [m]
    #[arg(long, help_heading = WORLD, value_name = "M", value_parser = number)]
    sphere: Option<f64>,
}

impl Stage {
    /// The keys of these flags.
    pub(super) fn file(&self) -> Result<SpaceFile, Failure> {
        let aircraft = self.aircraft.as_ref().map(|name| read_aircraft(name));
        Ok(SpaceFile {
            preset: self.preset.clone(),
            aircraft: aircraft.transpose().map_err(Failure::usage)?,
            airspeed: self.airspeed,
            world: self.world.map(|world| world.name().to_owned()),
            sphere: self.sphere,
            ..SpaceFile::default()
        })
    }
}
