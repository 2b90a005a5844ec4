//! The framer beside an oracle, and beside the reader of `mavlink-core`.

use crate::oracle::{Span, frames};
use crate::streams::{Maker, Stream};
use hil_protocol::mavlink::messages::{HEARTBEAT_DATA, MavMessage};
use hil_protocol::mavlink::{Frame, Framer, MAX_FRAME, Sender};
use mavlink::{MAVLinkMessageRaw, MavlinkReader};

/// A frame as it came out.
struct Found {
    bytes: Vec<u8>,
    /// How many bytes had come by then.
    come: usize,
}

/// What the framer finds in a stream that comes in pieces.
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

/// What the stock reader finds.
fn stock(stream: &[u8]) -> Vec<Vec<u8>> {
    let mut reader = MavlinkReader::new(stream);
    let mut found = Vec::new();
    while let Ok(message) = reader.read_any_raw_message::<MavMessage>() {
        found.push(match message {
            MAVLinkMessageRaw::V1(raw) => raw.raw_bytes().to_vec(),
            MAVLinkMessageRaw::V2(raw) => raw.raw_bytes().to_vec(),
        });
    }
    found
}

#[test]
fn in_pieces_of_any_length_the_oracle_finds_the_same() {
    for seed in 0..2000 {
        let mut maker = Maker::new(seed);
        let stream = match seed % 2 {
            0 => maker.mixed(20).bytes,
            _ => maker.malice(2000),
        };
        let expected: Vec<_> = frames(&stream)
            .0
            .into_iter()
            .map(|span| &stream[span])
            .collect();
        for piece in [1, 7, 280, stream.len()] {
            let found = found(&stream, piece);
            assert!(
                found
                    .iter()
                    .map(|found| &found.bytes[..])
                    .eq(expected.iter().copied()),
                "seed {seed}"
            );
        }
    }
}

/// Nothing is invented but what a checksum of 16 bits lets through by chance, and nothing is lost
/// but what such a chance covers, or what stands where an unknown frame says its
/// payload is, with an intact frame right behind: nobody without that message's checksum can tell.
#[test]
fn every_planted_frame_comes_out_and_no_other() {
    let (mut all, mut hidden, mut chance) = (0, 0, 0);
    for seed in 0..3000 {
        let Stream { bytes, planted } = Maker::new(seed).mixed(30);
        let (found, mut cover) = frames(&bytes);
        let by_chance = found.into_iter().filter(|span| !planted.contains(span));
        let before = cover.len();
        cover.extend(by_chance);
        chance += cover.len() - before;
        let (found, _) = frames(&bytes);
        for lost in planted.iter().filter(|span| !found.contains(span)) {
            let covers = |span: &Span| span.start < lost.end && lost.start < span.end;
            assert!(cover.iter().any(covers), "seed {seed}");
            hidden += 1;
        }
        all += planted.len();
    }
    println!("of {all} frames {hidden} were covered; {chance} checksums were right by chance");
    assert!(hidden * 500 < all && chance <= 5);
}

/// Among intact frames, whatever their messages, each is given out with its last byte.
#[test]
fn intact_frames_do_not_hold_up_one_another() {
    for seed in 0..1000 {
        let Stream { bytes, planted } = Maker::new(seed).intact(30);
        let came = found(&bytes, 1).into_iter().map(|found| found.come);
        assert!(
            came.eq(planted.into_iter().map(|span| span.end)),
            "seed {seed}"
        );
    }
}

#[test]
fn noise_holds_up_a_frame_by_a_bounded_number_of_bytes() {
    let mut longest = 0;
    for seed in 0..2000 {
        let stream = Maker::new(seed).mixed(30).bytes;
        for (found, span) in found(&stream, 1).iter().zip(frames(&stream).0) {
            longest = longest.max(found.come - span.end);
        }
    }
    println!("longest hold-up: {longest} bytes");
    assert!(longest <= 2 * MAX_FRAME, "{longest}");
}

/// The stock reader looks for frames inside unknown ones, so it finds those few as well; of all
/// others it finds no more.
#[test]
fn the_stock_reader_finds_no_more_planted_frames() {
    let (mut theirs, mut ours) = (0, 0);
    for seed in 0..2000 {
        let Stream { bytes, planted } = Maker::new(seed).mixed(30);
        let (found, unknown) = frames(&bytes);
        let stock = stock(&bytes);
        ours += found.len();
        for span in planted {
            let inside = unknown.iter().any(|unknown| unknown.contains(&span.start));
            let theirs_too = stock.iter().any(|frame| frame == &bytes[span.clone()]);
            theirs += usize::from(theirs_too);
            assert!(
                !theirs_too || inside || found.contains(&span),
                "seed {seed}"
            );
        }
    }
    println!("planted frames found: {ours}, by the stock reader {theirs}");
    assert!(1000 * ours > 998 * theirs);
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
    // Would wait for 255 bytes on a stream.
    framer.receive_datagram(&[0xFD, 0xFF, 0], |_| count += 1);
    framer.receive_datagram(&[&[0xFD, 0xFF, 0], heartbeat.as_bytes()].concat(), |_| {
        count += 1;
    });
    assert_eq!(count, 1);
    framer.receive_datagram(&Maker::new(1).unknown(), |_| count += 1);
    assert_eq!((count, framer.counters().unknown), (1, 1));
}
