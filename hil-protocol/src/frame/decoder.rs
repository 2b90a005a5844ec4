//! Messages in a stream of bytes.

use super::sum::{self, CHECKSUM};
use super::{DELIMITER, HEADER, LONGEST_PIECE, MAGIC, MAX_FRAME};
use crate::error::DecodeError;
use crate::message::{Body, Message, read};
use crate::version::PROTOCOL_VERSION;

/// Finds the messages in a stream of bytes.
///
/// It can start anywhere in the stream: after any noise it is in step again at the next delimiter. It undoes the
/// stuffing and sums up as the bytes come, so that little is left to do when the delimiter does.
#[derive(Clone, Debug)]
pub struct Decoder {
    /// The plain bytes of the frame. They stay until the next frame begins.
    plain: [u8; MAX_FRAME],
    /// Number of bytes in `plain`.
    length: usize,
    /// Number of bytes on the wire since the last delimiter.
    arrived: usize,
    /// The code of the present piece, and the bytes that it still lacks.
    code: u8,
    lacks: u8,
    sum: u32,
}

impl Decoder {
    /// A decoder at the beginning of a stream.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            plain: [0; MAX_FRAME],
            length: 0,
            arrived: 0,
            code: 0,
            lacks: 0,
            sum: sum::START,
        }
    }

    /// Takes in the next byte of the stream.
    ///
    /// Returns a result only at a delimiter: the message before the delimiter, or the reason why the bytes
    /// before it are not a message. A delimiter that directly follows another one gives no result.
    ///
    /// # Errors
    ///
    /// One [`DecodeError`] for each damaged, foreign or overlong frame.
    pub fn push(&mut self, byte: u8) -> Option<Result<Message, DecodeError>> {
        let id = self.take(byte)?;
        Some(id.and_then(|id| Message::read(id, self.payload())))
    }

    /// Does the work of [`Decoder::push`], but gives only the number of the message, which may be unknown. The
    /// receiver gets the message by [`Decoder::body`], before it takes the next byte.
    ///
    /// # Errors
    ///
    /// As of [`Decoder::push`], without faults of the payload.
    pub fn take(&mut self, byte: u8) -> Option<Result<u8, DecodeError>> {
        if byte != DELIMITER {
            self.unstuff(byte);
            return None;
        }
        match core::mem::take(&mut self.arrived) {
            0 => None,
            MAX_FRAME.. => Some(Err(DecodeError::TooLong)),
            _ if self.lacks > 0 => Some(Err(DecodeError::Cobs)),
            _ => Some(self.check()),
        }
    }

    /// Reads the message that [`Decoder::take`] found.
    ///
    /// # Errors
    ///
    /// [`DecodeError::Payload`] or [`DecodeError::TrailingBytes`] if the payload is no `T`.
    pub fn body<T: Body>(&self) -> Result<T, DecodeError> {
        read(self.payload())
    }

    fn payload(&self) -> &[u8] {
        let end = self.length.saturating_sub(CHECKSUM);
        self.plain.get(HEADER..end).unwrap_or_default()
    }

    /// Takes in a byte inside a frame.
    fn unstuff(&mut self, byte: u8) {
        if self.arrived == 0 {
            (self.length, self.code, self.lacks) = (0, u8::MAX, 0);
            self.sum = sum::START;
        }
        if self.arrived >= MAX_FRAME {
            return;
        }
        self.arrived += 1;
        if self.lacks > 0 {
            self.lacks -= 1;
            return self.append(byte);
        }
        // The byte is a code. Behind a piece stands the zero at which it was cut, unless it was cut for its
        // length; before the first piece stands none.
        if usize::from(self.code) <= LONGEST_PIECE {
            self.append(0);
        }
        self.code = byte;
        self.lacks = byte.saturating_sub(1);
    }

    fn append(&mut self, byte: u8) {
        self.sum = sum::next(self.sum, byte);
        if let Some(place) = self.plain.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
    }

    /// Checks the frame. Gives the number of its message.
    fn check(&self) -> Result<u8, DecodeError> {
        let [m, p, version, id, ..] = self.plain;
        if self.length < HEADER + CHECKSUM {
            return Err(DecodeError::TooShort);
        }
        if [m, p] != MAGIC {
            return Err(DecodeError::Magic);
        }
        // This check comes before that of the version, so that noise does not look like an old peer. Header
        // and CRC are the same in every version.
        if self.sum != sum::RESIDUE {
            return Err(DecodeError::Crc);
        }
        if version != PROTOCOL_VERSION {
            return Err(DecodeError::Version { peer: version });
        }
        Ok(id)
    }
}
