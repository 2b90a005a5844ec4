//! Tests the link: the same flight over a pipe and over TCP, and everything that can go wrong on
//! it.

mod input;
mod lidar;
mod restarts;
mod time;

use crc::Crc;
use hil_protocol::{ConfigureVerdict, DecodeError, Hello, MAX_FRAME, Message, Role, encode};
use mpp_sim::flight::{FlyError, fly};
use mpp_sim::link::{Link, LinkError};
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};
use sil_harness::link::{TcpLink, serve};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::mpsc::Receiver;
use std::thread;
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_millis(300);
/// Time after which a wait has failed. It is far longer than any wait takes on a busy machine.
const LONGEST: Duration = Duration::from_secs(60);

fn short(seed: u64) -> Scenario {
    Scenario {
        ticks: 500,
        ..Scenario::new(Preset::Flight, seed)
    }
}

/// A pipe that damages the harness's messages on the way.
struct Spoilt<F: FnMut(&mut PipeLink, &Message) -> bool> {
    pipe: PipeLink,
    /// Returns `true` when it has dealt with the message itself.
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

fn causes(log: &FlightLog) -> Vec<&str> {
    log.rejections
        .iter()
        .map(|rejection| rejection.cause.as_str())
        .collect()
}

fn local_listener() -> (TcpListener, String) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    (listener, address)
}

fn connect(address: &str) -> Result<TcpLink, LinkError> {
    TcpLink::connect(address, sil_harness::link::PATIENCE)
}

#[test]
fn a_core_behind_tcp_flies_the_same_bytes() {
    let (listener, address) = local_listener();
    let core = thread::spawn(move || serve(&listener, true, Duration::from_secs(20), None, |_| {}));
    let over_tcp = fly(&short(5), &mut connect(&address).unwrap(), |_| {}).unwrap();
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
        let mut node = Box::new(mpp_node::FlightNode::new());
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
    let error = fly(&short(1), &mut connect(&address).unwrap(), |_| {}).unwrap_err();
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

/// Waits for a line that holds these words.
#[expect(clippy::panic, reason = "a helper of tests fails as tests do")]
fn hear(told: &Receiver<String>, words: &str) {
    let deadline = Instant::now() + LONGEST;
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        let line = told
            .recv_timeout(left)
            .unwrap_or_else(|error| panic!("waited in vain for {words:?}: {error}"));
        if line.contains(words) {
            return;
        }
    }
}

#[test]
fn a_silent_harness_is_named_by_the_core() {
    let (listener, address) = local_listener();
    let _silent = TcpStream::connect(&address).unwrap();
    let (reports, told) = std::sync::mpsc::channel();
    // It has configured nothing, so the core that serves once waits for the next harness.
    thread::spawn(move || {
        serve(&listener, true, PATIENCE, None, |line| {
            let _ = reports.send(line.to_owned());
        })
    });
    hear(&told, "core waits for hello from the harness");
    let _next = TcpStream::connect(&address).unwrap();
    hear(&told, "harness connected");
}

/// Somebody who sends something now and then, but never says hello, does not keep others waiting.
#[test]
fn a_stranger_that_drips_is_dropped_and_the_next_harness_is_served() {
    let (listener, address) = local_listener();
    let mut stranger = TcpStream::connect(&address).unwrap();
    let drip = thread::spawn(move || {
        let begun = Instant::now();
        while stranger.write_all(b"GET ").is_ok() {
            assert!(
                begun.elapsed() < LONGEST,
                "waited {LONGEST:?} in vain for the core to drop a stranger"
            );
            thread::sleep(PATIENCE / 20);
        }
    });
    let (reports, told) = std::sync::mpsc::channel();
    thread::spawn(move || {
        serve(&listener, false, PATIENCE, None, |line| {
            // Nobody listens once the test is over.
            let _ = reports.send(line.to_owned());
        })
    });
    // Its hello is there before the core asks for it.
    let mut harness = TcpStream::connect(&address).unwrap();
    let hello = Message::Hello(Hello {
        role: Role::Harness,
        software: [0, 1, 0],
        tick_period_us: 10_000,
        beams_max: 64,
        stages: 20,
    });
    let mut frame = [0; MAX_FRAME];
    harness
        .write_all(encode(&hello, &mut frame).unwrap())
        .unwrap();
    let mut answer = [0; 8];
    harness.set_read_timeout(Some(LONGEST)).unwrap();
    harness
        .read_exact(&mut answer)
        .expect("the core answers the hello");
    drip.join().unwrap();
    let told = [(); 2].map(|()| told.recv_timeout(LONGEST).expect("the core reports"));
    assert!(
        told[1].contains("core waits for hello from the harness"),
        "{told:?}"
    );
}

#[test]
fn a_core_of_another_version_is_refused_by_name() {
    let (listener, address) = local_listener();
    let core = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        // This is a frame of protocol version 9: header, CRC-32 and COBS.
        let plain = [0x4D, 0x50, 9, 1];
        let mut frame = vec![0x09];
        frame.extend(plain);
        frame.extend(
            Crc::<u32>::new(&crc::CRC_32_ISO_HDLC)
                .checksum(&plain)
                .to_le_bytes(),
        );
        frame.push(0);
        assert!(!frame[1..9].contains(&0));
        stream.write_all(&frame).unwrap();
        let _ = stream.read(&mut [0; 64]);
    });
    let error = fly(&short(1), &mut connect(&address).unwrap(), |_| {}).unwrap_err();
    core.join().unwrap();
    let FlyError::Link(LinkError::Frame(DecodeError::Version { peer: 9 })) = error else {
        panic!("{error}");
    };
    assert!(error.to_string().contains("protocol 9"), "{error}");
}

#[test]
fn a_configuration_that_makes_no_sense_is_refused() {
    let with = |change: fn(&mut Scenario)| {
        let mut scenario = short(1);
        change(&mut scenario);
        scenario
    };
    let too_many = ConfigureVerdict::TooManyPaths { max: 50 };
    let wrong = [
        (with(|it| it.paths = 51), too_many),
        (with(|it| it.latency_ticks = 0), ConfigureVerdict::Latency),
        (with(|it| it.latency_ticks = 101), ConfigureVerdict::Latency),
        (
            with(|it| it.slices_per_tick = 0),
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
