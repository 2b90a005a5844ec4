//! What can go wrong with a log.

use super::SCHEMA;

/// Why a log could not be written or read.
#[derive(Debug)]
#[non_exhaustive]
pub enum LogError {
    /// The bytes are not a log, or a value cannot be written.
    Json(serde_json::Error),
    /// The file cannot be read or written.
    File(std::io::Error),
    /// The log's layout is another version's; holds that version.
    Schema(u32),
}

impl core::fmt::Display for LogError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Json(error) => write!(f, "flight log: {error}"),
            Self::File(error) => write!(f, "flight log file: {error}"),
            Self::Schema(found) => {
                write!(
                    f,
                    "flight log has schema {found}, this program reads {SCHEMA}"
                )
            }
        }
    }
}

impl core::error::Error for LogError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Json(error) => Some(error),
            Self::File(error) => Some(error),
            Self::Schema(_) => None,
        }
    }
}

impl From<serde_json::Error> for LogError {
    fn from(error: serde_json::Error) -> Self {
        Self::Json(error)
    }
}

impl From<std::io::Error> for LogError {
    fn from(error: std::io::Error) -> Self {
        Self::File(error)
    }
}
