//! What a flight knows of its motion: the core's estimator behind sensors with errors, or the truth.

use super::lidar::Beam;
use super::sensors::{SensorErrors, SpaceSensors, true_motion};
use super::{Pose, SpaceAircraft};
use mpp_core::config::TICK_PERIOD;
use mpp_core::control::SpaceMotion;
use mpp_core::estimate::{SpaceEstimator, SpacePose};
use mpp_core::map::SpaceBeam;
use mpp_core::vehicle::{LateralAirframe, LateralControl, SpaceModel};
use std::collections::VecDeque;

/// Number of true poses that are kept: the longest sweep and a clock that is wrong.
const POSES: usize = 32;

/// How beams find their poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deskew {
    /// Whether each beam has the pose of its own time; otherwise all of a sweep have that of its end.
    pub active: bool,
    /// Error of the lidar's clock \[s\]; beams seem so much older than they are.
    pub clock: f64,
}

impl Deskew {
    /// Each beam at its own time, by a clock that is right.
    pub const RIGHT: Self = Self {
        active: true,
        clock: 0.0,
    };
}

/// The motion as the flight knows it.
#[derive(Clone, Debug)]
pub(super) struct Navigator {
    /// Without sensors the truth is known.
    sensed: Option<Box<(SpaceSensors, SpaceEstimator)>>,
    /// The steady wind, for who knows the truth [m/s].
    steady: [f64; 3],
    deskew: Deskew,
    /// True poses, the last one at the end.
    poses: VecDeque<Pose>,
    /// The true motion of this tick, for who knows it.
    truth: Option<SpaceMotion>,
}

impl Navigator {
    pub(super) fn new(
        seed: u64,
        errors: Option<SensorErrors>,
        aircraft: (&SpaceModel, &LateralAirframe),
        steady: [f64; 3],
        deskew: Deskew,
    ) -> Self {
        let (model, lateral) = aircraft;
        let sensed = errors.map(|errors| {
            let sensors = SpaceSensors::new(seed, errors);
            Box::new((sensors, SpaceEstimator::new(model, lateral)))
        });
        Self {
            sensed,
            steady,
            deskew,
            poses: VecDeque::new(),
            truth: None,
        }
    }

    /// Takes what the sensors tell in this tick, with the last command to the surfaces.
    pub(super) fn step(&mut self, aircraft: &SpaceAircraft, surfaces: &LateralControl) {
        if self.poses.len() == POSES {
            self.poses.pop_front();
        }
        self.poses.push_back(Pose::of(aircraft.state()));
        self.truth = Some(true_motion(aircraft, &self.steady));
        if let Some(sensed) = &mut self.sensed {
            let (sensors, estimator) = sensed.as_mut();
            let told = sensors.step(aircraft);
            estimator.predict(told.inertial.as_ref());
            estimator.observe_airspeed(Some(told.airspeed), surfaces);
            estimator.observe_fix(told.fix.as_ref());
        }
    }

    /// The motion through air that moves with a wind [m/s].
    pub(super) fn motion_in(&self, wind: &[f64; 3]) -> Option<SpaceMotion> {
        match &self.sensed {
            Some(sensed) => sensed.1.motion_in(wind),
            None => self.truth,
        }
    }

    /// The wind for plans [m/s].
    pub(super) fn wind(&self) -> [f64; 3] {
        self.sensed.as_ref().map_or(self.steady, |it| it.1.wind())
    }

    /// The estimator, if there is one.
    pub(super) fn estimator(&self) -> Option<&SpaceEstimator> {
        self.sensed.as_ref().map(|it| &it.1)
    }

    /// Whether the poses of a whole sweep are known.
    pub(super) fn covers(&self, sweep: f64) -> bool {
        self.poses.len() as f64 * TICK_PERIOD > sweep + 2.0 * TICK_PERIOD
            && self.motion_in(&self.wind()).is_some()
            && self.told(sweep + self.deskew.clock).is_some()
    }

    /// The true pose at an age \[s\].
    pub(super) fn true_pose(&self, age: f64) -> Option<Pose> {
        let ticks = (age / TICK_PERIOD).max(0.0);
        let back = |ticks: usize| self.poses.get(self.poses.len().checked_sub(1 + ticks)?);
        let later = back(ticks as usize)?;
        let share = ticks - ticks.floor();
        Some(match back(ticks as usize + 1) {
            Some(earlier) if share > 0.0 => later.towards(earlier, share),
            _ => *later,
        })
    }

    /// The pose at an age \[s\], as the flight knows it.
    fn told(&self, age: f64) -> Option<SpacePose> {
        match &self.sensed {
            Some(sensed) => sensed.1.pose(age),
            None => self.true_pose(age).map(|pose| SpacePose {
                position: pose.at,
                attitude: pose.attitude,
            }),
        }
    }

    /// Places the beams of a sweep that has just ended after `sweep` \[s\] in the world, as seen from the present position.
    pub(super) fn placed(&self, beams: &[Beam], sweep: f64) -> Vec<SpaceBeam> {
        let Some(now) = self.told(0.0) else {
            return Vec::new();
        };
        let placed = beams.iter().filter_map(|beam| {
            let age = if self.deskew.active {
                sweep - beam.time + self.deskew.clock
            } else {
                0.0
            };
            let pose = self.told(age)?;
            Some(pose.beam(beam.direction, beam.range, &now.position))
        });
        placed.collect()
    }
}
