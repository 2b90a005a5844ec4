//! Talks with an emulated core without the harness.

use anyhow::{Context, Result, bail};
use hil_protocol::{
    AirData, Aircraft, Configure, Decoder, Hello, MAX_FRAME, Message, Position, Preset, Role,
    SensorFrame, encode,
};
use std::io::{Read, Write};

/// A harness's hello.
pub(crate) const HELLO: Hello = Hello {
    role: Role::Harness,
    software: [0; 3],
    tick_period_us: 10_000,
    beams_max: 100,
    stages: 18,
};

/// A configuration that every core accepts.
pub(crate) const CONFIGURE: Configure = Configure {
    actuators: hil_protocol::ActuatorLimits::NONE,
    preset: Preset::Flight,
    aircraft: Aircraft::REFERENCE,
    paths: 25,
    replan_period_ticks: 100,
    latency_ticks: 1,
    slices_per_tick: 1,
    seed: 1,
    beams: 100,
    range_max: 50.0,
    altitude: 50.0,
};

/// Sends a message.
pub(crate) fn send(stream: &mut impl Write, message: &Message) -> Result<()> {
    let mut buffer = [0; MAX_FRAME];
    stream.write_all(encode(message, &mut buffer)?)?;
    Ok(())
}

/// Reads messages until `wanted` returns a value.
pub(crate) fn await_message<T>(
    stream: &mut impl Read,
    wanted: impl Fn(&Message) -> Option<T>,
) -> Result<T> {
    let (mut decoder, mut bytes) = (Decoder::new(), [0; 256]);
    loop {
        let count = stream
            .read(&mut bytes)
            .context("the core says nothing more")?;
        if count == 0 {
            bail!("the core closed the link");
        }
        for byte in bytes.iter().take(count) {
            if let Some(Ok(message)) = decoder.push(*byte)
                && let Some(found) = wanted(&message)
            {
                return Ok(found);
            }
        }
    }
}

/// Measurements of level flight, which are new in each tick.
pub(crate) fn level(tick: u32) -> Message {
    let time = f64::from(tick) * 0.01;
    Message::SensorFrame(SensorFrame {
        tick,
        air: Some(AirData {
            tick,
            airspeed: 12.0 + 1e-3 * time,
            pitch: 0.156 + 1e-4 * time,
        }),
        position: Some(Position {
            tick,
            x: 12.0 * time,
            z: 50.0 + 1e-3 * time,
            sigma: 0.02,
            velocity: None,
        }),
    })
}
