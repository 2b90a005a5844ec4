//! Returns of a lidar that sees in space, and the slice of them about the vertical plane of the course.

use super::mounting::Rotation;
use hil_protocol::{LidarScan, MAX_BEAMS};

/// The fan of a scan \[rad\], centred on the body axis.
pub(crate) const FAN: f64 = 100.0 * std::f64::consts::PI / 180.0;
/// The least range of a scan \[m\]: 0 means no return.
const NEAREST: f64 = 0.01;

/// Attitude and speed of the aircraft against the course.
#[derive(Clone, Debug)]
pub(crate) struct Pose {
    /// From the body to the level frame of the course: ahead, right, down.
    pub(crate) attitude: Rotation,
    /// Nose-up positive \[rad\].
    pub(crate) pitch: f64,
    /// Speed along the course and upwards [m/s].
    pub(crate) velocity: [f64; 2],
}

impl Pose {
    /// Level flight that stands still.
    pub(crate) const LEVEL: Self = Self {
        attitude: Rotation::NONE,
        pitch: 0.0,
        velocity: [0.0; 2],
    };
}

/// The aircraft and the scan that it wants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    /// Radius of the aircraft \[m\]: so near to the middle returns are its own, and so near to the plane they count.
    pub(crate) body: f64,
    /// Longest range \[m\].
    pub(crate) range: f64,
    /// Beams.
    pub(crate) beams: usize,
}

/// The returns near the vertical plane of the course.
#[derive(Debug)]
pub(crate) struct Slice {
    /// From the sensor's axes (ahead, right, down) to the body's.
    pub(crate) mounting: Rotation,
    /// Tangent of the angle within which returns count.
    pub(crate) within: f64,
    /// Least and greatest elevation that the sensor sees, by its own axes \[rad\].
    pub(crate) sees: [f64; 2],
    /// Whether the sensor tells of each direction in which it sees nothing.
    pub(crate) tells: bool,
    pub(crate) wanted: Wanted,
    /// When each return was taken \[us\]; then along the course and upwards, from where the aircraft was \[m\].
    pub(crate) returns: Vec<(u64, [f64; 2])>,
}

impl Slice {
    /// Angle from one beam to the next \[rad\].
    pub(crate) fn step(&self) -> f64 {
        FAN / self.wanted.beams.saturating_sub(1).max(1) as f64
    }

    /// Takes a return by the sensor's axes \[m\].
    pub(crate) fn add(&mut self, at: u64, pose: &Pose, seen: [f64; 3]) {
        let [ahead, right, down] = pose.attitude.of(self.mounting.of(seen));
        let reach = libm::hypot(ahead, down);
        if reach > self.wanted.body && right.abs() <= self.wanted.body.max(self.within * reach) {
            self.returns.push((at, [ahead, -down]));
        }
    }

    /// Whether the sensor sees into a direction of the plane, by the angle against the body axis \[rad\].
    fn sees(&self, pose: &Pose, angle: f64) -> bool {
        let (up, ahead) = libm::sincos(angle + pose.pitch);
        let body = pose.attitude.back([ahead, 0.0, -up]);
        let [.., down] = self.mounting.back(body);
        let [least, most] = self.sees;
        (least..=most).contains(&libm::asin(-down.clamp(-1.0, 1.0)))
    }

    /// The angles of the beams \[rad\].
    fn angles(&self) -> impl Iterator<Item = f64> {
        let step = self.step();
        (0..self.wanted.beams).map(move |beam| step * beam as f64 - 0.5 * FAN)
    }

    /// How many beams the sensor sees in level flight.
    pub(crate) fn seen(&self) -> usize {
        let seen = |angle: &f64| self.sees(&Pose::LEVEL, *angle);
        self.angles().filter(seen).count()
    }

    /// The scan of an aircraft with this pose at this time. A return counts for the two beams about it, so that no beam
    /// between two returns of an obstacle looks free.
    pub(crate) fn scan(&self, now: u64, pose: &Pose) -> LidarScan {
        let free = |angle| (!self.tells && self.sees(pose, angle)).then_some(f64::INFINITY);
        let mut nearest: Vec<Option<f64>> = self.angles().map(free).collect();
        for (at, place) in &self.returns {
            let since = 1e-6 * (now as f64 - *at as f64);
            let [ahead, up] = [0, 1].map(|axis| place[axis] - since * pose.velocity[axis]);
            let angle = libm::atan2(up, ahead) - pose.pitch;
            let beam = (angle + 0.5 * FAN) / self.step();
            let range = libm::hypot(ahead, up).max(NEAREST);
            for about in [beam.floor(), beam.ceil()] {
                let index = (about >= 0.0).then_some(about as usize);
                if let Some(known) = index.and_then(|index| nearest.get_mut(index)) {
                    *known = Some(known.map_or(range, |known| known.min(range)));
                }
            }
        }
        let told = |range: Option<f64>| match range {
            None => -1.0,
            Some(range) if range > self.wanted.range => 0.0,
            Some(range) => range as f32,
        };
        LidarScan {
            tick: 0,
            angle_min: (-0.5 * FAN) as f32,
            angle_increment: self.step() as f32,
            ranges: nearest.into_iter().map(told).take(MAX_BEAMS).collect(),
        }
    }
}
