//! What is flown: the presets, and everything that a scenario file or a flag may change.

mod file;

use crate::faults::Faults;
use crate::lidar::{LidarConfig, LidarRule};
use crate::oracle;
use crate::scene::Scene;
use crate::sensors::AirDataNoise;
use crate::world::{Obstacle, ObstacleField};
use hil_protocol::{AirframeId, Configure};
use mpp_core::config::TICK_PERIOD;
use mpp_core::settings::Cruise;
use mpp_core::vehicle::{Airframe, Trim, TrimError, VehicleState};
use serde::{Deserialize, Serialize};

pub use file::{AirDataTable, LidarTable, ScenarioError, ScenarioFile};

/// The height at which flights start and which the planner returns to [m].
pub const ALTITUDE: f64 = 50.0;

/// Ticks in a second.
pub const TICKS_PER_SECOND: u32 = 100;

/// The named sets of parameters and rules.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    clap::ValueEnum,
)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The authors' code, faults included, to compare with it.
    Reference,
    /// The paper's text, its slips corrected.
    Paper,
    /// The best we know.
    Flight,
}

impl Preset {
    /// Its name on the command line and in logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Paper => "paper",
            Self::Flight => "flight",
        }
    }
}

/// The named airframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum AirframeName {
    /// The paper's appendix: with chord, `I_yy` = 0.17 kg m^2.
    Paper,
    /// The authors' code: without chord.
    Reference,
}

impl AirframeName {
    /// Its name on the command line and in logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Reference => "reference",
        }
    }

    /// Its parameters.
    #[must_use]
    pub fn airframe(self) -> Airframe {
        match self {
            Self::Paper => Airframe::PAPER,
            Self::Reference => Airframe::REFERENCE,
        }
    }
}

/// One flight, in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Seed of the field, of all noise and of the planner.
    pub seed: u64,
    /// Random obstacles in the field.
    pub obstacles: usize,
    /// A challenge scene in it.
    pub scene: Option<Scene>,
    /// Further obstacles in it, one by one.
    pub placed: Vec<Obstacle>,
    /// The core's preset.
    pub preset: Preset,
    /// The aircraft as the core knows it, and as it is but for its errors.
    pub airframe: AirframeName,
    /// Candidate paths of a cycle; 0 tracks the shortest path itself.
    pub paths: u16,
    /// Ticks from a plan to the next.
    pub replan_ticks: u32,
    /// Ticks from a scan until its plan is flown.
    pub latency_ticks: u32,
    /// Planner slices that run between two ticks.
    pub slices_per_tick: u32,
    /// Length of the flight [ticks].
    pub ticks: u32,
    /// The lidar.
    pub lidar: LidarConfig,
    /// Errors of the airspeed and pitch sensors.
    pub air_data: AirDataNoise,
    /// Faults and disturbances.
    pub faults: Faults,
    /// Whether the core knows the field and the true state, as [`crate::oracle`] says.
    pub oracle: bool,
}

impl Scenario {
    /// The paper's flight in a preset: 20 s, 20 obstacles, 25 paths, replanned every second.
    #[must_use]
    pub fn new(preset: Preset, seed: u64) -> Self {
        let lidar = match preset {
            Preset::Reference => LidarConfig::AUTHORS,
            Preset::Paper | Preset::Flight => LidarConfig::PAPER,
        };
        Self {
            seed,
            obstacles: 20,
            scene: None,
            placed: Vec::new(),
            preset,
            airframe: AirframeName::Reference,
            paths: 25,
            replan_ticks: TICKS_PER_SECOND,
            latency_ticks: 1,
            slices_per_tick: u32::MAX,
            ticks: 20 * TICKS_PER_SECOND,
            lidar,
            air_data: AirDataNoise::PAPER,
            faults: Faults::default(),
            oracle: false,
        }
    }

    /// The same flight by an oracle.
    #[must_use]
    pub fn informed(self) -> Self {
        Self {
            preset: Preset::Flight,
            replan_ticks: (f64::from(TICKS_PER_SECOND) / oracle::REPLAN_HZ) as u32,
            latency_ticks: 1,
            slices_per_tick: u32::MAX,
            air_data: AirDataNoise::NONE,
            oracle: true,
            ..self
        }
    }

    /// The core's level trim.
    ///
    /// # Errors
    /// [`TrimError`] when the airframe has no level flight.
    pub fn trim(&self) -> Result<Trim, TrimError> {
        let cruise = match self.preset {
            Preset::Reference => Cruise::Authors,
            Preset::Paper | Preset::Flight => Cruise::Airspeed(12.0),
        };
        cruise.trim(&self.airframe.airframe())
    }

    /// Where the flight starts: level, as the core's trim has it.
    ///
    /// # Errors
    /// [`TrimError`] when the airframe has no level flight.
    pub fn start(&self) -> Result<VehicleState, TrimError> {
        Ok(VehicleState {
            x: 0.0,
            z: ALTITUDE,
            air: self.trim()?.state,
        })
    }

    /// Every obstacle: the random ones, the scene's, the placed ones.
    #[must_use]
    pub fn field(&self) -> ObstacleField {
        let mut field = ObstacleField::generate(self.seed, self.obstacles, 0.0, ALTITUDE);
        if let Some(scene) = self.scene {
            field
                .obstacles
                .extend(scene.obstacles(self.seed, 0.0, ALTITUDE));
        }
        field.obstacles.extend(&self.placed);
        field
    }

    /// Replanning rate [Hz].
    #[must_use]
    pub fn replan_hz(&self) -> f64 {
        f64::from(TICKS_PER_SECOND) / f64::from(self.replan_ticks)
    }

    /// What the core is told.
    #[must_use]
    pub fn configure(&self) -> Configure {
        // The authors' lidar may return the far side of an obstacle whose centre is at its limit.
        let beyond = match self.lidar.rule {
            LidarRule::Authors => 1.0,
            LidarRule::Nearest => 0.0,
        };
        Configure {
            preset: match self.preset {
                Preset::Reference => hil_protocol::Preset::Reference,
                Preset::Paper => hil_protocol::Preset::Paper,
                Preset::Flight => hil_protocol::Preset::Flight,
            },
            airframe: match self.airframe {
                AirframeName::Paper => AirframeId::Paper,
                AirframeName::Reference => AirframeId::Reference,
            },
            paths: self.paths,
            replan_period_ticks: self.replan_ticks,
            latency_ticks: self.latency_ticks,
            slices_per_tick: self.slices_per_tick,
            seed: self.seed,
            beams: u16::try_from(self.lidar.beams).unwrap_or(u16::MAX),
            range_max: (self.lidar.range_max + beyond) as f32,
            altitude: ALTITUDE,
            actuators: self.faults.actuators.told(),
        }
    }

    /// Time of a tick [s].
    #[must_use]
    pub fn time(tick: u32) -> f64 {
        f64::from(tick) * TICK_PERIOD
    }
}
