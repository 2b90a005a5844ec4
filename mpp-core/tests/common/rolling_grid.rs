//! Rolling grids, built from scans.

use crate::common::draw::Draw;
use mpp_core::map::{DistanceField, RollingGrid};
use mpp_core::sense::LidarScan;
use mpp_core::vehicle::Pose;

/// A scan of 100 beams over 100 degrees. Ten beams at a time see an arc at a random range, or
/// nothing.
pub(crate) fn noise(draw: &mut Draw) -> LidarScan {
    let degree = core::f64::consts::PI / 180.0;
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-50.0 * degree, degree);
    let mut range = 0.0;
    for beam in 0..100 {
        if beam % 10 == 0 {
            range = draw.between(-20.0, 45.0).max(0.0) as f32;
        }
        assert!(scan.ranges.push(range).is_ok());
    }
    scan
}

/// A map that took in this number of such scans about `(x, 50)`.
pub(crate) fn random_map(draw: &mut Draw, x: f64, scans: usize) -> RollingGrid {
    let mut map = RollingGrid::new();
    map.roll(x, 50.0);
    for _ in 0..scans {
        let (z, pitch) = (draw.between(42.0, 58.0), draw.between(-0.3, 0.3));
        map.insert(&noise(draw), 45.0, &pose(x, z, pitch));
    }
    map
}

/// The distance field of a map.
pub(crate) fn field(map: &RollingGrid) -> DistanceField {
    let mut field = DistanceField::new();
    field.build(map, 0.0);
    field
}

pub(crate) fn pose(x: f64, z: f64, pitch: f64) -> Pose {
    Pose { x, z, pitch }
}
