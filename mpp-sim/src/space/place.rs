//! Where a flight in space takes place.

use super::scenario::SpaceFile;
use super::world::{ALTITUDE, Body, World, WorldConfig, WorldError, WorldName};
use crate::file_error::{ScenarioError, ensure};
use crate::names::{UnknownName, by_name};

/// What becomes of a plan without a way out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeName {
    /// It is flown: a forest has few.
    Forest,
    /// The plan before goes on to its way out. The band is wide enough for circles.
    Open,
}

impl ModeName {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Forest, Self::Open];

    /// The name, for scenarios and logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forest => "forest",
            Self::Open => "open",
        }
    }

    /// The name, unless it is the usual one.
    pub(super) fn written(self) -> Option<String> {
        (self != Self::Forest).then(|| self.name().to_owned())
    }
}

by_name!(ModeName, "mode");

/// Half the width of the band in mode `open` \[m\]: room for a circle to either side.
const OPEN_HALF_WIDTH: f64 = 60.0;

impl SpaceFile {
    /// The mode of the flight.
    pub(super) fn mode(&self) -> Result<ModeName, ScenarioError> {
        let mode = self.mode.as_deref().unwrap_or(ModeName::Forest.name());
        let mode: Result<ModeName, UnknownName> = mode.parse();
        mode.map_err(|error| ScenarioError::Value("mode", error.to_string()))
    }

    /// The world of a flight, with the name and the density of its generator if it has one.
    pub(super) fn world(
        &self,
        seed: u64,
        stems: Option<&[Body]>,
    ) -> Result<(World, Option<WorldName>, Option<f64>), ScenarioError> {
        let failed = |error: WorldError| ScenarioError::Value("world", error.to_string());
        let hills = WorldName::Hills.name();
        let over = self.terrain.is_some() || self.world.as_deref() == Some(hills);
        let advice = "leave it out: over level ground it is half of the ceiling";
        ensure(over || self.altitude.is_none(), "altitude", advice)?;
        if let Some(terrain) = &self.terrain {
            let alone = stems.is_none() && self.world.is_none() && self.density.is_none();
            let advice = "leave world, density and stem map out, or this height map";
            ensure(alone, "terrain", advice)?;
            let altitude = self.altitude.unwrap_or(ALTITUDE);
            let world = World::over(terrain.clone(), altitude).map_err(failed)?;
            return Ok((world, None, None));
        }
        if let Some(bodies) = stems {
            return Ok((
                World::of_stems(bodies.to_vec()).map_err(failed)?,
                None,
                None,
            ));
        }
        let name = self.world.as_deref().unwrap_or("forest");
        let name: WorldName = name
            .parse()
            .map_err(|error: UnknownName| ScenarioError::Value("world", error.to_string()))?;
        let mut config = WorldConfig::usual(name, seed);
        config.density = self.density.unwrap_or(config.density);
        config.window = self.window.unwrap_or(config.window);
        if self.mode()? == ModeName::Open {
            config.extent.half_width = OPEN_HALF_WIDTH;
        }
        config.altitude = self.altitude.unwrap_or(config.altitude);
        let world = config.build().map_err(failed)?;
        Ok((world, Some(name), Some(config.density)))
    }
}
