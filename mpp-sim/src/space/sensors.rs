//! What the sensors of an autopilot tell of the motion in space, with their errors.

use super::{SpaceAircraft, SpaceState};
use crate::random::{Draws, Stream, gaussian, generator};
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{InertialSample, SpaceFix};
use mpp_core::vehicle::{GRAVITY, Quaternion, SpacePath};
use std::collections::VecDeque;

/// Errors of the sensors: standard deviations, and the times over which they are correlated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorErrors {
    /// Attitude \[rad\], over 2 s.
    pub attitude: f64,
    /// Velocity over ground along an axis in fixes [m/s], over 2 s.
    pub velocity: f64,
    /// Airspeed [m/s], over 1 s.
    pub airspeed: f64,
    /// Rates of the body [rad/s], white.
    pub rates: f64,
    /// A constant part of the rates [rad/s], and an error of their scale [-].
    pub drift: [f64; 2],
    /// Specific force along an axis [m/s^2]: a constant part, and as much white.
    pub force: f64,
    /// Position along an axis in fixes \[m\], white. There are ten fixes a second, 50 ms late.
    pub position: f64,
}

impl SensorErrors {
    /// An attitude reference, and a satellite receiver that corrects the carrier phase. Source: chosen, as decision 46 says; the
    /// force is that of a small accelerometer.
    pub const RTK: Self = Self {
        attitude: 0.5 * core::f64::consts::PI / 180.0,
        velocity: 0.1,
        airspeed: 0.3,
        rates: 0.3 * core::f64::consts::PI / 180.0,
        drift: [0.1 * core::f64::consts::PI / 180.0, 0.005],
        force: 0.05,
        position: 0.02,
    };

    /// Almost no errors; the delays stay.
    pub const EXACT: Self = Self {
        attitude: 1e-4,
        velocity: 1e-3,
        airspeed: 1e-3,
        rates: 1e-4,
        drift: [0.0; 2],
        force: 1e-3,
        position: 1e-3,
    };
}

/// Ticks from a fix of the position to its arrival, and from fix to fix.
const FIX_LATE: u32 = 5;
const FIX_PERIOD: u32 = 10;
/// Ticks from an attitude to its arrival.
const ATTITUDE_LATE: u32 = 1;

/// An error that wanders: a first-order process.
#[derive(Clone, Copy, Debug, Default)]
struct Wander {
    value: f64,
    sigma: f64,
    keep: f64,
}

impl Wander {
    fn new(sigma: f64, time: f64, draws: &mut Draws) -> Self {
        Self {
            value: sigma * gaussian(draws),
            sigma,
            keep: libm::exp(-TICK_PERIOD / time),
        }
    }

    fn advance(&mut self, draws: &mut Draws) -> f64 {
        let fresh = libm::sqrt(1.0 - self.keep * self.keep) * self.sigma * gaussian(draws);
        self.value = self.keep * self.value + fresh;
        self.value
    }
}

/// What arrives in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensed {
    /// Attitude, rates and specific force of the tick before.
    pub inertial: Option<InertialSample>,
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// A fix, if one arrives.
    pub fix: Option<SpaceFix>,
}

/// The sensors of a flight.
#[derive(Clone, Debug)]
pub struct SpaceSensors {
    errors: SensorErrors,
    draws: Draws,
    attitude: [Wander; 3],
    velocity: [Wander; 3],
    airspeed: Wander,
    force_bias: [f64; 3],
    /// Bias [rad/s] and error of the scale [-] of each gyroscope.
    drift: [[f64; 2]; 3],
    /// Velocity over ground at the last tick [m/s].
    before: Option<[f64; 3]>,
    /// What has been measured and has not arrived.
    samples: VecDeque<InertialSample>,
    fixes: VecDeque<SpaceFix>,
    tick: u32,
}

impl SpaceSensors {
    /// The sensors of the flight with this seed.
    #[must_use]
    pub fn new(seed: u64, errors: SensorErrors) -> Self {
        let mut draws = generator(seed, Stream::SpaceEstimate);
        let mut wander = |sigma, time| Wander::new(sigma, time, &mut draws);
        let attitude = [(); 3].map(|()| wander(errors.attitude, 2.0));
        let velocity = [(); 3].map(|()| wander(errors.velocity, 2.0));
        let airspeed = wander(errors.airspeed, 1.0);
        Self {
            errors,
            force_bias: [(); 3].map(|()| errors.force * gaussian(&mut draws)),
            drift: [(); 3].map(|()| errors.drift.map(|sigma| sigma * gaussian(&mut draws))),
            draws,
            attitude,
            velocity,
            airspeed,
            before: None,
            samples: VecDeque::new(),
            fixes: VecDeque::new(),
            tick: 0,
        }
    }

    /// What the sensors tell in this tick.
    pub fn step(&mut self, aircraft: &SpaceAircraft) -> Sensed {
        let (state, errors) = (aircraft.state(), self.errors);
        let draws = &mut self.draws;
        let ground = ground_velocity(aircraft);
        let before = self.before.replace(ground).unwrap_or(ground);
        // The mean over the tick, as an accelerometer that is read without gaps gives it.
        let [x, y, z] = [0, 1, 2].map(|axis| (ground[axis] - before[axis]) / TICK_PERIOD);
        let force = state.attitude().world_in([x, y, -z - GRAVITY]);
        let [bank, pitch, heading] = self.attitude.each_mut().map(|it| it.advance(draws));
        let velocity = self.velocity.each_mut().map(|it| it.advance(draws));
        let [about_x, about_y, about_z] = state
            .attitude()
            .times(Quaternion::roll(bank))
            .times(Quaternion::pitch(pitch))
            .angles();
        let rates = rates(state);
        self.samples.push_back(InertialSample {
            age: ATTITUDE_LATE,
            attitude: [about_x, about_y, about_z + heading],
            sigma: errors.attitude,
            rates: core::array::from_fn(|axis| {
                let [bias, scale] = self.drift[axis];
                rates[axis] + bias + scale * rates[axis] + errors.rates * gaussian(draws)
            }),
            force: [0, 1, 2]
                .map(|axis| force[axis] + self.force_bias[axis] + errors.force * gaussian(draws)),
        });
        if self.tick.is_multiple_of(FIX_PERIOD) {
            self.fixes.push_back(SpaceFix {
                age: FIX_LATE,
                position: position(state).map(|it| it + errors.position * gaussian(draws)),
                sigma: errors.position,
                velocity: Some((
                    [0, 1, 2].map(|axis| ground[axis] + velocity[axis]),
                    errors.velocity,
                )),
            });
        }
        let arrives = self.tick % FIX_PERIOD == FIX_LATE;
        let late = self.samples.len() > ATTITUDE_LATE as usize;
        self.tick += 1;
        Sensed {
            inertial: late.then(|| self.samples.pop_front()).flatten(),
            airspeed: state.plane.air.airspeed + self.airspeed.advance(draws),
            fix: arrives.then(|| self.fixes.pop_front()).flatten(),
        }
    }
}

fn position(state: &SpaceState) -> [f64; 3] {
    [state.plane.x, state.lateral.y, state.plane.z]
}

fn rates(state: &SpaceState) -> [f64; 3] {
    let (side, air) = (&state.lateral, &state.plane.air);
    [side.roll_rate, air.pitch_rate, side.yaw_rate]
}

fn ground_velocity(aircraft: &SpaceAircraft) -> [f64; 3] {
    let state = aircraft.state();
    let [x, y, down] = state.lateral.attitude.in_world(state.air_velocity());
    let wind = aircraft.wind();
    [x + wind[0], y + wind[1], wind[2] - down]
}

/// The true motion as a point mass sees it.
#[must_use]
pub fn true_path(state: &SpaceState) -> SpacePath {
    let [x, y, down] = state.lateral.attitude.in_world(state.air_velocity());
    let air = &state.plane.air;
    SpacePath {
        position: position(state),
        airspeed: air.airspeed,
        angle_of_attack: air.angle_of_attack(),
        bank: state.bank(),
        flight_path: libm::atan2(-down, libm::hypot(x, y)),
        course: libm::atan2(y, x),
    }
}
