//! Sensors without error.

use mpp_core::estimate::Measurement;
use mpp_core::sense::SensorFrame;
use mpp_core::vehicle::VehicleState;

/// The frame that the sensors read.
pub(crate) fn frame(state: &VehicleState) -> SensorFrame {
    SensorFrame {
        measurement: Measurement {
            airspeed: state.air.airspeed,
            pitch: state.air.pitch,
        },
        x: state.x,
        z: state.z,
    }
}
