//! The opening of a session: the two sides, the configuration, and the parameters.

use super::size;
use super::verdict::{ConfigureVerdict, ParameterVerdict};
use mpp_data::{ActuatorLimits, Aircraft};
use serde::{Deserialize, Serialize};

/// The first message in both directions.
///
/// A hello of another link version is never decoded: its frame gives
/// [`DecodeError::Version`](crate::DecodeError::Version) instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// The side of the sender.
    pub role: Role,
    /// Version of the sender's software: major, minor, patch.
    pub software: [u8; 3],
    /// Time between two [`SensorFrame`](crate::SensorFrame)s \[us\].
    pub tick_period_us: u32,
    /// The most beams in a scan that the sender can produce or take in.
    pub beams_max: u16,
    /// Stages of the sender's planning horizon; 0 from a side that does not plan.
    pub stages: u16,
}

impl Hello {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + 3 * size::BYTE + size::U32 + 2 * size::U16;
}

/// The two ends of the link. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// The harness: plant, sensors and lidar.
    Harness = 0,
    /// The flight core: estimator, planner and controller.
    Core = 1,
}

/// Harness to core: the configuration of a flight. The answer is a [`ConfigureReply`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Configure {
    /// The planner's set of parameters.
    pub preset: Preset,
    /// The aircraft that the core flies.
    pub aircraft: Aircraft,
    /// Number of candidate paths that a planning cycle refines. 0 means that the core tracks a path itself
    /// without refinement; preset `flight` refuses 0.
    pub paths: u16,
    /// Ticks from the start of one planning cycle to the start of the next.
    pub replan_period_ticks: u32,
    /// Ticks from the start of a planning cycle to the first tick that may use its plan. A cycle starts at the sensor
    /// frame after its scan, or without a scan.
    pub latency_ticks: u32,
    /// Number of slices of planning work in each tick.
    pub slices_per_tick: u32,
    /// Seed of the planner's random numbers.
    pub seed: u64,
    /// Number of beams in each scan of the session.
    pub beams: u16,
    /// Longest range that the lidar reports \[m\].
    pub range_max: f32,
    /// World height to which the vehicle returns, positive up \[m\].
    pub altitude: f64,
    /// Limits of motor and elevator.
    pub actuators: ActuatorLimits,
}

impl Configure {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE
        + size::AIRCRAFT
        + 2 * size::U16
        + 3 * size::U32
        + size::U64
        + size::F32
        + size::F64
        + size::ACTUATOR_LIMITS;
}

/// A named set of the planner's parameters. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preset {
    /// Parameters of the reference implementation.
    Reference = 0,
    /// Parameters of the paper.
    Paper = 1,
    /// Our parameters for flight.
    Flight = 2,
    /// The planner in space; [`ConfigureLateral`](crate::ConfigureLateral) and [`ConfigureSpace`](crate::ConfigureSpace) come before.
    Space = 3,
}

/// Core to harness: the answer to a [`Configure`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ConfigureReply {
    /// The verdict: accepted, or the first fault.
    pub verdict: ConfigureVerdict,
}

impl ConfigureReply {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + size::U16;
}

/// Harness to core: a new value for one of the core's parameters. The answer is a [`ParameterReply`].
///
/// Between [`ConfigureReply`] and the first [`SensorFrame`](crate::SensorFrame) every parameter can
/// change. After that, only some parameters can change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetParameter {
    /// Number of the parameter. The core's software defines it.
    pub parameter: u8,
    /// New value, in the parameter's unit.
    pub value: f64,
}

impl SetParameter {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + size::F64;
}

/// Core to harness: the answer to a [`SetParameter`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterReply {
    /// Number of the parameter.
    pub parameter: u8,
    /// The verdict: accepted, or the cause of the refusal.
    pub verdict: ParameterVerdict,
}

impl ParameterReply {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + size::BYTE + ConfigureReply::MAX_SIZE;
}
