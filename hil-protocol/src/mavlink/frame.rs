//! One frame: the places of its parts, and the check whether it is intact.

use super::data::{MessageData, checksum};
use super::messages::MavMessage;

/// Size of the longest frame: MAVLink 2 with full payload and signature \[bytes\].
pub const MAX_FRAME: usize = V2_HEADER + 255 + CHECKSUM + SIGNATURE;

/// First byte of a MAVLink 1 frame.
const STX_V1: u8 = 0xFE;
/// First byte of a MAVLink 2 frame.
pub(super) const STX_V2: u8 = 0xFD;
/// The only incompatibility flag that this module understands: a signature follows.
pub(super) const SIGNED: u8 = 1;

/// Size of the header: STX, length, sequence, system, component, id.
const V1_HEADER: usize = 6;
/// Size of the header: STX, length, two flags, sequence, system, component, id in three bytes.
pub(super) const V2_HEADER: usize = 10;
pub(super) const CHECKSUM: usize = 2;
/// Size of the signature: link id, time in six bytes, and the truncated hash.
pub(super) const SIGNATURE: usize = 13;

/// An intact frame, MAVLink 1 or 2, of a message that the dialect has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// System of the sender.
    pub system: u8,
    /// Component of the sender.
    pub component: u8,
    /// Number of the frame in the sender's stream.
    pub sequence: u8,
    /// Id of the message.
    pub id: u32,
    /// Bytes of the message, perhaps without the zeros at its end.
    pub payload: &'a [u8],
    /// Bytes of the whole frame.
    pub bytes: &'a [u8],
}

impl Frame<'_> {
    /// The message, if the frame contains one of type `M`.
    #[must_use]
    pub fn decode<M: MessageData>(&self) -> Option<M> {
        (self.id == M::ID).then(|| M::deser(self.payload))
    }

    /// Whether a signature ends the frame. The function does not check the signature.
    #[must_use]
    pub fn is_signed(&self) -> bool {
        matches!(self.bytes, [STX_V2, _, SIGNED, ..])
    }
}

/// Classification of the bytes from some position on.
pub(super) enum Claim<'a> {
    /// The bytes are not a frame.
    No,
    /// The bytes may be the beginning of a frame whose rest has not come yet.
    Incomplete,
    /// By the header this is a frame of this many bytes, but its checksum is wrong.
    Damaged(usize),
    /// A frame of this many bytes with a message that the dialect does not have. Its checksum is right for
    /// some message. A random checksum is right for some message once in 256 times.
    Unknown(usize),
    /// An intact frame of a message that the dialect has.
    Intact(Frame<'a>),
}

/// Classifies the frame that would begin with the first of these bytes.
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
    match MavMessage::extra_crc(header.id) {
        Some(extra) if checksum(checked, extra) == sum => {}
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
    })
}

/// Whether `sum` is the checksum of these bytes for some message.
///
/// A checksum also covers one additional byte, which depends on the message and is not in the frame. Its
/// effect on the checksum is an entry of the CRC's table. The high byte of this entry differs for each of
/// the 256 values, so the function computes the entry from the high byte and compares.
fn is_some_messages(checked: &[u8], sum: u16) -> bool {
    let effect = checksum(checked, 0) ^ sum;
    let high = effect >> 8;
    let mixed = high ^ high >> 5;
    effect == mixed << 8 ^ mixed << 3 ^ mixed >> 4
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
                assert!(is_some_messages(checked, checksum(checked, extra)));
            }
            let right = (0..=u16::MAX).filter(|sum| is_some_messages(checked, *sum));
            assert_eq!(right.count(), 256);
        }
    }
}
