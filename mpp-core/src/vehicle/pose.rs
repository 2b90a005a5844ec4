//! Where a scan was made.

use super::VehicleState;

/// Position and pitch of the aircraft at a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Downrange position \[m\].
    pub x: f64,
    /// Height \[m\].
    pub z: f64,
    /// Pitch of the body axis \[rad\].
    pub pitch: f64,
}

impl Pose {
    /// The pose of a vehicle.
    #[must_use]
    pub fn of(state: &VehicleState) -> Self {
        Self {
            x: state.x,
            z: state.z,
            pitch: state.air.pitch,
        }
    }
}
