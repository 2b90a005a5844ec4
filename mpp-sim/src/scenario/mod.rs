//! The parameters of a flight: the presets, and everything that a scenario file or a flag may
//! change.

mod file;
mod recorded;

use crate::aircraft_file::AircraftModel;
use crate::faults::Faults;
use crate::field::{Obstacle, ObstacleField};
use crate::generator::Generator;
use crate::lidar::LidarConfig;
use crate::names::by_name;
use crate::navigation::NavigationConfig;
use crate::outcome::ALTITUDE_BAND;
use crate::scene::Scene;
use crate::sensors::AirDataNoise;
use hil_protocol::Configure;
use mpp_core::config::{MAX_PATHS, TICK_PERIOD};
use mpp_core::planner::plane::MAX_CANDIDATES;
use mpp_core::settings::{Aircraft, Settings};
use mpp_core::vehicle::{ActuatorLimits, Trim, TrimError, VehicleState};
use serde::{Deserialize, Serialize};

pub(crate) use recorded::Times;

pub use crate::file_error::ScenarioError;
pub use file::{
    AirDataTable, GeneratorTable, LidarTable, NavigationSource, NavigationTable, ScenarioFile,
};

/// The height at which flights start and which the planner returns to \[m\].
pub const ALTITUDE: f64 = 50.0;

/// Ticks in a second: the flight loop's rate \[Hz\].
pub const TICKS_PER_SECOND: u32 = (1.0 / TICK_PERIOD) as u32;

/// Length of a tick \[ms\].
pub const TICK_MS: u32 = 1000 / TICKS_PER_SECOND;

/// Length of a tick \[us\].
pub const TICK_US: u32 = 1000 * TICK_MS;

/// Replanning rate of an oracle \[Hz\]; see [`crate::oracle`].
pub const ORACLE_REPLAN_HZ: f64 = 10.0;

/// Number of candidate paths if nobody gives one: the paper's.
const USUAL_PATHS: u16 = 25;

/// The named sets of parameters and rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The rules of the authors' code, including its faults, for comparison with it.
    Reference,
    /// The paper's text, with its slips corrected.
    Paper,
    /// The best parameters and rules that we know.
    Flight,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Reference, Self::Paper, Self::Flight];

    /// Its name on the command line and in logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Paper => "paper",
            Self::Flight => "flight",
        }
    }

    /// The most candidate paths that a cycle finds.
    #[must_use]
    pub fn most_paths(self) -> usize {
        match self {
            Self::Reference | Self::Paper => MAX_PATHS,
            Self::Flight => MAX_CANDIDATES,
        }
    }

    /// The number of paths of a flight for which this number was asked: the usual one stands for all that are more than a
    /// cycle finds. Such flights are the same, and so have the same log.
    #[must_use]
    pub fn flown_paths(self, asked: u16) -> u16 {
        let more = self.most_paths() + 1..=MAX_PATHS;
        if more.contains(&usize::from(asked)) {
            USUAL_PATHS
        } else {
            asked
        }
    }

    /// The core's settings if nobody changes a parameter.
    #[must_use]
    pub fn settings(self) -> Settings {
        match self {
            Self::Reference => Settings::reference(),
            Self::Paper => Settings::paper(),
            Self::Flight => Settings::flight(),
        }
    }
}

by_name!(Preset, "preset");

/// One flight, in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Seed of the field, of all noise and of the planner.
    pub seed: u64,
    /// Number of random obstacles in the field, over 215 m.
    pub obstacles: usize,
    /// The generator of the random obstacles.
    pub generator: Generator,
    /// Challenge scene in the field.
    pub scene: Option<Scene>,
    /// Further obstacles in the field, placed one by one.
    pub placed: Vec<Obstacle>,
    /// Radius of the aircraft's body \[m\]. An obstacle that is nearer to the aircraft's place has been
    /// hit.
    pub body_radius: f64,
    /// The core's preset.
    pub preset: Preset,
    /// The aircraft. The true one differs from what the core knows by its model error, and by what an
    /// aircraft file says besides.
    pub aircraft: AircraftModel,
    /// Factor on the lengths of the field, of the lidar's range and of the strict band [-]; times are scaled
    /// by its root. By default it is that of the planner's units.
    pub world_scale: f64,
    /// Number of candidate paths of a cycle. With 0 the core tracks the shortest path itself.
    pub paths: u16,
    /// Ticks from one plan to the next.
    pub replan_ticks: u32,
    /// Ticks from the start of a cycle until its plan is flown.
    pub latency_ticks: u32,
    /// Planner slices that run between two ticks.
    pub slices_per_tick: u32,
    /// Length of the flight \[ticks\].
    pub ticks: u32,
    /// The lidar.
    pub lidar: LidarConfig,
    /// Errors of the airspeed and pitch sensors.
    pub air_data: AirDataNoise,
    /// The navigation source.
    pub navigation: NavigationConfig,
    /// Faults and disturbances.
    pub faults: Faults,
    /// Whether the core knows the field and the true state, as [`crate::oracle`] says.
    pub oracle: bool,
    /// Whether the core's map holds every obstacle within the lidar's range, hidden or not; see [`crate::oracle`].
    pub known_map: bool,
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
            generator: Generator::PAPER,
            scene: None,
            placed: Vec::new(),
            body_radius: 0.0,
            preset,
            aircraft: AircraftModel::reference().plane(),
            world_scale: 1.0,
            paths: USUAL_PATHS,
            replan_ticks: TICKS_PER_SECOND,
            latency_ticks: 1,
            slices_per_tick: u32::MAX,
            ticks: 20 * TICKS_PER_SECOND,
            lidar,
            air_data: AirDataNoise::PAPER,
            navigation: match preset {
                Preset::Reference | Preset::Paper => NavigationConfig::IDEAL,
                Preset::Flight => NavigationConfig::RTK,
            },
            faults: Faults::default(),
            oracle: false,
            known_map: false,
        }
    }

    /// The same flight with an oracle as its core.
    #[must_use]
    pub fn informed(self) -> Self {
        Self {
            preset: Preset::Flight,
            replan_ticks: self.oracle_ticks(),
            latency_ticks: 1,
            slices_per_tick: u32::MAX,
            air_data: AirDataNoise::NONE,
            navigation: NavigationConfig::IDEAL,
            oracle: true,
            ..self
        }
    }

    /// The most candidates of a cycle, as the preset finds them.
    #[must_use]
    pub fn most_candidates(&self) -> usize {
        usize::from(self.paths).min(self.preset.most_paths())
    }

    /// Whether the core gets advice of an [`crate::oracle`], which knows more than the sensors tell.
    #[must_use]
    pub fn is_advised(&self) -> bool {
        self.oracle || self.known_map
    }

    /// Ticks from one plan of an oracle to the next.
    fn oracle_ticks(&self) -> u32 {
        let reference = f64::from(TICKS_PER_SECOND) / ORACLE_REPLAN_HZ;
        (reference * self.aircraft.units().time).round().max(1.0) as u32
    }

    /// The core's level trim.
    ///
    /// # Errors
    /// [`TrimError`] when the aircraft has no level flight.
    pub fn trim(&self) -> Result<Trim, TrimError> {
        let cruise = match self.preset {
            Preset::Flight => return Ok(self.aircraft.trim),
            paper => paper.settings().cruise,
        };
        cruise.trim(&self.aircraft.known.airframe)
    }

    /// The limits of the actuators: those of the aircraft, or the narrower ones among the scenario's faults.
    #[must_use]
    pub fn limits(&self) -> ActuatorLimits {
        let own = self.aircraft.actuators;
        let more = self.faults.actuators.limits();
        let least = |a: Option<f64>, b: Option<f64>| [a, b].into_iter().flatten().reduce(f64::min);
        ActuatorLimits {
            thrust_max: least(own.thrust_max, more.thrust_max),
            thrust_lag: more.thrust_lag.or(own.thrust_lag),
            elevator_below: least(own.elevator_below, more.elevator_below),
            elevator_above: least(own.elevator_above, more.elevator_above),
            elevator_rate: least(own.elevator_rate, more.elevator_rate),
            elevator_delay: more.elevator_delay.or(own.elevator_delay),
            thrust_delay: more.thrust_delay.or(own.thrust_delay),
        }
    }

    /// The state at the start of the flight: level flight in the core's trim.
    ///
    /// # Errors
    /// [`TrimError`] when the aircraft has no level flight.
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
        let mut obstacles = self.drawn();
        obstacles.extend(self.placed.iter().cloned());
        ObstacleField::new(obstacles)
    }

    /// The obstacles that the seed draws: the random ones and the scene's.
    fn drawn(&self) -> Vec<Obstacle> {
        // Times are scaled by the root of the lengths.
        let (seed, duration) = (self.seed, self.duration() / self.world_scale.sqrt());
        let mut obstacles = self
            .generator
            .obstacles(seed, self.obstacles, ALTITUDE, duration);
        if let Some(scene) = self.scene {
            obstacles.extend(scene.obstacles(seed, 0.0, ALTITUDE));
        }
        // No other scale than 1 leaves every bit as it was drawn.
        if (self.world_scale - 1.0).abs() > 0.0 {
            for obstacle in &mut obstacles {
                *obstacle = obstacle.scaled(self.world_scale, ALTITUDE);
            }
        }
        obstacles
    }

    /// Length of the flight \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        Self::time(self.ticks)
    }

    /// Replanning rate \[Hz\].
    #[must_use]
    pub fn replan_hz(&self) -> f64 {
        f64::from(TICKS_PER_SECOND) / f64::from(self.replan_ticks)
    }

    /// The configuration that the core gets.
    #[must_use]
    pub fn configure(&self) -> Configure {
        Configure {
            preset: match self.preset {
                Preset::Reference => hil_protocol::Preset::Reference,
                Preset::Paper => hil_protocol::Preset::Paper,
                Preset::Flight => hil_protocol::Preset::Flight,
            },
            aircraft: Aircraft {
                body_radius: self.body_radius,
                ..self.aircraft.known
            },
            paths: self.paths,
            replan_period_ticks: self.replan_ticks,
            latency_ticks: self.latency_ticks,
            slices_per_tick: self.slices_per_tick,
            seed: self.seed,
            beams: u16::try_from(self.lidar.beams).unwrap_or(u16::MAX),
            range_max: self.lidar.farthest() as f32,
            altitude: ALTITUDE,
            actuators: self.limits(),
        }
    }

    /// Greatest distance from the initial altitude of a strict success \[m\].
    #[must_use]
    pub fn band(&self) -> f64 {
        ALTITUDE_BAND * self.world_scale
    }

    /// Time of a tick \[s\].
    #[must_use]
    pub fn time(tick: u32) -> f64 {
        f64::from(tick) * TICK_PERIOD
    }
}
