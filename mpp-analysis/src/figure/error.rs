//! The errors that leave no picture.

use super::panel::DrawingError;
use mpp_core::qp::CondenseError;
use mpp_sim::flight::FlyError;

/// The reason why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The log holds no tick.
    #[error("the flight log holds no tick to draw")]
    EmptyFlight,
    /// The flight to be drawn has no outcome.
    #[error("nothing to draw: {0}")]
    Flight(#[source] FlyError),
    /// No planning cycle of the flight begins at the tick.
    #[error("nothing to draw: no planning cycle begins at tick {0}; give a tick of a scan")]
    NoCycle(u32),
    /// The planning cycle is not a cycle of the paper's method.
    #[error(
        "nothing to draw: the figure shows a cycle of preset reference or paper; fly one of them"
    )]
    NotPapers,
    /// The planning cycle's programs cannot be condensed.
    #[error("nothing to draw: the cycle's programs cannot be condensed: {0}")]
    Condense(#[source] CondenseError),
    /// The planning cycle has no feasible candidate.
    #[error("nothing to draw: no candidate is feasible; give another seed")]
    NoCandidate,
    /// The drawing library failed.
    #[error("drawing: {0}")]
    Drawing(#[source] Box<dyn core::error::Error + Send + Sync>),
}

impl From<DrawingError> for FigureError {
    fn from(error: DrawingError) -> Self {
        Self::Drawing(Box::new(error))
    }
}
