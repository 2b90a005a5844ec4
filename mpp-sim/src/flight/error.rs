//! The errors that leave a flight without an outcome.

use crate::link::LinkError;
use crate::plant::PlantError;
use mpp_core::planner::SetupError;
use mpp_core::vehicle::TrimError;
use std::fmt;

/// The reason why a flight has no outcome.
#[derive(Debug)]
pub enum FlyError {
    /// The link failed.
    Link(LinkError),
    /// The plant cannot fly the core's command.
    Plant(PlantError),
    /// The airframe has no level flight to start from.
    Trim(TrimError),
    /// The planner cannot be set up.
    SetUp(SetupError),
}

impl fmt::Display for FlyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Link(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Trim(error) => {
                write!(f, "the airframe has no level flight to start from: {error}")
            }
            Self::SetUp(error) => write!(f, "the planner cannot be set up: {error}"),
        }
    }
}

impl core::error::Error for FlyError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Link(error) => Some(error),
            Self::Plant(error) => Some(error),
            Self::Trim(_) | Self::SetUp(_) => None,
        }
    }
}

impl From<LinkError> for FlyError {
    fn from(error: LinkError) -> Self {
        Self::Link(error)
    }
}
