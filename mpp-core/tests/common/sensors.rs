//! Sensors without error.

use mpp_core::sense::{AirData, Measurement, Position, SensorFrame};
use mpp_core::vehicle::VehicleState;

/// The frame that the sensors read.
pub(crate) fn frame(state: &VehicleState) -> SensorFrame {
    let measurement = Measurement {
        airspeed: state.air.airspeed,
        pitch: state.air.pitch,
    };
    SensorFrame {
        air: Some(AirData {
            age: 0,
            measurement,
        }),
        position: Some(Position {
            age: 0,
            x: state.x,
            z: state.z,
            sigma: 0.0,
            velocity: None,
        }),
    }
}

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
