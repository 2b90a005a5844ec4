//! The points between two sensor frames, and the clock of their sensor.

use core::ops::Range;
use hil_protocol::{PointPacket, RejectionCause};
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::SpaceEstimator;
use mpp_core::map::SpaceBeam;

/// Most points between two sensor frames. A sweep of 90 x 16 beams has 1,440.
pub const MOST_POINTS: usize = 2048;

/// Length of a beam without return, and how far off it may be \[m\].
const NO_RETURN: f64 = 0.5;
const ROUNDING: f64 = 1e-3;
/// Length of a tick \[us\].
const TICK_US: u32 = (TICK_PERIOD * 1e6) as u32;

/// A point as it came.
#[derive(Clone, Copy)]
pub(super) struct Point {
    /// In body axes \[m\].
    at: [f32; 3],
    /// By the clock of the sensor \[us\].
    time: u32,
}

/// The points since the last sensor frame, and the clock of their sensor.
pub(super) struct Sweep {
    points: heapless::Vec<Point, { MOST_POINTS }>,
    /// The least time of the sensor's clock beyond that of the ticks \[us\]: a packet bears the tick in which it begins.
    clock: Option<u32>,
}

impl Sweep {
    pub(super) const fn new() -> Self {
        Self {
            points: heapless::Vec::new(),
            clock: None,
        }
    }

    /// Forgets points and clock.
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.clock = None;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Takes a packet.
    pub(super) fn take(&mut self, packet: &PointPacket) -> Result<(), RejectionCause> {
        let found = packet.points.len();
        let room = self.points.capacity() - self.points.len();
        if found == 0 || found > room {
            let [expected, found] = [room, found].map(|it| u16::try_from(it).unwrap_or(u16::MAX));
            return Err(RejectionCause::ScanLength { expected, found });
        }
        let whole = |point: &[f32; 3]| {
            let square: f32 = point.iter().map(|it| it * it).sum();
            square.is_finite() && square > 0.0
        };
        if let Some(beam) = packet.points.iter().position(|point| !whole(point)) {
            let beam = beam as u16;
            return Err(RejectionCause::ScanNotFinite { beam });
        }
        let begun = packet.tick.wrapping_mul(TICK_US);
        let ahead = packet.sensor_time.wrapping_sub(begun);
        let less = |known: u32| ahead.wrapping_sub(known).cast_signed() < 0;
        if self.clock.is_none_or(less) {
            self.clock = Some(ahead);
        }
        let mut time = packet.sensor_time;
        for at in &packet.points {
            // There is room, as counted above.
            let _ = self.points.push(Point { at: *at, time });
            time = time.wrapping_add(u32::from(packet.interval));
        }
        Ok(())
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// Points as seen from the present position, each by the pose of its own time, all or only those that have hit. A point whose
    /// pose is not known shows nothing.
    pub(super) fn beams<'a>(
        &'a self,
        tick: u32,
        estimator: &'a SpaceEstimator,
        points: Range<usize>,
        hits: bool,
    ) -> impl Iterator<Item = SpaceBeam> + 'a {
        let known = estimator.position().zip(self.clock);
        let points = self.points.get(points).unwrap_or(&[]);
        points.iter().filter_map(move |point| {
            let (origin, clock) = known?;
            let at = point.at.map(f64::from);
            let length = libm::sqrt(at.iter().map(|it| it * it).sum());
            let answered = libm::fabs(length - NO_RETURN) > ROUNDING;
            if hits && !answered {
                return None;
            }
            let now = tick.wrapping_mul(TICK_US).wrapping_add(clock);
            let age = f64::from(now.wrapping_sub(point.time).cast_signed()) * 1e-6;
            let pose = estimator.pose(age)?;
            let direction = at.map(|it| it / length);
            Some(pose.beam(direction, answered.then_some(length), &origin))
        })
    }

    /// Forgets the points, but not the clock.
    pub(super) fn clear_points(&mut self) {
        self.points.clear();
    }
}
