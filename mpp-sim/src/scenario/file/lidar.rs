//! The lidar of a scenario: the table `[lidar]`, or a file of its own with the same keys.

use crate::file_error::{ScenarioError, ensure};
use crate::lidar::{LidarConfig, LidarRule};
use mpp_core::config::MAX_BEAMS;
use mpp_core::settings::Setting;
use serde::{Deserialize, Serialize};

/// The lidar's keys. An absent key takes the preset's value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LidarTable {
    /// Number of beams.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beams: Option<usize>,
    /// Field of view \[deg\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field_of_view_deg: Option<f64>,
    /// Greatest range \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_max: Option<f64>,
    /// Standard deviation of the range error, as a share of the range [-].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_error: Option<f64>,
    /// Rule by which a beam returns a range.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<LidarRule>,
}

impl LidarTable {
    /// Reads a lidar's file from text. An error shows `name` as the name of the text.
    ///
    /// # Errors
    /// [`ScenarioError::Toml`] or [`ScenarioError::File`].
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        let table: Self = toml::from_str(text)
            .map_err(|error| ScenarioError::Toml(name.to_owned(), Box::new(error)))?;
        // A sound lidar stays so if absent keys take the values of another sound lidar.
        check(&table.over(LidarConfig::PAPER))
            .map_err(|error| ScenarioError::File(name.to_owned(), Box::new(error)))?;
        Ok(table)
    }

    /// This table where it has a key, and `below` where it has none.
    #[must_use]
    pub fn before(&self, below: &Self) -> Self {
        Self {
            beams: self.beams.or(below.beams),
            field_of_view_deg: self.field_of_view_deg.or(below.field_of_view_deg),
            range_max: self.range_max.or(below.range_max),
            range_error: self.range_error.or(below.range_error),
            rule: self.rule.or(below.rule),
        }
    }

    /// This lidar, where it says nothing that of `base`.
    #[must_use]
    pub fn over(&self, base: LidarConfig) -> LidarConfig {
        LidarConfig {
            beams: self.beams.unwrap_or(base.beams),
            field_of_view: self
                .field_of_view_deg
                .map_or(base.field_of_view, f64::to_radians),
            range_max: self.range_max.unwrap_or(base.range_max),
            range_error: self.range_error.unwrap_or(base.range_error),
            rule: self.rule.unwrap_or(base.rule),
        }
    }
}

/// Whether a lidar's values keep to the limits.
pub(super) fn check(lidar: &LidarConfig) -> Result<(), ScenarioError> {
    ensure(
        (1..=MAX_BEAMS).contains(&lidar.beams),
        "lidar.beams",
        format!("give 1 to {MAX_BEAMS}"),
    )?;
    let view = lidar.field_of_view > 0.0 && lidar.field_of_view <= core::f64::consts::TAU;
    ensure(
        view,
        "lidar.field_of_view_deg",
        "give more than 0 and at most 360 deg",
    )?;
    let [least, most] = Setting::Sight.range();
    let range = lidar.range_max >= least && lidar.farthest() <= most;
    let advice = format!("give {least} to {most} m, the core's bounds");
    ensure(range, "lidar.range_max", advice)?;
    let error = lidar.range_error >= 0.0 && lidar.range_error.is_finite();
    ensure(error, "lidar.range_error", "give 0 or more")
}
