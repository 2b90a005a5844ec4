//! Scans as ROS sends them, to scans as the core takes them.

use crate::messages::LaserScan;
use hil_protocol::{LidarScan, MAX_BEAMS};

/// A scan that the core can take, without its tick.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sweep {
    /// When it was taken \[ns\].
    pub(crate) nanos: i64,
    /// The scan.
    pub(crate) scan: LidarScan,
    /// Longest range of the lidar \[m\].
    pub(crate) range_max: f32,
    /// Ranges that were no numbers.
    pub(crate) not_numbers: usize,
}

/// Why a scan is not used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum ScanError {
    /// It is in another frame.
    #[error(
        "the frame is `{0}`, not `{1}`, x forward and y up in the plane of the track: turn the scan, or set scan_frame"
    )]
    Frame(String, String),
    /// A cloud is in another frame.
    #[error(
        "the frame is `{0}`, not `{1}`, x forward, y left and z up in the body: turn the cloud, or set cloud_frame"
    )]
    CloudFrame(String, String),
    /// A cloud is not made of floats x, y and z.
    #[error(
        "the cloud needs fields x, y and z of FLOAT32, little-endian, and as many bytes as points"
    )]
    Fields,
    /// A number of its head makes no sense.
    #[error("angles, range_min or range_max make no sense: check the lidar's driver")]
    Head,
    /// Angles and ranges do not fit together.
    #[error("{0} ranges came, but the angles are for {1}: check the lidar's driver")]
    Beams(usize, i64),
    /// Too few beams look ahead.
    #[error("{0} beams look ahead: at least 2 must")]
    Few(usize),
}

impl ScanError {
    /// The kind of the complaint.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Frame(..) | Self::CloudFrame(..) => "scan frame",
            Self::Fields => "scan fields",
            Self::Head => "scan head",
            Self::Beams(..) | Self::Few(_) => "scan beams",
        }
    }
}

impl Sweep {
    /// The part of a scan that looks ahead, within 90 deg. If it has more beams than the core takes, each of its beams stands
    /// for some neighbours, and has the range of the nearest of them.
    ///
    /// # Errors
    /// [`ScanError`].
    pub(crate) fn of(from: &LaserScan, frame: &str) -> Result<Self, ScanError> {
        if from.header.frame_id != frame {
            let found = from.header.frame_id.clone();
            return Err(ScanError::Frame(found, frame.to_owned()));
        }
        let [first, step, last] =
            [from.angle_min, from.angle_increment, from.angle_max].map(f64::from);
        let steps = (last - first) / step;
        let is_sane = steps.is_finite()
            && step.abs() > 1e-6
            && from.range_min >= 0.0
            && from.range_max > from.range_min
            && from.range_max.is_finite();
        if !is_sane {
            return Err(ScanError::Head);
        }
        let wanted = steps.round() as i64 + 1;
        if wanted.abs_diff(from.ranges.len() as i64) > 1 {
            return Err(ScanError::Beams(from.ranges.len(), wanted));
        }
        let mut beams: Vec<(f64, f32)> = (0..)
            .zip(&from.ranges)
            .map(|(beam, range)| (first + step * f64::from(beam), *range))
            .filter(|(angle, _)| angle.abs() <= core::f64::consts::FRAC_PI_2)
            .collect();
        if step < 0.0 {
            beams.reverse();
        }
        if beams.len() < 2 {
            return Err(ScanError::Few(beams.len()));
        }
        let together = beams.len().div_ceil(MAX_BEAMS);
        let groups = beams.chunks_exact(together);
        let ranges = groups.map(|group| nearest(group, from)).collect();
        let half = 0.5 * (together - 1) as f64;
        let angle_min = beams.first().map_or(0.0, |(angle, _)| *angle) + half * step.abs();
        Ok(Self {
            nanos: from.header.stamp.nanos(),
            scan: LidarScan {
                tick: 0,
                angle_min: angle_min as f32,
                angle_increment: (step.abs() * together as f64) as f32,
                ranges,
            },
            range_max: from.range_max,
            not_numbers: beams.iter().filter(|(_, range)| range.is_nan()).count(),
        })
    }
}

/// A beam that is not to be believed.
const BAD: f32 = -1.0;
/// Nothing came back.
pub(crate) const NOTHING: f32 = 0.0;

/// The range of some neighbours: the least that came back; otherwise nothing, if one beam says so.
fn nearest(group: &[(f64, f32)], from: &LaserScan) -> f32 {
    group.iter().fold(BAD, |nearest, (_, range)| {
        let own = of_beam(*range, from);
        match (nearest > 0.0, own > 0.0) {
            (true, true) => nearest.min(own),
            (true, false) => nearest,
            (false, true) => own,
            (false, false) => nearest.max(own),
        }
    })
}

/// A range by REP-117: plus infinite is no return, minus infinite is too close to be measured, no number is an error.
fn of_beam(range: f32, from: &LaserScan) -> f32 {
    if range == f32::NEG_INFINITY {
        from.range_min.max(0.01)
    } else if range > from.range_max {
        NOTHING
    } else if range >= from.range_min && range > 0.0 {
        range
    } else {
        BAD
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::Header;

    fn scan(beams: usize, first: f32, last: f32) -> LaserScan {
        LaserScan {
            header: Header::of(5, "it"),
            angle_min: first,
            angle_max: last,
            angle_increment: (last - first) / (beams - 1) as f32,
            range_min: 0.5,
            range_max: 30.0,
            ranges: vec![10.0; beams],
            ..LaserScan::default()
        }
    }

    #[test]
    fn ranges_mean_what_rep_117_says() {
        let mut from = scan(7, -0.6, 0.6);
        from.ranges = vec![
            10.0,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
            0.2,
            31.0,
            0.0,
        ];
        let sweep = Sweep::of(&from, "it").unwrap();
        let ranges = [10.0, NOTHING, 0.5, BAD, BAD, NOTHING, BAD];
        assert_eq!(sweep.scan.ranges.as_slice(), ranges);
        assert_eq!((sweep.nanos, sweep.not_numbers), (5, 1));
    }

    #[test]
    fn a_scan_from_above_is_the_same_as_one_from_beneath() {
        let (mut up, mut down) = (scan(10, -0.4, 0.5), scan(10, 0.5, -0.4));
        up.ranges[0] = 3.0;
        down.ranges[9] = 3.0;
        let [up, down] = [up, down].map(|it| Sweep::of(&it, "it").unwrap().scan);
        assert_eq!(up.ranges, down.ranges);
        assert!((up.angle_min - down.angle_min).abs() < 1e-6);
        assert!((up.angle_increment - down.angle_increment).abs() < 1e-6);
    }

    #[test]
    fn of_a_whole_turn_the_front_is_kept_and_the_nearest_of_neighbours() {
        let pi = core::f32::consts::PI;
        let mut from = scan(1441, -pi, pi);
        // Straight ahead, and behind.
        from.ranges[721] = 4.0;
        from.ranges[0] = 1.0;
        let scan = Sweep::of(&from, "it").unwrap().scan;
        assert_eq!(scan.ranges.len(), 120);
        let nearest = scan.ranges.iter().position(|range| *range < 5.0).unwrap();
        let angle = scan.angle_min + scan.angle_increment * nearest as f32;
        assert!(angle.abs() < 0.02 && (scan.ranges[nearest] - 4.0).abs() < 1e-6);
        assert!(scan.ranges.iter().all(|range| *range > 3.0));
    }

    #[test]
    fn scans_that_make_no_sense_are_refused() {
        let good = scan(10, -0.4, 0.5);
        assert!(matches!(
            Sweep::of(&good, "lidar"),
            Err(ScanError::Frame(..))
        ));
        let with = |change: fn(&mut LaserScan)| {
            let mut bad = good.clone();
            change(&mut bad);
            Sweep::of(&bad, "it").unwrap_err()
        };
        assert_eq!(with(|it| it.angle_min = f32::NAN), ScanError::Head);
        assert_eq!(with(|it| it.angle_increment = 0.0), ScanError::Head);
        assert_eq!(with(|it| it.range_max = f32::INFINITY), ScanError::Head);
        assert_eq!(with(|it| it.ranges.truncate(5)), ScanError::Beams(5, 10));
        let behind = scan(10, 2.0, 3.0);
        assert_eq!(Sweep::of(&behind, "it"), Err(ScanError::Few(0)));
    }
}
