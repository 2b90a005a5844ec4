//! The MAVLink 2 link to ground stations: frames, signatures and messages.
//!
//! This module reads no socket and does not know the meaning of a message. The user of the module owns a
//! [`Framer`] for received bytes and a [`Sender`] for messages to send.
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

mod data;
mod frame;
mod framer;
#[allow(missing_docs, non_camel_case_types)]
pub mod messages;
mod sender;
mod signing;

pub use data::{CharArray, MessageData, text};
pub use frame::{Frame, MAX_FRAME};
pub use framer::{Counters, Framer};
pub use sender::{Datagram, Sender};
pub use signing::{Key, Refusal, Signer, Verifier};
