//! Tests the framer against an oracle, and against the reader of `mavlink-core`.

use super::oracle::{Shape, Span, crc, shape, unknown};
use super::streams::{Maker, Stream};
use hil_protocol::mavlink::messages::HEARTBEAT_DATA;
use hil_protocol::mavlink::{Frame, Framer, MAX_FRAME, Sender};
use mavlink::dialects::common::MavMessage as Common;
use mavlink::{MAVLinkMessageRaw, MavlinkReader};

/// A frame that came out of the framer.
#[derive(Debug, PartialEq)]
struct Found {
    bytes: Vec<u8>,
    /// Number of bytes that had come by then.
    come: usize,
}

/// The frames that the framer finds in a stream that comes in pieces.
fn found(stream: &[u8], piece: usize) -> Vec<Found> {
    let mut framer = Framer::new();
    let mut found = Vec::new();
    let mut come = 0;
    let mut take = |frame: &Frame<'_>, come| {
        let bytes = frame.bytes.to_vec();
        found.push(Found { bytes, come });
    };
    for bytes in stream.chunks(piece) {
        come += bytes.len();
        framer.receive(bytes, |frame| take(frame, come));
    }
    framer.end(|frame| take(frame, come));
    found
}

/// The frames of the common dialect that the stock reader finds.
fn stock(stream: &[u8]) -> Vec<Vec<u8>> {
    let mut reader = MavlinkReader::new(stream);
    let mut found = Vec::new();
    while let Ok(message) = reader.read_any_raw_message::<Common>() {
        found.push(match message {
            MAVLinkMessageRaw::V1(raw) => raw.raw_bytes().to_vec(),
            MAVLinkMessageRaw::V2(raw) => raw.raw_bytes().to_vec(),
        });
    }
    found
}

#[test]
fn pieces_of_any_length_hold_the_same_frames_and_each_is_one() {
    for seed in 0..2000 {
        let mut maker = Maker::new(seed);
        let stream = match seed % 2 {
            0 => maker.mixed(20).bytes,
            _ => maker.malice(2000),
        };
        let whole = found(&stream, stream.len());
        for piece in [1, 7, 280] {
            let pieces = found(&stream, piece);
            let bytes = |found: &[Found]| -> Vec<Vec<u8>> {
                found.iter().map(|found| found.bytes.clone()).collect()
            };
            assert!(bytes(&pieces) == bytes(&whole), "seed {seed}");
        }
        places(&stream, &whole);
    }
}

/// The places of the frames that came out: intact, one behind the other.
fn places(stream: &[u8], found: &[Found]) -> Vec<Span> {
    let mut from = 0;
    let mut places = Vec::new();
    for found in found {
        let length = found.bytes.len();
        let mut rest = stream[from..].windows(length);
        let at = from + rest.position(|window| window == found.bytes).unwrap();
        let Some(Shape::Frame(span)) = shape(stream, at) else {
            unreachable!("no frame at {at}");
        };
        assert_eq!(span.len(), length);
        from = span.end;
        places.push(span);
    }
    places
}

/// The framer invents only what a checksum of 16 bits lets through by chance. It loses only what
/// such a chance covers, or what an unknown frame covers whose checksum is right for one of the 256
/// messages that it could be: see the test below.
#[test]
fn every_planted_frame_comes_out_and_no_other() {
    let (mut all, mut lost, mut chance) = (0, 0, 0);
    for seed in 0..3000 {
        let Stream { bytes, planted } = Maker::new(seed).mixed(30);
        let found = places(&bytes, &found(&bytes, bytes.len()));
        let by_chance = found.iter().filter(|span| !planted.contains(span)).cloned();
        let by_chance: Vec<_> = by_chance.collect();
        chance += by_chance.len();
        for missing in planted.iter().filter(|span| !found.contains(span)) {
            let covers: Vec<_> = by_chance.iter().cloned().chain(unknown(&bytes)).collect();
            // A frame was sent twice and came out once. Then it is unknown which of the two came
            // out.
            let mut twins = planted
                .iter()
                .filter(|p| bytes[(*p).clone()] == bytes[missing.clone()]);
            let covered = |span: &Span| {
                covers
                    .iter()
                    .any(|c| c.start < span.end && span.start < c.end)
            };
            assert!(twins.any(covered), "seed {seed}");
            lost += 1;
        }
        all += planted.len();
    }
    println!("of {all} frames {lost} were covered; {chance} checksums were right by chance");
    assert!(lost <= 1 && chance <= 5);
}

/// An unknown message that carries a frame, and an unknown frame that lost its end before that
/// frame came, are the same bytes. A framer that gives the frame out invents one in the first case.
/// A framer that does not give it out misses one in the second case. Without the message's
/// definition there is no third way.
#[test]
fn two_histories_with_the_same_bytes_cannot_both_be_served() {
    let mut sender = Sender::new(255, 190);
    let mut frame = || sender.frame(&HEARTBEAT_DATA::DEFAULT).as_bytes().to_vec();
    let (carried, next) = (frame(), frame());
    let header = [0xFD, 40, 0, 0, 7, 1, 1, 0x39, 0x30, 0];

    let mut carrying = [&header[..], &[5; 9], &carried, &[6; 10]].concat();
    carrying.extend(crc(&carrying, 77).to_le_bytes());
    let carrying = [&carrying[..], &next].concat();

    let cut = [&header[..], &[5; 9]].concat();
    let noise = [&[6; 10][..], &carrying[50..52]].concat();
    let lost_its_end = [&cut[..], &carried, &noise, &next].concat();

    assert_eq!(carrying, lost_its_end);
    let alone = |bytes| Found {
        bytes,
        come: carrying.len(),
    };
    assert!(found(&carrying, 1) == [alone(next.clone())]);

    // A checksum that no message has cannot be an unknown message, so it hides nothing.
    let mut broken = carrying.clone();
    while matches!(shape(&broken, 0), Some(Shape::Unknown(_))) {
        broken[50] ^= 1;
        broken[51] = broken[51].wrapping_add(1);
    }
    let come = found(&broken, 1).into_iter().map(|found| found.bytes);
    assert!(come.eq([carried.clone(), next]));
    // Here no frame begins where this one says that it ends.
    let mut unfollowed = carrying.clone();
    unfollowed.insert(52, 0);
    assert_eq!(found(&unfollowed, 1).len(), 2);
}

/// Among frames that end where they say, each is given out with its last byte, whatever their
/// messages and checksums.
#[test]
fn frames_do_not_hold_up_one_another() {
    for seed in 0..2000 {
        let Stream { bytes, planted } = Maker::new(seed).whole(30, seed % 2 == 1);
        let found = found(&bytes, 1);
        let late: Vec<_> = found
            .iter()
            .zip(&planted)
            .filter(|(found, span)| found.come != span.end)
            .collect();
        assert_eq!((found.len(), late.len()), (planted.len(), 0), "seed {seed}");
    }
}

#[test]
fn noise_holds_up_a_frame_by_a_bounded_number_of_bytes() {
    let (mut all, mut late, mut longest) = (0, 0, 0);
    for seed in 0..2000 {
        let stream = Maker::new(seed).mixed(30).bytes;
        let found = found(&stream, 1);
        for (span, found) in places(&stream, &found).into_iter().zip(&found) {
            let wait = found.come - span.end;
            longest = longest.max(found.come - span.start);
            late += usize::from(wait > 0);
            all += 1;
        }
    }
    println!("{late} of {all} frames were late; out within {longest} bytes of their first");
    // The longest frame of MAVLink 2: header, payload, checksum and signature.
    assert_eq!(MAX_FRAME, 10 + 255 + 2 + 13);
    assert!(longest <= 2 * MAX_FRAME, "{longest}");
}

/// The stock reader looks for frames inside unknown ones, so it may find one of those. Of all other
/// frames it finds no more than ours.
#[test]
fn the_stock_reader_finds_no_more_planted_frames() {
    let (mut theirs, mut ours, mut only_theirs) = (0, 0, 0);
    for seed in 0..2000 {
        let Stream { bytes, planted } = Maker::new(seed).mixed(30);
        let found = places(&bytes, &found(&bytes, bytes.len()));
        let stock = stock(&bytes);
        // The scan is ours alone.
        let common = |span: &Span| bytes[span.start + 7..].first_chunk() != Some(&[0x54, 0xD3, 0]);
        for span in planted.into_iter().filter(common) {
            let theirs_too = stock.iter().any(|frame| frame == &bytes[span.clone()]);
            let ours_too = found.contains(&span);
            theirs += usize::from(theirs_too);
            ours += usize::from(ours_too);
            only_theirs += usize::from(theirs_too && !ours_too);
        }
    }
    println!("planted frames found: {ours}, by the stock reader {theirs}");
    assert!(ours > theirs && only_theirs == 0, "{only_theirs}");
}

/// Such a frame held back thirteen heartbeats in the stock reader.
#[test]
fn a_false_beginning_inside_an_unknown_frame_delays_nothing() {
    let mut stream = vec![
        0xFD, 4, 0, 0, 0, 1, 1, 0x39, 0x30, 0, 0xFD, 0xFF, 0, 0, 0xAA, 0xBB,
    ];
    let mut sender = Sender::new(1, 1);
    let mut ends = Vec::new();
    for _ in 0..3 {
        stream.extend(sender.frame(&HEARTBEAT_DATA::DEFAULT).as_bytes());
        ends.push(stream.len());
    }
    let came: Vec<_> = found(&stream, 1)
        .into_iter()
        .map(|found| found.come)
        .collect();
    assert_eq!(came, ends);
}

#[test]
fn a_million_random_strings_are_survived() {
    let mut maker = Maker::new(0);
    let mut framer = Framer::new();
    for _ in 0..1_000_000 {
        let length = maker.below(40);
        let bytes = maker.malice(length);
        framer.receive(&bytes, |_| {});
    }
    let counters = *framer.counters();
    assert!(counters.noise > 10_000_000, "{counters:?}");
    assert!(counters.damaged > 100_000, "{counters:?}");
}

#[test]
fn a_datagram_ends_with_its_last_byte() {
    let mut sender = Sender::new(1, 1);
    let heartbeat = sender.frame(&HEARTBEAT_DATA::DEFAULT);
    let mut count = 0;
    let mut framer = Framer::new();
    // On a stream this beginning would wait for 255 bytes.
    framer.receive_datagram(&[0xFD, 0xFF, 0], |_| count += 1);
    framer.receive_datagram(&[&[0xFD, 0xFF, 0], heartbeat.as_bytes()].concat(), |_| {
        count += 1;
    });
    assert_eq!(count, 1);
    framer.receive_datagram(&Maker::new(1).unknown(), |_| count += 1);
    assert_eq!((count, framer.counters().unknown), (1, 1));
}
