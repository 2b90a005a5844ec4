//! The errors that leave a flight without an outcome.

use crate::file_error::ScenarioError;
use crate::link::LinkError;
use crate::plant::PlantError;
use mpp_core::planner::SetupError;
use mpp_core::vehicle::TrimError;

/// The reason why a flight has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum FlyError {
    /// The link failed.
    #[error("{0}")]
    Link(#[from] LinkError),
    /// The plant cannot fly the core's command.
    #[error("{0}")]
    Plant(#[source] PlantError),
    /// The airframe has no level flight to start from.
    #[error("the airframe has no level flight to start from: {0}")]
    Trim(TrimError),
    /// The flight in space cannot begin.
    #[error("{0}")]
    Scenario(#[source] ScenarioError),
    /// The planner cannot be set up.
    #[error("the planner cannot be set up: {0}")]
    SetUp(SetupError),
}
