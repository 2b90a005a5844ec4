//! One scenario file over another.

use super::{ScenarioError, ScenarioFile};
use serde_json::Value;

impl ScenarioFile {
    /// This file under another one: the keys of the other text take precedence, and every other key stays. An
    /// error shows `name` as the name of the other text.
    ///
    /// # Errors
    /// [`ScenarioError::Toml`].
    pub fn under(&self, name: &str, text: &str) -> Result<Self, ScenarioError> {
        // This refuses unknown keys with their lines.
        Self::parse(name, text)?;
        let toml = |error| ScenarioError::Toml(name.to_owned(), Box::new(error));
        let over: Value = toml::from_str(text).map_err(toml)?;
        let json =
            |error: serde_json::Error| toml(<toml::de::Error as serde::de::Error>::custom(error));
        let mut both = serde_json::to_value(self).map_err(json)?;
        lay(over, &mut both);
        serde_json::from_value(both).map_err(json)
    }
}

/// Lays one value over another. Tables are merged; any other value replaces the one below.
fn lay(over: Value, below: &mut Value) {
    match (over, below) {
        (Value::Object(over), Value::Object(below)) => {
            for (key, value) in over {
                lay(value, below.entry(key).or_insert(Value::Null));
            }
        }
        (over, below) => *below = over,
    }
}
