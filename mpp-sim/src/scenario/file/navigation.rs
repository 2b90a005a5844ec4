//! The keys of the navigation source.

use crate::file_error::{ScenarioError, ensure};
use crate::names::by_name;
use crate::navigation::NavigationConfig;
use crate::scenario::{TICK_MS, TICKS_PER_SECOND};
use mpp_core::estimate::MOST_AGE;
use serde::{Deserialize, Serialize};

/// The named navigation sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NavigationSource {
    /// The true position in every tick.
    Ideal,
    /// Satellite navigation with carrier phase corrections.
    Rtk,
    /// Satellite navigation without corrections, with velocities.
    GnssIns,
    /// Odometry from lidar scans.
    LidarOdometry,
}

impl NavigationSource {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Ideal, Self::Rtk, Self::GnssIns, Self::LidarOdometry];

    /// Its name on the command line and in logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Rtk => "rtk",
            Self::GnssIns => "gnss-ins",
            Self::LidarOdometry => "lidar-odometry",
        }
    }

    /// Its errors.
    #[must_use]
    pub fn config(self) -> NavigationConfig {
        match self {
            Self::Ideal => NavigationConfig::IDEAL,
            Self::Rtk => NavigationConfig::RTK,
            Self::GnssIns => NavigationConfig::GNSS_INS,
            Self::LidarOdometry => NavigationConfig::LIDAR_ODOMETRY,
        }
    }
}

by_name!(NavigationSource, "navigation source");

/// The navigation source's keys. An absent key takes the value of the named source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NavigationTable {
    /// The named source; by default `rtk` for preset `flight`, and `ideal` for the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<NavigationSource>,
    /// Positions in a second \[Hz\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Time from a measurement until the core gets it \[ms\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay_ms: Option<u32>,
    /// Standard deviation of the white error along an axis \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// Standard deviation of the wandering error along an axis \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wander: Option<f64>,
    /// Correlation time of the wandering error \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wander_time: Option<f64>,
    /// Error of the downrange position as a share of the distance flown [-].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift: Option<f64>,
    /// Standard deviation of the velocity over ground [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_sigma: Option<f64>,
}

impl NavigationTable {
    pub(super) fn over(&self, base: NavigationConfig) -> Result<NavigationConfig, ScenarioError> {
        let base = self.source.map_or(base, NavigationSource::config);
        let delay_ms = self.delay_ms.unwrap_or(base.delay_ticks * TICK_MS);
        let advice = format!("give a multiple of {TICK_MS} ms");
        ensure(
            delay_ms.is_multiple_of(TICK_MS),
            "navigation.delay_ms",
            advice,
        )?;
        Ok(NavigationConfig {
            period_ticks: match self.rate_hz {
                Some(rate) => period_ticks(rate)?,
                None => base.period_ticks,
            },
            delay_ticks: delay_ms / TICK_MS,
            sigma: self.sigma.unwrap_or(base.sigma),
            wander: self.wander.unwrap_or(base.wander),
            wander_time: self.wander_time.unwrap_or(base.wander_time),
            drift: self.drift.unwrap_or(base.drift),
            velocity_sigma: self.velocity_sigma.or(base.velocity_sigma),
        })
    }
}

fn period_ticks(rate: f64) -> Result<u32, ScenarioError> {
    let period = f64::from(TICKS_PER_SECOND) / rate;
    let whole = (1.0..=f64::from(TICKS_PER_SECOND)).contains(&period) && period.fract() == 0.0;
    let advice = "give a rate of 1 Hz or more of which 100 Hz is a whole multiple";
    ensure(whole, "navigation.rate_hz", advice)?;
    Ok(period as u32)
}

/// Whether the values of a navigation source keep to the limits.
pub(super) fn check(config: &NavigationConfig) -> Result<(), ScenarioError> {
    let period = (1..=TICKS_PER_SECOND).contains(&config.period_ticks);
    ensure(period, "navigation.rate_hz", "give 1 to 100 Hz")?;
    let advice = format!("give at most {} ms", MOST_AGE * TICK_MS);
    ensure(
        config.delay_ticks <= MOST_AGE,
        "navigation.delay_ms",
        advice,
    )?;
    let time = config.wander_time > 0.0 && config.wander_time.is_finite();
    ensure(time, "navigation.wander_time", "give more than 0 s")?;
    for (value, key) in [
        (config.sigma, "navigation.sigma"),
        (config.wander, "navigation.wander"),
        (config.drift, "navigation.drift"),
        (
            config.velocity_sigma.unwrap_or(0.0),
            "navigation.velocity_sigma",
        ),
    ] {
        ensure((0.0..=1000.0).contains(&value), key, "give 0 to 1000")?;
    }
    Ok(())
}
