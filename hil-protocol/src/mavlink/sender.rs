//! Conversion of messages to frames.

use super::data::{MessageData, checksum};
use super::frame::{CHECKSUM, MAX_FRAME, SIGNED, STX_V2, V2_HEADER};
use super::signing::Signer;

/// One complete MAVLink 2 frame, ready to be sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Datagram {
    bytes: [u8; MAX_FRAME],
    length: usize,
}

impl Datagram {
    /// The bytes of the frame.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }

    fn push(&mut self, part: &[u8]) {
        let end = self.length + part.len();
        if let Some(place) = self.bytes.get_mut(self.length..end) {
            place.copy_from_slice(part);
            self.length = end;
        }
    }
}

/// The sender's side of a stream. It numbers the frames, so that a receiver can count lost frames.
#[derive(Clone, Debug)]
pub struct Sender {
    system: u8,
    component: u8,
    sequence: u8,
}

impl Sender {
    /// The sender of a component. Its next frame has the number 0.
    #[must_use]
    pub const fn new(system: u8, component: u8) -> Self {
        Self {
            system,
            component,
            sequence: 0,
        }
    }

    /// The message as the next frame.
    pub fn frame<M: MessageData>(&mut self, message: &M) -> Datagram {
        self.build(message, 0)
    }

    /// The message as the next frame, with a signature.
    pub fn signed_frame<M: MessageData>(&mut self, message: &M, signer: &mut Signer) -> Datagram {
        let mut datagram = self.build(message, SIGNED);
        let signature = signer.sign(datagram.as_bytes());
        datagram.push(&signature);
        datagram
    }

    fn build<M: MessageData>(&mut self, message: &M, flags: u8) -> Datagram {
        let mut payload = [0; 255];
        let length = message.ser(&mut payload);
        let payload = payload.get(..length).unwrap_or_default();
        let [a, b, c, _] = M::ID.to_le_bytes();
        let header: [u8; V2_HEADER] = [
            STX_V2,
            length as u8,
            flags,
            0,
            self.sequence,
            self.system,
            self.component,
            a,
            b,
            c,
        ];
        self.sequence = self.sequence.wrapping_add(1);
        let mut datagram = Datagram {
            bytes: [0; MAX_FRAME],
            length: 0,
        };
        datagram.push(&header);
        datagram.push(payload);
        let checked = datagram.as_bytes().get(1..).unwrap_or_default();
        let sum: [u8; CHECKSUM] = checksum(checked, M::EXTRA_CRC).to_le_bytes();
        datagram.push(&sum);
        datagram
    }
}
