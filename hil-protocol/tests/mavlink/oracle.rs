//! The frames in a stream, found slowly, from the whole of the stream and by the definition.

use mavlink::Message;

/// A part of a stream.
pub(crate) type Span = core::ops::Range<usize>;

/// CRC-16/MCRF4XX, bit by bit, over the bytes after the first and the message's seed.
pub(crate) fn crc(bytes: &[u8], seed: u8) -> u16 {
    let mut crc = 0xFFFF_u16;
    for byte in bytes.iter().skip(1).chain([&seed]) {
        crc ^= u16::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0x8408
            } else {
                crc >> 1
            };
        }
    }
    crc
}

/// The seed of a message's checksum. It comes from the common dialect as its maintainers publish
/// it, and from our three messages.
pub(crate) fn seed(id: u32) -> Option<u8> {
    use hil_protocol::mavlink::messages::MavMessage as Ours;
    use mavlink::dialects::common::MavMessage as Common;
    match id {
        54100.. => Ours::extra_crc(id),
        _ => Ours::IDS.contains(&id).then(|| Common::extra_crc(id)),
    }
}

/// The kind of a whole frame at a place.
pub(crate) enum Shape {
    /// An intact frame of a known message.
    Frame(Span),
    /// A frame of an unknown message whose checksum is right for one of the 256 messages that it
    /// could be.
    Unknown(Span),
}

/// The whole frame at a place; `None` if there is none.
pub(crate) fn shape(stream: &[u8], at: usize) -> Option<Shape> {
    let rest = &stream[at..];
    let (header, signature) = match rest {
        [0xFD, _, 0, ..] => (10, 0),
        [0xFD, _, 1, ..] => (10, 13),
        [0xFE, ..] => (6, 0),
        _ => return None,
    };
    let id = match (header, rest) {
        (10, [_, _, _, _, _, _, _, a, b, c, ..]) => u32::from_le_bytes([*a, *b, *c, 0]),
        (6, [_, _, _, _, _, id, ..]) => u32::from(*id),
        _ => return None,
    };
    let checked = header + usize::from(rest[1]);
    let span = at..at + checked + 2 + signature;
    if span.end > stream.len() {
        return None;
    }
    let sum = u16::from_le_bytes([rest[checked], rest[checked + 1]]);
    match seed(id) {
        Some(seed) => (crc(&rest[..checked], seed) == sum).then_some(Shape::Frame(span)),
        None => (0..=u8::MAX)
            .any(|seed| crc(&rest[..checked], seed) == sum)
            .then_some(Shape::Unknown(span)),
    }
}

/// Every unknown frame that is possible, also inside of others.
pub(crate) fn unknown(stream: &[u8]) -> Vec<Span> {
    let places = 0..stream.len();
    places
        .filter_map(|at| match shape(stream, at) {
            Some(Shape::Unknown(span)) => Some(span),
            _ => None,
        })
        .collect()
}
