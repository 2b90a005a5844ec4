//! Conversion of messages to bytes and back.

mod decoder;
mod stuffing;
mod sum;

use crate::error::EncodeError;
use crate::message::{Body, MAX_PAYLOAD, Message};
use crate::version::PROTOCOL_VERSION;
pub use decoder::Decoder;
use stuffing::{LONGEST_PIECE, codes, stuff};
use sum::CHECKSUM;

/// The first two bytes of a frame before COBS: "MP".
pub const MAGIC: [u8; 2] = *b"MP";

const HEADER: usize = 4;
const DELIMITER: u8 = 0;

/// Size of the longest frame on the wire, its delimiter included \[bytes\].
pub const MAX_FRAME: usize = {
    let plain = HEADER + MAX_PAYLOAD + CHECKSUM;
    codes(plain) + plain + 1
};
/// Number of codes in that frame.
const MAX_CODES: usize = codes(HEADER + MAX_PAYLOAD + CHECKSUM);

/// Writes `message` into `buffer` as one frame and returns its bytes, the delimiter included.
///
/// # Errors
///
/// [`EncodeError::TooLong`] if the message does not fit. Const assertions make this impossible.
pub fn encode<'a>(
    message: &Message,
    buffer: &'a mut [u8; MAX_FRAME],
) -> Result<&'a [u8], EncodeError> {
    encode_with(message.id(), buffer, |room| message.to_payload(room))
}

/// Does the work of [`encode`] for a message whose kind is known.
///
/// # Errors
///
/// As of [`encode`].
pub fn encode_body<'a, T: Body>(
    body: &T,
    buffer: &'a mut [u8; MAX_FRAME],
) -> Result<&'a [u8], EncodeError> {
    encode_with(T::ID, buffer, |room| postcard::to_slice(body, room))
}

fn encode_with(
    id: u8,
    buffer: &mut [u8; MAX_FRAME],
    write: impl FnOnce(&mut [u8]) -> postcard::Result<&mut [u8]>,
) -> Result<&[u8], EncodeError> {
    let too_long = EncodeError::TooLong { id };
    let room = buffer.get_mut(MAX_CODES + HEADER..).ok_or(too_long)?;
    let payload = write(room).map_err(|_| too_long)?.len();
    seal(id, payload, buffer).ok_or(too_long)
}

/// Makes a frame of the payload in the buffer, behind the room for header and codes.
fn seal(id: u8, payload: usize, buffer: &mut [u8; MAX_FRAME]) -> Option<&[u8]> {
    let [m, p] = MAGIC;
    let header = [m, p, PROTOCOL_VERSION, id];
    *buffer.get_mut(MAX_CODES..)?.first_chunk_mut()? = header;

    let plain = HEADER + payload + CHECKSUM;
    let start = MAX_CODES.checked_sub(codes(plain))?;
    let frame = buffer.get_mut(start..)?;
    let end = stuff(frame.get_mut(..codes(plain) + plain)?, codes(plain))?;
    *frame.get_mut(end)? = DELIMITER;
    frame.get(..=end)
}
