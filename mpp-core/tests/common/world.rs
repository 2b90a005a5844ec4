//! A world of discs, and a lidar that scans it.

use mpp_core::config::MAX_BEAMS;
use mpp_core::sense::LidarScan;
use mpp_core::vehicle::VehicleState;

/// A disc: centre `(x, z)` and radius \[m\].
pub(crate) type Disc = (f64, f64, f64);

/// Greatest range of the lidar \[m\].
pub(crate) const SIGHT: f64 = 50.0;
const BEAMS: usize = 100;
const _: () = assert!(BEAMS <= MAX_BEAMS);

/// A scan of 100 beams over 100 degrees, without noise.
pub(crate) fn scan(discs: &[Disc], state: &VehicleState) -> LidarScan {
    let mut scan = LidarScan::new();
    let degree = core::f64::consts::PI / 180.0;
    scan.angle_min = -50.0 * degree;
    scan.angle_increment = degree;
    for beam in 0..BEAMS {
        let angle = state.air.pitch + scan.angle_min + degree * beam as f64;
        let (sin, cos) = libm::sincos(angle);
        let nearest = discs
            .iter()
            .filter_map(|(x, z, radius)| {
                let (dx, dz) = (x - state.x, z - state.z);
                let along = dx * cos + dz * sin;
                let across = dz * cos - dx * sin;
                let half_chord_squared = radius * radius - across * across;
                (half_chord_squared >= 0.0).then(|| along - libm::sqrt(half_chord_squared))
            })
            .filter(|range| (0.0..SIGHT).contains(range))
            .fold(f64::INFINITY, f64::min);
        let _ = scan.ranges.push(if nearest.is_finite() {
            nearest as f32
        } else {
            0.0
        });
    }
    scan
}

/// Distance from a point to the nearest surface; negative within a disc.
pub(crate) fn clearance(discs: &[Disc], x: f64, z: f64) -> f64 {
    discs
        .iter()
        .map(|(at_x, at_z, radius)| libm::hypot(x - at_x, z - at_z) - radius)
        .fold(f64::INFINITY, f64::min)
}
