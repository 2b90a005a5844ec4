//! Where a scan was made.

use super::VehicleState;
use crate::tuning::scan_match::AGES;

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

/// Where the lidar was at the stamp of a scan, and earlier by each age that a stamp may hide.
pub type ScanPoses = [Pose; AGES];

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
