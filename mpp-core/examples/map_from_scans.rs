//! A map from scans: two scans of one disc go into the rolling occupancy grid, and the distance field tells how far a point
//! is from it.

use mpp_core::map::{DistanceField, RollingGrid};
use mpp_core::sense::LidarScan;
use mpp_core::vehicle::Pose;

/// Range of the lidar \[m\].
const SIGHT: f64 = 45.0;

/// The scan of a disc of 1 m radius at `(30, 52)` \[m\] from a pose: 100 beams of 0.01 rad, and 0 where nothing returns.
fn scan(pose: &Pose) -> LidarScan {
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-0.5, 0.01);
    for beam in 0..100 {
        let (up, ahead) = libm::sincos(pose.pitch + scan.beam_angle(beam));
        let (dx, dz) = (30.0 - pose.x, 52.0 - pose.z);
        let missed_by = ahead * dz - up * dx;
        let half_chord = libm::sqrt(1.0 - missed_by * missed_by);
        let range = (dx * ahead + dz * up - half_chord) as f32;
        // Not a number where the beam misses. A scan has room for 128 beams.
        let _ = scan.ranges.push(if range.is_nan() { 0.0 } else { range });
    }
    scan
}

fn main() {
    let mut map = Box::new(RollingGrid::new());
    for x in [0.0, 12.0] {
        let pose = Pose {
            x,
            z: 50.0,
            pitch: 0.1,
        };
        map.roll(x, 50.0);
        map.insert(&scan(&pose), SIGHT, &pose);
    }
    let mut field = Box::new(DistanceField::new());
    field.build(&map, 0.0);
    for (x, z) in [(20.0, 50.0), (27.0, 51.0), (29.1, 52.0), (40.0, 45.0)] {
        println!(
            "({x:4.1}, {z:4.1}): {:.2} m to the nearest occupied cell{}",
            field.distance(x, z),
            if field.is_unknown(x, z) {
                ", not seen"
            } else {
                ""
            }
        );
    }
    assert!(field.distance(29.1, 52.0) < 0.8 && field.distance(20.0, 50.0) > 2.5);
}
