//! Tests the files that a station can read.

use super::radio::{CONFIG, Radio, command, scenario};
use hil_protocol::mavlink::MessageData;
use hil_protocol::mavlink::messages::*;
use mpp_node::parameters::PARAMETERS;
use mpp_sim::scenario::Scenario;
use serde_json::Value;

const TERMINATE: u8 = 1;
const RESET: u8 = 2;
const LIST: u8 = 3;
const OPEN: u8 = 4;
const READ: u8 = 5;
const WRITE: u8 = 7;
const SUM: u8 = 14;
const BURST: u8 = 15;
const ACK: u8 = 128;
const NAK: u8 = 129;

fn request(opcode: u8, session: u8, offset: u32, data: &[u8]) -> FILE_TRANSFER_PROTOCOL_DATA {
    let mut payload = [0; 251];
    payload[..5].copy_from_slice(&[0xFF, 0xFF, session, opcode, data.len() as u8]);
    payload[8..12].copy_from_slice(&offset.to_le_bytes());
    payload[12..12 + data.len()].copy_from_slice(data);
    FILE_TRANSFER_PROTOCOL_DATA {
        target_system: 1,
        target_component: 1,
        payload,
        ..FILE_TRANSFER_PROTOCOL_DATA::DEFAULT
    }
}

/// Sends one request a tick and returns the answers' payloads with their ticks.
fn answers(requests: &[FILE_TRANSFER_PROTOCOL_DATA]) -> Vec<(u32, [u8; 251])> {
    let mut radio = Radio::new(&CONFIG);
    for (tick, request) in (0..).zip(requests) {
        radio.at(tick, request);
    }
    radio.fly(&Scenario {
        ticks: requests.len() as u32 + 1,
        ..scenario()
    });
    radio.all(|message| match message {
        MavMessage::FILE_TRANSFER_PROTOCOL(file) => {
            assert_eq!(file.target_system, 255);
            Some(file.payload)
        }
        _ => None,
    })
}

fn data(payload: &[u8; 251]) -> &[u8] {
    &payload[12..12 + usize::from(payload[4])]
}

/// Reads a whole file in parts of 100 bytes.
fn whole(path: &str) -> Vec<u8> {
    let reads = (0..200).map(|part| request(READ, 9, 100 * part, &[0; 100]));
    let requests: Vec<_> = [request(OPEN, 9, 0, path.as_bytes())]
        .into_iter()
        .chain(reads)
        .collect();
    let answers = answers(&requests);
    let length = u32::from_le_bytes(data(&answers[0].1).try_into().unwrap());
    let parts = answers[1..].iter().filter(|(_, payload)| payload[3] == ACK);
    let bytes: Vec<u8> = parts
        .flat_map(|(_, payload)| data(payload).to_vec())
        .collect();
    assert_eq!(bytes.len(), length as usize);
    bytes
}

#[test]
fn each_request_is_answered_at_once_by_its_number() {
    let (not_found, protected, unknown, no_session, end) = (10, 9, 7, 4, 6);
    let cases = [
        (request(RESET, 7, 0, b""), ACK, 0),
        (request(LIST, 7, 0, b"/"), ACK, b'F'),
        (request(LIST, 7, 2, b"/"), NAK, end),
        (request(LIST, 7, 0, b"/etc"), NAK, not_found),
        (request(OPEN, 7, 0, b"@PARAM/param.pck"), NAK, not_found),
        (request(OPEN, 7, 0, b"/../Cargo.toml"), NAK, not_found),
        (request(READ, 7, 0, b""), NAK, no_session),
        (request(WRITE, 7, 0, b"x"), NAK, protected),
        (request(99, 7, 0, b""), NAK, unknown),
    ];
    let requests: Vec<_> = cases.iter().map(|(request, ..)| request.clone()).collect();
    let answers = answers(&requests);
    assert_eq!(answers.len(), cases.len());
    for (((tick, answer), (request, verdict, first)), place) in answers.iter().zip(cases).zip(0..) {
        // The number of the answer follows that of the request, also over the end.
        assert_eq!((*tick, &answer[..3]), (place, &[0, 0, 7][..]));
        let expected = (verdict, request.payload[3], first);
        assert_eq!((answer[3], answer[5], answer[12]), expected, "{place}");
    }
}

#[test]
fn an_answer_is_never_answered() {
    assert_eq!(answers(&[request(ACK, 0, 0, b"")]), []);
}

#[test]
fn the_metadata_name_every_parameter_with_its_range() {
    let general: Value = serde_json::from_slice(&whole("/general.json")).unwrap();
    let about = &general["metadataTypes"][0];
    assert_eq!(
        (&general["version"], &about["type"]),
        (&1.into(), &1.into())
    );
    assert_eq!(about["uri"], "mftp:///parameter.json");
    let sum = answers(&[request(SUM, 0, 0, b"parameter.json")]);
    let sum = u32::from_le_bytes(data(&sum[0].1).try_into().unwrap());
    assert_eq!(about["fileCrc"], sum);

    let described: Value = serde_json::from_slice(&whole("parameter.json")).unwrap();
    let described = described["parameters"].as_array().unwrap();
    assert_eq!(described.len(), PARAMETERS.len());
    for (entry, parameter) in described.iter().zip(&PARAMETERS) {
        assert_eq!(entry["name"], parameter.name);
        assert_eq!(
            [&entry["min"], &entry["max"]],
            parameter.range.map(Value::from).each_ref()
        );
        let counts =
            ["MPP_PATHS", "MPP_SLICES", "MPP_ROUNDS", "MPP_DEEPENED"].contains(&parameter.name);
        assert_eq!(entry["type"], if counts { "Int32" } else { "Float" });
    }
}

/// The message that leads to the files has the sum of the first of them.
#[test]
fn the_vehicle_says_where_its_metadata_are() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(0, &request(SUM, 0, 0, b"/general.json"))
        .at(1, &command(512, COMPONENT_METADATA_DATA::ID as f32, 0.0));
    radio.fly(&Scenario {
        ticks: 3,
        ..scenario()
    });
    let sums = radio.all(|message| match message {
        MavMessage::FILE_TRANSFER_PROTOCOL(file) => {
            Some(u32::from_le_bytes(data(&file.payload).try_into().unwrap()))
        }
        MavMessage::COMPONENT_METADATA(about) => {
            assert_eq!(about.uri.to_str(), Ok("mftp:///general.json"));
            Some(about.file_crc)
        }
        _ => None,
    });
    assert_eq!(sums.len(), 2);
    assert_eq!(sums[0].1, sums[1].1);
}

/// A burst is bounded, its parts follow each other, and the last one is marked.
#[test]
fn a_burst_comes_in_parts_up_to_a_bound() {
    let answers = answers(&[
        request(OPEN, 3, 0, b"parameter.json"),
        request(BURST, 3, 160, &[0; 80]),
        request(TERMINATE, 3, 0, b""),
        request(BURST, 3, 0, &[0; 80]),
    ]);
    let burst: Vec<_> = answers.iter().filter(|(tick, _)| *tick == 1).collect();
    assert_eq!(burst.len(), 8);
    for ((_, part), number) in burst.iter().zip(0_u32..) {
        assert_eq!(part[0], number as u8);
        assert_eq!(part[8..12], (160 + 80 * number).to_le_bytes());
        assert_eq!((part[4], part[6]), (80, u8::from(number == 7)));
    }
    let (_, last) = answers.last().unwrap();
    assert_eq!((last[3], last[12]), (NAK, 4));
}
