//! The map: a grid of what the scans have shown, and the distances in it.
//!
//! | type | content |
//! |---|---|
//! | [`RollingGrid`] | the rolling occupancy grid: log-odds of earlier scans |
//! | [`ScanMonitor`] | whether a scan agrees with the one before it |
//! | [`VoxelGrid`], [`VoxelField`] | the same in space |
//! | [`DistanceField`] | the truncated distance field \(ESDF\): from a point to the nearest centre of an occupied cell of the grid |

pub(crate) mod cell;
mod distance_field;
mod evidence;
mod extent;
mod fan;
mod level_grid;
mod near_slices;
mod rolling_grid;
mod scan_age;
mod scan_fit;
mod scan_monitor;
mod upright;
pub(crate) mod voxel_field;
pub(crate) mod voxels;
mod walk;

pub use distance_field::{DistanceField, FAR};
pub(crate) use distance_field::{Height, split};
pub(crate) use fan::sees_below;
pub(crate) use rolling_grid::has_return;
pub use rolling_grid::{IsolatedHits, RollingGrid};
pub use scan_fit::{Prediction, Predictions};
pub use scan_monitor::{ScanMonitor, ScanVerdict};
pub(crate) use upright::{Storey, Upright};
pub use voxel_field::{MOST_CLEARANCE, VoxelField};
pub use voxels::{CELLS, VoxelGrid};
pub use walk::SpaceBeam;

#[cfg(test)]
mod tests {
    use super::cell::rounded_down;
    use super::{DistanceField, FAR, RollingGrid};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn rounding_down_is_the_floor() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let near = [0.0, 1.0, -1.0, 2_147_483_648.0, -2_147_483_648.0].map(f64::to_bits);
        for round in 0..200_000_u64 {
            // All patterns of bits, values of maps, and neighbours of whole numbers and of the ends.
            let bits = random.next_u64();
            let value = match round % 3 {
                0 => f64::from_bits(bits),
                1 => (bits >> 11) as f64 / (1_u64 << 41) as f64 - 2048.0,
                _ => f64::from_bits(
                    near[(bits % 5) as usize]
                        .wrapping_add((bits >> 8) % 9)
                        .wrapping_sub(4),
                ),
            };
            assert_eq!(rounded_down(value), libm::floor(value) as i32, "{value:e}");
        }
    }

    #[test]
    fn a_column_is_the_field_at_its_place() {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let mut map = RollingGrid::new();
        map.roll(100.0, 50.0);
        map.know(|x, z| (x * 7.0 + z * 3.0) as i64 % 23 == 0);
        map.roll(108.0, 52.0);
        let mut field = DistanceField::new();
        field.build(&map, 0.3);
        let (mut unknown, mut distant) = (0, 0);
        for _ in 0..2000 {
            let mut between = |least: f64, most: f64| {
                least + (most - least) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
            };
            let (x, z) = (between(95.0, 175.0), between(30.0, 75.0));
            let (column, height) = (field.column(x, true), field.height(z));
            assert!((column.distance(&height) - field.distance(x, z)).abs() < 1e-12);
            assert_eq!(column.is_unknown(&height), field.is_unknown(x, z));
            assert!(!column.is_far(&height) || (field.distance(x, z) - (FAR - 0.3)).abs() < 1e-12);
            distant += u32::from(column.is_far(&height));
            unknown += u32::from(column.is_unknown(&height));
        }
        assert!(unknown > 100, "{unknown} points were unknown");
        assert!(distant > 100, "{distant} points were far");
    }
}
