//! Disturbances that people switch while a flight goes on.

use serde::{Deserialize, Serialize};

/// Disturbances that change in flight. What is absent stays as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Disturbance {
    /// Intensity of the gusts [m/s]: the standard deviation of the vertical ones, 0 to 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gusts: Option<f64>,
    /// Share of the lidar's beams without return [-], 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dropouts: Option<f64>,
    /// Whether the elevator stays where it is; `false` frees it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevator_stuck: Option<bool>,
}

impl Disturbance {
    /// Whether every value is in its range.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        (0.0..=10.0).contains(&self.gusts.unwrap_or(0.0))
            && (0.0..=1.0).contains(&self.dropouts.unwrap_or(0.0))
    }
}
