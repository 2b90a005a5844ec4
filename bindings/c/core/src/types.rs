//! The values that cross the interface. Units are SI; angles are nose-up positive; x is downrange, z is up.

use crate::aircraft::MppAircraft;
use hil_protocol::{Configure, Preset};
use mpp_core::sense::{AirData, GroundVelocity, Position, SensorFrame};
use mpp_core::trajectory::Reference;
use mpp_core::vehicle::VehicleState;

/// Greatest number of beams of a scan.
pub const MPP_BEAMS: usize = 128;
/// Places of a plan.
pub const MPP_KNOTS: usize = 19;
/// Counters of events.
pub const MPP_COUNTERS: usize = 24;

/// What a flight needs to know before it begins.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppConfig {
    /// The aircraft.
    pub aircraft: MppAircraft,
    /// Candidate paths of a planning cycle, 1 to 50.
    pub paths: u16,
    /// Beams of each scan, 1 to 128.
    pub beams: u16,
    /// Ticks of 10 ms from `mpp_begin` until the plan of this cycle is flown, at least 1.
    pub latency_ticks: u32,
    /// Seed of the planner's random numbers.
    pub seed: u64,
    /// Longest range that the lidar reports [m], 1 to 100000.
    pub range_max: f32,
    /// Height to which the aircraft returns [m], -1000 to 20000.
    pub altitude: f64,
}

/// The measurements that are new in a tick. Ages are in ticks of 10 ms, at most 30.
///
/// What has nothing new has `has_air` or `has_position` false, and not its old value: a value that repeats to the last bit
/// counts as missing, a position at once and air data after 5 repeats. Values that are not finite and negative standard
/// deviations are not used either; the counters tell of them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppSensors {
    /// Whether there is new airspeed and pitch.
    pub has_air: bool,
    /// Their age.
    pub air_age: u32,
    /// True airspeed [m/s].
    pub airspeed: f64,
    /// Pitch against the horizontal [rad], nose up positive.
    pub pitch: f64,
    /// Whether there is a new position.
    pub has_position: bool,
    /// Its age.
    pub position_age: u32,
    /// Downrange [m].
    pub x: f64,
    /// Height [m].
    pub z: f64,
    /// Standard deviation of the white part of its error along an axis [m].
    pub sigma: f64,
    /// Whether the position has a velocity over ground.
    pub has_velocity: bool,
    /// Velocity downrange [m/s].
    pub velocity_x: f64,
    /// Velocity upwards [m/s].
    pub velocity_z: f64,
    /// Standard deviation of its error along an axis [m/s].
    pub velocity_sigma: f64,
}

/// A sweep of the lidar.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppScan {
    /// Age in ticks at the last step, at most 120.
    pub age: u32,
    /// Angle of the first beam against the body axis [rad]: 0 is straight ahead, positive is above.
    pub angle_min: f64,
    /// Angle from a beam to the next [rad]; positive if the next one is above.
    pub angle_increment: f64,
    /// Number of ranges.
    pub count: usize,
    /// Ranges [m]; 0, infinite, not a number or beyond `range_max` for no return, negative for a bad beam, which shows nothing.
    pub ranges: *const f32,
}

/// Position and motion.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct MppState {
    /// Downrange [m].
    pub x: f64,
    /// Height [m].
    pub z: f64,
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Pitch [rad].
    pub pitch: f64,
    /// Pitch rate [rad/s].
    pub pitch_rate: f64,
    /// Angle of the motion through the air above the horizontal [rad].
    pub flight_path: f64,
}

/// What a step gives.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct MppOutput {
    /// Thrust along the body axis [N].
    pub thrust: f64,
    /// Elevator, in the unit of the aircraft's coefficients.
    pub elevator: f64,
    /// Whether a plan is tracked; otherwise the core holds level flight.
    pub tracking: bool,
    /// Trust in airspeed: 0 good, 1 suspected, 2 not used, 3 recovering.
    pub airspeed_trust: u8,
    /// Trust in pitch.
    pub pitch_trust: u8,
    /// Trust in positions.
    pub position_trust: u8,
    /// Trust in the elevator: 1 while the core makes up for its weakness, 2 while it does not answer.
    pub elevator_trust: u8,
    /// Trust in the motor: 2 while it gives no thrust.
    pub motor_trust: u8,
    /// Whether this step has dropped the planning cycle that was under way: the estimates have jumped, and its plan does
    /// not fit them. Begin a new one with the next scan.
    pub cycle_dropped: bool,
    /// The estimate.
    pub estimate: MppState,
    /// Estimated wind downrange [m/s].
    pub wind_x: f64,
    /// Estimated wind upwards [m/s].
    pub wind_z: f64,
    /// Estimated excess of the lift coefficient [-].
    pub lift: f64,
    /// What was to be flown.
    pub reference: MppState,
}

/// What a planning cycle came to.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppPlan {
    /// 0: a feasible plan is flown. 1: the least violating plan is flown. 2: the last plan is kept. 3: straight
    /// and level. No plan passes the gate, and there is flown 4: a path of the lattice, 5: a reserve, 6: what strikes latest.
    pub outcome: u8,
    /// Whether the cycle did all its work.
    pub complete: bool,
    /// Whether the cycle had no scan, or one of a lidar that shows nothing where the map has obstacles. Its plans are slow
    /// flight.
    pub blind: bool,
    /// Programs that were solved.
    pub candidates: u32,
    /// Those that gave a feasible trajectory.
    pub feasible: u32,
    /// Trees.
    pub trees: u32,
    /// Slices.
    pub slices: u32,
    /// Cost [-]; infinite without a trajectory.
    pub cost: f64,
    /// Worst violation [m or rad].
    pub violation: f64,
    /// Time from a place to the next [s]. The first place is flown at `start`.
    pub period: f64,
    /// The places, if the outcome is 0 or 1.
    pub knots: [MppState; MPP_KNOTS],
    /// Thrust from each place to the next [N].
    pub thrust: [f64; MPP_KNOTS],
    /// Elevator command at each place.
    pub elevator: [f64; MPP_KNOTS],
    /// Time from which the plan is flown [s]: that of the step before `mpp_begin`, and the latency.
    pub start: f64,
}

const _: () = assert!(MPP_BEAMS == mpp_core::config::MAX_BEAMS);
const _: () = assert!(MPP_KNOTS == mpp_core::config::KNOTS);
const _: () = assert!(MPP_COUNTERS == hil_protocol::HealthReport::NAMES.len());

impl MppConfig {
    /// The reference aircraft with the paper's lidar, 25 paths and plans that are flown one tick after their cycle began.
    pub(crate) const USUAL: Self = Self {
        aircraft: MppAircraft::REFERENCE,
        paths: 25,
        beams: 100,
        latency_ticks: 1,
        seed: 1,
        range_max: 45.0,
        altitude: 50.0,
    };

    pub(crate) fn configure(&self) -> Configure {
        let (aircraft, actuators) = self.aircraft.told();
        Configure {
            preset: Preset::Flight,
            aircraft,
            paths: self.paths,
            // The caller decides when it plans. The period bounds the latency.
            replan_period_ticks: self.latency_ticks,
            latency_ticks: self.latency_ticks,
            slices_per_tick: u32::MAX,
            seed: self.seed,
            beams: self.beams,
            range_max: self.range_max,
            altitude: self.altitude,
            actuators,
        }
    }
}

impl MppSensors {
    pub(crate) fn frame(&self) -> SensorFrame {
        let air = AirData {
            age: self.air_age,
            measurement: mpp_core::sense::Measurement {
                airspeed: self.airspeed,
                pitch: self.pitch,
            },
        };
        let velocity = GroundVelocity {
            x: self.velocity_x,
            z: self.velocity_z,
            sigma: self.velocity_sigma,
        };
        let position = Position {
            age: self.position_age,
            x: self.x,
            z: self.z,
            sigma: self.sigma,
            velocity: self.has_velocity.then_some(velocity),
        };
        SensorFrame {
            air: self.has_air.then_some(air),
            position: self.has_position.then_some(position),
        }
    }
}

impl From<&VehicleState> for MppState {
    fn from(state: &VehicleState) -> Self {
        Self {
            x: state.x,
            z: state.z,
            airspeed: state.air.airspeed,
            pitch: state.air.pitch,
            pitch_rate: state.air.pitch_rate,
            flight_path: state.air.flight_path,
        }
    }
}

impl From<&Reference> for MppState {
    fn from(reference: &Reference) -> Self {
        Self::from(&reference.state)
    }
}
