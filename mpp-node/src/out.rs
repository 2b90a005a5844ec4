//! The way of the core's messages out: as frames for a wire, or as they are for a caller in the same process.

use hil_protocol::{Body, MAX_FRAME, Message, encode_body};

/// Takes each message that the core sends.
pub(crate) trait Out {
    /// Takes one message. A frame is made in the buffer.
    fn put<T: Body>(&mut self, message: &T, buffer: &mut [u8; MAX_FRAME]);
}

/// Gives each message as a frame.
pub(crate) struct Frames<F>(pub(crate) F);

/// Gives each message as it is.
pub(crate) struct Messages<F>(pub(crate) F);

impl<F: FnMut(&[u8])> Out for Frames<F> {
    fn put<T: Body>(&mut self, message: &T, buffer: &mut [u8; MAX_FRAME]) {
        // The buffer holds the longest message, so this cannot fail.
        if let Ok(frame) = encode_body(message, buffer) {
            (self.0)(frame);
        }
    }
}

impl<F: FnMut(Message)> Out for Messages<F> {
    fn put<T: Body>(&mut self, message: &T, _: &mut [u8; MAX_FRAME]) {
        (self.0)(message.clone().into_message());
    }
}
