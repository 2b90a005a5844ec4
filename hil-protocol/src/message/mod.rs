//! The messages: one struct for each message, and the enum [`Message`] of all of them.

pub(crate) mod flight;
pub(crate) mod report;
pub(crate) mod session;
mod size;
pub(crate) mod space;
pub(crate) mod verdict;

use crate::error::DecodeError;
use flight::{ActuatorCommand, LidarScan, SensorFrame, StepReport};
use report::{HealthReport, PlanControls, PlanReport, PlanTrajectory, Rejection};
use serde::Serialize;
use serde::de::DeserializeOwned;
use session::{Configure, ConfigureReply, Hello, ParameterReply, SetParameter};
use space::{
    ConfigureLateral, ConfigureSpace, InertialFrame, PointPacket, SpacePosition, SpaceReport,
    SpaceTrajectory, SurfaceCommand,
};

/// The struct of a message, which a frame carries.
pub trait Body: Clone + Serialize + DeserializeOwned {
    /// The number that stands for the message in a frame's header, one of [`id`].
    const ID: u8;

    /// The message of this struct.
    fn into_message(self) -> Message;
}

/// Makes all that follows from the list of messages.
macro_rules! messages {
    ($($(#[$doc:meta])* $number:literal $id:ident $body:ident,)*) => {
        /// Message ids, the fourth byte of a frame. Append-only: a number is never used again.
        pub mod id {
            $(
                #[doc = concat!("[`", stringify!($body), "`](crate::", stringify!($body), ").")]
                pub const $id: u8 = $number;
            )*
            /// The greatest of these numbers. All from [`HELLO`] on are used.
            pub const LAST: u8 = [$($number),*].len() as u8;
        }

        $(
            impl Body for $body {
                const ID: u8 = id::$id;

                fn into_message(self) -> Message {
                    Message::$body(self)
                }
            }
        )*

        /// A message of any kind.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Message {
            $($(#[$doc])* $body($body),)*
        }

        impl Message {
            /// The number that stands for this message in a frame's header, one of [`id`].
            #[must_use]
            pub const fn id(&self) -> u8 {
                match self {
                    $(Self::$body(_) => id::$id,)*
                }
            }

            /// Reads the payload of the message with this id.
            pub(crate) fn read(id: u8, payload: &[u8]) -> Result<Self, DecodeError> {
                Ok(match id {
                    $(id::$id => Self::$body(read(payload)?),)*
                    _ => return Err(DecodeError::UnknownId { id }),
                })
            }

            /// Writes the payload: the [postcard] form of the message's struct.
            ///
            /// # Errors
            ///
            /// Those of [`postcard::to_slice`]: the buffer is too short. One of [`MAX_PAYLOAD`] bytes is long enough.
            pub fn to_payload<'a>(&self, buffer: &'a mut [u8]) -> postcard::Result<&'a mut [u8]> {
                match self {
                    $(Self::$body(body) => postcard::to_slice(body, buffer),)*
                }
            }
        }

        const _: () = {
            $(assert!($body::MAX_SIZE <= MAX_PAYLOAD);)*
        };
    };
}

messages! {
    /// Both directions: the first message, which identifies the sender.
    1 HELLO Hello,
    /// Harness to core: the configuration of a flight.
    2 CONFIGURE Configure,
    /// Core to harness: the verdict on a configuration.
    3 CONFIGURE_REPLY ConfigureReply,
    /// Harness to core: the measurements of one tick.
    4 SENSOR_FRAME SensorFrame,
    /// Harness to core: one sweep of the lidar.
    5 LIDAR_SCAN LidarScan,
    /// Core to harness: the actuator command of one tick.
    6 ACTUATOR_COMMAND ActuatorCommand,
    /// Core to harness: estimate and reference of one tick.
    7 STEP_REPORT StepReport,
    /// Core to harness: the result of one planning cycle.
    8 PLAN_REPORT PlanReport,
    /// Core to harness: an input that the core did not use, and the cause.
    9 REJECTION Rejection,
    /// Harness to core: a new value for a parameter.
    10 SET_PARAMETER SetParameter,
    /// Core to harness: the verdict on a new value.
    11 PARAMETER_REPLY ParameterReply,
    /// Core to harness: the trajectory that a planning cycle chose.
    12 PLAN_TRAJECTORY PlanTrajectory,
    /// Core to harness: the counters of the flight.
    13 HEALTH_REPORT HealthReport,
    /// Core to harness: the commands along the trajectory that is flown.
    14 PLAN_CONTROLS PlanControls,
    /// Harness to core: the lateral part of the aircraft.
    15 CONFIGURE_LATERAL ConfigureLateral,
    /// Harness to core: attitude, body rates and specific force of one tick.
    16 INERTIAL_FRAME InertialFrame,
    /// Harness to core: a position in space.
    17 SPACE_POSITION SpacePosition,
    /// Harness to core: some points of a lidar in space.
    18 POINT_PACKET PointPacket,
    /// Core to harness: the command to the lateral surfaces of one tick.
    19 SURFACE_COMMAND SurfaceCommand,
    /// Core to harness: the lateral part of estimate and reference of one tick.
    20 SPACE_REPORT SpaceReport,
    /// Core to harness: the trajectory in space that a planning cycle chose.
    21 SPACE_TRAJECTORY SpaceTrajectory,
    /// Harness to core: limits, distances and candidates of plans in space.
    22 CONFIGURE_SPACE ConfigureSpace,
}

/// Reads one struct from exactly these bytes.
pub(crate) fn read<T: Body>(payload: &[u8]) -> Result<T, DecodeError> {
    match postcard::take_from_bytes(payload) {
        Ok((value, [])) => Ok(value),
        Ok(_) => Err(DecodeError::TrailingBytes { id: T::ID }),
        Err(_) => Err(DecodeError::Payload { id: T::ID }),
    }
}

/// Size of the longest payload, a full [`LidarScan`] \[bytes\].
pub const MAX_PAYLOAD: usize = LidarScan::MAX_SIZE;
