//! The reasons why a file of a scenario or of an aircraft cannot be flown.

use crate::field::FieldError;
use std::fmt;

/// The reason why there is no scenario.
#[derive(Debug)]
pub enum ScenarioError {
    /// The text with this name is no scenario; the message names line and key.
    Toml(String, Box<toml::de::Error>),
    /// A value is invalid. Holds the key and what to give instead.
    Value(&'static str, String),
    /// A value of the file with this name is invalid.
    File(String, Box<ScenarioError>),
    /// The field cannot be flown through.
    Field(FieldError),
}

/// Greatest length of a message that repeats a line of the file \[bytes\].
const LONGEST_MESSAGE: usize = 1000;

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Toml(path, error) => {
                let text = error.to_string();
                // The parser repeats the line, however long it is.
                if text.len() <= LONGEST_MESSAGE {
                    return write!(f, "{path}: {}", text.trim_end());
                }
                let place = error.span().map_or(0, |span| span.start);
                write!(f, "{path}, byte {place}: {}", error.message())
            }
            Self::File(name, error) => write!(f, "{name}: {error}"),
            Self::Field(error) => write!(f, "{error}"),
            Self::Value(key, advice) => write!(f, "{key}: {advice}"),
        }
    }
}

impl core::error::Error for ScenarioError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Toml(_, error) => Some(error),
            Self::File(_, error) => Some(error),
            Self::Field(error) => Some(error),
            Self::Value(..) => None,
        }
    }
}

impl ScenarioError {
    /// The same error, where a field that is at fault is that of the file with this name.
    #[must_use]
    pub fn of_field(self, file: Option<&str>) -> Self {
        match (self, file) {
            (Self::Field(error), Some(file)) => Self::Field(error.named(file)),
            (error, _) => error,
        }
    }
}

/// Gives an error with key and advice unless a value is sound.
pub(crate) fn ensure(
    sound: bool,
    key: &'static str,
    advice: impl Into<String>,
) -> Result<(), ScenarioError> {
    if sound {
        Ok(())
    } else {
        Err(ScenarioError::Value(key, advice.into()))
    }
}
