//! The measurements of an aircraft in space, as the messages of the link.

use super::lidar::{Beam, SpaceLidar, SpaceLidarConfig};
use super::world::{Vector, World};
use super::{Deskew, Pose, SpaceAircraft, SpaceScenario, SpaceSensors};
use crate::sensors::Measurement;
use hil_protocol::{
    AirData, InertialFrame, MAX_POINTS, Message, PointPacket, SensorFrame, SpacePosition,
};
use mpp_core::config::TICK_PERIOD;
use mpp_node::MOST_POINTS;
use std::collections::VecDeque;

/// Length of a beam without return \[m\], as the message has it.
const NO_RETURN: f64 = 0.5;
/// Number of true poses that are kept: more than the longest sweep.
const POSES: usize = 32;
/// Tick at which the first sweep ends. The core then knows its motion over all of the sweep.
const FIRST_SWEEP: u32 = 20;
/// Length of a tick \[us\].
const TICK_US: f64 = TICK_PERIOD * 1e6;

/// Attitude reference, receiver of satellites, air data and lidar.
pub(super) struct Instruments {
    sensors: SpaceSensors,
    lidar: SpaceLidar,
    deskew: Deskew,
    /// The beams of the sweep that ended in this tick.
    beams: Vec<Beam>,
    /// True poses, the last one at the end.
    poses: VecDeque<Pose>,
    replan_ticks: u32,
    /// The last measured pitch \[rad\], for the log.
    pitch: f64,
}

/// What is sent in a tick.
pub(super) struct Measured {
    pub(super) messages: Vec<Message>,
    pub(super) air: Measurement,
}

impl Instruments {
    pub(super) fn new(scenario: &SpaceScenario) -> Self {
        let plane = &scenario.plane;
        let mut lidar = SpaceLidar::new(plane.seed, scenario.lidar());
        if scenario.sees_through() {
            lidar.see_through(MOST_POINTS);
        }
        Self {
            sensors: SpaceSensors::new(plane.seed, scenario.errors()),
            lidar,
            deskew: scenario.deskew,
            beams: Vec::new(),
            poses: VecDeque::new(),
            replan_ticks: plane.replan_ticks,
            pitch: plane.aircraft.trim.state.pitch,
        }
    }

    /// The messages of a tick, in the order of the link.
    pub(super) fn measure(
        &mut self,
        tick: u32,
        aircraft: &SpaceAircraft,
        world: &World,
    ) -> Measured {
        if self.poses.len() == POSES {
            self.poses.pop_front();
        }
        self.poses.push_back(Pose::of(aircraft.state()));
        self.beams.clear();
        let sensed = self.sensors.step(aircraft);
        let mut messages = Vec::new();
        if let Some(sample) = &sensed.inertial {
            let [_, pitch, _] = sample.attitude;
            self.pitch = pitch;
            messages.push(Message::InertialFrame(InertialFrame {
                tick: tick.wrapping_sub(sample.age),
                attitude: sample.attitude.map(|it| it as f32),
                sigma: sample.sigma as f32,
                rates: sample.rates.map(|it| it as f32),
                force: sample.force.map(|it| it as f32),
            }));
        }
        if let Some(fix) = &sensed.fix {
            let velocity = fix.velocity;
            messages.push(Message::SpacePosition(SpacePosition {
                tick: tick.wrapping_sub(fix.age),
                position: fix.position,
                sigma: fix.sigma as f32,
                velocity: velocity.map(|(it, sigma)| (it.map(|it| it as f32), sigma as f32)),
            }));
        }
        let since = tick.checked_sub(FIRST_SWEEP);
        if since.is_some_and(|since| since.is_multiple_of(self.replan_ticks)) {
            self.sweep(tick, world, &mut messages);
        }
        let (airspeed, pitch) = (sensed.airspeed, self.pitch);
        messages.push(Message::SensorFrame(SensorFrame {
            tick,
            air: Some(AirData {
                tick,
                airspeed,
                pitch,
            }),
            position: None,
        }));
        Measured {
            messages,
            air: Measurement { airspeed, pitch },
        }
    }

    /// The sweep that ends at this tick, as packets.
    fn sweep(&mut self, tick: u32, world: &World, messages: &mut Vec<Message>) {
        let period = self.lidar.config().period;
        let poses = &self.poses;
        let beams = self
            .lidar
            .sweep(world, |time| pose(poses, period - time), 0.0);
        let interval = 1e6 * period / beams.len().max(1) as f64;
        for beams in beams.chunks(MAX_POINTS) {
            let age = beams.first().map_or(0.0, |beam| period - beam.time);
            let told = if self.deskew.active {
                age + self.deskew.clock
            } else {
                0.0
            };
            let time = f64::from(tick) * TICK_US - 1e6 * told;
            let point = |beam: &Beam| {
                let range = beam.range.unwrap_or(NO_RETURN);
                beam.direction.map(|part| (part * range) as f32)
            };
            messages.push(Message::PointPacket(PointPacket {
                tick: (time / TICK_US).max(0.0) as u32,
                sensor_time: time.max(0.0) as u32,
                interval: if self.deskew.active {
                    interval as u16
                } else {
                    0
                },
                points: beams.iter().map(point).collect(),
            }));
        }
        self.beams = beams;
    }

    /// Where the beams of the sweep of this tick have ended, by true poses, if there was a sweep.
    pub(super) fn returns(&self) -> Option<Vec<Vector>> {
        let SpaceLidarConfig { period, offset, .. } = *self.lidar.config();
        let ended = self.beams.iter().filter_map(|beam| {
            let (range, pose) = (beam.range?, pose(&self.poses, period - beam.time));
            Some(pose.place([0, 1, 2].map(|axis| offset[axis] + range * beam.direction[axis])))
        });
        (!self.beams.is_empty()).then(|| ended.collect())
    }
}

/// The true pose at an age \[s\]; the oldest known one beyond.
fn pose(poses: &VecDeque<Pose>, age: f64) -> Pose {
    let ticks = (age / TICK_PERIOD).max(0.0);
    let last = poses.len() - 1;
    let back = |ticks: usize| poses[last - ticks.min(last)];
    let (later, share) = (back(ticks as usize), ticks - ticks.floor());
    if share > 0.0 {
        later.towards(&back(ticks as usize + 1), share)
    } else {
        later
    }
}
