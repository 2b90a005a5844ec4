//! Tests the decoder on everything that a line can do to a frame.

use crate::support::{any, found, frame, oracle};
use hil_protocol::*;
use proptest::collection::vec;
use proptest::prelude::*;

/// A short message with an empty list, zeros and non-zeros in its payload.
fn scan() -> Message {
    Message::LidarScan(LidarScan {
        tick: 1000,
        angle_min: -0.7,
        angle_increment: 0.0,
        ranges: heapless::Vec::new(),
    })
}

/// Bytes of a noisy line, with as many delimiters as in real traffic.
fn noise() -> impl Strategy<Value = Vec<u8>> {
    vec(prop_oneof![20 => any::<u8>(), 1 => Just(0)], 0..1500)
}

proptest! {
    #[test]
    fn any_message_comes_back_bit_for_bit(message in any::message()) {
        let sent = frame(&message);
        let received = found(&sent);
        prop_assert_eq!(received.len(), 1);
        let received = received[0].as_ref().unwrap();
        prop_assert_eq!(received.id(), message.id());
        // The frames are compared as bytes, because a NaN does not equal itself.
        prop_assert_eq!(frame(received), sent);
    }

    #[test]
    fn a_frame_is_what_the_oracle_makes(message in any::message()) {
        let mut payload = [0; MAX_PAYLOAD];
        let payload = message.to_payload(&mut payload).unwrap();
        prop_assert_eq!(frame(&message), oracle::frame(b"MP", PROTOCOL_VERSION, message.id(), payload));
    }

    #[test]
    fn after_noise_and_a_delimiter_the_next_frame_is_found(
        before in noise(),
        between in noise(),
        message in any::message(),
    ) {
        let sent = frame(&message);
        let mut decoder = Decoder::new();
        for noise in [before, between] {
            for byte in noise {
                decoder.push(byte);
            }
            decoder.push(0);
            let received: Vec<_> = sent.iter().filter_map(|&byte| decoder.push(byte)).collect();
            prop_assert_eq!(received.len(), 1);
            prop_assert_eq!(frame(received[0].as_ref().unwrap()), sent.clone());
        }
    }

    #[test]
    fn noise_holds_no_message(bytes in noise()) {
        prop_assert!(found(&bytes).iter().all(Result::is_err));
    }

    #[test]
    fn any_payload_is_a_message_or_a_named_fault(id in any::<u8>(), payload in vec(any::<u8>(), 0..300)) {
        let received = found(&oracle::frame(b"MP", PROTOCOL_VERSION, id, &payload));
        prop_assert_eq!(received.len(), 1);
        match &received[0] {
            Ok(message) => prop_assert_eq!(message.id(), id),
            Err(DecodeError::UnknownId { id: named }) => {
                prop_assert!(*named == id && !(1..=9).contains(&id));
            }
            Err(DecodeError::Payload { id: named } | DecodeError::TrailingBytes { id: named }) => {
                prop_assert_eq!(*named, id);
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    #[test]
    fn a_flipped_bit_is_never_a_message(message in any::message(), at in any::<prop::sample::Index>()) {
        let mut bytes = frame(&message);
        let bit = at.index(bytes.len() * 8);
        bytes[bit / 8] ^= 1 << (bit % 8);
        bytes.push(0);
        prop_assert!(found(&bytes).iter().all(Result::is_err));
    }
}

#[test]
fn no_flipped_bit_of_a_frame_is_a_message() {
    let next = Message::ConfigureReply(ConfigureReply {
        verdict: ConfigureVerdict::Accepted,
    });
    let intact = frame(&scan());
    for bit in 0..intact.len() * 8 {
        let mut bytes = intact.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        bytes.push(0);
        assert!(found(&bytes).iter().all(Result::is_err), "bit {bit}");
        bytes.extend(frame(&next));
        assert_eq!(found(&bytes).last(), Some(&Ok(next.clone())), "bit {bit}");
    }
}

#[test]
fn a_truncated_frame_is_an_error_and_costs_no_more_than_the_next_one() {
    let whole = frame(&scan());
    for length in 1..whole.len() - 1 {
        let cut = &whole[..length];
        let delimited = found(&[cut, &[0], &whole].concat());
        assert!(
            matches!(delimited[..], [Err(_), Ok(_)]),
            "{length}: {delimited:?}"
        );
        let run_together = found(&[cut, &whole, &whole].concat());
        assert!(
            matches!(run_together[..], [Err(_), Ok(_)]),
            "{length}: {run_together:?}"
        );
    }
}

#[test]
fn delimiters_in_a_row_are_nothing() {
    let bytes = [&[0, 0, 0], frame(&scan()).as_slice(), &[0, 0]].concat();
    assert_eq!(found(&bytes), [Ok(scan())]);
}

#[test]
fn an_overlong_frame_is_one_error_at_its_end() {
    for length in [MAX_FRAME, MAX_FRAME + 1, 10 * MAX_FRAME] {
        let mut decoder = Decoder::new();
        assert!((0..length).all(|_| decoder.push(1).is_none()));
        assert_eq!(decoder.push(0), Some(Err(DecodeError::TooLong)));
        let rest: Vec<_> = frame(&scan())
            .iter()
            .filter_map(|&byte| decoder.push(byte))
            .collect();
        assert_eq!(rest, [Ok(scan())]);
    }
    // Without its delimiter the longest frame is one byte shorter. These bytes are long, but they
    // are no frame.
    let longest = [vec![1; MAX_FRAME - 1], vec![0]].concat();
    assert_eq!(found(&longest), [Err(DecodeError::Magic)]);
}

#[test]
fn each_fault_has_its_name() {
    use DecodeError::*;
    let reply = [0];
    let mut damaged = oracle::frame(b"MP", PROTOCOL_VERSION, id::CONFIGURE_REPLY, &reply);
    damaged[6] ^= 2;
    let cases: [(Vec<u8>, DecodeError); 10] = [
        (vec![5, 1, 0], Cobs),
        (vec![4, 1, 2, 3, 0], TooShort),
        (vec![8, 1, 2, 3, 4, 5, 6, 7, 0], TooShort),
        (
            oracle::frame(b"MQ", PROTOCOL_VERSION, id::CONFIGURE_REPLY, &reply),
            Magic,
        ),
        (damaged, Crc),
        (
            oracle::frame(b"MP", 1, id::CONFIGURE_REPLY, &reply),
            Version { peer: 1 },
        ),
        (
            oracle::frame(b"MP", 0, 200, &[1, 2, 3]),
            Version { peer: 0 },
        ),
        (
            oracle::frame(b"MP", PROTOCOL_VERSION, id::LAST + 1, &reply),
            UnknownId { id: id::LAST + 1 },
        ),
        (
            oracle::frame(b"MP", PROTOCOL_VERSION, id::CONFIGURE_REPLY, &[99]),
            Payload { id: 3 },
        ),
        (
            oracle::frame(b"MP", PROTOCOL_VERSION, id::CONFIGURE_REPLY, &[0, 0]),
            TrailingBytes { id: 3 },
        ),
    ];
    for (bytes, fault) in cases {
        assert_eq!(found(&bytes), [Err(fault)], "{bytes:02x?}");
    }
}

#[test]
fn a_damaged_version_is_damage_not_another_version() {
    let mut bytes = frame(&scan());
    assert_eq!(bytes[3], PROTOCOL_VERSION);
    bytes[3] ^= 3;
    assert_eq!(found(&bytes), [Err(DecodeError::Crc)]);
}

#[test]
fn a_list_longer_than_its_room_is_a_payload_fault() {
    // The payload holds a tick, two angles, and a count of 129. A frame with all their bytes would
    // be too long.
    let payload = [&[0; 9], [0x81, 0x01].as_slice(), &[0; 4 * 128]].concat();
    let received = found(&oracle::frame(
        b"MP",
        PROTOCOL_VERSION,
        id::LIDAR_SCAN,
        &payload,
    ));
    assert_eq!(received, [Err(DecodeError::Payload { id: id::LIDAR_SCAN })]);
}

#[test]
fn another_version_is_told_in_a_sentence() {
    assert_eq!(
        DecodeError::Version { peer: 1 }.to_string(),
        "peer speaks link protocol 1, this side speaks 2: update the older side"
    );
}
