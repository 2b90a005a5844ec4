//! The world of one flight: everything that a flight core can only measure.

use crate::aircraft::Aircraft;
use crate::faults::FaultyLidar;
use crate::field::Field;
use crate::lidar::Lidar;
use crate::plant::Plant;
use crate::scenario::Scenario;
use mpp_core::vehicle::TrimError;

/// Aircraft, obstacles and lidar. A caller may replace each of them by another type.
pub struct World {
    /// The true aircraft, and the air that it flies in.
    pub plant: Box<dyn Plant>,
    /// The obstacles in the aircraft's way.
    pub field: Box<dyn Field>,
    /// The sensor that measures the distances to the obstacles.
    pub lidar: Box<dyn Lidar>,
}

impl World {
    /// The world that a scenario describes.
    ///
    /// # Errors
    /// [`TrimError`] when the core's airframe has no level flight to start from.
    pub fn of(scenario: &Scenario) -> Result<Self, TrimError> {
        let lidar = FaultyLidar::new(scenario.seed, scenario.lidar, scenario.faults.lidar);
        Ok(Self {
            plant: Box::new(Aircraft::new(scenario)?),
            field: Box::new(scenario.field()),
            lidar: Box::new(lidar),
        })
    }
}
