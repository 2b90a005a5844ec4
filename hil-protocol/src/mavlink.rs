//! The MAVLink 2 link to ground stations: frames, signatures and messages.
//!
//! The messages are generated at build time from `dialect/mpp.xml`, which is ours and includes the
//! part of the common dialect that is used. Nobody here reads a socket or knows what a message
//! means; whoever does owns a [`Framer`] for what comes in and a [`Sender`] for what goes out.
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
//! The generated code checks the size of its buffers, which hold the longest payload there is:
//! these checks stay in an image that uses it, but never fail.

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

/// The messages, one struct each, named as the dialect names them.
pub use generated::mpp as messages;

#[allow(missing_docs, clippy::all, clippy::pedantic, clippy::panic)]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/mod.rs"));
}

/// A text as a field of `N` characters, cut before a character that does not fit.
#[must_use]
pub fn text<const N: usize>(text: &str) -> CharArray<N> {
    text.get(..text.floor_char_boundary(N))
        .unwrap_or_default()
        .into()
}
