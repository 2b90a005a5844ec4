//! The MAVLink 2 link to ground stations: frames, signatures and messages.
//!
//! The build generates the messages from our dialect `dialect/mpp.xml`, which includes the used part of
//! the common dialect. This module reads no socket and does not know the meaning of a message. The user
//! of the module owns a [`Framer`] for received bytes and a [`Sender`] for messages to send.
//!
//! ```
//! use hil_protocol::mavlink::{Framer, Sender, messages::HEARTBEAT_DATA};
//!
//! let mut sender = Sender::new(1, 1);
//! let datagram = sender.frame(&HEARTBEAT_DATA { custom_mode: 10, ..HEARTBEAT_DATA::DEFAULT });
//!
//! let mut mode = None;
//! Framer::new().receive(datagram.as_bytes(), |frame| {
//!     mode = frame.decode::<HEARTBEAT_DATA>().map(|heartbeat| heartbeat.custom_mode);
//! });
//! assert_eq!(mode, Some(10));
//! ```
//!
//! The generated code checks the size of its buffers. The buffers hold the longest payload, so these
//! checks never fail, but they stay in an image that uses the code.

mod frame;
mod framer;
mod sender;
mod signing;

pub use frame::{Frame, MAX_FRAME};
pub use framer::{Counters, Framer};
pub use mavlink_core::MessageData;
pub use mavlink_core::types::CharArray;
pub use sender::{Datagram, Sender};
pub use signing::{Key, Refusal, Signer, Verifier};

/// The messages: one struct for each message, with the name from the dialect.
pub use generated::mpp as messages;

#[allow(missing_docs, clippy::all, clippy::pedantic, clippy::panic)]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/mod.rs"));
}

/// A text as a field of `N` bytes, cut before the first character that does not fit.
#[must_use]
pub fn text<const N: usize>(text: &str) -> CharArray<N> {
    text.get(..text.floor_char_boundary(N))
        .unwrap_or_default()
        .into()
}
