//! Tests messages there and back, and against the published dialect.

use super::oracle;
use hil_protocol::mavlink::messages::{self as ours, MavMessage as Ours};
use hil_protocol::mavlink::{Framer, MessageData, Sender, text};
use mavlink::dialects::common::{self, MavMessage as Common};
use mavlink::{MavlinkReader, MavlinkVersion, Message};
use proptest::prelude::*;

fn back<M: MessageData>(sent: &M) -> M {
    let datagram = Sender::new(1, 1).frame(sent);
    let mut received = None;
    Framer::new().receive(datagram.as_bytes(), |frame| received = frame.decode());
    received.unwrap()
}

/// A wrong name of a message, and a wrong type, name or order of a field, change the seed of its checksum.
#[test]
fn our_part_of_the_common_dialect_is_the_common_dialect() {
    for id in Ours::IDS.iter().filter(|id| **id < 50_000) {
        assert!(Common::all_ids().contains(id), "{id}");
        assert_eq!(Ours::extra_crc(*id), Some(Common::extra_crc(*id)), "{id}");
    }
}

/// Other tools read our own messages from `mpp.xml`.
#[test]
fn our_own_messages_are_those_of_the_file() {
    let file = include_str!("../../dialect/mpp.xml");
    let value = |element: &'static str, attribute: &str| -> &'static str {
        let (_, rest) = element.split_once(&format!("{attribute}=\"")).unwrap();
        rest.split_once('"').unwrap().0
    };
    let mut ids = Vec::new();
    for message in file.split("<message ").skip(1) {
        let mut fields: Vec<_> = message.split("<field ").skip(1).collect();
        fields.sort_by_key(|field| match value(field, "type") {
            kind if kind.contains("32") || kind.contains("float") => 0,
            kind if kind.contains("16") => 1,
            _ => 2,
        });
        let mut covered = format!(" {} ", value(message, "name")).into_bytes();
        for field in fields {
            let (kind, count) = match value(field, "type").split_once('[') {
                Some((kind, count)) => (kind, count.trim_end_matches(']').parse::<u8>().ok()),
                None => (value(field, "type"), None),
            };
            covered.extend(format!("{kind} {} ", value(field, "name")).bytes());
            covered.extend(count);
        }
        let (last, rest) = covered.split_last().unwrap();
        let sum = oracle::crc(rest, *last);
        let id = value(message, "id").parse().unwrap();
        assert_eq!(Ours::extra_crc(id), Some((sum ^ sum >> 8) as u8), "{id}");
        ids.push(id);
    }
    assert!(Ours::IDS.ends_with(&ids));
}

#[test]
fn heartbeat_bytes_are_frozen() {
    let heartbeat = ours::HEARTBEAT_DATA {
        custom_mode: 10,
        mavtype: 1,
        autopilot: 0,
        base_mode: 0xB5,
        system_status: 4,
        mavlink_version: 3,
    };
    let mut sender = Sender::new(1, 1);
    let mut hex = || -> String {
        let frame = sender.frame(&heartbeat);
        frame
            .as_bytes()
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    };
    assert_eq!(hex(), "fd0900000001010000000a0000000100b5040357f8");
    assert!(hex().starts_with("fd090000010101"));
}

#[test]
fn frames_are_numbered_across_messages_and_wrap() {
    let mut sender = Sender::new(9, 8);
    for number in 0..=300_u16 {
        let sent = match number % 2 {
            0 => sender.frame(&ours::HEARTBEAT_DATA::DEFAULT),
            _ => sender.frame(&ours::PING_DATA::DEFAULT),
        };
        let (header, _) = MavlinkReader::new(sent.as_bytes())
            .read_message::<Common>(MavlinkVersion::V2)
            .unwrap();
        assert_eq!((header.system_id, header.component_id), (9, 8));
        assert_eq!(header.sequence, (number % 256) as u8);
    }
}

/// A command id that is in no list arrives unchanged.
#[test]
fn a_command_that_nobody_knows_is_read() {
    let sent = ours::COMMAND_LONG_DATA {
        command: 42_424,
        param7: 3.5,
        confirmation: 9,
        ..ours::COMMAND_LONG_DATA::DEFAULT
    };
    assert_eq!(back(&sent), sent);
}

#[test]
fn the_scan_is_one_frame_of_231_bytes() {
    let mut scan = ours::MPP_LIDAR_SCAN_DATA::DEFAULT;
    scan.ranges.fill(u16::MAX);
    scan.count = 100;
    assert_eq!(Sender::new(1, 1).frame(&scan).as_bytes().len(), 231);
}

#[test]
fn a_text_ends_with_a_whole_character() {
    let cut = |long: &str| text::<50>(long).to_str().unwrap().to_owned();
    assert_eq!(cut(""), "");
    assert_eq!(cut("no feasible plan"), "no feasible plan");
    assert_eq!(cut(&"a".repeat(51)), "a".repeat(50));
    assert_eq!(cut(&format!("{}é", "a".repeat(49))), "a".repeat(49));
    assert_eq!(
        cut(&format!("{}é", "a".repeat(48))),
        format!("{}é", "a".repeat(48))
    );
}

proptest! {
    /// The published dialect reads our frames.
    #[test]
    fn the_published_dialect_reads_what_we_send(time in any::<u32>(), z in -1e6_f32..1e6, climb in -9_f32..9.0) {
        let sent = ours::LOCAL_POSITION_NED_DATA { time_boot_ms: time, x: 1.0, y: 0.0, z, vx: 12.0, vy: 0.0, vz: climb };
        let frame = Sender::new(1, 1).frame(&sent);
        let (_, Common::LOCAL_POSITION_NED(read)) =
            MavlinkReader::new(frame.as_bytes()).read_message(MavlinkVersion::V2).unwrap() else { panic!() };
        let expected = common::LOCAL_POSITION_NED_DATA { time_boot_ms: time, x: 1.0, y: 0.0, z, vx: 12.0, vy: 0.0, vz: climb };
        prop_assert_eq!(read, expected);
    }

    #[test]
    fn a_trajectory_comes_back(values in prop::array::uniform19(-1e3_f32..1e3), tick in any::<u32>(), count in any::<u8>()) {
        let sent = ours::MPP_TRAJECTORY_DATA {
            scan_tick: tick, count, x: values, gamma: values, ..ours::MPP_TRAJECTORY_DATA::DEFAULT
        };
        prop_assert_eq!(back(&sent), sent);
    }

    #[test]
    fn the_checksum_is_the_oracles(tick in any::<u32>()) {
        let frame = Sender::new(3, 4).frame(&ours::MPP_PLAN_STATUS_DATA { scan_tick: tick, ..ours::MPP_PLAN_STATUS_DATA::DEFAULT });
        let (checked, sum) = frame.as_bytes().split_last_chunk::<2>().unwrap();
        let seed = <ours::MPP_PLAN_STATUS_DATA as MessageData>::EXTRA_CRC;
        prop_assert_eq!(oracle::crc(checked, seed), u16::from_le_bytes(*sum));
    }
}
