//! Sensors that never repeat a value.

use super::sensors::frame;
use mpp_core::sense::SensorFrame;
use mpp_core::vehicle::VehicleState;

/// Exact sensors, but for the last digits: values that repeat to the last bit count as missing.
pub(crate) fn lively(state: &VehicleState, tick: u32) -> SensorFrame {
    let mut frame = frame(state);
    let last_digits = 1e-9 * f64::from(tick % 2);
    if let Some(air) = &mut frame.air {
        air.measurement.airspeed += last_digits;
        air.measurement.pitch += last_digits;
    }
    frame
}
