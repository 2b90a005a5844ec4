//! Tests that what one address asks for changes nothing at another one.

use super::radio::{CONFIG, Radio, command, heard, scenario, write};
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Framer, MessageData, Sender, text};
use mpp_sim::scenario::Scenario;
use sil_harness::ground::tlog::TlogWriter;

const INT32: u8 = 6;
const REAL32: u8 = 9;
const VERSION: f32 = AUTOPILOT_VERSION_DATA::ID as f32;

fn flight(ticks: u32) -> Scenario {
    Scenario {
        ticks,
        ..scenario()
    }
}

fn attitude_ticks<'a>(heard: impl Iterator<Item = (u32, &'a MavMessage)>) -> Vec<u32> {
    heard
        .filter(|(_, message)| matches!(message, MavMessage::ATTITUDE(_)))
        .map(|(tick, _)| tick)
        .collect()
}

#[test]
fn rates_are_those_of_the_address_that_asked() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(100, &command(511, ATTITUDE_DATA::ID as f32, 20_000.0))
        .there_at(
            100,
            &REQUEST_DATA_STREAM_DATA {
                target_system: 1,
                target_component: 1,
                req_stream_id: 0,
                req_message_rate: 2,
                start_stop: 1,
            },
        )
        .there_at(150, &command(510, ATTITUDE_DATA::ID as f32, 0.0));
    radio.fly(&flight(300));
    let here = attitude_ticks(radio.heard.iter().map(|(tick, message)| (*tick, message)));
    let there = attitude_ticks(
        radio
            .heard_there
            .iter()
            .map(|(tick, _, message)| (*tick, message)),
    );
    let from = |ticks: &[u32]| ticks.iter().filter(|tick| **tick >= 100).count();
    assert_eq!((from(&here), from(&there)), (100, 4));
    assert_eq!((here.len() - 100, there.len() - 4), (10, 10));
    let told = heard!(radio, MESSAGE_INTERVAL, |told| told.interval_us);
    assert_eq!(told, [(150, 500_000)]);
}

/// A station counts lost frames by their numbers, so the numbers at an address have no gap.
#[test]
fn the_frames_of_an_address_are_numbered_without_a_gap() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(50, &command(511, ATTITUDE_DATA::ID as f32, 10_000.0))
        .there_at(77, &command(511, VFR_HUD_DATA::ID as f32, -1.0));
    radio.fly(&flight(200));
    let numbers: Vec<u8> = radio.heard_there.iter().map(|(_, n, _)| *n).collect();
    assert!(numbers.len() > 50);
    for (number, next) in numbers.iter().zip(&numbers[1..]) {
        assert_eq!(number.wrapping_add(1), *next);
    }
}

/// Messages that stations do not know go to those who asked for them. All others count no frame as lost.
#[test]
fn private_messages_are_for_those_who_ask() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(50, &command(511, MPP_PLAN_STATUS_DATA::ID as f32, 1.0))
        .at(120, &command(512, MPP_TRAJECTORY_DATA::ID as f32, 0.0))
        .at(130, &command(512, CURRENT_MODE_DATA::ID as f32, 0.0));
    let log = radio.fly(&flight(300));
    let private = |message: &MavMessage| match message {
        MavMessage::MPP_PLAN_STATUS(_) => Some("plan"),
        MavMessage::MPP_TRAJECTORY(_) => Some("trajectory"),
        MavMessage::MPP_LIDAR_SCAN(_) => Some("scan"),
        MavMessage::CURRENT_MODE(_) => Some("mode"),
        _ => None,
    };
    let here = radio.all(private);
    let expected = ["plan", "trajectory", "mode", "plan"];
    assert_eq!(
        here.iter().map(|(_, what)| *what).collect::<Vec<_>>(),
        expected
    );
    let mut there = radio.heard_there.iter();
    assert!(there.all(|(.., message)| private(message).is_none()));
    // The recording has every plan.
    let tlog = std::mem::replace(&mut radio.tlog, TlogWriter::new(Vec::new()));
    let mut plans = 0;
    Framer::new().receive_datagram(&tlog.finish().unwrap(), |frame| {
        plans += usize::from(frame.decode::<MPP_PLAN_STATUS_DATA>().is_some());
    });
    assert_eq!(plans, log.plans.len());
}

/// Whole numbers are floats for a station that never asked what the vehicle can do, and integers for one that did.
#[test]
fn integers_are_for_those_who_know_of_them() {
    let mut radio = Radio::new(&CONFIG);
    let read = PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: text("MPP_PATHS"),
    };
    let twelve = PARAM_SET_DATA {
        param_type: INT32,
        ..write("MPP_PATHS", f32::from_bits(12))
    };
    radio
        .there_at(10, &command(512, VERSION, 0.0))
        .there_at(20, &read)
        .there_at(30, &twelve)
        .there_at(40, &write("MPP_PATHS", 13.0));
    let log = radio.fly(&flight(100));
    let values = |message: &MavMessage| match message {
        MavMessage::PARAM_VALUE(value) => Some((value.param_type, value.param_value.to_bits())),
        _ => None,
    };
    let here: Vec<_> = radio
        .all(values)
        .into_iter()
        .map(|(_, told)| told)
        .collect();
    let heard = radio.heard_there.iter();
    let there: Vec<_> = heard.filter_map(|(.., message)| values(message)).collect();
    assert_eq!(
        here,
        [25.0_f32, 12.0, 13.0].map(|value| (REAL32, value.to_bits()))
    );
    assert_eq!(there, [25, 12, 13].map(|value| (INT32, value)));
    assert_eq!(log.orders.len(), 2);
    // Each of the two hears what is true for it: bytes or floats.
    let capabilities = radio
        .heard_there
        .iter()
        .find_map(|(.., message)| match message {
            MavMessage::AUTOPILOT_VERSION(version) => Some(version.capabilities),
            _ => None,
        });
    assert_eq!(capabilities.unwrap() & (16 | 131_072), 16);
}

/// Another program at the same address has not asked, so it gets floats again.
#[test]
fn the_form_of_parameters_is_that_of_who_speaks() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(10, &command(512, VERSION, 0.0));
    let other = Sender::new(254, 230).frame(&PARAM_REQUEST_READ_DATA {
        param_index: 0,
        target_system: 1,
        target_component: 1,
        param_id: text(""),
    });
    radio.bytes_at(20, other.as_bytes());
    radio.fly(&flight(50));
    assert_eq!(radio.values(), [("MPP_PATHS".to_owned(), 25.0)]);
}

/// A recording has every message once, whole numbers as floats.
#[test]
fn a_recording_has_each_message_once() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(10, &command(512, VERSION, 0.0))
        .there_at(20, &PARAM_REQUEST_LIST_DATA::DEFAULT);
    radio.fly(&flight(100));
    let listed = radio.values().len();
    let tlog = std::mem::replace(&mut radio.tlog, TlogWriter::new(Vec::new()));
    let mut recorded = 0;
    Framer::new().receive_datagram(&tlog.finish().unwrap(), |frame| {
        if let Some(value) = frame.decode::<PARAM_VALUE_DATA>() {
            assert_eq!(value.param_type, REAL32);
            recorded += 1;
        }
    });
    assert!(listed > 20);
    assert_eq!(recorded, listed);
}

#[test]
fn a_place_to_fly_to_is_refused_with_a_reason_and_an_altitude_is_taken() {
    let mut radio = Radio::new(&CONFIG);
    let reposition = |x, y, z| COMMAND_INT_DATA {
        frame: 6,
        command: 192,
        target_system: 1,
        target_component: 1,
        x,
        y,
        z,
        ..COMMAND_INT_DATA::DEFAULT
    };
    let long = COMMAND_LONG_DATA {
        param5: f32::NAN,
        param6: f32::NAN,
        // Above the sea, because this message names no frame.
        param7: 488.0 + 54.0,
        ..command(192, -1.0, 0.0)
    };
    radio
        .at(10, &reposition(473_977_420, 85_455_940, 60.0))
        .at(20, &reposition(i32::MAX, i32::MAX, 52.0))
        .at(30, &long)
        .at(40, &reposition(i32::MAX, i32::MAX, f32::NAN));
    let log = radio.fly(&flight(60));
    assert_eq!(radio.acks(), [(192, 2), (192, 0), (192, 0), (192, 2)]);
    assert_eq!(log.orders.len(), 2);
    let texts = radio.texts();
    let said = |text: &str| texts.iter().filter(|(_, other)| other == text).count();
    assert_eq!(said("It flies straight on: only an altitude can be set"), 2);
}
