//! Conversion of messages to bytes and back.

use crate::error::{DecodeError, EncodeError};
use crate::message::{MAX_PAYLOAD, Message};
use crate::version::PROTOCOL_VERSION;
use cobs::CobsEncoder;
use crc::{CRC_32_ISO_HDLC, Crc};

/// The first two bytes of a frame before COBS: "MP".
pub const MAGIC: [u8; 2] = *b"MP";

const HEADER: usize = 4;
const CHECKSUM: usize = 4;
const DELIMITER: u8 = 0;

/// Size of the longest frame on the wire, its delimiter included \[bytes\].
pub const MAX_FRAME: usize = cobs::max_encoding_length(HEADER + MAX_PAYLOAD + CHECKSUM) + 1;

/// CRC with a table of 256 words, which takes 1 kB of flash.
static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Writes `message` into `buffer` as one frame and returns its bytes, the delimiter included.
///
/// # Errors
///
/// [`EncodeError::TooLong`] if the message does not fit. Const assertions make this impossible.
pub fn encode<'a>(
    message: &Message,
    buffer: &'a mut [u8; MAX_FRAME],
) -> Result<&'a [u8], EncodeError> {
    let too_long = EncodeError::TooLong { id: message.id() };
    let mut scratch = [0; MAX_PAYLOAD];
    let payload = message.write(&mut scratch)?;
    let [m, p] = MAGIC;
    let header: [u8; HEADER] = [m, p, PROTOCOL_VERSION, message.id()];
    let mut checksum = CRC.digest();
    checksum.update(&header);
    checksum.update(payload);
    let checksum: [u8; CHECKSUM] = checksum.finalize().to_le_bytes();

    let mut encoder = CobsEncoder::new(buffer);
    for part in [&header, payload, &checksum] {
        encoder.push(part).map_err(|_| too_long)?;
    }
    let end = encoder.finalize();
    *buffer.get_mut(end).ok_or(too_long)? = DELIMITER;
    buffer.get(..=end).ok_or(too_long)
}

/// Finds the messages in a stream of bytes.
///
/// It can start anywhere in the stream: after any noise it is in step again at the next delimiter.
#[derive(Clone, Debug)]
pub struct Decoder {
    /// The bytes since the last delimiter.
    frame: [u8; MAX_FRAME - 1],
    /// Number of bytes in `frame`.
    length: usize,
    /// Whether more bytes came than `frame` can hold.
    overlong: bool,
}

impl Decoder {
    /// A decoder at the beginning of a stream.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            frame: [0; MAX_FRAME - 1],
            length: 0,
            overlong: false,
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
        if byte != DELIMITER {
            self.append(byte);
            return None;
        }
        let length = core::mem::take(&mut self.length);
        if core::mem::take(&mut self.overlong) {
            return Some(Err(DecodeError::TooLong));
        }
        match self.frame.get(..length) {
            None | Some([]) => None,
            Some(frame) => Some(decode(frame)),
        }
    }

    fn append(&mut self, byte: u8) {
        match self.frame.get_mut(self.length) {
            Some(next) => {
                *next = byte;
                self.length += 1;
            }
            None => self.overlong = true,
        }
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

/// The message in a frame without its delimiter.
fn decode(frame: &[u8]) -> Result<Message, DecodeError> {
    // The function does not decode in place. There the compiler cannot prove that cobs never indexes
    // past the end.
    let mut scratch = [0; MAX_FRAME];
    let decoded = cobs::decode(frame, &mut scratch).map_err(|_| DecodeError::Cobs)?;
    let plain = scratch
        .get(..decoded.frame_size())
        .ok_or(DecodeError::Cobs)?;

    let (checked, checksum) = plain
        .split_last_chunk::<CHECKSUM>()
        .ok_or(DecodeError::TooShort)?;
    let (&[m, p, version, id], payload) = checked
        .split_first_chunk::<HEADER>()
        .ok_or(DecodeError::TooShort)?;
    if [m, p] != MAGIC {
        return Err(DecodeError::Magic);
    }
    // This check comes before that of the version, so that noise does not look like an old peer. Header
    // and CRC are the same in every version.
    if CRC.checksum(checked) != u32::from_le_bytes(*checksum) {
        return Err(DecodeError::Crc);
    }
    if version != PROTOCOL_VERSION {
        return Err(DecodeError::Version { peer: version });
    }
    Message::read(id, payload)
}
