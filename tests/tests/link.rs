//! The link: the same flight over a pipe and over TCP, and everything that can go wrong on it.

use hil_protocol::{
    ConfigureVerdict, DecodeError, Hello, MAX_FRAME, Message, RejectionCause, Role, SensorFrame,
    encode,
};
use sil_harness::link::{Link, LinkError, PipeLink, TcpLink, serve};
use sil_harness::log::FlightLog;
use sil_harness::outcome::Outcome;
use sil_harness::run::{FlyError, fly};
use sil_harness::scenario::{Preset, Scenario};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;
use std::time::Duration;

const PATIENCE: Duration = Duration::from_millis(300);

fn short(seed: u64) -> Scenario {
    Scenario {
        ticks: 500,
        ..Scenario::new(Preset::Flight, seed)
    }
}

#[expect(clippy::unwrap_used, reason = "loopback")]
fn local_listener() -> (TcpListener, String) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    (listener, address)
}

#[test]
fn a_core_behind_tcp_flies_the_same_bytes() {
    let (listener, address) = local_listener();
    let core = thread::spawn(move || serve(&listener, true, Duration::from_secs(20), |_| {}));
    let over_tcp = fly(&short(5), &mut TcpLink::connect(&address).unwrap(), |_| {}).unwrap();
    core.join().unwrap().unwrap();
    let over_pipe = fly(&short(5), &mut PipeLink::new(), |_| {}).unwrap();
    assert_eq!(over_tcp.to_json().unwrap(), over_pipe.to_json().unwrap());
}

#[test]
fn a_silent_core_is_named_and_not_waited_for_forever() {
    let (listener, address) = local_listener();
    let stream = TcpStream::connect(&address).unwrap();
    let _accepted_and_silent = listener.accept().unwrap();
    let mut link = TcpLink::over(stream, address.clone(), PATIENCE).unwrap();
    let error = fly(&short(1), &mut link, |_| {}).unwrap_err();
    let text = error.to_string();
    assert!(
        matches!(error, FlyError::Link(LinkError::Silent { .. })),
        "{text}"
    );
    assert!(
        text.contains("harness waits for hello from the core at"),
        "{text}"
    );
    assert!(text.contains(&address), "{text}");
}

#[test]
fn a_core_that_dies_in_flight_is_named() {
    let (listener, address) = local_listener();
    let core = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut node = Box::new(flight_node::FlightNode::new());
        let mut bytes = [0; 4096];
        let mut frames = 0;
        while frames < 40 {
            let count = stream.read(&mut bytes).unwrap();
            node.receive(&bytes[..count], |frame| {
                frames += 1;
                stream.write_all(frame).unwrap();
            });
        }
    });
    let error = fly(&short(1), &mut TcpLink::connect(&address).unwrap(), |_| {}).unwrap_err();
    core.join().unwrap();
    let text = error.to_string();
    assert!(
        matches!(
            error,
            FlyError::Link(LinkError::Closed { .. } | LinkError::Io(..))
        ),
        "{text}"
    );
    assert!(text.contains("core"), "{text}");
}

#[test]
fn a_silent_harness_is_named_by_the_core() {
    let (listener, address) = local_listener();
    let _silent = TcpStream::connect(&address).unwrap();
    let error = serve(&listener, true, PATIENCE, |_| {}).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("core waits for the next frame from the harness"),
        "{text}"
    );
}

#[test]
fn a_core_of_another_version_is_refused_by_name() {
    let (listener, address) = local_listener();
    let core = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        // A frame of protocol version 9: header, CRC-32 and COBS by hand.
        let plain = [0x4D, 0x50, 9, 1];
        let mut frame = vec![0x09];
        frame.extend(plain);
        frame.extend(crc32(&plain).to_le_bytes());
        frame.push(0);
        assert!(!frame[1..9].contains(&0));
        stream.write_all(&frame).unwrap();
        let _ = stream.read(&mut [0; 64]);
    });
    let error = fly(&short(1), &mut TcpLink::connect(&address).unwrap(), |_| {}).unwrap_err();
    core.join().unwrap();
    let FlyError::Link(LinkError::Frame(DecodeError::Version { peer: 9 })) = error else {
        panic!("{error}");
    };
    assert!(error.to_string().contains("protocol 9"), "{error}");
}

/// Bit by bit, as its definition reads.
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = !0_u32;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0xEDB8_8320
            } else {
                crc >> 1
            };
        }
    }
    !crc
}

#[test]
fn a_configuration_that_makes_no_sense_is_refused() {
    let wrong = [
        (
            Scenario {
                paths: 51,
                ..short(1)
            },
            ConfigureVerdict::TooManyPaths { max: 50 },
        ),
        (
            Scenario {
                latency_ticks: 0,
                ..short(1)
            },
            ConfigureVerdict::Latency,
        ),
        (
            Scenario {
                latency_ticks: 101,
                ..short(1)
            },
            ConfigureVerdict::Latency,
        ),
        (
            Scenario {
                slices_per_tick: 0,
                ..short(1)
            },
            ConfigureVerdict::SlicesPerTick,
        ),
    ];
    for (scenario, verdict) in wrong {
        let error = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap_err();
        assert!(
            matches!(&error, FlyError::Link(LinkError::Refused(found)) if *found == verdict),
            "{error}"
        );
    }
}

/// A pipe on which what the harness sends is spoilt on the way.
struct Spoilt<F: FnMut(&mut PipeLink, &Message) -> bool> {
    pipe: PipeLink,
    /// True when it has dealt with the message itself.
    spoil: F,
}

impl<F: FnMut(&mut PipeLink, &Message) -> bool> Link for Spoilt<F> {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        if (self.spoil)(&mut self.pipe, message) {
            return Ok(());
        }
        self.pipe.send(message)
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.pipe.receive(awaited)
    }
}

#[expect(clippy::unwrap_used, reason = "spoilt input must not stop a flight")]
fn fly_spoilt(spoil: impl FnMut(&mut PipeLink, &Message) -> bool) -> FlightLog {
    let mut link = Spoilt {
        pipe: PipeLink::new(),
        spoil,
    };
    fly(&short(2), &mut link, |_| {}).unwrap()
}

fn causes(log: &FlightLog) -> Vec<&str> {
    log.rejections
        .iter()
        .map(|rejection| rejection.cause.as_str())
        .collect()
}

/// Every tenth sensor frame holds values that are no numbers: each is rejected and logged, and the
/// flight goes on.
#[test]
fn values_that_are_no_numbers_are_rejected_and_logged() {
    let log = fly_spoilt(|pipe, message| {
        let Message::SensorFrame(frame) = message else {
            return false;
        };
        if frame.tick % 10 != 3 {
            return false;
        }
        let bad = SensorFrame {
            airspeed: f64::NAN,
            pitch: if frame.tick % 20 == 3 {
                f64::INFINITY
            } else {
                frame.pitch
            },
            x: if frame.tick % 30 == 3 {
                f64::NAN
            } else {
                frame.x
            },
            ..*frame
        };
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
        let bad = SensorFrame {
            airspeed: 400.0,
            ..*frame
        };
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
            100 => bad.ranges.truncate(99),
            200 => bad.ranges[7] = f32::NAN,
            300 => bad.ranges[8] = -1.0,
            400 => bad.tick = 399,
            _ => return false,
        }
        pipe.send(&Message::LidarScan(bad)).is_ok()
    });
    assert_eq!(
        causes(&log),
        [
            "ScanLength { expected: 100, found: 99 }",
            "ScanNotFinite { beam: 7 }",
            "ScanRange { beam: 8 }",
            "TickOrder { expected: 400, found: 399 }",
        ]
    );
    // The plans of those scans are missing, and the one before is flown on.
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
        // A delimiter ends what noise left behind; the frame itself then comes whole.
        pipe.send_bytes(&[0]);
        false
    });
    assert_eq!(log.rejections.len(), 4, "{:?}", log.rejections);
    assert!(causes(&log).iter().all(|cause| cause.starts_with("Frame(")));
    assert_eq!(causes(&log)[3], "Frame(TooLong)");
    assert_eq!(log.summary.outcome, Outcome::Survived);
}

/// A core without a configuration says so, and one with a flight under way refuses another.
#[test]
fn messages_out_of_place_are_rejected() {
    let mut pipe = PipeLink::new();
    let frame = SensorFrame {
        tick: 0,
        airspeed: 12.0,
        pitch: 0.1,
        x: 0.0,
        z: 50.0,
    };
    pipe.send(&Message::SensorFrame(frame)).unwrap();
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
    // What only a core may say.
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
    let frame = |tick| {
        Message::SensorFrame(SensorFrame {
            tick,
            airspeed: 12.0,
            pitch: 0.156,
            x: 0.0,
            z: 50.0,
        })
    };
    for tick in [0, 1, 1] {
        pipe.send(&frame(tick)).unwrap();
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

/// The core restarts and says hello, as one that was reset does; the frame that it got is lost.
fn restart(pipe: &mut PipeLink) {
    *pipe = PipeLink::new();
    let hello = Hello {
        role: Role::Harness,
        software: [0; 3],
        tick_period_us: 10_000,
        beams_max: 100,
        stages: 18,
    };
    assert!(pipe.send(&Message::Hello(hello)).is_ok());
}

#[test]
fn a_core_that_restarts_in_flight_is_configured_anew_and_flies_on() {
    let mut restarted = false;
    let log = fly_spoilt(|pipe, message| {
        let now = matches!(message, Message::SensorFrame(frame) if frame.tick == 70) && !restarted;
        if now {
            restarted = true;
            restart(pipe);
        }
        now
    });
    assert_eq!(causes(&log), ["CoreRestarted"]);
    assert_eq!(log.ticks.t.len(), 500);
    // The first plan was lost with the core, which holds level trim until the next one.
    let tracked = |tick: usize| log.ticks.ref_x[tick].is_some();
    assert!(tracked(69) && !tracked(70) && !tracked(99) && tracked(110));
}

#[test]
fn a_core_that_restarts_again_and_again_is_named() {
    let mut link = Spoilt {
        pipe: PipeLink::new(),
        spoil: |pipe: &mut PipeLink, message: &Message| {
            let frame = matches!(message, Message::SensorFrame(_));
            if frame {
                restart(pipe);
            }
            frame
        },
    };
    let error = fly(&short(2), &mut link, |_| {}).map(|_| ()).unwrap_err();
    assert!(
        error.to_string().contains("restarts again and again"),
        "{error}"
    );
}
