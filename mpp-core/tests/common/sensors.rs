//! Sensors without error.

use mpp_core::sense::Measurement;
use mpp_core::sense::{AirData, Position, SensorFrame};
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
