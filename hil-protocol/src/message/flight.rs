//! The messages of a tick: measurements to the core, and commands from it.

use super::size;
use core::fmt;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// The most beams in a [`LidarScan`].
pub const MAX_BEAMS: usize = 128;

// The length of the list must fit the two bytes that `LidarScan::MAX_SIZE` counts for it.
const _: () = assert!(MAX_BEAMS < 1 << 14);

/// Harness to core: the measurements that arrived in one tick. World frame: x downrange, z up.
///
/// Each measurement bears the tick at which it was taken. A sensor that is late sends the tick of the
/// measurement, not the tick of the arrival. A sensor that has nothing new sends nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorFrame {
    /// Number of the tick. The sender chooses the first number, and each following number is one more. After
    /// the greatest number comes 0.
    pub tick: u32,
    /// New air data, if there are any.
    pub air: Option<AirData>,
    /// A new position, if there is one.
    pub position: Option<Position>,
}

impl SensorFrame {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize =
        size::U32 + size::BYTE + AirData::MAX_SIZE + size::BYTE + Position::MAX_SIZE;
}

/// Airspeed and pitch at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AirData {
    /// The tick at which both values were measured.
    pub tick: u32,
    /// Airspeed \[m/s\].
    pub airspeed: f64,
    /// Pitch, nose-up positive \[rad\].
    pub pitch: f64,
}

impl AirData {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 2 * size::F64;
}

/// A position from the navigation source, with its declared error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Position {
    /// The tick at which the position was measured.
    pub tick: u32,
    /// Position downrange \[m\].
    pub x: f64,
    /// Height, positive up \[m\].
    pub z: f64,
    /// Standard deviation of the white part of the error along an axis \[m\].
    pub sigma: f32,
    /// Velocity over ground at the same time, if the source measures it.
    pub velocity: Option<GroundVelocity>,
}

impl Position {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize =
        size::U32 + 2 * size::F64 + size::F32 + size::BYTE + GroundVelocity::MAX_SIZE;
}

/// A measured velocity over ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroundVelocity {
    /// Downrange \[m/s\].
    pub x: f32,
    /// Upwards \[m/s\].
    pub z: f32,
    /// Standard deviation of the error along an axis \[m/s\].
    pub sigma: f32,
}

impl GroundVelocity {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 3 * size::F32;
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
    /// Range of each beam, from `angle_min` on \[m\]; 0, infinite, not a number or beyond the lidar's reach means no return, negative a bad beam.
    pub ranges: Vec<f32, MAX_BEAMS>,
}

impl LidarScan {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + 2 * size::F32 + 2 * size::BYTE + MAX_BEAMS * size::F32;
}

/// Core to harness: the actuator command of one tick. It ends the tick: only the rejection of a scan may follow it.
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
    /// Estimated position: x downrange, z up \[m\].
    pub position: [f64; 2],
    /// Estimated velocity of the air over ground: x downrange, z up \[m/s\].
    pub wind: [f64; 2],
    /// Estimated amount by which the lift coefficient exceeds that of the known airframe \[-\].
    pub lift: f64,
    /// Reference: x downrange \[m\], z up \[m\], airspeed \[m/s\], pitch \[rad\],
    /// pitch rate \[rad/s\], flight path angle \[rad\].
    pub reference: [f64; 6],
    /// Ticks since the scan from which the present plan was made; 0 without a plan.
    pub plan_age_ticks: u32,
    /// The core's trust in its sensors.
    pub sensors: SensorStates,
}

/// The core's trust in each sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SensorStates {
    /// Airspeed.
    pub airspeed: SensorState,
    /// Pitch.
    pub pitch: SensorState,
    /// Positions.
    pub position: SensorState,
    /// Scans of the lidar.
    pub lidar: SensorState,
    /// The elevator, which is no sensor but is watched like one: suspected if it is weak and the core makes up for it,
    /// excluded while it does not answer.
    pub elevator: SensorState,
    /// The motor, likewise: excluded while it gives no thrust.
    pub motor: SensorState,
}

impl SensorStates {
    /// Size of the longest form \[bytes\].
    pub const MAX_SIZE: usize = 6 * size::BYTE;

    /// Name and state of each sensor.
    #[must_use]
    pub const fn sensors(&self) -> [(&'static str, SensorState); 4] {
        [
            ("airspeed", self.airspeed),
            ("pitch", self.pitch),
            ("position", self.position),
            ("lidar", self.lidar),
        ]
    }

    /// Name and state of each sensor and then of each actuator.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, SensorState); 6] {
        let [airspeed, pitch, position, lidar] = self.sensors();
        let elevator = ("elevator", self.elevator);
        [
            airspeed,
            pitch,
            position,
            lidar,
            elevator,
            ("motor", self.motor),
        ]
    }
}

/// The core's trust in a sensor. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SensorState {
    /// The sensor delivers good values.
    #[default]
    Healthy = 0,
    /// The last good value is some ticks old.
    Suspected = 1,
    /// The sensor delivers no good values, and its values are not used.
    Excluded = 2,
    /// The sensor delivers good values again, but not for long enough to be used.
    Recovering = 3,
}

impl fmt::Display for SensorState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Healthy => "healthy",
            Self::Suspected => "suspected",
            Self::Excluded => "excluded",
            Self::Recovering => "recovering",
        })
    }
}

impl StepReport {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 2 * size::U32 + 15 * size::F64 + SensorStates::MAX_SIZE;
}
