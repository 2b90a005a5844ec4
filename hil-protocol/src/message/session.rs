//! The opening of a session: who speaks, and what to fly with.

use super::size;
use serde::{Deserialize, Serialize};

/// The first message in both directions.
///
/// A peer whose link version differs never gets this far: its frame is
/// [`DecodeError::Version`](crate::DecodeError::Version).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// Which side the sender is.
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

/// The two ends of the link. The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// Plant, sensors and lidar.
    Harness = 0,
    /// Estimator, planner and controller.
    Core = 1,
}

/// Harness to core: what to fly with. Answered by a [`ConfigureReply`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Configure {
    /// The planner's set of parameters.
    pub preset: Preset,
    /// The aircraft that the core assumes.
    pub airframe: AirframeId,
    /// Candidate paths that are refined in a planning cycle; 0 = track the path itself, without
    /// refinement.
    pub paths: u16,
    /// Ticks from the start of one planning cycle to the start of the next.
    pub replan_period_ticks: u32,
    /// Ticks from a scan to the first tick that may use its plan.
    pub latency_ticks: u32,
    /// Slices of planning work done in each tick.
    pub slices_per_tick: u32,
    /// Seed of the planner's random numbers.
    pub seed: u64,
    /// Beams in each scan to come.
    pub beams: u16,
    /// Longest range that the lidar reports \[m\].
    pub range_max: f32,
    /// World height to return to, positive up \[m\].
    pub altitude: f64,
    /// What motor and elevator can do.
    pub actuators: ActuatorLimits,
}

impl Configure {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 2 * size::BYTE
        + 2 * size::U16
        + 3 * size::U32
        + size::U64
        + size::F32
        + size::F64
        + ActuatorLimits::MAX_SIZE;
}

/// Limits of the actuators; `None` is no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActuatorLimits {
    /// Greatest thrust \[N\].
    pub thrust_max: Option<f32>,
    /// Time constant of the thrust's first-order lag \[s\].
    pub thrust_lag: Option<f32>,
    /// Greatest distance of the elevator from its trim, in units of the command.
    pub elevator_range: Option<f32>,
    /// Greatest rate of the elevator \[1/s\].
    pub elevator_rate: Option<f32>,
}

impl ActuatorLimits {
    /// Size of the longest form \[bytes\].
    pub const MAX_SIZE: usize = 4 * (size::BYTE + size::F32);
}

/// A named set of the planner's parameters. The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preset {
    /// The reference implementation's.
    Reference = 0,
    /// The paper's.
    Paper = 1,
    /// Ours, for flight.
    Flight = 2,
}

/// An aircraft that the core has a model of. The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AirframeId {
    /// The paper's.
    Paper = 0,
    /// The reference implementation's.
    Reference = 1,
}

/// Core to harness: the answer to a [`Configure`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ConfigureReply {
    /// Accepted, or the first thing that was wrong.
    pub verdict: ConfigureVerdict,
}

impl ConfigureReply {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + size::U16;
}

/// What the core thinks of a [`Configure`]. After anything but `Accepted` it stays unconfigured.
///
/// The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ConfigureVerdict {
    /// The core flies with it from the next tick on.
    Accepted,
    /// More candidate paths than there is room for.
    TooManyPaths {
        /// The most that it takes.
        max: u16,
    },
    /// The replanning period cannot be kept.
    ReplanPeriod,
    /// The latency does not suit the replanning period.
    Latency,
    /// No beams, or more than there is room for.
    Beams {
        /// The most that it takes.
        max: u16,
    },
    /// A float is infinite or not a number.
    NonFinite,
    /// The airframe has no trim state with these parameters.
    NotTrimmable,
    /// No planning work in a tick, or more than a tick can hold.
    SlicesPerTick,
    /// The lidar's range is not positive.
    RangeMax,
    /// A session is running; it goes on as it was.
    AlreadyConfigured,
    /// A limit of an actuator is not a positive, finite number, or the thrust does not carry level
    /// flight.
    Actuators,
}

/// Harness to core: another value for one of the core's parameters. Answered by a
/// [`ParameterReply`].
///
/// Between [`ConfigureReply`] and the first [`SensorFrame`](crate::SensorFrame) every parameter can
/// change; after it, those that the core can change in flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetParameter {
    /// Which one, a number that the core's software gives it.
    pub parameter: u8,
    /// Its value from now on, in its own unit.
    pub value: f64,
}

impl SetParameter {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + size::F64;
}

/// Core to harness: the answer to a [`SetParameter`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterReply {
    /// Which one.
    pub parameter: u8,
    /// Accepted, or why not.
    pub verdict: ParameterVerdict,
}

impl ParameterReply {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::BYTE + size::BYTE + ConfigureReply::MAX_SIZE;
}

/// What the core thinks of a [`SetParameter`]. After anything but `Accepted` it flies on with the
/// value that it had. The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ParameterVerdict {
    /// In force: at once before the flight, and from the next planning cycle on in flight.
    Accepted,
    /// No such parameter, or not with this preset.
    Unknown,
    /// Not a number, or outside the parameter's range.
    Range,
    /// A whole number is asked for.
    NotWhole,
    /// Can only change before the flight.
    InFlight,
    /// There is no configuration yet.
    NotConfigured,
    /// With this value the core cannot be set up.
    SetUp(ConfigureVerdict),
}
