//! Hostile frames of the link into a whole flight core.

use super::aircraft::aircraft;
use super::draw::Draw;
use super::{ROUND, Report};
use crc::Crc;
use hil_protocol::{
    ActuatorCommand, ActuatorLimits, AirData, Configure, ConfigureVerdict, Decoder, GroundVelocity,
    Hello, LidarScan, MAX_FRAME, Message, ParameterVerdict, Position, Preset, Role, SensorFrame,
    SetParameter, encode,
};
use mpp_node::FlightNode;
use mpp_node::parameters::{PARAMETERS, Tuning};
use mpp_sim::scenario::{self, Scenario};

const CRC: Crc<u32> = Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// A core, what it was told, and what it answered.
struct Bench {
    node: Box<FlightNode>,
    /// It hears what the core hears.
    heard: Decoder,
    answers: Decoder,
    asked: Option<Configure>,
    set: Option<SetParameter>,
    /// What the core flies with.
    tuning: Option<Tuning>,
    tick: u32,
    report: Report,
}

/// One round of hostile frames, and a good session.
pub(super) fn round(draw: &mut Draw) -> Result<Report, String> {
    let mut bench = Bench {
        node: Box::new(FlightNode::new()),
        heard: Decoder::new(),
        answers: Decoder::new(),
        asked: None,
        set: None,
        tuning: None,
        tick: 0,
        report: Report::default(),
    };
    for frame in 0..ROUND {
        draw.tame = frame < 2 || draw.once_in(2);
        let bytes = match frame {
            0 => framed(&Message::Hello(hello(128))),
            1 => framed(&Message::Configure(configure(draw))),
            _ => hostile(draw, bench.tick),
        };
        bench.send(&bytes)?;
        bench.report.frames += 1;
    }
    bench.good_session()?;
    Ok(bench.report)
}

/// Noise, a message with odd values, or such a message that was damaged.
fn hostile(draw: &mut Draw, tick: u32) -> Vec<u8> {
    if draw.once_in(12) {
        return draw.bytes(2 * MAX_FRAME);
    }
    let mut bytes = framed(&message(draw, tick));
    if draw.once_in(4) {
        draw.damage(&mut bytes);
    } else if draw.once_in(8) {
        // A whole frame whose payload is damaged: only the postcard reader stands in its way.
        bytes = resealed(draw, &bytes);
    }
    bytes
}

fn framed(message: &Message) -> Vec<u8> {
    let mut buffer = [0; MAX_FRAME];
    encode(message, &mut buffer).map_or_else(|_| vec![], <[u8]>::to_vec)
}

/// The frame with a damaged payload and a checksum that fits it.
fn resealed(draw: &mut Draw, frame: &[u8]) -> Vec<u8> {
    let mut plain = cobs::decode_vec(frame.strip_suffix(&[0]).unwrap_or(frame)).unwrap_or_default();
    plain.truncate(plain.len().saturating_sub(4));
    let mut payload = plain.split_off(plain.len().min(4));
    draw.damage(&mut payload);
    plain.extend(payload);
    plain.extend(CRC.checksum(&plain).to_le_bytes());
    let mut bytes = cobs::encode_vec(&plain);
    bytes.push(0);
    bytes
}

fn message(draw: &mut Draw, tick: u32) -> Message {
    match draw.below(100) {
        0 if draw.once_in(8) => Message::Hello(Hello {
            role: if draw.once_in(4) {
                Role::Core
            } else {
                Role::Harness
            },
            ..hello(draw.count(128) as u16)
        }),
        0..=1 => Message::Configure(configure(draw)),
        2..=8 => Message::SetParameter(parameter(draw)),
        9..=10 => Message::LidarScan(scan(draw, tick)),
        11 => Message::ActuatorCommand(ActuatorCommand {
            tick,
            thrust: draw.number(4.0),
            elevator: draw.number(4.0),
            mode: hil_protocol::ControlMode::Tracking,
        }),
        _ => Message::SensorFrame(SensorFrame {
            // A tick far ahead ends the session, because the core takes no earlier one after it.
            tick: if draw.once_in(200) {
                draw.count(tick)
            } else {
                tick
            },
            air: (!draw.once_in(20)).then(|| AirData {
                tick: earlier(draw, tick),
                airspeed: draw.number(12.0),
                pitch: draw.number(0.15),
            }),
            position: (!draw.once_in(3)).then(|| Position {
                tick: earlier(draw, tick),
                x: draw.number(f64::from(tick) * 0.12),
                z: draw.number(50.0),
                sigma: draw.number(0.02) as f32,
                velocity: draw.once_in(3).then(|| GroundVelocity {
                    x: draw.number(12.0) as f32,
                    z: draw.number(0.0) as f32,
                    sigma: draw.number(0.1) as f32,
                }),
            }),
        }),
    }
}

/// The tick of a measurement: mostly this one, sometimes an earlier or any one.
fn earlier(draw: &mut Draw, tick: u32) -> u32 {
    match draw.below(20) {
        0 => draw.count(tick),
        1..=3 => tick.wrapping_sub(draw.below(60) as u32),
        _ => tick,
    }
}

fn hello(beams_max: u16) -> Hello {
    Hello {
        role: Role::Harness,
        software: [0, 1, 0],
        tick_period_us: scenario::TICK_US,
        beams_max,
        stages: 0,
    }
}

fn configure(draw: &mut Draw) -> Configure {
    let limit = |draw: &mut Draw, plausible| (draw.once_in(2)).then(|| draw.number(plausible));
    Configure {
        preset: [
            Preset::Reference,
            Preset::Paper,
            Preset::Flight,
            Preset::Flight,
        ][draw.below(4)],
        aircraft: aircraft(draw),
        paths: draw.count(5) as u16,
        replan_period_ticks: draw.count(50),
        latency_ticks: draw.count(5),
        slices_per_tick: 1 + draw.below(8) as u32,
        seed: draw.bits(),
        beams: draw.count(20) as u16,
        range_max: draw.number(45.0) as f32,
        altitude: draw.number(50.0),
        actuators: ActuatorLimits {
            thrust_max: limit(draw, 15.0),
            thrust_lag: limit(draw, 0.1),
            elevator_below: limit(draw, 2.0),
            elevator_above: limit(draw, 2.0),
            elevator_rate: limit(draw, 20.0),
            elevator_delay: limit(draw, 0.1),
            thrust_delay: limit(draw, 0.1),
        },
    }
}

fn parameter(draw: &mut Draw) -> SetParameter {
    let number = draw.below(PARAMETERS.len() + 2);
    let range = PARAMETERS.get(number).map_or([0.0, 1.0], |it| it.range);
    let value = match draw.below(4) {
        0 => range[draw.below(2)],
        1 => draw.number(range[1]),
        // The slices stay few, or else a round takes minutes.
        _ => draw.number(range[0].max(0.01) * 3.0),
    };
    let slices = PARAMETERS
        .get(number)
        .is_some_and(|it| it.name == "MPP_SLICES");
    SetParameter {
        parameter: number as u8,
        value: if slices { 3.0 } else { value },
    }
}

fn scan(draw: &mut Draw, tick: u32) -> LidarScan {
    let beams = draw.count(20) % 129;
    LidarScan {
        tick: draw.count(tick),
        angle_min: draw.number(-0.5) as f32,
        angle_increment: draw.number(0.05) as f32,
        ranges: (0..beams).map(|_| draw.number(30.0) as f32).collect(),
    }
}

impl Bench {
    /// Sends bytes and checks every answer.
    fn send(&mut self, bytes: &[u8]) -> Result<Vec<Message>, String> {
        for message in bytes
            .iter()
            .filter_map(|byte| self.heard.push(*byte))
            .flatten()
        {
            self.report.messages += 1;
            match message {
                Message::Configure(configure) => self.asked = Some(configure),
                Message::SetParameter(set) => self.set = Some(set),
                _ => {}
            }
        }
        let mut answered = vec![];
        self.node
            .receive(bytes, |frame| answered.extend_from_slice(frame));
        let mut messages = vec![];
        for byte in answered {
            match self.answers.push(byte) {
                None => {}
                Some(Ok(message)) => {
                    self.judge(&message)?;
                    messages.push(message);
                }
                Some(Err(error)) => return Err(format!("the core sent a broken frame: {error}")),
            }
        }
        Ok(messages)
    }

    fn judge(&mut self, message: &Message) -> Result<(), String> {
        match message {
            Message::ConfigureReply(reply) if reply.verdict == ConfigureVerdict::Accepted => {
                let asked = self
                    .asked
                    .as_ref()
                    .ok_or("it accepted what was not asked")?;
                self.tuning = Some(Tuning::new(asked).map_err(|error| error.to_string())?);
                (self.tick, self.report.accepted) = (0, self.report.accepted + 1);
            }
            Message::ParameterReply(reply) if reply.verdict == ParameterVerdict::Accepted => {
                let set = self.set.ok_or("it took a parameter that was not set")?;
                let tuning = self
                    .tuning
                    .ok_or("it took a parameter without a configuration")?;
                let changed = tuning.with(set.parameter, set.value, false);
                self.tuning = Some(changed.map_err(|error| error.to_string())?);
                self.report.accepted += 1;
            }
            Message::PlanReport(_) => self.report.plans += 1,
            Message::ActuatorCommand(command) => {
                self.report.commands += 1;
                self.tick = command.tick.wrapping_add(1);
                self.judge_command(command)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Whether a command is finite and within the limits that the core was told.
    fn judge_command(&self, command: &ActuatorCommand) -> Result<(), String> {
        let settings = self
            .tuning
            .ok_or("it commands without a configuration")?
            .settings;
        let trim = settings.cruise.trim(&settings.airframe);
        let trim = trim.map_err(|error| error.to_string())?;
        let limits = settings.actuators;
        let most = limits.thrust_max.unwrap_or(f64::MAX);
        let side = |side: Option<f64>| side.unwrap_or(f64::MAX / 4.0) * (1.0 + 1e-9);
        let range = -side(limits.elevator_below)..=side(limits.elevator_above);
        let off = command.elevator - trim.control.elevator;
        if (0.0..=most).contains(&command.thrust) && range.contains(&off) {
            Ok(())
        } else {
            Err(format!(
                "{command:?} is outside of {limits:?} about {trim:?}"
            ))
        }
    }

    /// A harness that knows its manners comes after all this.
    fn good_session(&mut self) -> Result<(), String> {
        let configure = Scenario::new(scenario::Preset::Flight, 1).configure();
        // The delimiter ends whatever the line holds.
        self.send(&[0])?;
        let answers = self.send(&framed(&Message::Hello(hello(128))))?;
        if !answers.iter().any(|it| matches!(it, Message::Hello(_))) {
            return Err(format!("it does not answer a hello: {answers:?}"));
        }
        let accepted = self.report.accepted;
        let answers = self.send(&framed(&Message::Configure(configure)))?;
        if self.report.accepted == accepted {
            return Err(format!(
                "it does not take a good configuration: {answers:?}"
            ));
        }
        for tick in 0..5 {
            let frame = SensorFrame {
                tick,
                air: Some(AirData {
                    tick,
                    airspeed: 12.0 + 0.01 * f64::from(tick),
                    pitch: 0.156 + 0.001 * f64::from(tick),
                }),
                position: Some(Position {
                    tick,
                    x: 0.12 * f64::from(tick),
                    z: 50.0,
                    sigma: 0.0,
                    velocity: None,
                }),
            };
            let commands = self.report.commands;
            let answers = self.send(&framed(&Message::SensorFrame(frame)))?;
            if self.report.commands != commands + 1 {
                return Err(format!("it does not command tick {tick}: {answers:?}"));
            }
        }
        Ok(())
    }
}
