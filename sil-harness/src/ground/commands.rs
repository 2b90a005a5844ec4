//! Commands. The vehicle acknowledges every command, even an unknown one.

use super::channels::Turn;
use super::demands::{Address, Command, Demand};
use super::parameters::decimal;
use super::severity::Severity;
use super::vehicle::{Vehicle, Waiting};
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Frame, MessageData};
use mpp_sim::orders::{Mode, Order};

/// Numbers of MAV_CMD.
mod number {
    pub(super) const SET_MODE: u16 = 176;
    pub(super) const CHANGE_SPEED: u16 = 178;
    pub(super) const TERMINATE: u16 = 185;
    pub(super) const CHANGE_ALTITUDE: u16 = 186;
    pub(super) const REPOSITION: u16 = 192;
    pub(super) const ARM: u16 = 400;
    pub(super) const HOME: u16 = 410;
    pub(super) const GET_INTERVAL: u16 = 510;
    pub(super) const SET_INTERVAL: u16 = 511;
    pub(super) const REQUEST_MESSAGE: u16 = 512;
    pub(super) const REQUEST_PROTOCOL: u16 = 519;
    pub(super) const REQUEST_VERSION: u16 = 520;
}

/// With this second parameter a vehicle disarms in flight.
const FORCE: f32 = 21196.0;
/// Parameter of the height to which the aircraft returns \[m\].
const ALTITUDE: &str = "MPP_ALT_M";
/// Parameter of the airspeed of level flight [m/s].
const CRUISE: &str = "MPP_CRUISE_MS";
/// MAV_FRAME: altitudes above the sea, and above home.
const GLOBAL: u32 = 0;
const ABOVE_HOME: u32 = 3;
const GLOBAL_INT: u32 = 5;
const ABOVE_HOME_INT: u32 = 6;
/// MAV_MODE_FLAG_CUSTOM_MODE_ENABLED.
pub(super) const CUSTOM_MODE: u8 = 1;

/// The result in an acknowledgement, with the numbers of MAV_RESULT.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Accepted = 0,
    Denied = 2,
    Unsupported = 3,
    Failed = 4,
}

/// A mode's number in ArduPlane's table, which ground stations use for fixed wings.
pub(super) fn mode_number(mode: Mode) -> u32 {
    match mode {
        Mode::Auto => 10,
        Mode::Cruise => 7,
    }
}

fn mode_of(number: u32) -> Option<Mode> {
    [Mode::Auto, Mode::Cruise]
        .into_iter()
        .find(|mode| mode_number(*mode) == number)
}

impl Vehicle {
    /// The change that a frame asks this vehicle for. Returns `None` if the frame asks for no
    /// change, or if it is for another vehicle.
    pub(super) fn demand(&self, frame: &Frame<'_>, from: Address) -> Option<Demand> {
        let (system, component, demand) = if let Some(long) = frame.decode::<COMMAND_LONG_DATA>() {
            let command = Command {
                number: long.command,
                first: long.param1,
                second: long.param2,
                has_place: !(long.param5.is_nan() && long.param6.is_nan()),
                altitude: long.param7,
                // This message has no field for it.
                frame: GLOBAL,
                from,
            };
            let COMMAND_LONG_DATA {
                target_system,
                target_component,
                ..
            } = long;
            (target_system, target_component, Demand::Command(command))
        } else if let Some(int) = frame.decode::<COMMAND_INT_DATA>() {
            let command = Command {
                number: int.command,
                first: int.param1,
                second: int.param2,
                // This number stands for none.
                has_place: [int.x, int.y] != [i32::MAX; 2],
                altitude: int.z,
                frame: int.frame.into(),
                from,
            };
            (
                int.target_system,
                int.target_component,
                Demand::Command(command),
            )
        } else if let Some(write) = frame.decode::<PARAM_SET_DATA>() {
            (
                write.target_system,
                write.target_component,
                Demand::Parameter(write),
            )
        } else if let Some(set) = frame.decode::<SET_MODE_DATA>() {
            (set.target_system, 0, Demand::Mode(set))
        } else {
            let ask = frame.decode::<REQUEST_DATA_STREAM_DATA>()?;
            (
                ask.target_system,
                ask.target_component,
                Demand::Streams(ask, from),
            )
        };
        self.is_target(system, component).then_some(demand)
    }

    pub(super) fn meet(&mut self, demand: Demand) {
        match demand {
            Demand::Command(command) => self.command(&command),
            Demand::Parameter(write) => self.write_parameter(&write),
            Demand::Mode(set) => match mode_of(set.custom_mode) {
                Some(mode) => self.order(Order::Mode { mode }, Waiting::Nobody),
                None => self.say(Severity::Warning, "No such mode: AUTO or CRUISE"),
            },
            Demand::Streams(ask, from) => {
                let start = ask.start_stop == 1;
                if let Some(own) = self.channels.own(from) {
                    own.streams
                        .set_group(ask.req_stream_id, ask.req_message_rate, start);
                }
            }
        }
    }

    fn command(&mut self, command: &Command) {
        let outcome = match command.number {
            number::ARM => self.arm(command),
            number::SET_MODE => self.set_mode(command),
            number::TERMINATE => self.terminate(command),
            number::CHANGE_ALTITUDE => {
                let frame = whole(command.second);
                self.change_altitude(command.first, frame, command)
            }
            number::REPOSITION => self.reposition(command),
            number::CHANGE_SPEED => self.change_speed(command),
            number::SET_INTERVAL => self.set_interval(command),
            number::REQUEST_MESSAGE => match whole(command.first) {
                Some(MESSAGE_INTERVAL_DATA::ID) => self.tell_interval(command.second, command.from),
                Some(AUTOPILOT_VERSION_DATA::ID) => self.answer_version(command),
                id => self.request(id, command),
            },
            // These are older requests for the same messages.
            number::GET_INTERVAL => self.tell_interval(command.first, command.from),
            number::HOME => self.request(Some(HOME_POSITION_DATA::ID), command),
            number::REQUEST_PROTOCOL => self.request(Some(PROTOCOL_VERSION_DATA::ID), command),
            number::REQUEST_VERSION => self.answer_version(command),
            _ => Some(Outcome::Unsupported),
        };
        if let Some(outcome) = outcome {
            self.send_ack(command.number, command.from, outcome);
        }
    }

    /// Returns `None` if the acknowledgement follows later, when the flight has carried out the
    /// order.
    fn arm(&mut self, command: &Command) -> Option<Outcome> {
        let on = match command.first {
            0.0 => false,
            1.0 => true,
            _ => return Some(Outcome::Denied),
        };
        if !self.flying {
            self.armed = on;
            return Some(Outcome::Accepted);
        }
        if on == self.armed {
            return Some(Outcome::Accepted);
        }
        let forced = (FORCE..=FORCE).contains(&command.second);
        if !on && !forced {
            self.say(Severity::Warning, "Disarm refused: flying");
            return Some(Outcome::Denied);
        }
        self.order(Order::Motor { on }, waiting(command));
        None
    }

    fn set_mode(&mut self, command: &Command) -> Option<Outcome> {
        let custom = |flags: u32| flags & u32::from(CUSTOM_MODE) != 0;
        let mode = whole(command.first)
            .filter(|flags| custom(*flags))
            .and_then(|_| mode_of(whole(command.second)?));
        let Some(mode) = mode else {
            self.say(Severity::Warning, "No such mode: AUTO or CRUISE");
            return Some(Outcome::Denied);
        };
        self.order(Order::Mode { mode }, waiting(command));
        None
    }

    fn terminate(&mut self, command: &Command) -> Option<Outcome> {
        if !self.flying || !(1.0..=1.0).contains(&command.first) {
            return Some(Outcome::Denied);
        }
        self.order(Order::Terminate, waiting(command));
        None
    }

    /// Sets the height to which the aircraft returns, by the parameter for it. `frame` says from where the altitude counts.
    fn change_altitude(
        &mut self,
        metres: f32,
        frame: Option<u32>,
        command: &Command,
    ) -> Option<Outcome> {
        let value = match frame {
            Some(GLOBAL | GLOBAL_INT) => decimal(metres) - self.home.altitude,
            Some(ABOVE_HOME | ABOVE_HOME_INT) => decimal(metres),
            _ => {
                let line = "Altitude: give it above the sea or above home";
                self.say(Severity::Warning, line);
                return Some(Outcome::Denied);
            }
        };
        let name = ALTITUDE.to_owned();
        self.order(Order::Parameter { name, value }, waiting(command));
        None
    }

    /// Takes the altitude of a position. The vehicle flies straight on in one plane, so it can fly to no place.
    fn reposition(&mut self, command: &Command) -> Option<Outcome> {
        if command.has_place || command.altitude.is_nan() {
            self.say(
                Severity::Warning,
                "It flies straight on: only an altitude can be set",
            );
            return Some(Outcome::Denied);
        }
        self.change_altitude(command.altitude, Some(command.frame), command)
    }

    /// Sets the airspeed of level flight, by the parameter for it. A speed over ground cannot be asked for.
    fn change_speed(&mut self, command: &Command) -> Option<Outcome> {
        if command.first != 0.0 {
            self.say(Severity::Warning, "Only the airspeed can be changed");
            return Some(Outcome::Denied);
        }
        let name = CRUISE.to_owned();
        let value = decimal(command.second);
        self.order(Order::Parameter { name, value }, waiting(command));
        None
    }

    /// Sets the rate of a message at the address from which the command came, and at no other.
    fn set_interval(&mut self, command: &Command) -> Option<Outcome> {
        let own = self.channels.own(command.from);
        let set = |id| own.is_some_and(|own| own.streams.set(id, command.second));
        accepted_if(whole(command.first).is_some_and(set))
    }

    fn answer_version(&mut self, command: &Command) -> Option<Outcome> {
        self.tell_version(command.from);
        Some(Outcome::Accepted)
    }

    fn tell_interval(&mut self, of: f32, from: Address) -> Option<Outcome> {
        let known = whole(of).and_then(|id| Some((id, u16::try_from(id).ok()?)));
        if let Some((id, message_id)) = known {
            let channel = self.channels.of(from.peer);
            let interval_us = channel.map_or(0, |channel| channel.streams.interval(id));
            self.send(&MESSAGE_INTERVAL_DATA {
                message_id,
                interval_us,
            });
        }
        accepted_if(known.is_some())
    }

    /// Sends a message to the address that asks for it, and to no other.
    fn request(&mut self, id: Option<u32>, command: &Command) -> Option<Outcome> {
        let has_room = self.channels.own(command.from).is_some();
        self.channels.set_turn(Turn::Peer(command.from.peer));
        let sent = has_room
            && match id {
                Some(AVAILABLE_MODES_DATA::ID) => {
                    whole(command.second).is_some_and(|number| self.list_modes(number))
                }
                id => id.is_some_and(|id| self.send_by_id(id)),
            };
        self.channels.set_turn(Turn::All);
        accepted_if(sent)
    }

    /// Acknowledges a command whose order is settled.
    pub(super) fn acknowledge(&mut self, command: u16, to: Address, done: bool) {
        let outcome = if done {
            Outcome::Accepted
        } else {
            Outcome::Failed
        };
        self.send_ack(command, to, outcome);
    }

    fn send_ack(&mut self, command: u16, to: Address, outcome: Outcome) {
        self.send(&COMMAND_ACK_DATA {
            command,
            result: outcome as u8,
            target_system: to.system,
            target_component: to.component,
            ..COMMAND_ACK_DATA::DEFAULT
        });
    }
}

fn waiting(command: &Command) -> Waiting {
    Waiting::Command(command.number, command.from)
}

#[expect(
    clippy::unnecessary_wraps,
    reason = "it stands among those that answer later"
)]
fn accepted_if(done: bool) -> Option<Outcome> {
    Some(if done {
        Outcome::Accepted
    } else {
        Outcome::Denied
    })
}

/// The whole number that was sent as a float; `None` if the float is no such number.
fn whole(value: f32) -> Option<u32> {
    let number = value as u32;
    // The comparison also fails if the value is no number, negative or out of range.
    #[expect(clippy::float_cmp, reason = "whole numbers are exact")]
    (number as f32 == value && number < u32::MAX).then_some(number)
}
