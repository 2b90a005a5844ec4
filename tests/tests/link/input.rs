//! The harness's messages are damaged on the way. They are rejected and logged, and the flight goes
//! on.

use super::{Spoilt, causes, short};
use hil_protocol::{
    AirData, ConfigureVerdict, MAX_FRAME, Message, Position, RejectionCause, SensorFrame, encode,
};
use mpp_sim::flight::fly;
use mpp_sim::link::Link;
use mpp_sim::log::FlightLog;
use mpp_sim::navigation::NavigationConfig;
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::Scenario;

fn fly_spoilt(spoil: impl FnMut(&mut PipeLink, &Message) -> bool) -> FlightLog {
    let mut link = Spoilt {
        pipe: PipeLink::new(),
        spoil,
    };
    // Every frame has a position.
    let scenario = Scenario {
        navigation: NavigationConfig::IDEAL,
        ..short(2)
    };
    fly(&scenario, &mut link, |_| {}).unwrap()
}

/// The sensor frame of level flight at this tick.
pub(crate) fn level_flight(tick: u32) -> Message {
    let air = AirData {
        tick,
        airspeed: 12.0,
        pitch: 0.156,
    };
    let position = Position {
        tick,
        x: 0.12 * f64::from(tick),
        z: 50.0,
        sigma: 0.0,
        velocity: None,
    };
    Message::SensorFrame(SensorFrame {
        tick,
        air: Some(air),
        position: Some(position),
    })
}

/// Every tenth sensor frame holds values that are no numbers. Each such frame is rejected and
/// logged, and the flight goes on.
#[test]
fn values_that_are_no_numbers_are_rejected_and_logged() {
    let log = fly_spoilt(|pipe, message| {
        let Message::SensorFrame(frame) = message else {
            return false;
        };
        if frame.tick % 10 != 3 {
            return false;
        }
        let mut bad = *frame;
        let air = bad.air.as_mut().unwrap();
        air.airspeed = f64::NAN;
        if frame.tick % 20 == 3 {
            air.pitch = f64::INFINITY;
        }
        if frame.tick % 30 == 3 {
            bad.position.as_mut().unwrap().x = f64::NAN;
        }
        pipe.send(&Message::SensorFrame(bad)).is_ok()
    });
    assert_eq!(log.summary.outcome, Outcome::Survived);
    assert_eq!(log.rejections.len(), 50);
    assert!(causes(&log).iter().all(|cause| *cause == "NonFiniteSensor"));
    assert!(
        log.ticks
            .elevator
            .iter()
            .all(|elevator| elevator.is_finite())
    );
}

#[test]
fn an_absurd_airspeed_is_gated_and_logged() {
    let log = fly_spoilt(|pipe, message| {
        let Message::SensorFrame(frame) = message else {
            return false;
        };
        let mut bad = *frame;
        bad.air.as_mut().unwrap().airspeed = 400.0;
        frame.tick == 200 && pipe.send(&Message::SensorFrame(bad)).is_ok()
    });
    assert_eq!(
        causes(&log),
        ["InnovationGate { airspeed: true, pitch: false }"]
    );
    assert_eq!(log.summary.outcome, Outcome::Survived);
}

#[test]
fn scans_that_cannot_be_used_are_rejected_and_logged() {
    let log = fly_spoilt(|pipe, message| {
        let Message::LidarScan(scan) = message else {
            return false;
        };
        let mut bad = scan.clone();
        match scan.tick {
            100 => bad.ranges.clear(),
            200 => bad.angle_min = f32::NAN,
            300 => bad.ranges[8..].fill(-1.0),
            // Older than the way that the core remembers.
            400 => bad.tick = 250,
            _ => return false,
        }
        pipe.send(&Message::LidarScan(bad)).is_ok()
    });
    assert_eq!(
        causes(&log),
        [
            "ScanLength { expected: 100, found: 0 }",
            "ScanAngle",
            "ScanRange { beam: 8 }",
            "TickOrder { expected: 400, found: 250 }",
        ]
    );
    // The plans of those scans are missing, so the earlier plan is flown on.
    assert_eq!(log.plans.len(), 1);
}

#[test]
fn garbage_and_damaged_frames_are_rejected_and_logged() {
    let log = fly_spoilt(|pipe, message| {
        let Message::SensorFrame(frame) = message else {
            return false;
        };
        let mut buffer = [0; MAX_FRAME];
        let bytes = encode(message, &mut buffer).unwrap();
        match frame.tick {
            50 => pipe.send_bytes(&[0xFF, 0xAA, 0x12, 0x00]),
            60 => pipe.send_bytes(&[&bytes[..bytes.len() / 2], &[0]].concat()),
            70 => {
                let mut damaged = bytes.to_vec();
                damaged[9] ^= 0x10;
                pipe.send_bytes(&damaged);
            }
            80 => pipe.send_bytes(&vec![0x55; 4000]),
            _ => {}
        }
        // A delimiter ends the rest of the noise. The frame itself then comes whole.
        pipe.send_bytes(&[0]);
        false
    });
    assert_eq!(log.rejections.len(), 4, "{:?}", log.rejections);
    assert!(causes(&log).iter().all(|cause| cause.starts_with("Frame(")));
    assert_eq!(causes(&log)[3], "Frame(TooLong)");
    assert_eq!(log.summary.outcome, Outcome::Survived);
}

/// A core without a configuration reports this, and a core in flight refuses another configuration.
#[test]
fn messages_out_of_place_are_rejected() {
    let mut pipe = PipeLink::new();
    pipe.send(&level_flight(0)).unwrap();
    let answer = pipe.receive("a rejection").unwrap();
    assert!(
        matches!(&answer, Message::Rejection(r) if r.cause == RejectionCause::NotConfigured),
        "{answer:?}"
    );
    let configure = Message::Configure(short(1).configure());
    pipe.send(&configure).unwrap();
    assert!(
        matches!(pipe.receive("a reply"), Ok(Message::ConfigureReply(r)) if r.verdict == ConfigureVerdict::Accepted)
    );
    pipe.send(&configure).unwrap();
    assert!(
        matches!(pipe.receive("a reply"), Ok(Message::ConfigureReply(r)) if r.verdict == ConfigureVerdict::AlreadyConfigured)
    );
    // Only a core may send this message.
    pipe.send(&answer).unwrap();
    assert!(
        matches!(pipe.receive("a rejection"), Ok(Message::Rejection(r)) if r.cause == RejectionCause::UnexpectedMessage { id: answer.id() })
    );
}

/// A tick that comes twice is answered once.
#[test]
fn an_old_tick_is_not_flown_again() {
    let mut pipe = PipeLink::new();
    pipe.send(&Message::Configure(short(1).configure()))
        .unwrap();
    for tick in [0, 1, 1] {
        pipe.send(&level_flight(tick)).unwrap();
    }
    let mut commands = 0;
    let mut rejected = false;
    while let Ok(message) = pipe.receive("anything") {
        commands += usize::from(matches!(message, Message::ActuatorCommand(_)));
        rejected |= matches!(message, Message::Rejection(r)
            if r.cause == RejectionCause::TickOrder { expected: 2, found: 1 });
    }
    assert_eq!(commands, 2);
    assert!(rejected);
}
