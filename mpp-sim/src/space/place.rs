//! Where a flight in space takes place.

use super::scenario::SpaceFile;
use super::world::{ALTITUDE, Body, World, WorldConfig, WorldError, WorldName};
use crate::file_error::{ScenarioError, ensure};

impl SpaceFile {
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
        let name: WorldName = name.parse().map_err(|error: crate::names::UnknownName| {
            ScenarioError::Value("world", error.to_string())
        })?;
        let mut config = WorldConfig::usual(name, seed);
        config.density = self.density.unwrap_or(config.density);
        config.window = self.window.unwrap_or(config.window);
        config.altitude = self.altitude.unwrap_or(config.altitude);
        let world = config.build().map_err(failed)?;
        Ok((world, Some(name), Some(config.density)))
    }
}
