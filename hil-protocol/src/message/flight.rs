//! The messages of a tick: measurements to the core, and commands from it.

use super::size;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// The most beams in a [`LidarScan`].
pub const MAX_BEAMS: usize = 128;

// The length of the list must fit the two bytes that `LidarScan::MAX_SIZE` counts for it.
const _: () = assert!(MAX_BEAMS < 1 << 14);

/// Harness to core: the measurements of one tick. World frame: x downrange, z up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorFrame {
    /// Number of the tick. The sender chooses the first number, and each following number is one more.
    pub tick: u32,
    /// Airspeed \[m/s\].
    pub airspeed: f64,
    /// Pitch, nose-up positive \[rad\].
    pub pitch: f64,
    /// Position downrange \[m\].
    pub x: f64,
    /// Height, positive up \[m\].
    pub z: f64,
}

impl SensorFrame {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 4 * size::F64;
}

/// Harness to core: one sweep of the lidar in the vertical plane, sent before the
/// [`SensorFrame`] of the same tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LidarScan {
    /// The tick at which the sweep was taken.
    pub tick: u32,
    /// Angle of the first beam against the body axis, nose-up positive \[rad\].
    pub angle_min: f32,
    /// Angle from each beam to the next, nose-up positive \[rad\].
    pub angle_increment: f32,
    /// Range of each beam, from `angle_min` on \[m\]; 0 means no return.
    pub ranges: Vec<f32, MAX_BEAMS>,
}

impl LidarScan {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 2 * size::F32 + 2 * size::BYTE + MAX_BEAMS * size::F32;
}

/// Core to harness: the actuator command of one tick. It ends the tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActuatorCommand {
    /// The tick of the [`SensorFrame`] that this message answers.
    pub tick: u32,
    /// Thrust along the body axis \[N\].
    pub thrust: f64,
    /// Elevator, in the unit of the airframe's model \[-\].
    pub elevator: f64,
    /// The source of the reference in this tick.
    pub mode: ControlMode,
}

impl ActuatorCommand {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 2 * size::F64 + size::BYTE;
}

/// The source of the controller's reference. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ControlMode {
    /// The controller holds straight and level flight, because there is no plan.
    TrimHold = 0,
    /// The controller tracks the plan.
    Tracking = 1,
}

/// Core to harness: estimate and reference of one tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// The tick of the [`SensorFrame`] that the step used.
    pub tick: u32,
    /// Estimate: airspeed \[m/s\], pitch \[rad\], pitch rate \[rad/s\], flight path angle \[rad\];
    /// angles nose-up positive.
    pub estimate: [f64; 4],
    /// Reference: x downrange \[m\], z up \[m\], airspeed \[m/s\], pitch \[rad\],
    /// pitch rate \[rad/s\], flight path angle \[rad\].
    pub reference: [f64; 6],
    /// Ticks since the scan from which the present plan was made; 0 without a plan.
    pub plan_age_ticks: u32,
}

impl StepReport {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 2 * size::U32 + 10 * size::F64;
}
