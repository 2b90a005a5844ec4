//! The errors that leave a benchmark without a result.

use clarabel::solver::{SolverError, SolverStatus};

/// The reason why a program cannot be benchmarked. The first field is the program's name.
#[derive(Debug, thiserror::Error)]
pub enum QpBenchError {
    /// The program's model cannot be condensed.
    #[error("{0}: the Hessian is not positive definite: leave it out")]
    NotPositiveDefinite(String),
    /// Clarabel does not take the program.
    #[error("{0}: {1}")]
    Clarabel(String, #[source] SolverError),
    /// Clarabel finds no margin for the program.
    #[error("{0}: no margin: {1:?}: leave it out")]
    NoMargin(String, SolverStatus),
}
