//! The errors of encoding and decoding a frame.

use crate::version::PROTOCOL_VERSION;
use serde::{Deserialize, Serialize};

/// The reason why a message could not be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EncodeError {
    /// The message is longer than a frame can hold. The sizes are checked at compile time, so this is a
    /// fault of this crate. Nothing was sent.
    #[error("message {id} does not fit into a frame: report it as a fault of hil-protocol")]
    TooLong {
        /// The message, one of [`id`](crate::id).
        id: u8,
    },
}

/// The reason why the bytes between two delimiters are not a message, in the order of the checks.
///
/// In each case the decoder drops the whole frame, and is in step again at the next frame. The core also
/// reports the error with [`RejectionCause::Frame`](crate::RejectionCause::Frame). The position of a
/// variant therefore goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum DecodeError {
    /// The frame with its delimiter is longer than [`MAX_FRAME`](crate::MAX_FRAME) bytes. The cause is a lost
    /// delimiter, noise, or a peer with longer messages. The decoder reports it once, at the delimiter at
    /// the end. The receiver goes on.
    #[error("the frame is longer than any message: check that the peer is this core")]
    TooLong,
    /// The bytes are not a COBS sequence, because they were cut or damaged. The receiver goes on.
    #[error("the frame is not a COBS sequence: check the line, for it is damaged")]
    Cobs,
    /// The frame is too short for header and CRC. It is a part of a frame, for example after the opening of
    /// a line. The receiver goes on.
    #[error(
        "the frame is too short for header and checksum: check the line, unless it has just been opened"
    )]
    TooShort,
    /// The frame does not begin with [`MAGIC`](crate::MAGIC): another protocol uses this line. The receiver
    /// goes on. If every frame gives this error, it is the wrong line.
    #[error("the frame does not begin with \"MP\": check that the line leads to a core")]
    Magic,
    /// The checksum differs, because the frame was damaged on its way. The receiver goes on. The link does
    /// not repeat frames by itself, so a side that waits for an answer needs its own time limit.
    #[error("the frame is damaged, for its checksum differs: check the line")]
    Crc,
    /// The frame is intact, but has another link version. The receiver must stop the session and show this
    /// error, because it can understand no message of this peer.
    #[error(
        "peer speaks link protocol {peer}, this side speaks {PROTOCOL_VERSION}: update the older side"
    )]
    Version {
        /// The version that the peer speaks.
        peer: u8,
    },
    /// The frame is intact, but this version does not have its id. This is a fault in the peer. The
    /// receiver goes on without the frame.
    #[error("link protocol {PROTOCOL_VERSION} has no message {id}: correct the peer")]
    UnknownId {
        /// The unknown id.
        id: u8,
    },
    /// The frame is intact, but its payload does not belong to its id. This is a fault in the peer, because
    /// the same version has the same payloads. The receiver goes on without the frame.
    #[error("the payload is not that of message {id}: correct the peer")]
    Payload {
        /// The message that the id stands for.
        id: u8,
    },
    /// The frame is intact, but bytes follow the message in its payload. This is a fault in the peer. The
    /// receiver goes on without the frame.
    #[error("bytes follow message {id} in its frame: correct the peer")]
    TrailingBytes {
        /// The message that the id stands for.
        id: u8,
    },
}
