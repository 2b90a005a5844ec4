//! The errors that leave no picture.

use super::panel::DrawingError;
use mpp_core::qp::CondenseError;
use mpp_sim::flight::FlyError;

/// The reason why there is no picture.
#[derive(Debug)]
pub enum FigureError {
    /// The log holds no tick.
    EmptyFlight,
    /// The flight to be drawn has no outcome.
    Flight(FlyError),
    /// No planning cycle of the flight begins at the tick.
    NoCycle(u32),
    /// The planning cycle is not a cycle of the paper's method.
    NotPapers,
    /// The planning cycle's programs cannot be condensed.
    Condense(CondenseError),
    /// The planning cycle has no feasible candidate.
    NoCandidate,
    /// The drawing library failed.
    Drawing(Box<dyn core::error::Error + Send + Sync>),
}

impl core::fmt::Display for FigureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::EmptyFlight => f.write_str("the flight log holds no tick to draw"),
            Self::Flight(error) => write!(f, "nothing to draw: {error}"),
            Self::NoCycle(tick) => write!(
                f,
                "nothing to draw: no planning cycle begins at tick {tick}; give a tick of a scan"
            ),
            Self::NotPapers => f.write_str(
                "nothing to draw: the figure shows a cycle of preset reference or paper; fly one of them",
            ),
            Self::Condense(error) => write!(
                f,
                "nothing to draw: the cycle's programs cannot be condensed: {error}"
            ),
            Self::NoCandidate => {
                f.write_str("nothing to draw: no candidate is feasible; give another seed")
            }
            Self::Drawing(error) => write!(f, "drawing: {error}"),
        }
    }
}

impl core::error::Error for FigureError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::EmptyFlight | Self::NoCycle(_) | Self::NotPapers | Self::NoCandidate => None,
            Self::Condense(error) => Some(error),
            Self::Flight(error) => Some(error),
            Self::Drawing(error) => Some(error.as_ref()),
        }
    }
}

impl From<DrawingError> for FigureError {
    fn from(error: DrawingError) -> Self {
        Self::Drawing(Box::new(error))
    }
}
