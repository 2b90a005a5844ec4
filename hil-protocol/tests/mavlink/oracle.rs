//! The frames of a stream, found slowly, from the whole of it and by the definition.

use mavlink::Message;

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

/// The seed of a message's checksum: of the common dialect as its keepers publish it, and of the
/// three messages that are ours.
pub(crate) fn seed(id: u32) -> Option<u8> {
    use hil_protocol::mavlink::messages::MavMessage as Ours;
    use mavlink::dialects::common::MavMessage as Common;
    Ours::all_ids().contains(&id).then(|| match id {
        54100.. => Ours::extra_crc(id),
        _ => Common::extra_crc(id),
    })
}

enum Shape {
    No,
    Known { end: usize, intact: bool },
    Unknown { end: usize },
}

fn shape(stream: &[u8], at: usize) -> Shape {
    let rest = &stream[at..];
    let (header, signature) = match rest {
        [0xFD, _, 0, ..] => (10, 0),
        [0xFD, _, 1, ..] => (10, 13),
        [0xFE, ..] => (6, 0),
        _ => return Shape::No,
    };
    if rest.len() < header {
        return Shape::No;
    }
    let id = match header {
        10 => u32::from_le_bytes([rest[7], rest[8], rest[9], 0]),
        _ => u32::from(rest[5]),
    };
    let checked = header + usize::from(rest[1]);
    let end = at + checked + 2 + signature;
    match seed(id) {
        Some(_) if end > stream.len() => Shape::No,
        Some(seed) => {
            let sum = u16::from_le_bytes([rest[checked], rest[checked + 1]]);
            Shape::Known {
                end,
                intact: crc(&rest[..checked], seed) == sum,
            }
        }
        None if header == 10 && rest[3] == 0 && rest[9] == 0 => Shape::Unknown { end },
        None => Shape::No,
    }
}

/// Whether an unknown frame that ends here is believed.
fn believed(stream: &[u8], end: usize) -> bool {
    if end >= stream.len() {
        return end == stream.len();
    }
    match shape(stream, end) {
        Shape::No => false,
        Shape::Known { intact, .. } => intact,
        Shape::Unknown { end: second } => {
            second == stream.len()
                || second < stream.len()
                    && match &stream[second..] {
                        [0xFD, rest @ ..] => plausible(rest),
                        [0xFE, rest @ ..] => rest.len() < 5 || seed(rest[4].into()).is_some(),
                        _ => false,
                    }
        }
    }
}

/// Whether a header, as far as it has come, may be one.
fn plausible(header: &[u8]) -> bool {
    if header.get(1).is_some_and(|flags| *flags > 1) {
        return false;
    }
    let [_, _, compat, _, _, _, a, b, c, ..] = header else {
        return true;
    };
    seed(u32::from_le_bytes([*a, *b, *c, 0])).is_some() || (*compat, *c) == (0, 0)
}

/// A part of a stream.
pub(crate) type Span = core::ops::Range<usize>;

/// Every frame, and every unknown frame that is passed over.
pub(crate) fn frames(stream: &[u8]) -> (Vec<Span>, Vec<Span>) {
    let (mut found, mut unknown) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < stream.len() {
        at = match shape(stream, at) {
            Shape::Known { end, intact: true } => {
                found.push(at..end);
                end
            }
            Shape::Unknown { end } if believed(stream, end) => {
                unknown.push(at..end);
                end
            }
            _ => at + 1,
        };
    }
    (found, unknown)
}
