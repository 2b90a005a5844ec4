//! One frame: where its parts are, and whether it is intact.

use super::messages::MavMessage;
use mavlink_core::{MavlinkVersion, Message, MessageData, calculate_crc};

/// The longest frame there is: MAVLink 2, full payload, signed \[bytes\].
pub const MAX_FRAME: usize = V2_HEADER + 255 + CHECKSUM + SIGNATURE;

/// First byte of a MAVLink 1 frame.
const STX_V1: u8 = 0xFE;
/// First byte of a MAVLink 2 frame.
pub(super) const STX_V2: u8 = 0xFD;
/// The only incompatibility flag that is understood: a signature follows.
pub(super) const SIGNED: u8 = 1;

/// STX, length, sequence, system, component, id.
const V1_HEADER: usize = 6;
/// STX, length, two flags, sequence, system, component, id in three bytes.
pub(super) const V2_HEADER: usize = 10;
pub(super) const CHECKSUM: usize = 2;
/// Link id, time in six bytes, and the truncated hash.
pub(super) const SIGNATURE: usize = 13;

/// An intact frame, MAVLink 1 or 2, of a message that the dialect has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Sender's system.
    pub system: u8,
    /// Sender's component.
    pub component: u8,
    /// Number of the frame in the sender's stream.
    pub sequence: u8,
    /// Which message.
    pub id: u32,
    /// The message, perhaps without the zeros at its end.
    pub payload: &'a [u8],
    /// The whole frame.
    pub bytes: &'a [u8],
    version: MavlinkVersion,
}

impl Frame<'_> {
    /// The message, if it is of this kind.
    #[must_use]
    pub fn decode<M: MessageData>(&self) -> Option<M> {
        if self.id != M::ID {
            return None;
        }
        M::deser(self.version, self.payload).ok()
    }

    /// Whether a signature ends the frame; nobody has looked at it.
    #[must_use]
    pub fn is_signed(&self) -> bool {
        self.version == MavlinkVersion::V2 && self.bytes.get(2) == Some(&SIGNED)
    }
}

/// What the bytes from some position on are.
pub(super) enum Claim<'a> {
    /// Not a frame.
    No,
    /// Perhaps a frame: the rest has not come yet.
    Incomplete,
    /// By its header a frame of this many bytes, but its checksum is wrong.
    Damaged(usize),
    /// A frame of this many bytes, of a message that the dialect does not have: its checksum is
    /// right for some message, which it is by chance once in 256 times.
    Unknown(usize),
    /// A frame.
    Intact(Frame<'a>),
}

/// Judges the frame that would begin with the first of these bytes.
pub(super) fn claim(bytes: &[u8]) -> Claim<'_> {
    match bytes {
        [STX_V2, _, flags, ..] if *flags & !SIGNED != 0 => Claim::No,
        [
            STX_V2,
            length,
            flags,
            _,
            sequence,
            system,
            component,
            a,
            b,
            c,
            ..,
        ] => {
            let tail = if *flags & SIGNED == 0 { 0 } else { SIGNATURE };
            let header = Header {
                version: MavlinkVersion::V2,
                length: V2_HEADER,
                sequence: *sequence,
                system: *system,
                component: *component,
                id: u32::from_le_bytes([*a, *b, *c, 0]),
            };
            judge(bytes, &header, usize::from(*length), tail)
        }
        [STX_V1, length, sequence, system, component, id, ..] => {
            let header = Header {
                version: MavlinkVersion::V1,
                length: V1_HEADER,
                sequence: *sequence,
                system: *system,
                component: *component,
                id: u32::from(*id),
            };
            judge(bytes, &header, usize::from(*length), 0)
        }
        [STX_V1 | STX_V2, ..] => Claim::Incomplete,
        _ => Claim::No,
    }
}

struct Header {
    version: MavlinkVersion,
    length: usize,
    sequence: u8,
    system: u8,
    component: u8,
    id: u32,
}

fn judge<'a>(bytes: &'a [u8], header: &Header, payload: usize, tail: usize) -> Claim<'a> {
    let end = header.length + payload;
    let total = end + CHECKSUM + tail;
    let (Some(frame), Some(checked), Some(body), Some([low, high])) = (
        bytes.get(..total),
        bytes.get(1..end),
        bytes.get(header.length..end),
        bytes.get(end..end + CHECKSUM),
    ) else {
        return Claim::Incomplete;
    };
    let sum = u16::from_le_bytes([*low, *high]);
    match extra_crc(header.id) {
        Some(extra) if calculate_crc(checked, extra) == sum => {}
        None if is_some_messages(checked, sum) => return Claim::Unknown(total),
        _ => return Claim::Damaged(total),
    }
    Claim::Intact(Frame {
        system: header.system,
        component: header.component,
        sequence: header.sequence,
        id: header.id,
        payload: body,
        bytes: frame,
        version: header.version,
    })
}

/// Whether there is a message whose checksum over these bytes this is.
///
/// A checksum ends with one byte that only who knows the message has. Its effect is what the CRC's
/// table holds for it, and of that the high byte is another for each of the 256.
fn is_some_messages(checked: &[u8], sum: u16) -> bool {
    let effect = calculate_crc(checked, 0) ^ sum;
    let high = effect >> 8;
    let mixed = high ^ high >> 5;
    effect == mixed << 8 ^ mixed << 3 ^ mixed >> 4
}

/// What a message's checksum is seeded with; none if the dialect does not have the message.
fn extra_crc(id: u32) -> Option<u8> {
    MavMessage::all_ids()
        .contains(&id)
        .then(|| MavMessage::extra_crc(id))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beside all 256 messages that there could be.
    #[test]
    fn a_checksum_is_some_messages_or_nobodys() {
        let mut bytes = [0; 40];
        for (length, factor) in (0..40).zip(0_u8..) {
            bytes[length] = factor.wrapping_mul(factor ^ 0x5A);
            let checked = &bytes[..length];
            for extra in 0..=u8::MAX {
                assert!(is_some_messages(checked, calculate_crc(checked, extra)));
            }
            let right = (0..=u16::MAX).filter(|sum| is_some_messages(checked, *sum));
            assert_eq!(right.count(), 256);
        }
    }
}
