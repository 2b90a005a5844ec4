//! The messages: one struct for each message, and the enum [`Message`] of all of them.

pub(crate) mod flight;
pub(crate) mod report;
pub(crate) mod session;
mod size;
pub(crate) mod verdict;

use crate::error::DecodeError;
use flight::{ActuatorCommand, LidarScan, SensorFrame, StepReport};
use report::{HealthReport, PlanControls, PlanReport, PlanTrajectory, Rejection};
use serde::Serialize;
use serde::de::DeserializeOwned;
use session::{Configure, ConfigureReply, Hello, ParameterReply, SetParameter};

/// Message ids, the fourth byte of a frame. Append-only: a number is never used again.
pub mod id {
    /// [`Hello`](crate::Hello).
    pub const HELLO: u8 = 1;
    /// [`Configure`](crate::Configure).
    pub const CONFIGURE: u8 = 2;
    /// [`ConfigureReply`](crate::ConfigureReply).
    pub const CONFIGURE_REPLY: u8 = 3;
    /// [`SensorFrame`](crate::SensorFrame).
    pub const SENSOR_FRAME: u8 = 4;
    /// [`LidarScan`](crate::LidarScan).
    pub const LIDAR_SCAN: u8 = 5;
    /// [`ActuatorCommand`](crate::ActuatorCommand).
    pub const ACTUATOR_COMMAND: u8 = 6;
    /// [`StepReport`](crate::StepReport).
    pub const STEP_REPORT: u8 = 7;
    /// [`PlanReport`](crate::PlanReport).
    pub const PLAN_REPORT: u8 = 8;
    /// [`Rejection`](crate::Rejection).
    pub const REJECTION: u8 = 9;
    /// [`SetParameter`](crate::SetParameter).
    pub const SET_PARAMETER: u8 = 10;
    /// [`ParameterReply`](crate::ParameterReply).
    pub const PARAMETER_REPLY: u8 = 11;
    /// [`PlanTrajectory`](crate::PlanTrajectory).
    pub const PLAN_TRAJECTORY: u8 = 12;
    /// [`HealthReport`](crate::HealthReport).
    pub const HEALTH_REPORT: u8 = 13;
    /// [`PlanControls`](crate::PlanControls).
    pub const PLAN_CONTROLS: u8 = 14;
    /// The greatest of these numbers. All from [`HELLO`] on are used.
    pub const LAST: u8 = PLAN_CONTROLS;
}

/// The struct of a message, which a frame carries.
pub trait Body: Serialize + DeserializeOwned {
    /// The number that stands for the message in a frame's header, one of [`id`].
    const ID: u8;
}

/// Gives structs their numbers.
macro_rules! bodies {
    ($($body:ty => $id:ident,)*) => {
        $(impl Body for $body {
            const ID: u8 = id::$id;
        })*
    };
}

bodies! {
    Hello => HELLO,
    Configure => CONFIGURE,
    ConfigureReply => CONFIGURE_REPLY,
    SensorFrame => SENSOR_FRAME,
    LidarScan => LIDAR_SCAN,
    ActuatorCommand => ACTUATOR_COMMAND,
    StepReport => STEP_REPORT,
    PlanReport => PLAN_REPORT,
    Rejection => REJECTION,
    SetParameter => SET_PARAMETER,
    ParameterReply => PARAMETER_REPLY,
    PlanTrajectory => PLAN_TRAJECTORY,
    HealthReport => HEALTH_REPORT,
    PlanControls => PLAN_CONTROLS,
}

/// A message of any kind.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the scan on"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// Both directions: the first message, which identifies the sender.
    Hello(Hello),
    /// Harness to core: the configuration of a flight.
    Configure(Configure),
    /// Core to harness: the verdict on a configuration.
    ConfigureReply(ConfigureReply),
    /// Harness to core: the measurements of one tick.
    SensorFrame(SensorFrame),
    /// Harness to core: one sweep of the lidar.
    LidarScan(LidarScan),
    /// Core to harness: the actuator command of one tick.
    ActuatorCommand(ActuatorCommand),
    /// Core to harness: estimate and reference of one tick.
    StepReport(StepReport),
    /// Core to harness: the result of one planning cycle.
    PlanReport(PlanReport),
    /// Core to harness: an input that the core did not use, and the cause.
    Rejection(Rejection),
    /// Harness to core: a new value for a parameter.
    SetParameter(SetParameter),
    /// Core to harness: the verdict on a new value.
    ParameterReply(ParameterReply),
    /// Core to harness: the trajectory that a planning cycle chose.
    PlanTrajectory(PlanTrajectory),
    /// Core to harness: the counters of the flight.
    HealthReport(HealthReport),
    /// Core to harness: the commands along the trajectory that is flown.
    PlanControls(PlanControls),
}

impl Message {
    /// The number that stands for this message in a frame's header, one of [`id`].
    #[must_use]
    pub const fn id(&self) -> u8 {
        match self {
            Self::Hello(_) => id::HELLO,
            Self::Configure(_) => id::CONFIGURE,
            Self::ConfigureReply(_) => id::CONFIGURE_REPLY,
            Self::SensorFrame(_) => id::SENSOR_FRAME,
            Self::LidarScan(_) => id::LIDAR_SCAN,
            Self::ActuatorCommand(_) => id::ACTUATOR_COMMAND,
            Self::StepReport(_) => id::STEP_REPORT,
            Self::PlanReport(_) => id::PLAN_REPORT,
            Self::Rejection(_) => id::REJECTION,
            Self::SetParameter(_) => id::SET_PARAMETER,
            Self::ParameterReply(_) => id::PARAMETER_REPLY,
            Self::PlanTrajectory(_) => id::PLAN_TRAJECTORY,
            Self::HealthReport(_) => id::HEALTH_REPORT,
            Self::PlanControls(_) => id::PLAN_CONTROLS,
        }
    }

    /// Reads the payload of the message with this id.
    pub(crate) fn read(id: u8, payload: &[u8]) -> Result<Self, DecodeError> {
        Ok(match id {
            id::HELLO => Self::Hello(read(payload)?),
            id::CONFIGURE => Self::Configure(read(payload)?),
            id::CONFIGURE_REPLY => Self::ConfigureReply(read(payload)?),
            id::SENSOR_FRAME => Self::SensorFrame(read(payload)?),
            id::LIDAR_SCAN => Self::LidarScan(read(payload)?),
            id::ACTUATOR_COMMAND => Self::ActuatorCommand(read(payload)?),
            id::STEP_REPORT => Self::StepReport(read(payload)?),
            id::PLAN_REPORT => Self::PlanReport(read(payload)?),
            id::REJECTION => Self::Rejection(read(payload)?),
            id::SET_PARAMETER => Self::SetParameter(read(payload)?),
            id::PARAMETER_REPLY => Self::ParameterReply(read(payload)?),
            id::PLAN_TRAJECTORY => Self::PlanTrajectory(read(payload)?),
            id::HEALTH_REPORT => Self::HealthReport(read(payload)?),
            id::PLAN_CONTROLS => Self::PlanControls(read(payload)?),
            _ => return Err(DecodeError::UnknownId { id }),
        })
    }
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

const _: () = {
    assert!(Hello::MAX_SIZE <= MAX_PAYLOAD);
    assert!(Configure::MAX_SIZE <= MAX_PAYLOAD);
    assert!(ConfigureReply::MAX_SIZE <= MAX_PAYLOAD);
    assert!(SensorFrame::MAX_SIZE <= MAX_PAYLOAD);
    assert!(ActuatorCommand::MAX_SIZE <= MAX_PAYLOAD);
    assert!(StepReport::MAX_SIZE <= MAX_PAYLOAD);
    assert!(PlanReport::MAX_SIZE <= MAX_PAYLOAD);
    assert!(Rejection::MAX_SIZE <= MAX_PAYLOAD);
    assert!(SetParameter::MAX_SIZE <= MAX_PAYLOAD);
    assert!(ParameterReply::MAX_SIZE <= MAX_PAYLOAD);
    assert!(PlanTrajectory::MAX_SIZE <= MAX_PAYLOAD);
    assert!(HealthReport::MAX_SIZE <= MAX_PAYLOAD);
    assert!(PlanControls::MAX_SIZE <= MAX_PAYLOAD);
};
