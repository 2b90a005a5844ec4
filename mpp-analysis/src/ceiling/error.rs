//! Why there is no verdict.

use mpp_core::vehicle::TrimError;

/// Why there is no verdict about a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CeilingError {
    /// The envelope does not bound the turn; the text says why.
    Unbounded(&'static str),
    /// The aircraft has no level flight.
    Trim(TrimError),
    /// Obstacles move.
    Moving,
    /// The margin is not a distance \[m\].
    Margin(f64),
}

impl core::fmt::Display for CeilingError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unbounded(why) => {
                write!(f, "the ceiling needs an aircraft with bounded turns: {why}")
            }
            Self::Trim(error) => write!(f, "the aircraft has no level flight: {error}"),
            Self::Moving => {
                f.write_str("the ceiling knows obstacles at rest only: give them no velocity")
            }
            Self::Margin(margin) => {
                write!(
                    f,
                    "a margin of {margin} m makes no sense: give 0 or a positive distance"
                )
            }
        }
    }
}

impl core::error::Error for CeilingError {}
