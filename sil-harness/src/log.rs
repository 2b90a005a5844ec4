//! One flight as JSON.
//!
//! A log holds what happened in the flight and nothing about the link, the machine or the wall
//! clock: a seed gives the same bytes in process, over TCP and on other machines. The bytes are
//! compact JSON in the order of the fields here; the file is exactly the bytes that are hashed,
//! so `sha256sum flight.json` begins with [`FlightLog::hash`].
//!
//! JSON knows no NaN and no infinity: where they can occur the field is an `Option`, and `null`.

mod error;
mod summary;

pub use error::LogError;
pub use summary::Summary;

use crate::faults::Faults;
use crate::ground::OrderEntry;
use crate::lidar::LidarConfig;
use crate::scene::Scene;
use crate::sensors::{AirDataNoise, Measurement};
use crate::world::Obstacle;
use mpp_core::vehicle::{AirState, Control, VehicleState};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Version of the log's layout.
pub const SCHEMA: u32 = 2;

/// One flight from its parameters to its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightLog {
    /// [`SCHEMA`].
    pub schema: u32,
    /// What was flown.
    pub header: Header,
    /// The flight at 100 Hz.
    pub ticks: Columns,
    /// Every plan that the core delivered.
    pub plans: Vec<PlanEntry>,
    /// Every input that the core refused.
    pub rejections: Vec<RejectionEntry>,
    /// Every order from the ground that took effect; not written if there was none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub orders: Vec<OrderEntry>,
    /// How it ended.
    pub summary: Summary,
}

/// What was flown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Version of `sil-harness`.
    pub package_version: String,
    /// Seed of the field and of all noise.
    pub seed: u64,
    /// Number of obstacles.
    pub obstacles: usize,
    /// Number of candidate paths that the planner asks for.
    pub paths: usize,
    /// Name of the planner's preset.
    pub preset: String,
    /// Name of the airframe.
    pub airframe: String,
    /// Replanning rate [Hz].
    pub replan_hz: f64,
    /// Time from a scan until its plan is flown [s].
    pub latency: f64,
    /// Slices of planning work done in each tick; not written if that is all there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slices_per_tick: Option<u32>,
    /// Length that the flight was to have [s].
    pub duration: f64,
    /// The lidar.
    pub lidar: LidarConfig,
    /// Errors of the airspeed and pitch sensors.
    pub air_data: AirDataNoise,
    /// Faults and disturbances.
    pub faults: Faults,
    /// The challenge scene, if any.
    pub scene: Option<Scene>,
    /// Whether an oracle flew; not written if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub oracle: bool,
    /// The obstacles.
    pub field: Vec<ObstacleEntry>,
}

/// A circular obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObstacleEntry {
    /// Centre, downrange [m].
    pub x: f64,
    /// Centre, height [m].
    pub z: f64,
    /// Radius [m].
    pub radius: f64,
}

impl From<&Obstacle> for ObstacleEntry {
    fn from(obstacle: &Obstacle) -> Self {
        let &Obstacle { x, z, radius } = obstacle;
        Self { x, z, radius }
    }
}

/// What is logged of one tick. Every value but the reference's must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Time since the start [s].
    pub t: f64,
    /// True state at `t`.
    pub state: VehicleState,
    /// What the sensors measured of it.
    pub measured: Measurement,
    /// What the core estimated from that.
    pub estimate: AirState,
    /// What the core's trajectory asks for at `t`; none before the first plan.
    pub reference: Option<VehicleState>,
    /// The control that the core answered.
    pub control: Control,
    /// The control that the actuators gave, flown until the next tick.
    pub applied: Control,
    /// Motion of the air, downrange and up [m/s].
    pub wind: (f64, f64),
}

/// One column per quantity, one row per tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Columns {
    /// Time since the start [s].
    pub t: Vec<f64>,
    /// True downrange distance [m].
    pub x: Vec<f64>,
    /// True height [m].
    pub z: Vec<f64>,
    /// True airspeed [m/s].
    pub airspeed: Vec<f64>,
    /// True pitch [rad].
    pub pitch: Vec<f64>,
    /// True pitch rate [rad/s].
    pub pitch_rate: Vec<f64>,
    /// True flight path angle [rad].
    pub flight_path: Vec<f64>,
    /// Measured airspeed [m/s].
    pub measured_airspeed: Vec<f64>,
    /// Measured pitch [rad].
    pub measured_pitch: Vec<f64>,
    /// Estimated airspeed [m/s].
    pub est_airspeed: Vec<f64>,
    /// Estimated pitch [rad].
    pub est_pitch: Vec<f64>,
    /// Estimated pitch rate [rad/s].
    pub est_pitch_rate: Vec<f64>,
    /// Estimated flight path angle [rad].
    pub est_flight_path: Vec<f64>,
    /// Reference downrange distance [m]; this and the other references: null without a plan.
    pub ref_x: Vec<Option<f64>>,
    /// Reference height [m].
    pub ref_z: Vec<Option<f64>>,
    /// Reference airspeed [m/s].
    pub ref_airspeed: Vec<Option<f64>>,
    /// Reference pitch [rad].
    pub ref_pitch: Vec<Option<f64>>,
    /// Reference pitch rate [rad/s].
    pub ref_pitch_rate: Vec<Option<f64>>,
    /// Reference flight path angle [rad].
    pub ref_flight_path: Vec<Option<f64>>,
    /// Commanded thrust [N].
    pub thrust: Vec<f64>,
    /// Commanded elevator [-].
    pub elevator: Vec<f64>,
    /// Thrust that the actuators gave [N]; like the elevator below, the command unless they are
    /// limited.
    pub applied_thrust: Vec<f64>,
    /// Elevator that the actuators gave [-].
    pub applied_elevator: Vec<f64>,
    /// Motion of the air downrange [m/s].
    pub wind_x: Vec<f64>,
    /// Motion of the air upwards [m/s].
    pub wind_z: Vec<f64>,
}

impl Columns {
    /// Appends one row.
    pub fn push(&mut self, tick: &Tick) {
        let reference = |pick: fn(&VehicleState) -> f64| finite(tick.reference.as_ref().map(pick));
        self.t.push(tick.t);
        self.x.push(tick.state.x);
        self.z.push(tick.state.z);
        self.airspeed.push(tick.state.air.airspeed);
        self.pitch.push(tick.state.air.pitch);
        self.pitch_rate.push(tick.state.air.pitch_rate);
        self.flight_path.push(tick.state.air.flight_path);
        self.measured_airspeed.push(tick.measured.airspeed);
        self.measured_pitch.push(tick.measured.pitch);
        self.est_airspeed.push(tick.estimate.airspeed);
        self.est_pitch.push(tick.estimate.pitch);
        self.est_pitch_rate.push(tick.estimate.pitch_rate);
        self.est_flight_path.push(tick.estimate.flight_path);
        self.ref_x.push(reference(|r| r.x));
        self.ref_z.push(reference(|r| r.z));
        self.ref_airspeed.push(reference(|r| r.air.airspeed));
        self.ref_pitch.push(reference(|r| r.air.pitch));
        self.ref_pitch_rate.push(reference(|r| r.air.pitch_rate));
        self.ref_flight_path.push(reference(|r| r.air.flight_path));
        self.thrust.push(tick.control.thrust);
        self.elevator.push(tick.control.elevator);
        self.applied_thrust.push(tick.applied.thrust);
        self.applied_elevator.push(tick.applied.elevator);
        self.wind_x.push(tick.wind.0);
        self.wind_z.push(tick.wind.1);
    }
}

/// One plan that the core delivered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanEntry {
    /// Tick of the scan that it was made from.
    pub tick: u64,
    /// First tick that flew it; null if none did.
    pub used_from_tick: Option<u64>,
    /// What the planner says about it.
    pub outcome: String,
    /// Candidates considered.
    pub candidates: u32,
    /// Candidates whose trajectory met every constraint.
    pub feasible: u32,
    /// Runs of the path search.
    pub tree_runs: u32,
    /// Slices of planning work used.
    pub slices: u32,
    /// Cost of the chosen trajectory [-]; null if none was chosen.
    pub cost: Option<f64>,
    /// Worst constraint violation of the chosen trajectory [m]; null if none was chosen.
    pub violation: Option<f64>,
}

impl PlanEntry {
    /// Whether its cycle had nothing to offer: an older plan is flown on, or level trim held.
    #[must_use]
    pub fn had_nothing(&self) -> bool {
        matches!(self.outcome.as_str(), "KeptPrevious" | "TrimHold")
    }
}

/// One input that the core refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RejectionEntry {
    /// Tick of the input.
    pub tick: u64,
    /// Why.
    pub cause: String,
}

/// The value if it is a number that JSON can write.
#[must_use]
pub fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

impl FlightLog {
    /// The log of a flight that is about to begin.
    #[must_use]
    pub fn begin(header: Header) -> Self {
        Self {
            schema: SCHEMA,
            header,
            ticks: Columns::default(),
            plans: Vec::new(),
            rejections: Vec::new(),
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

    /// The log of these bytes.
    ///
    /// # Errors
    /// [`LogError::Json`], or [`LogError::Schema`] for another version's log.
    pub fn from_json(bytes: &[u8]) -> Result<Self, LogError> {
        #[derive(Deserialize)]
        struct Version {
            schema: u32,
        }
        // The version first: another version's fields would only say which one is missing.
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
        let digest = Sha256::digest(self.to_json()?);
        Ok(digest[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect())
    }

    /// Writes the log's bytes to a file.
    ///
    /// # Errors
    /// [`LogError`].
    pub fn write_json(&self, path: &Path) -> Result<(), LogError> {
        Ok(std::fs::write(path, self.to_json()?)?)
    }
}

#[cfg(test)]
mod tests;
