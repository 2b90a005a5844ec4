//! Tests the link itself: bad, silent, signed, recorded.

use super::radio::{CONFIG, Channel, HERE, Radio, command, heard, heartbeat, scenario, write};
use chacha20::ChaCha8Rng;
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Framer, Key, Sender, Signer, Verifier};
use mpp_sim::flight::fly;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::Scenario;
use rand_core::{Rng, SeedableRng};
use sil_harness::ground::vehicle::{Vehicle, VehicleConfig};

/// A link that loses a fifth of the datagrams, sends a fifth twice, damages a fifth and keeps a
/// fifth for later.
fn bad(seed: u64) -> Channel {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut kept: Vec<Vec<u8>> = Vec::new();
    Box::new(move |datagrams| {
        let mut arrived = Vec::new();
        for mut datagram in datagrams {
            match random.next_u32() % 10 {
                0 | 1 => {}
                2 | 3 => arrived.extend([datagram.clone(), datagram]),
                4 | 5 => {
                    let at = random.next_u32() as usize % datagram.len();
                    datagram[at] ^= 1 << (random.next_u32() % 8);
                    arrived.push(datagram);
                }
                6 | 7 => {
                    kept.push(datagram);
                    if kept.len() > 3 {
                        arrived.push(kept.remove(random.next_u32() as usize % kept.len()));
                    }
                }
                _ => arrived.push(datagram),
            }
        }
        arrived
    })
}

/// Sends, once a second, everything that a station may say without changing the flight.
fn chatter(radio: &mut Radio) {
    for second in 0..12 {
        let tick = 100 * second;
        radio
            .at(tick, &heartbeat())
            .at(tick + 1, &PARAM_REQUEST_LIST_DATA::DEFAULT)
            .at(tick + 2, &PING_DATA::DEFAULT)
            .at(tick + 3, &command(42_424, 0.0, 0.0))
            .at(tick + 4, &command(511, 30.0, 20_000.0))
            .at(tick + 5, &command(512, 148.0, 0.0))
            .at(tick + 6, &MISSION_REQUEST_LIST_DATA::DEFAULT)
            .at(tick + 7, &write("MPP_PATHS", 99.0))
            .at(tick + 8, &write("LQR_R_ELEVATOR", 1.0))
            .at(tick + 9, &command(400, 0.0, 0.0))
            .at(tick + 10, &TIMESYNC_DATA::DEFAULT);
    }
}

#[test]
fn no_link_and_the_worst_link_fly_the_same_bytes() {
    let alone = fly(&scenario(), &mut PipeLink::new(), |_| {})
        .unwrap()
        .hash()
        .unwrap();
    for seed in 0..4 {
        let mut radio = Radio::new(&CONFIG);
        chatter(&mut radio);
        if seed > 0 {
            (radio.up, radio.down) = (bad(seed), bad(100 + seed));
        }
        let log = radio.fly(&scenario());
        assert_eq!(log.hash().unwrap(), alone, "seed {seed}");
        assert!(log.orders.is_empty());
        assert!(
            radio.acks().len() > 20,
            "seed {seed}: {}",
            radio.acks().len()
        );
    }
}

/// An order that comes twice, or that is damaged on the way, is carried out once or not at all.
#[test]
fn a_repeated_order_is_one_order() {
    let mut radio = Radio::new(&CONFIG);
    for tick in 300..310 {
        radio
            .at(tick, &write("MPP_ALT_M", 52.0))
            .at(tick, &command(176, 1.0, 7.0));
    }
    radio.up = bad(7);
    let log = radio.fly(&scenario());
    assert_eq!(log.orders.len(), 2, "{:?}", log.orders);
}

#[test]
fn a_station_is_lost_and_returns_in_simulated_time() {
    let mut radio = Radio::new(&CONFIG);
    for tick in [0, 100, 200, 900, 1000] {
        radio.at(tick, &heartbeat());
    }
    let alone = fly(&scenario(), &mut PipeLink::new(), |_| {})
        .unwrap()
        .hash()
        .unwrap();
    let log = radio.fly(&scenario());
    assert_eq!(log.hash().unwrap(), alone);
    let stations: Vec<_> = radio
        .texts()
        .into_iter()
        .filter(|(_, text)| text.contains("station"))
        .collect();
    let expected = [
        (0, "Ground station 255 connected".to_owned()),
        (701, "Ground station 255 lost, flying on".to_owned()),
        (900, "Ground station 255 is back".to_owned()),
    ];
    assert_eq!(stations, expected);
    assert_eq!(radio.notes[1], "7.01 s: Ground station 255 lost, flying on");
}

#[test]
fn a_recording_has_the_same_bytes_each_time() {
    let record = || {
        let mut radio = Radio::new(&CONFIG);
        radio.fly(&scenario());
        radio.tlog.finish().unwrap()
    };
    let first = record();
    assert!(first == record());
    // The first time is 2026-01-01T00:00:00Z.
    let time = u64::from_be_bytes(*first.first_chunk().unwrap());
    assert_eq!(time, 1_767_225_600_000_000);
    assert_eq!(first[8], 0xFD);
}

/// A router may cut its stream of bytes anywhere. What one address cut is not completed by another one.
#[test]
fn a_frame_that_was_cut_over_two_datagrams_is_read() {
    let frame = Sender::new(255, 190).frame(&command(42_424, 0.0, 0.0));
    let bytes = frame.as_bytes();
    for cut in [1, 2, 9, 30, bytes.len() - 1] {
        let mut radio = Radio::new(&CONFIG);
        let (begin, end) = bytes.split_at(cut);
        // Behind a whole frame, and before one; then with another frame in between; then from two addresses.
        radio.bytes_at(10, &[bytes, begin].concat());
        radio.bytes_at(11, &[end, bytes].concat());
        radio.bytes_at(20, begin);
        radio.at(21, &heartbeat());
        radio.bytes_at(22, end);
        radio.bytes_at(30, begin);
        radio.there_bytes_at(31, end);
        radio.fly(&Scenario {
            ticks: 50,
            ..scenario()
        });
        assert_eq!(radio.acks(), [(42_424, 3); 3], "cut at {cut}");
    }
}

const NOW: u64 = 36_000_000_000_000;

fn keyed() -> VehicleConfig {
    VehicleConfig {
        key: Some((Key::of_passphrase("secret"), NOW)),
        ..CONFIG
    }
}

#[test]
fn with_a_key_only_its_holder_commands() {
    let mut radio = Radio::new(&keyed());
    radio
        .at(100, &command(176, 1.0, 7.0))
        .at(110, &write("MPP_ALT_M", 60.0))
        .at(
            120,
            &PARAM_REQUEST_READ_DATA {
                param_id: hil_protocol::mavlink::text("MPP_ALT_M"),
                param_index: -1,
                ..PARAM_REQUEST_READ_DATA::DEFAULT
            },
        );
    radio
        .at(130, &STATUSTEXT_DATA::DEFAULT)
        .at(
            131,
            &COMMAND_LONG_DATA {
                target_system: 7,
                ..command(176, 1.0, 7.0)
            },
        )
        .at(
            132,
            &REQUEST_DATA_STREAM_DATA {
                req_stream_id: 0,
                ..REQUEST_DATA_STREAM_DATA::DEFAULT
            },
        );
    radio.signed_at(
        200,
        &command(176, 1.0, 7.0),
        Key::of_passphrase("guess"),
        NOW,
    );
    radio.signed_at(
        300,
        &command(176, 1.0, 10.0),
        Key::of_passphrase("secret"),
        NOW + 1,
    );
    radio.signed_at(
        400,
        &write("MPP_ALT_M", 52.0),
        Key::of_passphrase("secret"),
        NOW + 2,
    );
    let log = radio.fly(&scenario());
    // A request to read needs no signature.
    assert_eq!(
        radio.values(),
        [
            ("MPP_ALT_M".to_owned(), 50.0),
            ("MPP_ALT_M".to_owned(), 52.0)
        ]
    );
    assert_eq!(radio.acks(), [(176, 0)]);
    assert_eq!(log.orders.len(), 1, "{:?}", log.orders);
    assert_eq!(radio.vehicle.refused_signatures(), 4);
    // Frames for another vehicle and frames that are no orders are not counted either.
    let errors = heard!(radio, SYS_STATUS, |status| status.errors_count2);
    assert_eq!(errors.last().unwrap().1, 4);
}

/// A vehicle that has flown for ten minutes is trusted by a station that has just started. The
/// vehicle does not trust what was recorded at its start.
#[test]
fn signatures_go_with_the_time() {
    const TEN_MINUTES: u64 = 60_000_000;
    let signed = |time| {
        let mut signer = Signer::new(Key::of_passphrase("secret"), 9, time);
        Sender::new(254, 1)
            .signed_frame(&command(400, 1.0, 0.0), &mut signer)
            .as_bytes()
            .to_vec()
    };
    let mut vehicle = Vehicle::new(&keyed());
    vehicle.set_signing_time(NOW + TEN_MINUTES);
    vehicle.hold();
    let mut station = Verifier::new(Key::of_passphrase("secret"), NOW + TEN_MINUTES);
    for frame in vehicle.take_outgoing() {
        Framer::new().receive_datagram(frame.wire[0].1.as_bytes(), |frame| {
            assert_eq!(station.verify(frame), Ok(()));
        });
    }
    vehicle.receive(HERE, &signed(NOW));
    assert_eq!(vehicle.refused_signatures(), 1);
    // A station whose clock is a little ahead moves the vehicle's time on.
    let ahead = NOW + TEN_MINUTES + TEN_MINUTES / 20;
    vehicle.receive(HERE, &signed(ahead));
    assert_eq!(vehicle.refused_signatures(), 1);
    vehicle.take_outgoing();
    vehicle.end("here");
    let mut station = Verifier::new(Key::of_passphrase("secret"), ahead);
    for frame in vehicle.take_outgoing() {
        Framer::new().receive_datagram(frame.wire[0].1.as_bytes(), |frame| {
            assert_eq!(station.verify(frame), Ok(()));
        });
    }
}

/// A frame of the arming command, signed by a station at a time.
fn arming(system: u8, time: u64) -> Vec<u8> {
    let mut signer = Signer::new(Key::of_passphrase("secret"), 9, time);
    let frame = Sender::new(system, 1).signed_frame(&command(400, 1.0, 0.0), &mut signer);
    frame.as_bytes().to_vec()
}

/// One stamp of a year ahead would make every honest one too old.
#[test]
fn a_stamp_from_far_ahead_locks_nobody_out() {
    const MINUTE: u64 = 6_000_000;
    let mut vehicle = Vehicle::new(&keyed());
    vehicle.receive(HERE, &arming(250, NOW + 365 * 24 * 60 * MINUTE));
    vehicle.receive(HERE, &arming(251, NOW + MINUTE + 1));
    assert_eq!(vehicle.refused_signatures(), 2);
    vehicle.receive(HERE, &arming(252, NOW + MINUTE));
    vehicle.receive(HERE, &arming(253, NOW));
    assert_eq!(vehicle.refused_signatures(), 2);
}

/// What was recorded in one flight is not obeyed in the next, and what is new is.
#[test]
fn a_frame_of_the_flight_before_is_refused() {
    let mut first = Vehicle::new(&keyed());
    first.receive(HERE, &arming(254, NOW + 7));
    assert_eq!(first.refused_signatures(), 0);
    let kept = first.heard().unwrap().format();
    let mut second = Vehicle::new(&keyed());
    second.remember(&sil_harness::ground::heard::Heard::parse(&kept).unwrap());
    second.receive(HERE, &arming(254, NOW + 7));
    assert_eq!(second.refused_signatures(), 1);
    second.receive(HERE, &arming(254, NOW + 8));
    second.receive(HERE, &arming(253, NOW + 7));
    assert_eq!(second.refused_signatures(), 1);
}

/// However many commands come in a tick, the flight carries out a few and goes on.
#[test]
fn a_flood_of_commands_is_carried_out_bit_by_bit() {
    let mut radio = Radio::new(&CONFIG);
    for index in 1..=1000 {
        let height = 50.0 + f32::from(u16::try_from(index).unwrap()) / 1000.0;
        radio.at(300, &write("MPP_ALT_M", height));
    }
    let log = radio.fly(&scenario());
    let mut ticks: Vec<u64> = log.orders.iter().map(|entry| entry.tick).collect();
    // 16 at once and 256 later; the rest is lost, and that is told.
    assert_eq!(ticks.len(), 16 + 256, "{ticks:?}");
    assert_eq!(radio.vehicle.lost_demands(), 1000 - 16 - 256);
    let told = |(_, text): &(u32, String)| text.contains("Too many commands at once");
    assert_eq!(radio.texts().iter().filter(|text| told(text)).count(), 1);
    ticks.dedup();
    assert_eq!(ticks, (300..317).collect::<Vec<u64>>());
}

/// A station without the key cannot replace a station that is there.
#[test]
fn an_unsigned_heartbeat_is_nobodys() {
    let mut radio = Radio::new(&keyed());
    radio.at(0, &heartbeat());
    radio.fly(&scenario());
    assert!(radio.notes.is_empty(), "{:?}", radio.notes);
}
