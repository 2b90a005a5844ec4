//! The least distance of a flight from obstacles.

use crate::common::world::Disc;

/// Distance from a point to the nearest surface; negative within a disc.
pub(crate) fn clearance(discs: &[Disc], x: f64, z: f64) -> f64 {
    discs
        .iter()
        .map(|(at_x, at_z, radius)| libm::hypot(x - at_x, z - at_z) - radius)
        .fold(f64::INFINITY, f64::min)
}
