//! What can go wrong with a frame.

use crate::frame::PROTOCOL_VERSION;
use core::fmt;
use serde::{Deserialize, Serialize};

/// Why a message could not be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EncodeError {
    /// The message is longer than a frame can hold. The sizes are tied at compile time, so this
    /// is a fault of this crate; nothing was sent.
    TooLong {
        /// Which message, one of [`id`](crate::id).
        id: u8,
    },
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong { id } => write!(f, "message {id} does not fit into a frame"),
        }
    }
}

impl core::error::Error for EncodeError {}

/// Why the bytes between two delimiters are not a message, in the order of the checks.
///
/// Whatever it was, the frame is dropped, nothing of it is used, and the decoder is in step again
/// at the next frame. The core also reports it with
/// [`RejectionCause::Frame`](crate::RejectionCause::Frame); the order of the variants is therefore
/// what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum DecodeError {
    /// More than [`MAX_FRAME`](crate::MAX_FRAME) bytes without a delimiter: lost delimiters,
    /// noise, or a peer with longer messages. Reported once, at the end delimiter; go on.
    TooLong,
    /// Not a COBS sequence: cut short or damaged. Go on.
    Cobs,
    /// Too short for header and CRC: a piece of a frame, as at the opening of a line. Go on.
    TooShort,
    /// Does not begin with [`MAGIC`](crate::MAGIC): something else speaks on this line. Go on; if
    /// every frame is like that, the line is the wrong one.
    Magic,
    /// The checksum differs: damaged on the way. Go on; the link repeats nothing by itself, so a
    /// side that waits for an answer needs its own time limit.
    Crc,
    /// An intact frame of another link version. Stop the session and show this error: no message
    /// of this peer can be understood.
    Version {
        /// The version that the peer speaks.
        peer: u8,
    },
    /// An intact frame with an id that this version does not have: a fault in the peer. Go on
    /// without it.
    UnknownId {
        /// The id.
        id: u8,
    },
    /// An intact frame whose payload is not that message: a fault in the peer, for the same
    /// version has the same payloads. Go on without it.
    Payload {
        /// Which message it claims to be.
        id: u8,
    },
    /// An intact frame with bytes left after the message: a fault in the peer, as above.
    TrailingBytes {
        /// Which message it claims to be.
        id: u8,
    },
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong => write!(f, "frame is longer than any message"),
            Self::Cobs => write!(f, "frame is not a COBS sequence"),
            Self::TooShort => write!(f, "frame is too short for header and checksum"),
            Self::Magic => write!(f, "frame does not begin with the magic \"MP\""),
            Self::Crc => write!(f, "frame is damaged: its checksum differs"),
            Self::Version { peer } => write!(
                f,
                "peer speaks link protocol {peer}, this side speaks {PROTOCOL_VERSION}: \
                 update the older side"
            ),
            Self::UnknownId { id } => {
                write!(f, "link protocol {PROTOCOL_VERSION} has no message {id}")
            }
            Self::Payload { id } => write!(f, "payload is not that of message {id}"),
            Self::TrailingBytes { id } => write!(f, "message {id} is followed by more bytes"),
        }
    }
}

impl core::error::Error for DecodeError {}
