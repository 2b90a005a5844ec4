//! The values that cross the interface. Units are SI; angles are nose-up positive; x is downrange, z is up.

use hil_protocol::{ActuatorLimits, Aircraft, Configure, Preset};
use mpp_core::sense::{AirData, GroundVelocity, Position, SensorFrame};
use mpp_core::trajectory::Reference;
use mpp_core::vehicle::VehicleState;

/// Greatest number of beams of a scan.
pub const MPP_BEAMS: usize = 128;
/// Places of a plan.
pub const MPP_KNOTS: usize = 19;
/// Counters of events.
pub const MPP_COUNTERS: usize = 19;

/// The aircraft, by its coefficients: `L = q S (C_L + C_La' alpha' + C_Lq theta')`,
/// `C_L = C_L0 + C_La alpha + C_Le delta_e`, `C_D = C_D0 + K C_L^2`,
/// `C_M = C_M0 + C_Ma alpha + C_Ma' alpha' + C_Mq theta' + C_Me delta_e`. The elevator may be in any unit.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppAircraft {
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia in pitch [kg m^2].
    pub pitch_inertia: f64,
    /// Wing area [m^2].
    pub wing_area: f64,
    /// Reference length of the pitching moment [m].
    pub moment_length: f64,
    /// Air density [kg/m^3].
    pub air_density: f64,
    /// `C_L0` [-].
    pub lift_zero: f64,
    /// `C_La` [1/rad].
    pub lift_alpha: f64,
    /// `C_La'` [s/rad].
    pub lift_alpha_rate: f64,
    /// `C_Lq` [s/rad].
    pub lift_pitch_rate: f64,
    /// `C_Le` [1 per unit of elevator].
    pub lift_elevator: f64,
    /// `C_D0` [-].
    pub drag_zero: f64,
    /// `K` [-].
    pub drag_induced: f64,
    /// `C_M0` [-].
    pub moment_zero: f64,
    /// `C_Ma` [1/rad].
    pub moment_alpha: f64,
    /// `C_Ma'` [s/rad].
    pub moment_alpha_rate: f64,
    /// `C_Mq` [s/rad].
    pub moment_pitch_rate: f64,
    /// `C_Me` [1 per unit of elevator].
    pub moment_elevator: f64,
    /// Airspeed of level flight [m/s].
    pub cruise: f64,
    /// Radius of the circle that holds the aircraft [m].
    pub body_radius: f64,
    /// Distance of the stall from the angle of attack of level flight [rad]; 0 if it is not known.
    pub stall: f64,
    /// Greatest thrust [N]; 0 for no limit. The same holds for the four limits below.
    pub thrust_max: f64,
    /// Time constant of the thrust [s].
    pub thrust_lag: f64,
    /// Greatest distance of the elevator below its trim.
    pub elevator_below: f64,
    /// Greatest distance of the elevator above its trim.
    pub elevator_above: f64,
    /// Greatest rate of the elevator [1/s].
    pub elevator_rate: f64,
}

/// What a flight needs to know before it begins.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppConfig {
    /// The aircraft.
    pub aircraft: MppAircraft,
    /// Candidate paths of a planning cycle, 1 to 100.
    pub paths: u16,
    /// Beams of each scan, 1 to 128.
    pub beams: u16,
    /// Ticks of 10 ms from a scan until its plan is flown, at least 1.
    pub latency_ticks: u32,
    /// Seed of the planner's random numbers.
    pub seed: u64,
    /// Longest range that the lidar reports [m].
    pub range_max: f32,
    /// Height to which the aircraft returns [m].
    pub altitude: f64,
}

/// The measurements that are new in a tick. Ages are in ticks of 10 ms.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppSensors {
    /// Whether there is new airspeed and pitch.
    pub has_air: bool,
    /// Their age.
    pub air_age: u32,
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Pitch [rad].
    pub pitch: f64,
    /// Whether there is a new position.
    pub has_position: bool,
    /// Its age.
    pub position_age: u32,
    /// Downrange [m].
    pub x: f64,
    /// Height [m].
    pub z: f64,
    /// Standard deviation of the white part of its error [m].
    pub sigma: f64,
    /// Whether the position has a velocity over ground.
    pub has_velocity: bool,
    /// Velocity downrange [m/s].
    pub velocity_x: f64,
    /// Velocity upwards [m/s].
    pub velocity_z: f64,
    /// Standard deviation of its error [m/s].
    pub velocity_sigma: f64,
}

/// A sweep of the lidar.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppScan {
    /// Age in ticks.
    pub age: u32,
    /// Angle of the first beam against the body axis [rad].
    pub angle_min: f64,
    /// Angle from a beam to the next [rad].
    pub angle_increment: f64,
    /// Number of ranges.
    pub count: usize,
    /// Ranges [m]; 0 for no return.
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
    /// Flight path angle [rad].
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
    /// and level.
    pub outcome: u8,
    /// Whether the cycle did all its work.
    pub complete: bool,
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
    /// Time from a place to the next [s].
    pub period: f64,
    /// The places, if the outcome is 0 or 1.
    pub knots: [MppState; MPP_KNOTS],
    /// Thrust from each place to the next [N].
    pub thrust: [f64; MPP_KNOTS],
    /// Elevator command at each place.
    pub elevator: [f64; MPP_KNOTS],
}

const _: () = assert!(MPP_BEAMS == mpp_core::config::MAX_BEAMS);
const _: () = assert!(MPP_KNOTS == mpp_core::config::KNOTS);
const _: () = assert!(MPP_COUNTERS == hil_protocol::HealthReport::NAMES.len());

impl MppAircraft {
    pub(crate) const REFERENCE: Self = {
        let own = Aircraft::REFERENCE;
        Self {
            mass: own.mass,
            pitch_inertia: own.pitch_inertia,
            wing_area: own.wing_area,
            moment_length: own.moment_length,
            air_density: own.air_density,
            lift_zero: own.lift_zero,
            lift_alpha: own.lift_alpha,
            lift_alpha_rate: own.lift_alpha_rate,
            lift_pitch_rate: own.lift_pitch_rate,
            lift_elevator: own.lift_elevator,
            drag_zero: own.drag_zero,
            drag_induced: own.drag_induced,
            moment_zero: own.moment_zero,
            moment_alpha: own.moment_alpha,
            moment_alpha_rate: own.moment_alpha_rate,
            moment_pitch_rate: own.moment_pitch_rate,
            moment_elevator: own.moment_elevator,
            cruise: own.cruise,
            body_radius: own.body_radius,
            stall: 0.0,
            thrust_max: 0.0,
            thrust_lag: 0.0,
            elevator_below: 0.0,
            elevator_above: 0.0,
            elevator_rate: 0.0,
        }
    };

    fn told(&self) -> (Aircraft, ActuatorLimits) {
        // Not a number is not "no limit": the core's checks refuse it.
        let unless_zero = |value: f64| if value == 0.0 { None } else { Some(value) };
        let aircraft = Aircraft {
            mass: self.mass,
            pitch_inertia: self.pitch_inertia,
            wing_area: self.wing_area,
            moment_length: self.moment_length,
            air_density: self.air_density,
            lift_zero: self.lift_zero,
            lift_alpha: self.lift_alpha,
            lift_alpha_rate: self.lift_alpha_rate,
            lift_pitch_rate: self.lift_pitch_rate,
            lift_elevator: self.lift_elevator,
            drag_zero: self.drag_zero,
            drag_induced: self.drag_induced,
            moment_zero: self.moment_zero,
            moment_alpha: self.moment_alpha,
            moment_alpha_rate: self.moment_alpha_rate,
            moment_pitch_rate: self.moment_pitch_rate,
            moment_elevator: self.moment_elevator,
            cruise: self.cruise,
            body_radius: self.body_radius,
            stall: unless_zero(self.stall),
        };
        let actuators = ActuatorLimits {
            thrust_max: unless_zero(self.thrust_max),
            thrust_lag: unless_zero(self.thrust_lag),
            elevator_below: unless_zero(self.elevator_below),
            elevator_above: unless_zero(self.elevator_above),
            elevator_rate: unless_zero(self.elevator_rate),
        };
        (aircraft, actuators)
    }
}

impl MppConfig {
    /// The reference aircraft with the paper's lidar, 25 paths and plans that are flown one tick after their scan.
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
            measurement: mpp_core::estimate::Measurement {
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
