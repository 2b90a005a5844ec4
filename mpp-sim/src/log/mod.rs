//! One flight as JSON.
//!
//! A log holds what happened in the flight and nothing about the link, the machine or the wall
//! clock: a seed gives the same bytes in process, over TCP and on other machines. The bytes are
//! compact JSON in the order of the fields here; a log's file is exactly the bytes that are hashed,
//! so `sha256sum flight.json` begins with [`FlightLog::hash`].

mod space;
mod summary;

pub use space::SpaceHeader;
pub use summary::Summary;

use crate::aircraft_file::{AircraftFile, AircraftModel};
use crate::entries::{Columns, LateralColumns, PlanEntry, RejectionEntry, SensorEntry};
use crate::faults::Faults;
use crate::field::{Field, FieldFile};
use crate::generator::Generator;
use crate::lidar::LidarConfig;
use crate::names::UnknownName;
use crate::navigation::NavigationConfig;
use crate::orders::OrderEntry;
use crate::scenario::{Scenario, ScenarioError, Times};
use crate::scene::Scene;
use crate::sensors::AirDataNoise;
use hil_protocol::SensorStates;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io::{BufWriter, Result as IoResult, Write};

/// Version of the log's layout.
pub const SCHEMA: u32 = 4;

/// Version of the rules of flight: the release that first flew by them. A release whose flights have the same bytes
/// keeps it, so that a log's hash does not depend on the release.
pub const RULES: &str = "0.1.0";

/// One flight from its parameters to its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightLog {
    /// [`SCHEMA`].
    pub schema: u32,
    /// The flight's parameters.
    pub header: Header,
    /// The ticks of the flight, at 100 Hz.
    pub ticks: Columns,
    /// The lateral part of the ticks; not written of a flight in the vertical plane.
    #[serde(default, skip_serializing_if = "LateralColumns::is_empty")]
    pub lateral: LateralColumns,
    /// Every plan that the core delivered.
    pub plans: Vec<PlanEntry>,
    /// Every input that the core refused.
    pub rejections: Vec<RejectionEntry>,
    /// Every change of the core's trust in a sensor.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensors: Vec<SensorEntry>,
    /// The core's counters that are not zero, as of its last report.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub health: BTreeMap<String, u32>,
    /// Every order from the ground that took effect; not written if there was no such order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub orders: Vec<OrderEntry>,
    /// The end of the flight and its totals.
    pub summary: Summary,
}

/// The flight's parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// [`RULES`]. The name of the field is older than its meaning.
    pub package_version: String,
    /// Seed of the field and of all noise.
    pub seed: u64,
    /// Number of random obstacles.
    pub obstacles: usize,
    /// The generator of the random obstacles; not written if it is the paper's.
    #[serde(default = "papers", skip_serializing_if = "Generator::is_papers")]
    pub generator: Generator,
    /// Number of candidate paths that the planner asks for.
    pub paths: usize,
    /// Name of the planner's preset.
    pub preset: String,
    /// The aircraft.
    pub aircraft: AircraftFile,
    /// Factor on the lengths of the world [-]; see [`Scenario::world_scale`].
    pub world_scale: f64,
    /// Replanning rate \[Hz\].
    pub replan_hz: f64,
    /// Time from the start of a cycle until its plan is flown \[s\].
    pub latency: f64,
    /// Slices of planning work done in each tick; not written if each tick does all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slices_per_tick: Option<u32>,
    /// Planned duration of the flight \[s\].
    pub duration: f64,
    /// The lidar.
    pub lidar: LidarConfig,
    /// Errors of the airspeed and pitch sensors.
    pub air_data: AirDataNoise,
    /// The navigation source; not written if it is ideal.
    #[serde(default = "ideal", skip_serializing_if = "is_ideal")]
    pub navigation: NavigationConfig,
    /// Faults and disturbances.
    pub faults: Faults,
    /// The challenge scene, if any.
    pub scene: Option<Scene>,
    /// Whether an oracle flew; not written if this is false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub oracle: bool,
    /// Whether the core's map held every obstacle within the lidar's range; not written if this is false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub known_map: bool,
    /// Radius of the aircraft's body \[m\]; not written if it is 0.
    #[serde(default, skip_serializing_if = "is_point")]
    pub body_radius: f64,
    /// All obstacles, as in a field file.
    pub field: FieldFile,
    /// World and aircraft of a flight in space; not written of a flight in the vertical plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub space: Option<SpaceHeader>,
}

fn papers() -> Generator {
    Generator::PAPER
}

fn is_point(radius: &f64) -> bool {
    *radius <= 0.0
}

fn ideal() -> NavigationConfig {
    NavigationConfig::IDEAL
}

fn is_ideal(navigation: &NavigationConfig) -> bool {
    *navigation == NavigationConfig::IDEAL
}

impl Header {
    /// The header of a flight of this scenario in this field.
    #[must_use]
    pub fn of(scenario: &Scenario, field: &dyn Field) -> Self {
        Self {
            package_version: RULES.to_owned(),
            seed: scenario.seed,
            obstacles: scenario.obstacles,
            generator: scenario.generator,
            paths: usize::from(scenario.paths),
            preset: scenario.preset.name().to_owned(),
            aircraft: scenario.aircraft.file.clone(),
            world_scale: scenario.world_scale,
            replan_hz: scenario.replan_hz(),
            latency: Scenario::time(scenario.latency_ticks),
            slices_per_tick: Some(scenario.slices_per_tick).filter(|slices| *slices != u32::MAX),
            duration: Scenario::time(scenario.ticks),
            lidar: scenario.lidar,
            air_data: scenario.air_data,
            navigation: scenario.navigation,
            faults: scenario.faults,
            scene: scenario.scene,
            oracle: scenario.oracle,
            known_map: scenario.known_map,
            body_radius: scenario.body_radius,
            field: FieldFile::of(field.obstacles()),
            space: None,
        }
    }

    /// The scenario that was flown, unless the flight had a world of its own.
    ///
    /// # Errors
    /// [`LogError::Header`] when no scenario file could ask for it.
    pub fn scenario(&self) -> Result<Scenario, LogError> {
        if self.space.is_some() {
            return Err(LogError::Space);
        }
        let unknown = |key, error: UnknownName| {
            LogError::Header(ScenarioError::Value(key, error.to_string()))
        };
        let preset = self
            .preset
            .parse()
            .map_err(|error| unknown("preset", error))?;
        let scenario = Scenario {
            obstacles: self.obstacles,
            generator: self.generator,
            scene: self.scene,
            body_radius: self.body_radius,
            aircraft: AircraftModel::new(self.aircraft.clone()).map_err(LogError::Header)?,
            world_scale: self.world_scale,
            // Too many for the type are too many for a scenario.
            paths: u16::try_from(self.paths).unwrap_or(u16::MAX),
            slices_per_tick: self.slices_per_tick.unwrap_or(u32::MAX),
            lidar: self.lidar,
            air_data: self.air_data,
            navigation: self.navigation,
            faults: self.faults,
            oracle: self.oracle,
            known_map: self.known_map,
            ..Scenario::new(preset, self.seed)
        };
        let times = Times {
            replan_hz: self.replan_hz,
            latency: self.latency,
            duration: self.duration,
        };
        scenario
            .recorded(times, &self.field)
            .map_err(LogError::Header)
    }
}

impl FlightLog {
    /// Share of the cycles that know a way out [-].
    #[must_use]
    pub fn knows_way_out(&self) -> f64 {
        let known = (self.plans.iter()).filter(|plan| plan.way_out.is_some_and(|time| time > 0.0));
        known.count() as f64 / self.plans.len().max(1) as f64
    }

    /// Notes each sensor that the core trusts otherwise than in the tick before.
    pub(crate) fn note_sensors(&mut self, before: &SensorStates, now: &SensorStates, tick: u32) {
        for ((sensor, before), (_, now)) in before.named().into_iter().zip(now.named()) {
            if before != now {
                self.sensors.push(SensorEntry {
                    tick: u64::from(tick),
                    sensor: sensor.to_owned(),
                    state: now.to_string(),
                });
            }
        }
    }

    /// The log of a flight that is about to begin.
    #[must_use]
    pub fn begin(header: Header) -> Self {
        Self {
            schema: SCHEMA,
            header,
            ticks: Columns::default(),
            lateral: LateralColumns::default(),
            plans: Vec::new(),
            rejections: Vec::new(),
            sensors: Vec::new(),
            health: BTreeMap::new(),
            orders: Vec::new(),
            summary: Summary::default(),
        }
    }

    /// The log's bytes.
    ///
    /// # Errors
    /// [`LogError::Json`].
    pub fn to_json(&self) -> Result<Vec<u8>, LogError> {
        Ok(serde_json::to_vec(self)?)
    }

    /// Reads a log from its bytes.
    ///
    /// # Errors
    /// [`LogError::Json`], or [`LogError::Schema`] for another version's log.
    pub fn from_json(bytes: &[u8]) -> Result<Self, LogError> {
        #[derive(Deserialize)]
        struct Version {
            schema: u32,
        }
        // The version is read first. The fields of another version's log would only cause an error
        // about a missing field.
        let version: Version = serde_json::from_slice(bytes)?;
        if version.schema != SCHEMA {
            return Err(LogError::Schema(version.schema));
        }
        Ok(serde_json::from_slice(bytes)?)
    }

    /// First 16 hexadecimal digits of the SHA-256 of the log's bytes.
    ///
    /// # Errors
    /// [`LogError::Json`].
    pub fn hash(&self) -> Result<String, LogError> {
        // Serde writes a few bytes at a time; the hash takes them in pieces, so that the text is nowhere as a whole.
        let mut hashing = Hashing(Sha256::new());
        let mut pieces = BufWriter::new(&mut hashing);
        serde_json::to_writer(&mut pieces, self)?;
        pieces.flush().map_err(serde_json::Error::io)?;
        drop(pieces);
        Ok(hashing.0.finalize()[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect())
    }
}

/// A hash that bytes are written into.
struct Hashing(Sha256);

impl Write for Hashing {
    fn write(&mut self, bytes: &[u8]) -> IoResult<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> IoResult<()> {
        Ok(())
    }
}

/// The reason why bytes are no log, or why a log cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The bytes are not a log, or a value cannot be written.
    #[error("flight log: {0}")]
    Json(#[from] serde_json::Error),
    /// The log has the layout of another version; holds that version.
    #[error("flight log has schema {0}, this program reads {SCHEMA}")]
    Schema(u32),
    /// The flight was one in space.
    #[error(
        "flight log: of a flight in space there is no scenario: fly preset space with its seed, or export it"
    )]
    Space,
    /// The header says what cannot be flown.
    #[error("flight log: header.{0}")]
    Header(#[source] ScenarioError),
}

#[cfg(test)]
mod tests;
