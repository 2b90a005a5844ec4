//! A scenario as text in TOML. Every key may be absent; the preset's flight then gives its value
//! (20 s, 20 obstacles, 25 paths, replanned at 1 Hz). An unknown key gives an error with its name.
//! `docs/scenarios/example.toml` holds every key with its unit.

mod generator;
mod lidar;
mod navigation;
mod overlay;

use super::{ALTITUDE, Preset, Scenario, TICK_MS, TICKS_PER_SECOND};
use crate::aircraft_file::{AircraftFile, AircraftModel};
use crate::faults::Faults;
use crate::field::{FieldFile, MAX_VERTICES, Obstacle, Shape};
use crate::file_error::{ScenarioError, ensure};
use crate::lidar::{LidarConfig, LidarRule};
use crate::scene::Scene;
use crate::sensors::AirDataNoise;
pub use generator::GeneratorTable;
pub use lidar::LidarTable;
use mpp_core::config::MAX_PATHS;
pub use navigation::{NavigationSource, NavigationTable};
use serde::{Deserialize, Serialize};

/// Greatest number of random obstacles over 215 m.
const MAX_OBSTACLES: usize = 1000;
/// Longest flight \[s\].
pub(super) const MAX_DURATION: u32 = 3600;

/// The content of a scenario file. Command-line flags replace its values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ScenarioFile {
    /// The core's preset; by default `flight`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<Preset>,
    /// The aircraft: the name of one that comes with the project, or a table with the keys of an aircraft
    /// file; by default `reference`.
    #[serde(
        skip_serializing_if = "Option::is_none",
        deserialize_with = "AircraftFile::named_or_table"
    )]
    pub aircraft: Option<AircraftFile>,
    /// Factor on the lengths of random field, scene, lidar and strict band [-], and the square of the factor on the
    /// duration. By default it is that of the aircraft's speed squared over that of the reference aircraft.
    /// Placed obstacles and lengths that are given keep their sizes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub world_scale: Option<f64>,
    /// Seed of the field, of all noise and of the planner; by default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Number of random obstacles; by default 20, or 0 if there is a scene or a field of one's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacles: Option<usize>,
    /// Radius of the aircraft's body \[m\]; by default 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body_radius: Option<f64>,
    /// Challenge scene; by default there is no scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<Scene>,
    /// Candidate paths of a cycle; by default 25. Preset `flight` has no more than 7: a greater number is used as 7.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub paths: Option<u16>,
    /// Replanning rate \[Hz\]; by default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub replan_hz: Option<f64>,
    /// Simulated time from the start of a cycle until its plan is flown \[ms\]; by default 10.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub latency_ms: Option<u32>,
    /// Planner slices that run between two ticks; by default all that the cycle needs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slices_per_tick: Option<u32>,
    /// Length of the flight \[s\], a multiple of 0.01; by default 20.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
    /// Whether an oracle flies, as [`crate::oracle`] describes; by default `false`. An oracle needs
    /// preset `flight`. It flies with 10 Hz and exact sensors, whatever the other keys say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub oracle: Option<bool>,
    /// Whether the core's map holds every obstacle within the lidar's range, hidden or not; by default `false`. All
    /// else is as in the flight without it, so that the difference is what hidden obstacles cost. It needs preset `flight`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub known_map: Option<bool>,
    /// The lidar.
    pub lidar: LidarTable,
    /// Errors of the airspeed and pitch sensors.
    pub air_data: AirDataTable,
    /// The navigation source; by default `rtk` for preset `flight`, and `ideal` for the others.
    pub navigation: NavigationTable,
    /// Faults and disturbances.
    pub faults: Faults,
    /// The generator of the random obstacles.
    #[serde(skip_serializing_if = "GeneratorTable::is_empty")]
    pub generator: GeneratorTable,
    /// Obstacles placed one by one.
    #[serde(skip_serializing_if = "FieldFile::is_empty")]
    pub field: FieldFile,
}

/// The air data sensors' keys. An absent key takes the preset's value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AirDataTable {
    /// Standard deviation of the airspeed [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub airspeed_sigma: Option<f64>,
    /// Standard deviation of the pitch \[deg\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_sigma_deg: Option<f64>,
}

impl ScenarioFile {
    /// Reads a scenario file from text. An error shows `name` as the name of the text.
    ///
    /// # Errors
    /// [`ScenarioError::Toml`].
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        toml::from_str(text).map_err(|error| ScenarioError::Toml(name.to_owned(), Box::new(error)))
    }

    /// Builds the complete scenario.
    ///
    /// # Errors
    /// [`ScenarioError::Value`].
    pub fn build(&self) -> Result<Scenario, ScenarioError> {
        let preset = self.preset.unwrap_or(Preset::Flight);
        let base = Scenario::new(preset, self.seed.unwrap_or(1));
        let alone = self.scene.is_none() && self.field.is_empty();
        let replan_ticks = match self.replan_hz {
            Some(rate) => replan_ticks(rate)?,
            None => base.replan_ticks,
        };
        let aircraft = match &self.aircraft {
            Some(file) => AircraftModel::new(file.clone())?.plane(),
            None => base.aircraft.clone(),
        };
        let world_scale = match (self.world_scale, preset) {
            (Some(scale), _) => scale,
            (None, Preset::Flight) => aircraft.units().length,
            (None, Preset::Reference | Preset::Paper) => 1.0,
        };
        check_world_scale(world_scale)?;
        let usual = f64::from(base.ticks / TICKS_PER_SECOND) * world_scale.sqrt();
        let scenario = Scenario {
            obstacles: self
                .obstacles
                .unwrap_or(if alone { base.obstacles } else { 0 }),
            scene: self.scene,
            generator: self.generator.generator()?,
            placed: self.field.obstacles(),
            body_radius: self.body_radius.unwrap_or(aircraft.known.body_radius),
            aircraft,
            world_scale,
            paths: self
                .paths
                .map_or(base.paths, |paths| preset.flown_paths(paths)),
            replan_ticks,
            latency_ticks: match self.latency_ms {
                Some(latency) => latency_ticks(latency, replan_ticks)?,
                None => base.latency_ticks,
            },
            slices_per_tick: self.slices_per_tick.unwrap_or(base.slices_per_tick),
            ticks: flight_ticks(self.duration.unwrap_or(usual.ceil()))?,
            lidar: self.lidar.over(LidarConfig {
                range_max: base.lidar.range_max * world_scale,
                ..base.lidar
            }),
            air_data: self.air_data.over(base.air_data),
            navigation: self.navigation.over(base.navigation)?,
            faults: self.faults,
            known_map: self.known_map.unwrap_or(false),
            ..base
        };
        self.field.check().map_err(ScenarioError::Field)?;
        check(&scenario)?;
        if let Some((key, advice)) = scenario.faults.idle(scenario.ticks) {
            return Err(ScenarioError::Value(key, advice.to_owned()));
        }
        let oracle = self.oracle.unwrap_or(false);
        let advice = "only preset flight has an oracle";
        ensure(!oracle || preset == Preset::Flight, "oracle", advice)?;
        let advice = "only preset flight can fly by a known map";
        let flies = preset == Preset::Flight;
        ensure(!scenario.known_map || flies, "known_map", advice)?;
        Ok(if oracle {
            scenario.informed()
        } else {
            scenario
        })
    }
}

fn replan_ticks(rate: f64) -> Result<u32, ScenarioError> {
    let period = f64::from(TICKS_PER_SECOND) / rate;
    // A rate that was printed has lost its last digits.
    const ROUNDING: f64 = 0.01;
    let whole = (0.5..=f64::from(u16::MAX)).contains(&period)
        && (period - period.round()).abs() <= ROUNDING;
    let advice = format!(
        "give a rate of which {TICKS_PER_SECOND} Hz is a whole multiple, such as 0.5, 1, 2, 4, 5 or 10"
    );
    ensure(whole, "replan_hz", advice)?;
    Ok(period.round() as u32)
}

fn flight_ticks(duration: f64) -> Result<u32, ScenarioError> {
    let ticks = duration * f64::from(TICKS_PER_SECOND);
    let sound = (1.0 - 1e-6..=f64::from(MAX_DURATION * TICKS_PER_SECOND)).contains(&ticks)
        && (ticks - ticks.round()).abs() < 1e-6;
    let advice = format!("give 0.01 to {MAX_DURATION} s, a multiple of 0.01 s");
    ensure(sound, "duration", advice)?;
    Ok(ticks.round() as u32)
}

fn latency_ticks(latency_ms: u32, replan_ticks: u32) -> Result<u32, ScenarioError> {
    let ticks = latency_ms / TICK_MS;
    let sound = latency_ms.is_multiple_of(TICK_MS) && (1..=replan_ticks).contains(&ticks);
    let advice = format!(
        "give a multiple of {TICK_MS} ms, at least {TICK_MS} and no longer than the time between two plans"
    );
    ensure(sound, "latency_ms", advice)?;
    Ok(ticks)
}

/// Whether lengths can be scaled so. The duration depends on it, so it is checked first.
fn check_world_scale(scale: f64) -> Result<(), ScenarioError> {
    let sound = (1e-3..=1e3).contains(&scale);
    ensure(sound, "world_scale", "give 0.001 to 1000")
}

/// Whether a scenario's values, its times apart, keep to the limits.
pub(super) fn check(scenario: &Scenario) -> Result<(), ScenarioError> {
    let air_data = &scenario.air_data;
    check_world_scale(scenario.world_scale)?;
    ensure(
        scenario.obstacles <= MAX_OBSTACLES,
        "obstacles",
        format!("give at most {MAX_OBSTACLES}"),
    )?;
    ensure(
        usize::from(scenario.paths) <= MAX_PATHS,
        "paths",
        format!("give at most {MAX_PATHS}"),
    )?;
    ensure(
        scenario.slices_per_tick > 0,
        "slices_per_tick",
        "give at least 1",
    )?;
    let not_negative = |value: f64| value >= 0.0 && value.is_finite();
    for (value, key) in [
        (air_data.airspeed_sigma, "air_data.airspeed_sigma"),
        (air_data.pitch_sigma, "air_data.pitch_sigma_deg"),
    ] {
        ensure(not_negative(value), key, "give 0 or more")?;
    }
    lidar::check(&scenario.lidar)?;
    navigation::check(&scenario.navigation)?;
    check_field(scenario)?;
    match scenario.faults.flaw() {
        Some((key, advice)) => ensure(false, key, advice),
        None => Ok(()),
    }
}

/// Whether a scenario's field can be drawn and flown through.
fn check_field(scenario: &Scenario) -> Result<(), ScenarioError> {
    let body = scenario.body_radius;
    let sound = body >= 0.0 && body.is_finite();
    ensure(sound, "body_radius", "give 0 m or more")?;
    let generator = &scenario.generator;
    generator::check(generator, body)?;
    let expected = generator.expected(scenario.obstacles, scenario.duration());
    let most = 0.5 * MAX_VERTICES as f64;
    let few = expected <= most;
    let advice = format!(
        "give fewer, or fly for less time: the field would have about {expected:.0}, and may have {most:.0}"
    );
    ensure(few, "obstacles", advice)?;
    let is_circle = |one: &Obstacle| matches!(one.shape, Shape::Circle { .. });
    let circles = scenario.field().obstacles.iter().all(is_circle);
    let advice = "the authors' lidar knows circles only: give \"nearest\", or a field of circles";
    ensure(
        circles || scenario.lidar.rule == LidarRule::Nearest,
        "lidar.rule",
        advice,
    )?;
    let start = (0.0, ALTITUDE);
    let drawn = FieldFile::of(&scenario.drawn()).check_start(start, body);
    let advice = "give less: what is drawn covers the start of such a body";
    ensure(drawn.is_ok(), "body_radius", advice)?;
    let placed = FieldFile::of(&scenario.placed);
    placed
        .check_start(start, body)
        .map_err(ScenarioError::Field)
}

impl AirDataTable {
    fn over(&self, base: AirDataNoise) -> AirDataNoise {
        AirDataNoise {
            airspeed_sigma: self.airspeed_sigma.unwrap_or(base.airspeed_sigma),
            pitch_sigma: self
                .pitch_sigma_deg
                .map_or(base.pitch_sigma, f64::to_radians),
        }
    }
}

#[cfg(test)]
mod tests;
