//! The table `[generator]` of a scenario file.

use crate::field::Point;
use crate::file_error::{ScenarioError, ensure};
use crate::generator::{Generator, GeneratorName};
use serde::{Deserialize, Serialize};

/// The generator's keys. An absent key takes the value of the named generator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GeneratorTable {
    /// Name of the generator; by default `paper`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<GeneratorName>,
    /// Radius or half thickness \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Free height \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<f64>,
    /// Standard deviation of the places in a cluster \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<f64>,
    /// Obstacles of a cluster.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cluster: Option<usize>,
    /// Length of bars \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Velocity, downrange and up [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Point>,
}

/// Greatest length of a key \[m\], and greatest speed [m/s].
const MOST: f64 = 100.0;

impl GeneratorTable {
    /// Whether it has no key.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The generator that it describes.
    pub(super) fn generator(&self) -> Result<Generator, ScenarioError> {
        let name = self.name.unwrap_or_default();
        let given = [
            ("generator.radius", self.radius.is_some()),
            ("generator.gap", self.gap.is_some()),
            ("generator.spread", self.spread.is_some()),
            ("generator.cluster", self.cluster.is_some()),
            ("generator.length", self.length.is_some()),
            ("generator.velocity", self.velocity.is_some()),
        ];
        for (key, given) in given {
            let own = key.trim_start_matches("generator.");
            let takes = !given || name.keys().contains(&own);
            let advice = format!("leave it out: {name} takes {}", name.keys().join(", "));
            ensure(takes, key, advice)?;
        }
        let usual = Generator::named(name);
        Ok(Generator {
            name,
            radius: self.radius.unwrap_or(usual.radius),
            gap: self.gap.unwrap_or(usual.gap),
            spread: self.spread.unwrap_or(usual.spread),
            cluster: self.cluster.unwrap_or(usual.cluster),
            length: self.length.unwrap_or(usual.length),
            velocity: self.velocity.unwrap_or(usual.velocity),
        })
    }
}

/// Whether a generator's parameters leave room for a body of this radius \[m\].
pub(super) fn check(generator: &Generator, body_radius: f64) -> Result<(), ScenarioError> {
    let size = |key, value: f64, least: f64| {
        let sound = value >= least && value <= MOST;
        ensure(sound, key, format!("give {least} to {MOST}"))
    };
    size("generator.radius", generator.radius, 0.01)?;
    size("generator.spread", generator.spread, 0.0)?;
    size("generator.length", generator.length, 0.0)?;
    for part in [generator.velocity.0, generator.velocity.1] {
        size("generator.velocity", part.abs(), 0.0)?;
    }
    ensure(
        generator.cluster > 0,
        "generator.cluster",
        "give at least 1",
    )?;
    if generator.name.keys().contains(&"gap") {
        let most = 2.0 * crate::generator::BAND;
        let sound = generator.gap > 2.0 * body_radius && generator.gap <= most;
        let advice = format!(
            "give more than {} m, which is the body's size, and at most {most} m",
            2.0 * body_radius
        );
        ensure(sound, "generator.gap", advice)?;
    }
    Ok(())
}
