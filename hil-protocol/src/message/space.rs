//! The messages of an aircraft in space, beside those of the vertical plane. The node in space of `mpp-node` takes them; that of
//! the vertical plane refuses them as unexpected.
//!
//! World: x downrange, y to the right, z up. Body: x ahead, y to the right, z down. Bank, heading, course, rates and commands
//! are positive to the right.

use super::report::MAX_KNOTS;
use super::size;
use heapless::Vec;
use mpp_data::LateralAirframe;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The most points in a [`PointPacket`].
pub const MAX_POINTS: usize = 40;

// The lengths of the lists must fit the single byte that the sizes count for them.
const _: () = assert!(MAX_POINTS < 1 << 7 && MAX_KNOTS < 1 << 7);

/// Harness to core: the lateral part of the aircraft, sent before [`Configure`](crate::Configure). The answer is a
/// [`ConfigureReply`](crate::ConfigureReply).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConfigureLateral {
    /// Inertia and lateral aerodynamics.
    pub airframe: LateralAirframe,
    /// Greatest aileron and rudder to both sides \[rad\]; `None` means no limit.
    pub surfaces_max: [Option<f64>; 2],
    /// Greatest rate of both surfaces [rad/s]; `None` means no limit.
    pub surface_rate: Option<f64>,
    /// Dead time of the roll loop of an autopilot \[s\]: the aileron is then the commanded bank, the elevator the commanded angle
    /// of attack, and the airframe that of the closed loops. On the link this is a tail, without which a peer may end.
    #[serde(serialize_with = "put_tail", deserialize_with = "take_tail")]
    pub roll_loop: Option<f64>,
}

fn put_tail<S: Serializer>(tail: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match tail {
        Some(number) => number.serialize(serializer),
        None => serializer.serialize_unit(),
    }
}

// What ends within the number leaves bytes behind, which the frame's reader refuses.
fn take_tail<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Ok(f64::deserialize(deserializer).ok())
}

impl ConfigureLateral {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize =
        (LateralAirframe::COUNT + 1) * size::F64 + 3 * (size::BYTE + size::F64);
}

/// Harness to core: limits, distances and candidates of plans in space, sent before [`Configure`](crate::Configure). The answer
/// is a [`ConfigureReply`](crate::ConfigureReply).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConfigureSpace {
    /// Greatest bank \[rad\] and rate of the bank [rad/s] of plans.
    pub bank: [f64; 2],
    /// Least distance of the body from what hits have shown, beyond the half span \[m\]. A sphere has its radius in it.
    pub margin: f64,
    /// Half of the span of a wing that banks \[m\]; 0 for a sphere.
    pub half_span: f64,
    /// Least and greatest height of the body \[m\].
    pub heights: [f64; 2],
    /// Greatest distance to either side of the line on which the flight starts \[m\].
    pub half_width: f64,
    /// Whether a program improves each candidate.
    pub programs: bool,
    /// Whether only plans with a way out are flown, as long as one is known.
    pub open: bool,
}

impl ConfigureSpace {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 7 * size::F64 + 2 * size::BYTE;
}

/// Harness to core: what an attitude reference and its gyroscopes and accelerometers tell, sent before the
/// [`SensorFrame`](crate::SensorFrame) of the tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InertialFrame {
    /// The tick at which all values were measured.
    pub tick: u32,
    /// Bank, pitch, heading \[rad\]. A heading of 0 looks downrange.
    pub attitude: [f32; 3],
    /// Standard deviation of the attitude's error about an axis \[rad\].
    pub sigma: f32,
    /// Roll rate, pitch rate, yaw rate [rad/s].
    pub rates: [f32; 3],
    /// Specific force along the body axes [m/s^2].
    pub force: [f32; 3],
}

impl InertialFrame {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 10 * size::F32;
}

/// Harness to core: a position in space, in place of [`Position`](crate::Position).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpacePosition {
    /// The tick at which the position was measured.
    pub tick: u32,
    /// Position \[m\].
    pub position: [f64; 3],
    /// Standard deviation of the white part of the error along an axis \[m\].
    pub sigma: f32,
    /// Velocity over ground at the same time [m/s], and the standard deviation of its error along an axis [m/s].
    pub velocity: Option<([f32; 3], f32)>,
}

impl SpacePosition {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 3 * size::F64 + size::F32 + size::BYTE + 4 * size::F32;
}

/// Harness to core: some points of a lidar in the order in which it measured them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointPacket {
    /// The tick in which the first point was measured, by the clock of the sender.
    pub tick: u32,
    /// Time of the first point by the sensor's own clock \[us\]. After the greatest number comes 0.
    pub sensor_time: u32,
    /// Time from each point to the next \[us\].
    pub interval: u16,
    /// The points in the sensor's axes \[m\], turned into those of the body. A beam without return is the direction of the
    /// beam with a length of 0.5.
    pub points: Vec<[f32; 3], MAX_POINTS>,
}

impl PointPacket {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 2 * size::U32 + size::U16 + size::BYTE + MAX_POINTS * 3 * size::F32;
}

/// Core to harness: the command to the lateral surfaces of one tick, sent before the
/// [`ActuatorCommand`](crate::ActuatorCommand).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceCommand {
    /// The tick that the command answers.
    pub tick: u32,
    /// Aileron \[rad\].
    pub aileron: f64,
    /// Rudder \[rad\].
    pub rudder: f64,
}

impl SurfaceCommand {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 2 * size::F64;
}

/// Core to harness: the lateral part of estimate and reference of one tick, sent before the
/// [`StepReport`](crate::StepReport).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpaceReport {
    /// The tick of the measurements that the step used.
    pub tick: u32,
    /// Estimate: sideslip \[rad\], bank \[rad\], roll rate, yaw rate [rad/s], course \[rad\].
    pub estimate: [f64; 5],
    /// Estimated position to the right \[m\].
    pub y: f64,
    /// Estimated velocity of the air over ground to the right [m/s].
    pub wind: f64,
    /// Reference: position to the right \[m\], bank \[rad\], course \[rad\].
    pub reference: [f64; 3],
    /// Time for which the plan has a way out \[s\]: after it the plan turns to a circle in space that was seen free. 0 without one, and the length
    /// of a plan on the circle.
    pub way_out: f32,
}

impl SpaceReport {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 10 * size::F64 + size::F32;
}

/// Core to harness: the trajectory in space that a planning cycle chose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpaceTrajectory {
    /// The tick of the scan from which the plan was made.
    pub scan_tick: u32,
    /// Time from each knot to the next \[s\]; from the first to the second it may be another one, because a plan keeps the knots of
    /// the one before.
    pub period: f32,
    /// Position \[m\], bank and course \[rad\] at each knot.
    pub knots: Vec<[f32; 5], MAX_KNOTS>,
}

impl SpaceTrajectory {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + size::F32 + size::BYTE + MAX_KNOTS * 5 * size::F32;
}
