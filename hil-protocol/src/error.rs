//! The errors of encoding and decoding a frame.

use crate::version::PROTOCOL_VERSION;
use core::fmt;
use serde::{Deserialize, Serialize};

/// The reason why a message could not be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// The message is longer than a frame can hold. The sizes are checked at compile time, so this is a
    /// fault of this crate. Nothing was sent.
    TooLong {
        /// The message, one of [`id`](crate::id).
        id: u8,
    },
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong { id } => write!(
                f,
                "message {id} does not fit into a frame: report it as a fault of hil-protocol"
            ),
        }
    }
}

impl core::error::Error for EncodeError {}

/// The reason why the bytes between two delimiters are not a message, in the order of the checks.
///
/// In each case the decoder drops the whole frame, and is in step again at the next frame. The core also
/// reports the error with [`RejectionCause::Frame`](crate::RejectionCause::Frame). The position of a
/// variant therefore goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum DecodeError {
    /// The frame with its delimiter is longer than [`MAX_FRAME`](crate::MAX_FRAME) bytes. The cause is a lost
    /// delimiter, noise, or a peer with longer messages. The decoder reports it once, at the delimiter at
    /// the end. The receiver goes on.
    TooLong,
    /// The bytes are not a COBS sequence, because they were cut or damaged. The receiver goes on.
    Cobs,
    /// The frame is too short for header and CRC. It is a part of a frame, for example after the opening of
    /// a line. The receiver goes on.
    TooShort,
    /// The frame does not begin with [`MAGIC`](crate::MAGIC): another protocol uses this line. The receiver
    /// goes on. If every frame gives this error, it is the wrong line.
    Magic,
    /// The checksum differs, because the frame was damaged on its way. The receiver goes on. The link does
    /// not repeat frames by itself, so a side that waits for an answer needs its own time limit.
    Crc,
    /// The frame is intact, but has another link version. The receiver must stop the session and show this
    /// error, because it can understand no message of this peer.
    Version {
        /// The version that the peer speaks.
        peer: u8,
    },
    /// The frame is intact, but this version does not have its id. This is a fault in the peer. The
    /// receiver goes on without the frame.
    UnknownId {
        /// The unknown id.
        id: u8,
    },
    /// The frame is intact, but its payload does not belong to its id. This is a fault in the peer, because
    /// the same version has the same payloads. The receiver goes on without the frame.
    Payload {
        /// The message that the id stands for.
        id: u8,
    },
    /// The frame is intact, but bytes follow the message in its payload. This is a fault in the peer. The
    /// receiver goes on without the frame.
    TrailingBytes {
        /// The message that the id stands for.
        id: u8,
    },
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooLong => "the frame is longer than any message: check that the peer is this core",
            Self::Cobs => "the frame is not a COBS sequence: check the line, for it is damaged",
            Self::TooShort => {
                "the frame is too short for header and checksum: check the line, unless it has just \
                 been opened"
            }
            Self::Magic => {
                "the frame does not begin with \"MP\": check that the line leads to a core"
            }
            Self::Crc => "the frame is damaged, for its checksum differs: check the line",
            Self::Version { peer } => {
                return write!(
                    f,
                    "peer speaks link protocol {peer}, this side speaks {PROTOCOL_VERSION}: \
                     update the older side"
                );
            }
            Self::UnknownId { id } => {
                return write!(
                    f,
                    "link protocol {PROTOCOL_VERSION} has no message {id}: correct the peer"
                );
            }
            Self::Payload { id } => {
                return write!(f, "the payload is not that of message {id}: correct the peer");
            }
            Self::TrailingBytes { id } => {
                return write!(f, "bytes follow message {id} in its frame: correct the peer");
            }
        })
    }
}

impl core::error::Error for DecodeError {}
