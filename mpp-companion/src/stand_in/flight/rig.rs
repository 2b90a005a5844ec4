//! The lidar of the stand-in, as each source sends it.

use crate::lidar::{Mounting, ScanSource};
use crate::stand_in::StandIn;
use crate::wire::{Mav, Sender};
use hil_protocol::{MAX_FRAME, Message, encode};
use mavlink::dialects::common::{MavFrame, OBSTACLE_DISTANCE_DATA};
use mpp_sim::field::Field;
use mpp_sim::lidar::{FanLidar, Lidar, LidarConfig};

/// Distances of `OBSTACLE_DISTANCE`.
const STEPS: usize = 72;
/// Rays to a distance.
const RAYS: usize = 4;
/// Time from one datagram of the Mid-360 to the next \[us\]. The real one sends ten times as many.
const SPAN: u64 = 5000;
/// Points of a datagram.
const POINTS: usize = 96;
/// One in so many points lies in the plane.
const IN_PLANE: usize = 6;
/// The part of a turn that leads on to new directions for ever: a pattern that does not repeat.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The lidar and its counters.
pub(super) struct Rig {
    source: ScanSource,
    lidar: FanLidar,
    config: LidarConfig,
    sender: Sender,
    sent: u64,
    rays: u32,
}

impl Rig {
    pub(super) fn new(source: ScanSource, seed: u64, config: LidarConfig) -> Self {
        let beams = match source {
            ScanSource::Frames => config.beams,
            ScanSource::Obstacles(_) => RAYS * STEPS,
            ScanSource::Livox(..) => 1,
        };
        let fan = if beams == 1 {
            0.0
        } else {
            config.field_of_view
        };
        let own = LidarConfig {
            beams,
            field_of_view: fan,
            ..config
        };
        Self {
            source,
            lidar: FanLidar::new(seed, own),
            config,
            sender: Sender::new(1, 196),
            sent: 0,
            rays: 0,
        }
    }

    /// The datagrams of a tick.
    pub(super) fn sends(&mut self, autopilot: &StandIn, field: &dyn Field) -> Vec<Vec<u8>> {
        let (state, scans) = (autopilot.state(), autopilot.tick.is_multiple_of(10));
        match self.source {
            ScanSource::Frames if scans => {
                let scan = self.config.wire_scan(0, &self.lidar.scan(&state, field));
                let mut buffer = [0; MAX_FRAME];
                let frame = encode(&Message::LidarScan(scan), &mut buffer);
                frame.map(|frame| vec![frame.to_vec()]).unwrap_or_default()
            }
            ScanSource::Obstacles(_) if scans => vec![self.distances(autopilot, field)],
            ScanSource::Livox(mounting, _) => (0..2)
                .map(|_| self.points(autopilot, mounting, field))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// A sensor on its right side: clockwise, as seen from its top, is down.
    fn distances(&mut self, autopilot: &StandIn, field: &dyn Field) -> Vec<u8> {
        let ranges = self.lidar.scan(&autopilot.state(), field);
        let mut distances = [0; STEPS];
        for (distance, rays) in distances.iter_mut().zip(ranges.rchunks(RAYS)) {
            let met = rays.iter().copied().filter(|range| *range > 0.0);
            *distance = met
                .reduce(f32::min)
                .map_or(u16::MAX - 1, |it| (100.0 * it) as u16);
        }
        let fan = self.config.field_of_view.to_degrees() as f32;
        let step = fan / STEPS as f32;
        self.sender
            .frame(&Mav::OBSTACLE_DISTANCE(OBSTACLE_DISTANCE_DATA {
                time_usec: 10_000 * u64::from(autopilot.tick) + 1,
                distances,
                max_distance: (100.0 * self.config.farthest()) as u16,
                increment_f: step,
                angle_offset: 0.5 * (step - fan),
                frame: MavFrame::MAV_FRAME_BODY_FRD,
                ..OBSTACLE_DISTANCE_DATA::DEFAULT
            }))
    }

    fn points(&mut self, autopilot: &StandIn, mounting: Mounting, field: &dyn Field) -> Vec<u8> {
        let body = autopilot.attitude();
        let mut points = vec![point([0.0; 3], 0); POINTS];
        for one in points.iter_mut().step_by(IN_PLANE) {
            let mut turned = autopilot.state();
            let turn = (GOLDEN * f64::from(self.rays)).fract() - 0.5;
            turned.air.pitch += turn * self.config.field_of_view;
            self.rays = self.rays.wrapping_add(1);
            let ranges = self.lidar.scan(&turned, field);
            let range = ranges.first().copied().map_or(0.0, f64::from);
            let (up, ahead) = libm::sincos(turned.air.pitch);
            let seen = body.back([range * ahead, 0.0, -range * up]);
            *one = point(mounting.rotation().back(seen), 0);
        }
        let taken = 1000 * SPAN * self.sent;
        self.sent += 1;
        datagram(self.sent as u16, taken, 1, &points)
    }
}

/// A point of 32 bits at a place ahead, to the right and down of the sensor \[m\].
pub(crate) fn point([x, y, z]: [f64; 3], tag: u8) -> Vec<u8> {
    let place = [x, -y, -z].map(|it| (1e3 * it).round() as i32);
    let place = place.iter().flat_map(|it| it.to_le_bytes());
    place.chain([90, tag]).collect()
}

/// A datagram of points that were taken from a time on \[ns\]. It has no checksum.
pub(crate) fn datagram(count: u16, taken: u64, data_type: u8, points: &[Vec<u8>]) -> Vec<u8> {
    let (data, number) = (points.concat(), points.len() as u64);
    let interval = 10 * SPAN * number.saturating_sub(1).max(1) / number.max(1);
    let mut bytes = vec![0];
    for field in [
        36 + data.len() as u16,
        interval as u16,
        number as u16,
        count,
    ] {
        bytes.extend(field.to_le_bytes());
    }
    // Number of the frame, type of the data, type of the time, reserved, checksum.
    bytes.extend([0, data_type, 0]);
    bytes.extend([0; 12 + 4]);
    bytes.extend(taken.to_le_bytes());
    bytes.extend(data);
    bytes
}
