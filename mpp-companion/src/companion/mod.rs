//! The companion: inputs with their times go in, frames to the autopilot come out.

mod asked;
mod config;
mod core_side;
mod level;
mod questions;

pub use config::Config;

use crate::CompanionError;
use crate::autopilot::{AUTOPILOT, Kind, SYSTEM};
use crate::brain::Brain;
use crate::checks::Checked;
use crate::clock::Clock;
use crate::frames::{CourseFrame, Placed, is_finite};
use crate::guard::{Guard, Reason, Sight, State};
use crate::lidar::{Lidar, Pose};
use crate::setpoint::{Gate, Setpoint};
use crate::wire::{Framer, Mav, OWN_COMPONENT, Sender};
use asked::Asked;
use mavlink::dialects::common::{
    ATTITUDE_DATA, HEARTBEAT_DATA, LOCAL_POSITION_NED_DATA, MavModeFlag, SET_ATTITUDE_TARGET_DATA,
};

/// Ticks for which the core may be without trust in a sensor: it flies on without that sensor.
const UNSURE: u32 = 100;

/// For how long an attitude is turned on by its rates \[s\]. From then on it shows no pose.
const LATEST: f64 = 0.15;

/// Where an input comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Bytes of the autopilot.
    Autopilot,
    /// A datagram of the lidar.
    Lidar,
    /// No bytes: time passed. It comes each 20 ms.
    Time,
}

/// What the companion tells its user.
#[derive(Clone, Debug, PartialEq)]
pub enum Told {
    /// The state changed.
    State(State, Reason),
    /// What was verified, or why the companion is not ready.
    Verified(String),
    /// What of the lidar is not used, and why.
    Lidar(String),
    /// The core cannot fly.
    Core(String),
}

/// What the autopilot said last.
#[derive(Default)]
struct Heard {
    /// When anything came \[us\].
    at: Option<u64>,
    armed: bool,
    mode: Option<u32>,
    attitude: Option<ATTITUDE_DATA>,
    /// The last attitude whose numbers are all finite.
    sound: Option<ATTITUDE_DATA>,
    position: Option<LOCAL_POSITION_NED_DATA>,
    /// Height of the estimator's origin above home \[m\].
    origin: Option<f32>,
    airspeed: Option<f64>,
    /// When an airspeed came that the core has not got yet \[us\].
    fresh: Option<u64>,
}

/// A flight by the core.
struct Flown {
    brain: Brain,
    frame: CourseFrame,
    /// The autopilot's time of tick 0 \[ms\].
    start: u32,
    /// Height at hand-over \[m\].
    height: f64,
    placed: Option<Placed>,
    /// When a heading was asked for last \[us\].
    headed: Option<u64>,
}

/// A companion. It has no clock: each input bears its time.
pub struct Companion {
    config: Config,
    /// The kind of autopilot, once it is known.
    kind: Option<Kind>,
    thrust_max: f64,
    framer: Framer,
    sender: Sender,
    heard: Heard,
    lidar: Lidar,
    clock: Clock,
    checked: Checked,
    guard: Guard,
    /// Height \[m\] and line that PX4 was given on.
    held: Option<(f64, CourseFrame)>,
    flown: Option<Flown>,
    asked: Asked,
    told: Vec<Told>,
}

impl Companion {
    /// A companion that has heard nothing.
    ///
    /// # Errors
    /// [`CompanionError::Lacks`] or [`CompanionError::NoPitchLoop`] when the aircraft is not one that an autopilot flies,
    /// [`CompanionError::Range`], [`CompanionError::Mounting`] or [`CompanionError::Unseen`].
    pub fn new(config: Config) -> Result<Self, CompanionError> {
        if !(config.range > 0.0 && config.range.is_finite()) {
            return Err(CompanionError::Range(config.range));
        }
        if !config.model.known.airframe.commands_angle_of_attack() {
            return Err(CompanionError::NoPitchLoop);
        }
        let file = &config.model.file;
        let thrust_max = file.thrust.max.ok_or(CompanionError::Lacks("thrust.max"))?;
        if file.elevator.min.is_none() || file.elevator.max.is_none() {
            return Err(CompanionError::Lacks("pitch_loop.min and pitch_loop.max"));
        }
        let kind = config.kind;
        Ok(Self {
            lidar: Lidar::new(config.source, config.wanted())?,
            config,
            kind,
            thrust_max,
            framer: Framer::default(),
            sender: Sender::new(SYSTEM, OWN_COMPONENT),
            heard: Heard::default(),
            clock: Clock::default(),
            checked: Checked::new(kind.unwrap_or(Kind::ArduPlane)),
            guard: Guard::new(0.0),
            held: None,
            flown: None,
            asked: Asked::default(),
            told: Vec::new(),
        })
    }

    /// The state.
    #[must_use]
    pub fn state(&self) -> State {
        self.guard.state
    }

    /// What is new for the user.
    pub fn told(&mut self) -> Vec<Told> {
        std::mem::take(&mut self.told)
    }

    /// Takes an input at a time \[us\]. `send` gets each frame to the autopilot.
    pub fn receive(&mut self, now: u64, side: Side, bytes: &[u8], send: &mut dyn FnMut(&[u8])) {
        match side {
            Side::Autopilot => {
                let mut messages = Vec::new();
                self.framer.receive(bytes, |system, component, message| {
                    let autopilot = (system, component) == (u32::from(SYSTEM), AUTOPILOT);
                    // A sensor may speak through the autopilot.
                    if autopilot || matches!(message, Mav::OBSTACLE_DISTANCE(_)) {
                        messages.push((autopilot, message));
                    }
                });
                for (autopilot, message) in messages {
                    if autopilot {
                        self.heard.at = Some(now);
                    }
                    self.hear(now, &message, send);
                }
            }
            Side::Lidar => {
                let pose = self.pose_at(now);
                self.lidar.receive(now, bytes, pose.as_ref());
            }
            Side::Time => {
                self.look(now, send);
                self.ask(now, send);
            }
        }
    }

    fn hear(&mut self, now: u64, message: &Mav, send: &mut dyn FnMut(&[u8])) {
        match message {
            Mav::HEARTBEAT(beat) => {
                self.hear_heartbeat(beat);
                self.look(now, send);
            }
            Mav::CURRENT_MODE(mode) if self.kind == Some(Kind::Px4) => {
                self.heard.mode = Some(mode.custom_mode);
                self.look(now, send);
            }
            Mav::TIMESYNC(sync) if sync.tc1 != 0 => {
                self.clock.hear(now, sync.ts1 / 1000, sync.tc1 / 1000);
            }
            Mav::PARAM_VALUE(value) => self.checked.hear(value),
            Mav::VFR_HUD(hud) => {
                self.heard.airspeed =
                    Some(f64::from(hud.airspeed)).filter(|speed| speed.is_finite());
                self.heard.fresh = self.heard.airspeed.map(|_| now);
            }
            Mav::LOCAL_POSITION_NED(position) => self.hear_position(position),
            Mav::GLOBAL_POSITION_INT(global) => {
                let z = self.heard.position.as_ref().map(|position| position.z);
                let origin = z.map(|z| global.relative_alt as f32 * 1e-3 + z);
                let origin = origin.filter(|origin| origin.is_finite());
                self.heard.origin = origin.or(self.heard.origin);
            }
            Mav::OBSTACLE_DISTANCE(told) => {
                let pose = self.pose_at(now);
                self.lidar.hear(now, told, pose.as_ref());
            }
            Mav::ATTITUDE(attitude) => self.hear_attitude(now, attitude, send),
            _ => {}
        }
    }

    /// Attitude and speed at this time.
    fn pose_at(&self, now: u64) -> Option<Pose> {
        let told = self.heard.sound.as_ref()?.time_boot_ms;
        self.pose(self.clock.age(now, told)?)
    }

    /// Before a heartbeat came the companion asks what it asks ArduPlane for.
    fn asked_kind(&self) -> Kind {
        self.kind.unwrap_or(Kind::ArduPlane)
    }

    fn hear_heartbeat(&mut self, beat: &HEARTBEAT_DATA) {
        let custom = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
        let armed = MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED;
        self.heard.armed = beat.base_mode.contains(armed);
        let mode = beat.base_mode.contains(custom).then_some(beat.custom_mode);
        self.heard.mode = mode;
        let before = self.asked_kind();
        self.kind = self.config.kind.or_else(|| Kind::of(beat));
        if self.asked_kind() != before {
            self.checked = Checked::new(self.asked_kind());
            self.asked = Asked::default();
        }
    }

    fn hear_attitude(&mut self, now: u64, attitude: &ATTITUDE_DATA, send: &mut dyn FnMut(&[u8])) {
        let last = self.heard.attitude.as_ref().map(|last| last.time_boot_ms);
        if last.is_some_and(|last| attitude.time_boot_ms.saturating_add(1000) < last) {
            self.start_anew();
        } else if last.is_some_and(|last| attitude.time_boot_ms <= last) {
            return;
        }
        self.heard.attitude = Some(attitude.clone());
        if is_finite(attitude) {
            self.heard.sound = Some(attitude.clone());
        }
        self.look(now, send);
        self.think(now, attitude);
        self.look(now, send);
        self.propose(attitude, send);
    }

    /// The autopilot restarted: nothing that it said holds any more.
    fn start_anew(&mut self) {
        self.heard = Heard {
            at: self.heard.at,
            ..Heard::default()
        };
        self.flown = None;
        self.clock = Clock::default();
        self.checked = Checked::new(self.asked_kind());
        self.asked.told = false;
    }

    /// Lets the guard look, and does what its change asks for.
    fn look(&mut self, now: u64, send: &mut dyn FnMut(&[u8])) {
        let sight = self.sight(now);
        let Some(reason) = self.guard.look(&sight) else {
            return;
        };
        self.told.push(Told::State(self.guard.state, reason));
        match self.guard.state {
            State::GiveBack => self.give_back(send),
            State::Flying | State::Climb => {}
            State::Off | State::Ready | State::Listening | State::Lost => self.flown = None,
        }
        if self.guard.state == State::Lost && self.asked_kind().manners().flows {
            // It may have left the mode since.
            self.heard.mode = None;
        }
        match self.guard.state {
            State::Listening => self.held = self.line(),
            State::Flying | State::Climb => {}
            _ => self.held = None,
        }
    }

    /// What keeps the companion on the ground; `None` if all is well.
    fn flaw(&self) -> Option<String> {
        let lack = |lacks: bool, name| lacks.then(|| format!("{name} is not told"));
        let unknown = "the kind of autopilot is not told: it is neither ArduPlane nor a fixed wing of PX4; else give --kind";
        (self.kind.is_none().then(|| unknown.to_owned()))
            .or_else(|| self.checked.flaw())
            .or_else(|| lack(!self.clock.is_in_step(), "TIMESYNC"))
            .or_else(|| lack(self.heard.origin.is_none(), "GLOBAL_POSITION_INT"))
    }

    fn sight(&self, now: u64) -> Sight {
        let seconds =
            |at: Option<u64>| at.map_or(f64::INFINITY, |at| now.saturating_sub(at) as f64 * 1e-6);
        let attitude = self.heard.attitude.as_ref();
        let placed = self.flown.as_ref().and_then(|flown| flown.placed);
        let thought = self.flown.as_ref().and_then(|flown| flown.brain.last);
        let age = attitude.and_then(|last| self.clock.age(now, last.time_boot_ms));
        let bank = attitude.map_or(f64::NAN, |last| f64::from(last.roll).abs());
        let brain = self.flown.as_ref().map(|flown| &flown.brain);
        Sight {
            now: now as f64 * 1e-6,
            silence: seconds(self.heard.at),
            verified: self.flaw().is_none(),
            ours: self.heard.armed && self.heard.mode == Some(self.asked_kind().manners().mode),
            level: self.is_level(),
            fresh: brain.is_some_and(Brain::is_fresh),
            plans: brain.map_or(0, |brain| brain.plans),
            planless: brain.map_or(f64::INFINITY, |brain| f64::from(brain.planless) * 0.01),
            unseen: seconds(self.lidar.heard),
            sees: thought.is_some_and(|thought| thought.sees()),
            knows: brain.is_some_and(|brain| brain.last.is_some() && brain.unsure < UNSURE),
            age: age.unwrap_or(f64::NAN),
            bank,
            aside: placed.map_or(f64::NAN, |placed| placed.cross.abs()),
            climbed: self
                .flown
                .as_ref()
                .and_then(|flown| Some(flown.placed?.z - flown.height))
                .unwrap_or(0.0),
        }
    }

    /// Sends the setpoint of the state, if one may be sent.
    fn propose(&mut self, attitude: &ATTITUDE_DATA, send: &mut dyn FnMut(&[u8])) {
        let Some((pitch_min, pitch_max)) = self.checked.pitch() else {
            return;
        };
        let kind = self.asked_kind();
        let asked = match self.guard.state {
            _ if !self.guard.sends(kind.manners().flows) => None,
            State::Climb => Some(Setpoint {
                pitch: self.config.model.trim.state.pitch + 0.2,
                roll: 0.0,
                throttle: 1.0,
            }),
            State::Flying => self.wanted(),
            _ => self.level(),
        };
        let gate = Gate {
            pitch_min,
            pitch_max,
            bank: kind.manners().bank,
        };
        let asked = asked.map(|asked| Setpoint {
            roll: self.roll(kind),
            ..asked
        });
        let Some(setpoint) = asked.and_then(|asked| gate.pass(asked)) else {
            return;
        };
        let (q, type_mask) = kind.target(setpoint, f64::from(attitude.yaw));
        self.send(
            &Mav::SET_ATTITUDE_TARGET(SET_ATTITUDE_TARGET_DATA {
                time_boot_ms: attitude.time_boot_ms,
                q,
                thrust: setpoint.throttle as f32,
                target_system: SYSTEM,
                target_component: AUTOPILOT,
                type_mask,
                ..SET_ATTITUDE_TARGET_DATA::DEFAULT
            }),
            send,
        );
    }

    fn send(&mut self, message: &Mav, send: &mut dyn FnMut(&[u8])) {
        send(&self.sender.frame(message));
    }
}
