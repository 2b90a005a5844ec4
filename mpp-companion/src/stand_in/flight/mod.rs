//! One flight of companion and stand-in, in lockstep and in simulated time.

mod exchange;
pub(crate) mod rig;

use super::autopilot::StandIn;
use super::faults::Fault;
use crate::wire::Framer;
use crate::{
    Companion, CompanionError, Config, Kind, LogWriter, Replayed, ScanSource, Side, State, Told,
};
use mpp_sim::field::Field;
use mpp_sim::random::{Draws, Stream, generator};
use mpp_sim::scenario::{Scenario, ScenarioFile};
use rig::Rig;
use std::collections::VecDeque;

/// How far the field is moved, so that it begins where the core takes over: level flight of 7 s.
const RUN_UP: f64 = 7.0;
/// Ticks from the switch of the mode until a fault begins.
const FAULT: u32 = 800;
/// The tick at which the pilot gives the aircraft.
const CHOSEN: u32 = 150;

/// What is flown.
#[derive(Clone, Debug)]
pub struct Flight {
    /// The kind of autopilot.
    pub kind: Kind,
    /// Seed.
    pub seed: u64,
    /// Obstacles over the length of the field.
    pub obstacles: usize,
    /// Dead time of the pitch \[ticks\], and whether the companion's aircraft file tells it.
    pub dead: usize,
    /// Whether it is told.
    pub told: bool,
    /// Replanning \[Hz\].
    pub replan_hz: f64,
    /// Wind along the course [m/s].
    pub wind: f64,
    /// Intensity of the turbulence [m/s].
    pub gusts: f64,
    /// Fault of the exchange.
    pub fault: Option<Fault>,
    /// What sends scans.
    pub source: ScanSource,
}

/// How it went.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Least distance to an obstacle, less the body \[m\].
    pub clearance: f64,
    /// Greatest distance from the height at which the core took over \[m\].
    pub off: f64,
    /// Greatest distance from the course at the start \[m\].
    pub aside: f64,
    /// Whether the core had the aircraft to the end of the field.
    pub flown: bool,
    /// Setpoints that were sent.
    pub setpoints: u32,
    /// Setpoints that were not finite or beyond limits.
    pub unsound: u32,
    /// Setpoints after the companion heard of a take-over.
    pub late: u32,
    /// Height at the end above that at which the core took over \[m\].
    pub end: f64,
    /// Time from a take-over to the last setpoint \[ms\].
    pub last_after: u32,
    /// What the companion told.
    pub told: Vec<Told>,
}

impl Outcome {
    /// Past the field, within the strict band, without a touch.
    #[must_use]
    pub fn is_strict(&self, scenario: &Scenario) -> bool {
        self.flown && self.clearance > 0.0 && self.off <= scenario.band()
    }
}

impl Flight {
    /// `ArduPlane`, 20 obstacles, 2 Hz, a dead time of 0.1 s that is told.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            kind: Kind::ArduPlane,
            seed,
            obstacles: 20,
            dead: 10,
            told: true,
            replan_hz: 2.0,
            wind: 0.0,
            gusts: 0.0,
            fault: None,
            source: ScanSource::Frames,
        }
    }

    /// 40 obstacles, 4 Hz.
    #[must_use]
    pub fn forty(seed: u64) -> Self {
        Self {
            obstacles: 40,
            replan_hz: 4.0,
            ..Self::new(seed)
        }
    }

    /// The scenario: field, lidar, plant.
    ///
    /// # Errors
    /// [`CompanionError::Aircraft`].
    pub fn scenario(&self) -> Result<Scenario, CompanionError> {
        let text = super::AIRCRAFT;
        let file = mpp_sim::aircraft_file::AircraftFile::parse("plane.toml", text)?;
        let mut scenario = ScenarioFile {
            aircraft: Some(file),
            seed: Some(self.seed),
            obstacles: Some(self.obstacles),
            replan_hz: Some(self.replan_hz),
            ..ScenarioFile::default()
        }
        .build()?;
        scenario.faults.gusts.intensity = self.gusts;
        Ok(scenario)
    }

    fn config(&self, scenario: &Scenario) -> Config {
        let mut model = scenario.aircraft.clone();
        model.known.body_radius = scenario.body_radius;
        if !self.told {
            model.actuators.elevator_delay = None;
        }
        Config {
            source: self.source,
            replan_ticks: scenario.replan_ticks,
            ..Config::new(model, scenario.lidar.farthest() as f32)
        }
    }

    /// Flies, and logs what goes in and out.
    ///
    /// # Errors
    /// [`CompanionError`].
    pub fn fly(&self, log: Option<&mut Vec<u8>>) -> Result<Outcome, CompanionError> {
        let scenario = self.scenario()?;
        let companion = Companion::new(self.config(&scenario))?;
        let mut plant = scenario.clone();
        // The dead time is the autopilot's, of the pitch that is demanded. The plant has none beside it.
        plant.aircraft.actuators.elevator_delay = None;
        plant.aircraft.actuators.elevator_below = None;
        plant.aircraft.actuators.elevator_above = None;
        let no_trim = |error: mpp_core::vehicle::TrimError| {
            mpp_sim::scenario::ScenarioError::Value("aircraft", error.to_string())
        };
        let autopilot = StandIn::new(self.kind, &plant, self.wind, self.dead).map_err(no_trim)?;
        let run = Run {
            kind: self.kind,
            rig: Rig::new(self.source, self.seed, scenario.lidar),
            noise: generator(self.seed, Stream::AirspeedSensor),
            fault: self.fault,
            companion,
            autopilot,
            log: log.map(LogWriter),
            up: VecDeque::new(),
            down: VecDeque::new(),
            framer: Framer::default(),
            count: 0,
            held: None,
            frozen: None,
            given: false,
            taken: None,
            outcome: Outcome {
                clearance: f64::INFINITY,
                ..Outcome::default()
            },
        };
        run.fly(&scenario)
    }

    /// Flies a log again.
    ///
    /// # Errors
    /// [`CompanionError::Differs`].
    pub fn replay(&self, log: &[u8]) -> Result<Replayed, CompanionError> {
        let mut companion = Companion::new(self.config(&self.scenario()?))?;
        crate::replay(&mut companion, log)
    }
}

struct Run<'a> {
    kind: Kind,
    companion: Companion,
    autopilot: StandIn,
    rig: Rig,
    noise: Draws,
    fault: Option<Fault>,
    log: Option<LogWriter<&'a mut Vec<u8>>>,
    /// Frames to the companion, and to the autopilot, with the tick at which they arrive.
    up: VecDeque<(u32, Vec<u8>)>,
    down: VecDeque<(u32, Vec<u8>)>,
    framer: Framer,
    count: u32,
    held: Option<Vec<u8>>,
    frozen: Option<Vec<Vec<u8>>>,
    /// Whether the companion had the aircraft in the last tick.
    given: bool,
    /// When the pilot took over, and whether the companion heard of it.
    taken: Option<(u32, bool)>,
    outcome: Outcome,
}

impl Run<'_> {
    fn fly(mut self, scenario: &Scenario) -> Result<Outcome, CompanionError> {
        let speed = scenario.aircraft.file.cruise;
        let shift = speed * RUN_UP + 0.01 * f64::from(CHOSEN) * speed;
        let mut obstacles = scenario.field().obstacles().to_vec();
        for obstacle in &mut obstacles {
            obstacle.shape.shift((shift, 0.0));
        }
        let field = mpp_sim::field::ObstacleField::new(obstacles);
        let end = shift + 242.0 * scenario.world_scale;
        let mut start = None;
        while self.autopilot.state().x < end && self.autopilot.tick < 9000 {
            let before = self.autopilot.state();
            self.tick(&field);
            if self.autopilot.step().is_err() {
                self.outcome.clearance = -1.0;
                break;
            }
            let after = self.autopilot.state();
            let clearance =
                field.clearance_of_motion((before.x, before.z), (after.x, after.z), 0.01);
            self.outcome.aside = self.outcome.aside.max(self.autopilot.aside());
            let clear = clearance - scenario.body_radius;
            self.outcome.clearance = self.outcome.clearance.min(clear);
            if self.outcome.setpoints > 0 {
                // The core keeps to the height at which it took over, which gusts have moved.
                let off = after.z - *start.get_or_insert(before.z);
                self.outcome.off = self.outcome.off.max(off.abs());
                self.outcome.end = off;
            }
        }
        self.outcome.flown = self.companion.state() == State::Flying;
        self.outcome.told = self.companion.told();
        Ok(self.outcome)
    }

    fn since(&self) -> Option<u32> {
        self.autopilot.tick.checked_sub(CHOSEN + FAULT)
    }

    /// The fault, once it has begun.
    fn acting(&self) -> Option<Fault> {
        self.fault.filter(|_| self.since().is_some())
    }

    /// The companion's clock \[us\].
    fn now(&self) -> u64 {
        let tick = i64::from(self.autopilot.tick);
        let slower = match self.fault {
            Some(Fault::Drift(parts)) => tick * parts,
            _ => 0,
        };
        u64::try_from(3_000_000 + 10_000 * tick + slower).unwrap_or(0)
    }

    fn tick(&mut self, field: &dyn Field) {
        let tick = self.autopilot.tick;
        if tick == CHOSEN {
            self.autopilot.give();
        }
        if let (Some(fault), Some(since)) = (self.fault, self.since()) {
            fault.act(&mut self.autopilot, since);
        }
        let given = self.autopilot.is_given();
        if given {
            self.taken = None;
        } else if self.given {
            self.taken = Some((tick, false));
        }
        self.given = given;
        if let Some(frame) = self.autopilot.says() {
            self.post_up(frame);
        }
        if tick.is_multiple_of(2) {
            let noise = self.draw();
            for frame in self.autopilot.stream(noise) {
                self.post_up(frame);
            }
            self.input(Side::Time, &[]);
        }
        self.scan(field);
        while self.up.front().is_some_and(|(due, _)| *due <= tick) {
            let Some((_, frame)) = self.up.pop_front() else {
                break;
            };
            self.note(&frame);
            self.input(Side::Autopilot, &frame);
        }
        self.deliver(tick);
    }

    fn scan(&mut self, field: &dyn Field) {
        let mut sent = self.rig.sends(&self.autopilot, field);
        match self.acting() {
            Some(Fault::LidarSilent) => return,
            Some(Fault::LidarFrozen) if !sent.is_empty() => {
                sent = self.frozen.get_or_insert(sent).clone();
            }
            _ => {}
        }
        for bytes in sent {
            self.input(Side::Lidar, &bytes);
        }
    }
}
