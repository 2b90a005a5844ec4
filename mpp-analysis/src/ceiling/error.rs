//! Why there is no verdict.

use mpp_core::vehicle::TrimError;

/// Why there is no verdict about a field.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CeilingError {
    /// The envelope does not bound the turn; the text says why.
    #[error("the ceiling needs an aircraft with bounded turns: {0}")]
    Unbounded(&'static str),
    /// The aircraft has no level flight.
    #[error("the aircraft has no level flight: {0}")]
    Trim(TrimError),
    /// Obstacles move.
    #[error("the ceiling knows obstacles at rest only: give them no velocity")]
    Moving,
    /// The margin is not a distance \[m\].
    #[error("a margin of {0} m makes no sense: give 0 or a positive distance")]
    Margin(f64),
    /// The world has more than endless trunks.
    #[error("the ceiling in space knows endless trunks only: take a world of trunks without tops")]
    NoTrunk,
    /// The scenario's aircraft cannot fly in space; the text says why.
    #[error("{0}")]
    Aircraft(String),
}
