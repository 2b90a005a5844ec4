//! Point clouds, cut to a slab about the plane of the track, as scans.

use crate::messages::{PointCloud, PointField};
use crate::scans::{NOTHING, ScanError, Sweep};
use hil_protocol::LidarScan;

/// Beams that a cloud becomes.
const BEAMS: usize = 100;
/// Angle from the lowest to the highest beam \[rad\].
const VIEW: f64 = 100.0 * core::f64::consts::PI / 180.0;
/// Half the width of the slab \[m\].
const HALF_SLAB: f64 = 0.5;
/// The number of the data type `FLOAT32`.
const FLOAT32: u8 = 7;

impl Sweep {
    /// The points of the slab, each in the beam that is next to it; of a beam the nearest one counts, and one without
    /// points has no return. The cloud is in the body's axes: x forward, y left, z up.
    ///
    /// # Errors
    /// [`ScanError`].
    pub(crate) fn of_cloud(
        cloud: &PointCloud,
        frame: &str,
        range_max: f64,
    ) -> Result<Self, ScanError> {
        if cloud.header.frame_id != frame {
            let found = cloud.header.frame_id.clone();
            return Err(ScanError::CloudFrame(found, frame.to_owned()));
        }
        let at = ["x", "y", "z"].map(|name| offset(&cloud.fields, name, cloud.point_step));
        let [Some(x), Some(y), Some(z)] = at else {
            return Err(ScanError::Fields);
        };
        let points = u64::from(cloud.width) * u64::from(cloud.height);
        if cloud.is_bigendian || cloud.data.len() as u64 != points * u64::from(cloud.point_step) {
            return Err(ScanError::Fields);
        }
        let step = VIEW / (BEAMS - 1) as f64;
        let (mut ranges, mut not_numbers) = ([NOTHING; BEAMS], 0);
        for point in cloud.data.chunks_exact(cloud.point_step as usize) {
            let [x, y, z] = [x, y, z].map(|offset| float(point, offset));
            if !(x + y + z).is_finite() {
                not_numbers += 1;
                continue;
            }
            let range = libm::hypot(x, z);
            let beam = ((libm::atan2(z, x) + 0.5 * VIEW) / step).round();
            let is_seen = libm::fabs(y) <= HALF_SLAB && range > 0.0 && range <= range_max;
            let own = ranges
                .get_mut(beam as usize)
                .filter(|_| is_seen && beam >= 0.0);
            if let Some(nearest) = own
                && (*nearest <= NOTHING || range < f64::from(*nearest))
            {
                *nearest = range as f32;
            }
        }
        Ok(Self {
            nanos: cloud.header.stamp.nanos(),
            scan: LidarScan {
                tick: 0,
                angle_min: (-0.5 * VIEW) as f32,
                angle_increment: step as f32,
                ranges: ranges.into_iter().collect(),
            },
            range_max: range_max as f32,
            // Clouds that are not dense mark beams without a return so.
            not_numbers: if cloud.is_dense { not_numbers } else { 0 },
        })
    }
}

/// Where a field of floats begins in a point.
fn offset(fields: &[PointField], name: &str, step: u32) -> Option<usize> {
    let field = fields.iter().find(|field| field.name == name)?;
    let ends = field.offset.checked_add(4)?;
    (field.datatype == FLOAT32 && ends <= step).then_some(field.offset as usize)
}

fn float(point: &[u8], offset: usize) -> f64 {
    let bytes = point.get(offset..offset + 4);
    let bytes = bytes.and_then(|bytes| bytes.try_into().ok());
    f64::from(bytes.map_or(f32::NAN, f32::from_le_bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::Header;

    fn cloud(points: &[[f32; 3]]) -> PointCloud {
        let field = |(name, offset): (&str, u32)| PointField {
            name: name.to_owned(),
            offset,
            datatype: FLOAT32,
            count: 1,
        };
        // An intensity stands before each point.
        let bytes = |point: &[f32; 3]| {
            let numbers = [7.0, point[0], point[1], point[2]];
            numbers
                .iter()
                .flat_map(|it: &f32| it.to_le_bytes())
                .collect::<Vec<u8>>()
        };
        PointCloud {
            header: Header::of(5, "lidar"),
            height: 1,
            width: points.len() as u32,
            fields: [("x", 4), ("y", 8), ("z", 12)].map(field).to_vec(),
            is_bigendian: false,
            point_step: 16,
            row_step: 16 * points.len() as u32,
            data: points.iter().flat_map(bytes).collect(),
            is_dense: true,
        }
    }

    #[test]
    fn the_nearest_point_of_the_slab_counts_in_its_direction() {
        let from = cloud(&[
            [12.0, 0.3, 12.0],
            [10.0, 0.1, 10.0],
            // Beside the slab, behind, too far, beneath the view, no number.
            [3.0, 0.8, 0.0],
            [-5.0, 0.0, 0.0],
            [60.0, 0.0, 0.0],
            [1.0, 0.0, -3.0],
            [f32::NAN, 0.0, 0.0],
        ]);
        let sweep = Sweep::of_cloud(&from, "lidar", 45.0).unwrap();
        let ranges = sweep.scan.ranges.as_slice();
        let hits: Vec<usize> = (0..BEAMS).filter(|beam| ranges[*beam] > 0.0).collect();
        assert_eq!((hits.len(), sweep.not_numbers), (1, 1));
        let angle = sweep.scan.angle_min + sweep.scan.angle_increment * hits[0] as f32;
        assert!((f64::from(angle) - core::f64::consts::FRAC_PI_4).abs() < 0.01);
        assert!((ranges[hits[0]] - 200.0_f32.sqrt()).abs() < 1e-5);
    }

    #[test]
    fn clouds_that_make_no_sense_are_refused() {
        let good = cloud(&[[1.0; 3]; 2]);
        let refused = |cloud: &PointCloud| Sweep::of_cloud(cloud, "lidar", 45.0).unwrap_err();
        for bad in [
            PointCloud {
                width: 3,
                ..good.clone()
            },
            PointCloud {
                fields: Vec::new(),
                ..good.clone()
            },
            PointCloud {
                is_bigendian: true,
                ..good.clone()
            },
            PointCloud {
                point_step: 8,
                width: 4,
                ..good.clone()
            },
            PointCloud {
                point_step: 0,
                width: 0,
                ..good.clone()
            },
        ] {
            assert_eq!(refused(&bad), ScanError::Fields);
        }
        let other = PointCloud {
            header: Header::of(0, "map"),
            ..good
        };
        assert!(matches!(refused(&other), ScanError::CloudFrame(..)));
    }
}
