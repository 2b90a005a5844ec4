//! The autopilot and the aircraft: dead time, pitch loop, altitude hold and course hold, and the rules for setpoints.

mod messages;

use super::rules::{self, Watch};
use crate::autopilot::{AUTOPILOT, Kind, SYSTEM, px4};
use crate::frames::roll_pitch;
use crate::level::Level;
use crate::lidar::Rotation;
use crate::wire::{Framer, Mav, Sender};
use mavlink::dialects::common::{
    COMMAND_INT_DATA, COMMAND_LONG_DATA, MavCmd, SET_ATTITUDE_TARGET_DATA, TIMESYNC_DATA,
};
use mpp_core::vehicle::{Control, GRAVITY, VehicleState};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::plant::{Plant, PlantError};
use mpp_sim::scenario::Scenario;
use std::collections::{BTreeMap, VecDeque};

/// Time constant of the roll loop \[s\].
const ROLL: f64 = 0.3;
/// What the wings of PX4's aircraft hang to the right when it holds them level \[rad\]: its course must be held.
const SLANT: f64 = 0.02;
/// Height of the estimator's origin above home \[m\].
const ORIGIN: f64 = 12.0;

/// A setpoint that the autopilot obeys.
#[derive(Clone, Copy, Debug)]
struct Obeyed {
    at: u32,
    pitch: f64,
    /// Bank, where the autopilot takes it.
    roll: Option<f64>,
    throttle: f64,
}

/// An autopilot in its aircraft. A tick is 10 ms.
pub struct StandIn {
    kind: Kind,
    plant: Aircraft,
    level: Level,
    thrust_max: f64,
    density: f64,
    /// Ticks since power was switched on.
    pub(crate) tick: u32,
    /// Ticks at which the clock starts.
    pub(crate) booted: u32,
    /// The mode, and the one that it told last.
    pub(crate) mode: u32,
    said: u32,
    /// Whether the companion asked to be told of each mode at once.
    tells: bool,
    watch: Watch,
    /// Bank, course and distance to the right of the first course.
    lateral: [f64; 3],
    /// The first course \[rad\].
    course: f64,
    heading: f64,
    /// Ticks of dead time of pitch and bank.
    dead: usize,
    demands: VecDeque<(f64, Option<f64>)>,
    obeyed: Option<Obeyed>,
    /// Height that it holds by itself \[m\].
    height: f64,
    /// Wind along the course [m/s], and how far it has carried the aircraft \[m\].
    wind: f64,
    carried: f64,
    parameters: BTreeMap<&'static str, f32>,
    /// What the estimate has jumped: north, east, down \[m\].
    pub(crate) jumped: [f32; 3],
    framer: Framer,
    sender: Sender,
    /// Setpoints that were refused.
    pub(crate) refused: u32,
}

impl StandIn {
    /// An aircraft in level flight, in another mode than that of setpoints.
    ///
    /// # Errors
    /// When the aircraft has no level flight.
    pub fn new(
        kind: Kind,
        scenario: &Scenario,
        wind: f64,
        dead: usize,
    ) -> Result<Self, mpp_core::vehicle::TrimError> {
        let plant = Aircraft::new(scenario)?;
        let trim = scenario.trim()?;
        let state = *plant.state();
        let rules = rules::of(kind);
        Ok(Self {
            kind,
            level: Level {
                pitch: trim.state.pitch,
                thrust: trim.control.thrust,
                mass: scenario.aircraft.known.airframe.mass,
                cruise: trim.state.airspeed,
            },
            thrust_max: scenario.aircraft.file.thrust.max.unwrap_or(f64::MAX),
            density: scenario.aircraft.file.air_density,
            plant,
            tick: 0,
            booted: 0,
            mode: rules.other,
            said: rules.other,
            tells: kind == Kind::ArduPlane,
            watch: Watch::default(),
            lateral: [0.0, 0.7, 0.0],
            course: 0.7,
            heading: 0.7,
            dead,
            demands: VecDeque::new(),
            obeyed: None,
            height: state.z,
            wind,
            carried: 0.0,
            parameters: rules.parameters.iter().copied().collect(),
            jumped: [0.0; 3],
            framer: Framer::default(),
            sender: Sender::new(SYSTEM, AUTOPILOT),
            refused: 0,
        })
    }

    /// The true state over ground.
    #[must_use]
    pub fn state(&self) -> VehicleState {
        let state = *self.plant.state();
        VehicleState {
            x: state.x + self.carried,
            ..state
        }
    }

    /// From the axes of the body to ahead along the first course, right and down.
    pub(crate) fn attitude(&self) -> Rotation {
        let [bank, course, _] = self.lateral;
        Rotation::new([bank, self.plant.state().air.pitch, course - self.course])
    }

    /// The distance from the first course \[m\].
    pub(crate) fn aside(&self) -> f64 {
        self.lateral[2].abs()
    }

    /// Milliseconds since the autopilot started.
    fn boot_ms(&self) -> u32 {
        10 * (self.tick - self.booted)
    }

    /// Takes bytes of the companion. `send` gets each answer.
    pub(crate) fn receive(&mut self, bytes: &[u8], send: &mut dyn FnMut(Vec<u8>)) {
        let mut messages = Vec::new();
        self.framer
            .receive(bytes, |_, _, message| messages.push(message));
        for message in messages {
            match message {
                Mav::TIMESYNC(sync) if sync.tc1 == 0 => {
                    let tc1 = i64::from(self.boot_ms()) * 1_000_000 + 1;
                    let answer = TIMESYNC_DATA { tc1, ..sync };
                    send(self.sender.frame(&Mav::TIMESYNC(answer)));
                }
                Mav::PARAM_REQUEST_READ(request) => {
                    let name = request.param_id.to_str().unwrap_or_default();
                    if let Some(value) = self.parameters.get(name) {
                        let answer = rules::told(name, *value);
                        send(self.sender.frame(&Mav::PARAM_VALUE(answer)));
                    }
                }
                Mav::SET_ATTITUDE_TARGET(target) => self.obey(&target),
                Mav::COMMAND_INT(command) if self.is_given() => self.command(&command),
                Mav::COMMAND_LONG(command) if self.kind == Kind::Px4 => self.order(&command),
                _ => {}
            }
        }
    }

    /// Whether the mode takes setpoints.
    pub(crate) fn is_given(&self) -> bool {
        self.mode == self.kind.manners().mode
    }

    /// The pilot gives the aircraft. PX4 refuses while no setpoints flow.
    pub(crate) fn give(&mut self) {
        if self.kind == Kind::ArduPlane || self.watch.admits(self.tick, self.kept()) {
            self.mode = self.kind.manners().mode;
        }
    }

    /// The pilot, the companion or the autopilot itself ends that.
    pub(crate) fn take(&mut self) {
        self.mode = rules::of(self.kind).other;
        if self.kind == Kind::Px4 {
            // Hold keeps the height at which it begins. The real one circles.
            (self.height, self.heading) = (self.plant.state().z, self.lateral[1]);
        }
    }

    /// Ticks for which a setpoint is obeyed.
    fn kept(&self) -> u32 {
        let timeout = self.parameters.get(rules::of(self.kind).timeout);
        (100.0 * timeout.copied().unwrap_or(3.0)) as u32
    }

    /// Least and greatest pitch of the parameters \[rad\].
    pub(crate) fn pitch_limits(&self) -> [f64; 2] {
        self.kind.manners().pitch.map(|name| {
            self.parameters
                .get(name)
                .map_or(0.0, |deg| f64::from(*deg).to_radians())
        })
    }

    fn obey(&mut self, target: &SET_ATTITUDE_TARGET_DATA) {
        let mask = target.type_mask.bits();
        let (roll, pitch) = roll_pitch(target.q);
        let (is_asked, roll) = match self.kind {
            Kind::ArduPlane => (mask == 133, None),
            // Neither attitude nor throttle is left out.
            Kind::Px4 => (mask & (128 | 64) == 0, Some(roll)),
        };
        if is_asked {
            let kept = self.kept();
            self.watch.hear(self.tick, kept);
        }
        if !self.is_given() || !is_asked {
            self.refused += 1;
            return;
        }
        self.obeyed = Some(Obeyed {
            at: self.tick,
            pitch,
            roll,
            throttle: f64::from(target.thrust),
        });
    }

    /// It has the aircraft from a companion that dies after this setpoint.
    pub(crate) fn obey_last(&mut self, pitch: f64, throttle: f64) {
        self.mode = self.kind.manners().mode;
        self.watch.hear(self.tick, 0);
        let roll = (self.kind == Kind::Px4).then_some(0.0);
        self.obeyed = Some(Obeyed {
            at: self.tick,
            pitch,
            roll,
            throttle,
        });
    }

    /// PX4's commands.
    fn order(&mut self, command: &COMMAND_LONG_DATA) {
        let asked = [command.param1, command.param2, command.param3];
        match command.command {
            // Main mode AUTO, sub-mode LOITER.
            MavCmd::MAV_CMD_DO_SET_MODE if asked.map(|it| it as u8) == [1, 4, 3] => self.take(),
            MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL => {
                self.tells |= asked[0].to_bits() == px4::CURRENT_MODE.to_bits();
            }
            _ => {}
        }
    }

    fn command(&mut self, command: &COMMAND_INT_DATA) {
        match command.command {
            MavCmd::MAV_CMD_GUIDED_CHANGE_HEADING => {
                self.heading = f64::from(command.param2).to_radians();
            }
            MavCmd::MAV_CMD_GUIDED_CHANGE_ALTITUDE => {
                self.height = f64::from(command.z) - ORIGIN;
            }
            _ => {}
        }
    }

    /// Flies a tick.
    pub(crate) fn step(&mut self) -> Result<(), PlantError> {
        let state = *self.plant.state();
        let kept = self.kept();
        if self.kind == Kind::Px4 && self.is_given() && !self.watch.lives(self.tick, kept) {
            self.take();
        }
        let given = self.is_given();
        self.obeyed = self
            .obeyed
            .filter(|last| given && self.tick - last.at <= kept);
        let (pitch, thrust) = match self.obeyed {
            Some(obeyed) => (obeyed.pitch, obeyed.throttle * self.thrust_max),
            None => {
                let below = self.height - state.z;
                let air = state.air;
                self.level.hold(below, air.airspeed, air.flight_path)
            }
        };
        // PX4 does not limit the pitch of OFFBOARD.
        let pitch = if self.kind == Kind::ArduPlane {
            let [least, most] = self.pitch_limits();
            pitch.clamp(least, most)
        } else {
            pitch
        };
        let roll = self.obeyed.and_then(|obeyed| obeyed.roll);
        self.demands.push_back((pitch, roll));
        let (acting, roll) = if self.demands.len() > self.dead {
            self.demands.pop_front().unwrap_or((pitch, roll))
        } else {
            (self.level.pitch, None)
        };
        // The loop takes the demanded pitch; the plant's elevator is an angle of attack.
        let elevator = acting - state.air.flight_path;
        self.plant.step(Control {
            thrust: thrust.clamp(0.0, self.thrust_max),
            elevator,
        })?;
        self.turn(state.air.airspeed, roll);
        self.carried += 0.01 * self.wind;
        self.tick += 1;
        Ok(())
    }

    /// Roll loop and course hold.
    fn turn(&mut self, airspeed: f64, roll: Option<f64>) {
        let [bank, course, aside] = self.lateral;
        let error = (self.heading - course + 3.0).rem_euclid(2.0 * std::f64::consts::PI) - 3.0;
        let wanted = roll.map_or((1.2 * error).clamp(-0.5, 0.5), |roll| roll + SLANT);
        self.lateral = [
            bank + 0.01 * (wanted - bank) / ROLL,
            course + 0.01 * GRAVITY * libm::tan(bank) / airspeed.max(1.0),
            aside + 0.01 * airspeed * libm::sin(course - self.course),
        ];
    }
}

#[cfg(test)]
mod tests;
