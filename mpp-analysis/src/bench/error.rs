//! The errors that leave a benchmark without a result.

use clarabel::solver::{SolverError, SolverStatus};
use std::fmt;

/// The reason why a program cannot be benchmarked. The first field is the program's name.
#[derive(Debug)]
pub enum QpBenchError {
    /// The program's model cannot be condensed.
    NotPositiveDefinite(String),
    /// Clarabel does not take the program.
    Clarabel(String, SolverError),
    /// Clarabel finds no margin for the program.
    NoMargin(String, SolverStatus),
}

impl fmt::Display for QpBenchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotPositiveDefinite(name) => {
                write!(
                    f,
                    "{name}: the Hessian is not positive definite: leave it out"
                )
            }
            Self::Clarabel(name, error) => write!(f, "{name}: {error}"),
            Self::NoMargin(name, status) => {
                write!(f, "{name}: no margin: {status:?}: leave it out")
            }
        }
    }
}

impl std::error::Error for QpBenchError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Clarabel(_, error) => Some(error),
            Self::NotPositiveDefinite(_) | Self::NoMargin(..) => None,
        }
    }
}
