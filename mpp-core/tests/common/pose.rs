//! Poses in one line.

use mpp_core::vehicle::Pose;

pub(crate) fn pose(x: f64, z: f64, pitch: f64) -> Pose {
    Pose { x, z, pitch }
}
