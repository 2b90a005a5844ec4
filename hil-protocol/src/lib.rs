//! The link between the flight core and the hardware-in-the-loop harness, and the link between the
//! vehicle and its ground stations.
//!
//! The crate knows frames, versions, checksums and messages. It does not know the meaning of a value to
//! the planner. It reads no clock, does no input or output, allocates nothing and has no panic.
//!
//! # A frame
//!
//! ```text
//!            0      1      2      3      4              n - 4        n
//!            +------+------+------+------+--------------+------------+
//! plain      | 0x4D | 0x50 | ver. |  id  |   payload    |   CRC-32   |
//!            +------+------+------+------+--------------+------------+
//!            |<------- header ---------->|  postcard    | little     |
//!            |<------------ checked by the CRC -------->| endian     |
//!
//!            +------------------------------------------------+------+
//! on wire    |        COBS(plain): no zero byte inside        | 0x00 |
//!            +------------------------------------------------+------+
//! ```
//!
//! * The magic is "MP"; `ver.` is [`PROTOCOL_VERSION`]; `id` is one of [`id`].
//! * The payload is the [postcard](https://postcard.jamesmunns.com/wire-format) form of the
//!   message's struct: integers wider than a byte are varints, floats are little endian, an enum
//!   is the position of its variant. [`Message`] itself is never encoded; the id stands for it.
//! * The CRC is CRC-32/ISO-HDLC (the one of Ethernet and zlib).
//! * The zero byte ends a frame and occurs nowhere else. After any noise a receiver is therefore in step
//!   again at the next zero byte. A sender that opens a line of unknown state writes one 0x00 first:
//!   successive zeros are not an error.
//!
//! # A session
//!
//! ```text
//! harness                                      core
//!    | -------- Hello -------------------------> |
//!    | <------------------------- Hello -------- |   both check the version and the sizes
//!    | -------- Configure ---------------------> |
//!    | <---------------- ConfigureReply -------- |   Accepted, or why not
//!    | -------- [SetParameter] ----------------> |   any number, then and between ticks;
//!    | <-------------- [ParameterReply] -------- |   each is answered
//!    |                                           |
//!    | -------- [LidarScan] -------------------> |  \
//!    | -------- SensorFrame -------------------> |   |
//!    | <------------------ [PlanReport] -------- |   |  each tick, 100 Hz;
//!    | <-------------- [PlanTrajectory] -------- |   |  [..] only when there is one
//!    | <---------------- [PlanControls] -------- |   |
//!    | <------------------- [Rejection] -------- |   |
//!    | <-------------------- StepReport -------- |   |
//!    | <---------------- [HealthReport] -------- |   |
//!    | <--------------- ActuatorCommand -------- |  /
//! ```
//!
//! The [`ActuatorCommand`] ends the tick: a harness in lockstep sends nothing more until it has received
//! this message. Only the rejection of a scan may follow it; the harness finds it before the answers of the next tick.
//!
//! A core that starts sends a [`Hello`] without being asked. The harness then configures this core, sends
//! it every parameter value that the core before the restart had accepted, and repeats the request whose
//! answer it still waits for.
//!
//! Messages [15](ConfigureLateral) to [22](ConfigureSpace) are those of an aircraft that banks, which preset
//! [`Space`](Preset::Space) flies.
//!
//! # Versions
//!
//! Postcard messages cannot grow: a peer that knows one field more reads wrong values. Therefore
//!
//! * every change of the messages raises [`PROTOCOL_VERSION`], and both sides must have the same version:
//!   [`DecodeError::Version`] names that of the other side;
//! * header and CRC stay as they are in every version, so that this error can be told from noise;
//! * ids and variants are only ever appended, never moved or used again, so that a number means
//!   the same in every recording. `tests/frozen_bytes` holds the bytes of all of them.
//!
//! A version is open until a release uses it. Until then its row in the table collects the changes.
//!
//! | version | release | what changed |
//! |---|---|---|
//! | 1 | none | messages 1 to 9 |
//! | 2 | 0.2.0, open | messages 10 to 22; [`SensorFrame`] with the time and the errors of each measurement; [`StepReport`] with position, wind, lift and trust in the sensors, the elevator and the motor; [`RejectionCause`] from [`BytesLost`](RejectionCause::BytesLost) on; [`Configure::aircraft`] instead of the number of an airframe, [`Configure::actuators`], which may end without its dead times; [`ConfigureVerdict`] from [`Actuators`](ConfigureVerdict::Actuators) on; [`ParameterVerdict`] from [`NotInPreset`](ParameterVerdict::NotInPreset) on; [`Setting`] |
//!
//! # Use
//!
//! ```
//! use hil_protocol::{AirData, Decoder, MAX_FRAME, Message, SensorFrame, encode};
//!
//! let air = AirData { tick: 7, airspeed: 9.0, pitch: 0.1 };
//! let sent = Message::SensorFrame(SensorFrame { tick: 7, air: Some(air), position: None });
//! let mut buffer = [0; MAX_FRAME];
//! let frame = encode(&sent, &mut buffer)?;
//!
//! let mut decoder = Decoder::new();
//! let received = frame.iter().find_map(|&byte| decoder.push(byte));
//! assert_eq!(received, Some(Ok(sent)));
//! # Ok::<(), hil_protocol::EncodeError>(())
//! ```
//!
//! The link to ground stations is MAVLink 2. It is separate, in [`mavlink`].

#![no_std]
#![forbid(unsafe_code)]

mod error;
mod frame;
pub mod mavlink;
mod message;
mod version;

pub use error::{DecodeError, EncodeError};
pub use frame::{Decoder, MAGIC, MAX_FRAME, encode, encode_body};
pub use message::flight::{
    ActuatorCommand, AirData, ControlMode, GroundVelocity, LidarScan, MAX_BEAMS, Position,
    SensorFrame, SensorState, SensorStates, StepReport,
};
pub use message::report::{
    CoreFault, CoreTask, HealthReport, MAX_KNOTS, PlanControls, PlanOutcome, PlanReport,
    PlanTrajectory, Rejection, RejectionCause,
};
pub use message::session::{
    Configure, ConfigureReply, Hello, ParameterReply, Preset, Role, SetParameter,
};
pub use message::space::{
    ConfigureLateral, ConfigureSpace, InertialFrame, MAX_POINTS, PointPacket, SpacePosition,
    SpaceReport, SpaceTrajectory, SurfaceCommand,
};
pub use message::verdict::{ConfigureVerdict, ParameterVerdict};
pub use message::{Body, MAX_PAYLOAD, Message, id};
pub use mpp_data::{
    ActuatorLimits, Aircraft, Airframe, Derivatives, LateralAirframe, OutOfRange, Setting,
};
pub use version::PROTOCOL_VERSION;
