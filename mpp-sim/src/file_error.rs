//! The reasons why a file of a scenario or of an aircraft cannot be flown.

use crate::field::FieldError;
use crate::toml_error::place_and_cause;

/// The reason why there is no scenario.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// The text with this name is no scenario; the message names line and key.
    #[error("{0}{why}", why = place_and_cause(.1))]
    Toml(String, #[source] Box<toml::de::Error>),
    /// A value is invalid. Holds the key and what to give instead.
    #[error("{0}: {1}")]
    Value(&'static str, String),
    /// A value of the file with this name is invalid.
    #[error("{0}: {1}")]
    File(String, #[source] Box<ScenarioError>),
    /// The field cannot be flown through.
    #[error("{0}")]
    Field(#[source] FieldError),
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
