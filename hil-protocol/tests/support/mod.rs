//! Code that the tests share: an oracle for frames, and any message.

pub(crate) mod any;
pub(crate) mod oracle;

use hil_protocol::{DecodeError, Decoder, MAX_FRAME, Message, encode};

/// The frame of a message.
pub(crate) fn frame(message: &Message) -> Vec<u8> {
    encode(message, &mut [0; MAX_FRAME]).unwrap().to_vec()
}

/// All that a decoder finds in these bytes.
pub(crate) fn found(bytes: &[u8]) -> Vec<Result<Message, DecodeError>> {
    let mut decoder = Decoder::new();
    bytes
        .iter()
        .filter_map(|&byte| decoder.push(byte))
        .collect()
}
