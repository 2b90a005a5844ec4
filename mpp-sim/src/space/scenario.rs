//! The parameters of a flight in space.

use super::baseline::{Baseline, BaselineName};
use super::lidar::SpaceLidarConfig;
use super::world::{Body, Extent, Terrain, World};
use super::{Hull, SensorErrors, WindConfig, lateral, regulator};
use crate::aircraft_file::{AircraftFile, AircraftModel};
use crate::field::ObstacleField;
use crate::file_error::{ScenarioError, ensure};
use crate::lidar::LidarConfig;
use crate::log::{Header, SpaceHeader};
use crate::navigation::NavigationConfig;
use crate::scenario::{Preset, Scenario, TICK_MS, TICKS_PER_SECOND};
use crate::sensors::AirDataNoise;
use hil_protocol::{Configure, ConfigureLateral, ConfigureSpace};
use mpp_core::config::MAX_PATHS;
use mpp_core::planner::space::SPACE_CANDIDATES;
use serde::{Deserialize, Serialize};

/// Name of the preset on the command line, in scenario files and in logs.
pub const SPACE: &str = "space";
/// Distance of plans from what hits have shown, beyond the radius of a sphere or the half span \[m\]. Source: decision 58.
pub(super) const MARGIN: f64 = 0.3;
/// Part of a fuselage that reaches below its wing, and room to ceiling and sides \[m\].
const BELOW: f64 = 0.5;
const ROOM: f64 = 0.3;
const SIDE_ROOM: f64 = 0.5;
/// Fuselage \[m\]: half its length as a share of the span, and its radius.
const HALF_LENGTH: f64 = 0.4;
const FUSELAGE: f64 = 0.08;
/// Longest flight \[ticks\].
const MOST_TICKS: u32 = 4000;

/// How beams find their poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deskew {
    /// Whether each beam bears its own time; otherwise all of a sweep bear that of its end.
    pub active: bool,
    /// Error of the lidar's clock \[s\]; beams seem so much older than they are.
    pub clock: f64,
}

impl Deskew {
    /// Each beam at its own time, by a clock that is right.
    pub const RIGHT: Self = Self {
        active: true,
        clock: 0.0,
    };
}

/// The keys of a flight in space. Every key may be absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SpaceFile {
    /// `space`.
    pub preset: Option<String>,
    /// Name of an aircraft or its table, with a lateral part; by default `ultrastick`.
    #[serde(deserialize_with = "AircraftFile::named_or_table")]
    pub aircraft: Option<AircraftFile>,
    /// Airspeed of level flight [m/s]; by default that of the aircraft's file, and 13 of `ultrastick`.
    pub airspeed: Option<f64>,
    /// Generator of the world; by default `forest`.
    pub world: Option<String>,
    /// Density of the world in the unit of its generator; by default the usual one.
    pub density: Option<f64>,
    /// Side of the windows of `walls` \[m\]; by default 5.
    pub window: Option<f64>,
    /// Height map to fly over in place of a drawn world; by default none.
    pub terrain: Option<Terrain>,
    /// Wanted height over terrain or `hills`, above the ground at the start \[m\]; by default 15.
    pub altitude: Option<f64>,
    /// Name of the lidar; by default `grid-90x16`.
    pub lidar: Option<String>,
    /// Greatest range of the lidar \[m\], as in haze or before dark bark; by default what the lidar has.
    pub sight: Option<f64>,
    /// Radius of a sphere that stands for wing and fuselage \[m\].
    pub sphere: Option<f64>,
    /// Measurements without errors; by default `false`.
    pub exact: Option<bool>,
    /// Beams go through what they hit and return all that is on their way: nothing hides anything; by default `false`.
    pub see_through: Option<bool>,
    /// Candidates of a cycle, the previous plan included; by default 3. Of the baseline `paper` the paths, by default 25.
    pub candidates: Option<u8>,
    /// Whether a program improves each candidate; by default `true`.
    pub programs: Option<bool>,
    /// Name of a baseline that plans in place of the planner; by default none.
    pub baseline: Option<String>,
    /// `open` to fly only plans with a way out, in a drawn world 120 m wide; by default `forest`.
    pub mode: Option<String>,
    /// Steady wind ahead, to the right and up [m/s]; by default none.
    pub wind: Option<[f64; 3]>,
    /// Standard deviation of the vertical gusts [m/s]; those along and across are 1.6 times as strong; by default 0.
    pub gusts: Option<f64>,
    /// Whether beams bear their own time, and not that of the end of their sweep; by default `true`.
    pub deskew: Option<bool>,
    /// Error of the lidar's clock \[ms\]: beams seem so much older than they are; by default 0.
    pub lidar_clock: Option<f64>,
    /// Rate of the cycles \[Hz\]; by default 10.
    pub replan_hz: Option<f64>,
    /// Time from the start of a cycle until its plan is flown \[ms\]; by default 50.
    pub latency_ms: Option<u32>,
    /// Seed of world, measurements and gusts; by default 1.
    pub seed: Option<u64>,
}

/// A flight in space, in full.
#[derive(Clone, Debug)]
pub struct SpaceScenario {
    /// Aircraft, seed, faults and air in the vertical plane.
    pub plane: Scenario,
    /// Where it flies.
    pub world: World,
    /// Motion of the air besides.
    pub wind: WindConfig,
    /// How beams find their poses.
    pub deskew: Deskew,
    /// What plans in place of the planner.
    baseline: Option<BaselineName>,
    lidar: SpaceLidarConfig,
    header: SpaceHeader,
    candidates: u8,
}

impl SpaceFile {
    /// Builds the flight, among the trunks of a stem map if there is one.
    ///
    /// # Errors
    /// [`ScenarioError::Value`] with the key and what to give.
    pub fn build(&self, stems: Option<&[Body]>) -> Result<SpaceScenario, ScenarioError> {
        let usual =
            || AircraftFile::known("ultrastick").map(|it| AircraftFile { cruise: 13.0, ..it });
        let Some(mut file) = self.aircraft.clone().or_else(usual) else {
            return Err(ScenarioError::Value("aircraft", "give one".to_owned()));
        };
        file.cruise = self.airspeed.unwrap_or(file.cruise);
        let seed = self.seed.unwrap_or(1);
        let baseline = self.baseline()?;
        let (usual, most) = match baseline {
            Some(BaselineName::Paper) => (25, MAX_PATHS),
            _ => (3, SPACE_CANDIDATES),
        };
        let candidates = self.candidates.unwrap_or(usual);
        let sound = (1..=most).contains(&usize::from(candidates));
        ensure(sound, "candidates", format!("give 1 to {most}"))?;
        let sphere = self.sphere.is_none_or(|it| it > 0.0 && it <= 10.0);
        ensure(sphere, "sphere", "give more than 0 and at most 10 m")?;
        let preset = self.preset.as_deref().unwrap_or(SPACE);
        ensure(preset == SPACE, "preset", "give space")?;
        let period = f64::from(TICKS_PER_SECOND) / self.replan_hz.unwrap_or(10.0);
        let whole = (10.0..=100.0).contains(&period) && (period - period.round()).abs() < 0.01;
        let advice = "give a rate from 1 to 10 Hz of which 100 Hz is a whole multiple";
        ensure(whole, "replan_hz", advice)?;
        let latency = self.latency_ms.unwrap_or(50);
        let whole = latency.is_multiple_of(TICK_MS) && (TICK_MS..=1000).contains(&latency);
        ensure(whole, "latency_ms", "give a multiple of 10 up to 1000 ms")?;
        let (steady, gusts) = (self.wind.unwrap_or_default(), self.gusts.unwrap_or(0.0));
        let weak = steady.iter().all(|it| it.abs() <= 30.0);
        ensure(weak, "wind", "give three speeds of at most 30 m/s")?;
        ensure((0.0..=5.0).contains(&gusts), "gusts", "give 0 to 5 m/s")?;
        let clock = self.lidar_clock.unwrap_or(0.0);
        let sound = (-20.0..=100.0).contains(&clock);
        ensure(sound, "lidar_clock", "give -20 to 100 ms")?;
        let lidar = SpaceLidarConfig::kept(self.lidar.as_deref().unwrap_or("grid-90x16"))?;
        let (world, name, density) = self.world(seed, stems)?;
        let Extent {
            length,
            half_width,
            ceiling,
        } = *world.extent();
        let mut plane = Scenario {
            aircraft: AircraftModel::new(file)?,
            replan_ticks: period.round() as u32,
            latency_ticks: latency / TICK_MS,
            ticks: MOST_TICKS,
            ..Scenario::new(Preset::Flight, seed)
        };
        plane.faults.gusts.intensity = gusts;
        let scenario = SpaceScenario {
            plane,
            world,
            wind: WindConfig {
                steady,
                lateral_gusts: gusts,
                ..WindConfig::default()
            },
            deskew: Deskew {
                active: self.deskew.unwrap_or(true),
                clock: 0.001 * clock,
            },
            baseline,
            lidar: lidar.seeing(self.sight)?,
            header: SpaceHeader {
                world: name.map(|name| name.name().to_owned()),
                density,
                window: self.window,
                terrain: self.terrain.clone(),
                altitude: self.altitude,
                lidar: self.lidar.clone(),
                stems: stems.unwrap_or_default().iter().filter_map(stem).collect(),
                extent: [length, half_width, ceiling],
                sphere: self.sphere,
                exact: self.exact.unwrap_or(false),
                see_through: self.see_through.unwrap_or(false),
                programs: self.programs.unwrap_or(true),
                baseline: self.baseline.clone(),
                mode: self.mode()?.written(),
                wind: self.wind,
                deskew: self.deskew.filter(|active| !active),
                lidar_clock: self.lidar_clock,
            },
            candidates,
        };
        scenario.check()?;
        Ok(scenario)
    }

    fn baseline(&self) -> Result<Option<BaselineName>, ScenarioError> {
        let Some(name) = &self.baseline else {
            return Ok(None);
        };
        let name = name
            .parse::<BaselineName>()
            .map_err(|error| ScenarioError::Value("baseline", error.to_string()))?;
        let draws = name == BaselineName::Paper;
        let alone =
            (self.candidates.is_none() || draws) && self.programs.is_none() && self.mode.is_none();
        let advice = "leave candidates, programs and mode out: they are the planner's; paper takes candidates";
        ensure(alone, "baseline", advice)?;
        Ok(Some(name))
    }
}

/// A trunk as the log writes it.
fn stem(body: &Body) -> Option<(f64, f64, f64, Option<f64>)> {
    match *body {
        Body::Cylinder {
            x,
            y,
            radius,
            height,
        } => Some((x, y, radius, Some(height).filter(|it| it.is_finite()))),
        _ => None,
    }
}

impl SpaceScenario {
    /// Refuses an aircraft that cannot bank, and a world without room for its wing.
    fn check(&self) -> Result<(), ScenarioError> {
        let lateral = lateral(&self.plane)?;
        if lateral.roll_loop.is_none() {
            regulator(&self.plane)?;
        }
        let hull = self.hull();
        let room = self.world.extent().half_width - SIDE_ROOM;
        let advice = format!(
            "its half span of {:.1} m leaves no room in a band of {room:.1} m to either side",
            hull.half_span
        );
        ensure(hull.half_span + 1.0 < room, "aircraft", advice)?;
        match self.world.narrows(hull.half_span, hull.radius) {
            None => Ok(()),
            Some(x) => Err(ScenarioError::Value(
                "world",
                format!(
                    "the aircraft is wider than every gap at {x:.1} m ahead: take a smaller one, or a lighter world"
                ),
            )),
        }
    }

    /// What the aircraft can hit something with.
    #[must_use]
    pub fn hull(&self) -> Hull {
        let lateral = self.plane.aircraft.file.lateral.as_ref();
        let span = lateral.map_or(0.0, |lateral| lateral.span);
        match self.header.sphere {
            Some(radius) => Hull {
                half_span: 0.0,
                half_length: 0.0,
                radius,
            },
            None => Hull {
                half_span: 0.5 * span,
                half_length: HALF_LENGTH * span,
                radius: FUSELAGE,
            },
        }
    }

    /// The lidar. Each cycle takes one whole sweep.
    #[must_use]
    pub fn lidar(&self) -> SpaceLidarConfig {
        self.lidar
    }

    /// Whether beams go through what they hit.
    pub(super) fn sees_through(&self) -> bool {
        self.header.see_through
    }

    /// Errors of the sensors.
    #[must_use]
    pub fn errors(&self) -> SensorErrors {
        if self.header.exact {
            SensorErrors::EXACT
        } else {
            SensorErrors::RTK
        }
    }

    /// Height of the start and of plans \[m\].
    #[must_use]
    pub fn altitude(&self) -> f64 {
        self.world.altitude()
    }

    /// What plans in place of the planner, if anything does.
    pub(super) fn baseline(&self) -> Option<Baseline> {
        let name = self.baseline?;
        Some(Baseline::new(
            name,
            self.altitude(),
            &self.configure_space(),
            self.candidates.into(),
            self.plane.seed,
        ))
    }

    /// The lateral part of the aircraft for the core.
    pub(super) fn configure_lateral(&self) -> Option<ConfigureLateral> {
        let lateral = self.plane.aircraft.file.lateral.as_ref()?;
        let rudder = lateral.rudder.as_ref();
        let most = [
            lateral.aileron.range.to_radians(),
            rudder.map_or(0.0, |rudder| rudder.range.to_radians()),
        ];
        Some(ConfigureLateral {
            airframe: lateral.airframe(),
            surfaces_max: most.map(Some),
            surface_rate: Some(lateral.aileron.rate.to_radians()),
            roll_loop: lateral.roll_loop.map(|it| it.delay),
        })
    }

    /// Limits and distances of plans for the core.
    pub(super) fn configure_space(&self) -> ConfigureSpace {
        let (hull, extent) = (self.hull(), self.world.extent());
        let sphere = self.header.sphere;
        let lowest = self.world.terrain().map_or(0.0, |it| it.heights()[0]);
        ConfigureSpace {
            bank: self.plane.aircraft.file.plan_bank(),
            margin: MARGIN + sphere.unwrap_or(0.0),
            half_span: hull.half_span,
            heights: [lowest + hull.radius + BELOW, extent.ceiling - ROOM],
            half_width: extent.half_width - SIDE_ROOM,
            programs: self.header.programs,
            open: self.header.mode.is_some(),
        }
    }

    /// The rest of the configuration.
    pub(super) fn configure(&self) -> Configure {
        Configure {
            preset: hil_protocol::Preset::Space,
            paths: u16::from(self.candidates),
            beams: 1,
            range_max: self.lidar.range[1] as f32,
            altitude: self.altitude(),
            ..self.plane.configure()
        }
    }

    /// The header of the flight's log.
    #[must_use]
    pub fn header(&self) -> Header {
        let (lidar, errors) = (self.lidar, self.errors());
        let plane = Scenario {
            lidar: LidarConfig {
                beams: lidar.beams(),
                field_of_view: (lidar.azimuth[1] - lidar.azimuth[0]).to_radians(),
                range_max: lidar.range[1],
                range_error: lidar.noise[1],
                ..LidarConfig::PAPER
            },
            air_data: AirDataNoise {
                airspeed_sigma: errors.airspeed,
                pitch_sigma: errors.attitude,
            },
            navigation: NavigationConfig::IDEAL,
            ..self.plane.clone()
        };
        Header {
            preset: SPACE.to_owned(),
            obstacles: self.world.bodies().len(),
            paths: usize::from(self.candidates),
            space: Some(self.header.clone()),
            ..Header::of(&plane, &ObstacleField::new(Vec::new()))
        }
    }
}
