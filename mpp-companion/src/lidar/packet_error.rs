//! Why bytes of a lidar are not used.

/// Why a message of a lidar is not used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum PacketError {
    /// A frame of our link is damaged.
    #[error("a frame of the link: {0}")]
    Link(hil_protocol::DecodeError),
    /// Less than a header.
    #[error("{0} bytes are no point data of a Mid-360")]
    Short(usize),
    /// A field has a value that is not known.
    #[error("{0} is {1}: it must be {2}")]
    Field(&'static str, u8, &'static str),
    /// The header does not agree with what came.
    #[error("{came} bytes came, the header says {told} with {points} points")]
    Length { told: u16, points: u16, came: usize },
    /// The checksum is wrong.
    #[error("the checksum is wrong")]
    Checksum,
    /// The sensor is frozen, or sends more often than it measures.
    #[error("OBSTACLE_DISTANCE repeats its distances")]
    Repeated,
    /// The angles make no sense.
    #[error("OBSTACLE_DISTANCE steps by {0} deg from {1} deg: 90 deg are the most")]
    Angles(f32, f32),
}
