//! What an autopilot's estimator tells of the motion in space, with its errors.

use super::{SpaceAircraft, SpaceState};
use crate::random::{Draws, Stream, gaussian, generator};
use mpp_core::config::TICK_PERIOD;
use mpp_core::control::SpaceMotion;
use mpp_core::vehicle::SpacePath;
use std::collections::VecDeque;

/// Errors of an autopilot's estimate: standard deviations, and the times over which they are correlated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimateErrors {
    /// Attitude \[rad\], over 2 s.
    pub attitude: f64,
    /// Velocity over ground along an axis [m/s], over 2 s.
    pub velocity: f64,
    /// Airspeed [m/s], over 1 s.
    pub airspeed: f64,
    /// Angle of attack \[rad\], over 2 s.
    pub angle_of_attack: f64,
    /// Rates of the body [rad/s], white.
    pub rates: f64,
    /// Fixes of the position along an axis \[m\], ten a second, 50 ms late.
    pub position: f64,
}

impl EstimateErrors {
    /// No errors.
    pub const NONE: Self = Self {
        attitude: 0.0,
        velocity: 0.0,
        airspeed: 0.0,
        angle_of_attack: 0.0,
        rates: 0.0,
        position: 0.0,
    };

    /// An autopilot with a satellite receiver that corrects the carrier phase. Source: chosen, as decision 46 says.
    pub const RTK: Self = Self {
        attitude: 0.5 * core::f64::consts::PI / 180.0,
        velocity: 0.1,
        airspeed: 0.3,
        angle_of_attack: 0.1 * core::f64::consts::PI / 180.0,
        rates: 0.3 * core::f64::consts::PI / 180.0,
        position: 0.02,
    };
}

/// Ticks from a fix of the position to its arrival, and from fix to fix.
const FIX_LATE: usize = 5;
const FIX_PERIOD: usize = 10;
/// Share of a fix's difference that the estimate takes over [-].
const FIX_SHARE: f64 = 0.35;
/// Time over which the wind is averaged \[s\].
const WIND_TIME: f64 = 1.0;

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

/// The estimator: true values with errors. Its wind is the velocity over ground less that through the air.
#[derive(Clone, Debug)]
pub struct SpaceEstimator {
    errors: EstimateErrors,
    draws: Draws,
    attitude: [Wander; 3],
    velocity: [Wander; 3],
    airspeed: Wander,
    attack: Wander,
    /// Error of the position \[m\], and its history.
    drift: [f64; 3],
    past: VecDeque<[f64; 3]>,
    wind: [f64; 3],
    tick: usize,
}

impl SpaceEstimator {
    /// The estimator of a flight, which starts with this wind [m/s].
    #[must_use]
    pub fn new(seed: u64, errors: EstimateErrors, wind: [f64; 3]) -> Self {
        let mut draws = generator(seed, Stream::SpaceEstimate);
        let mut wander = |sigma, time| Wander::new(sigma, time, &mut draws);
        let attitude = [(); 3].map(|()| wander(errors.attitude, 2.0));
        let velocity = [(); 3].map(|()| wander(errors.velocity, 2.0));
        let airspeed = wander(errors.airspeed, 1.0);
        let attack = wander(errors.angle_of_attack, 2.0);
        Self {
            errors,
            draws,
            attitude,
            velocity,
            airspeed,
            attack,
            drift: [0.0; 3],
            past: VecDeque::new(),
            wind,
            tick: 0,
        }
    }

    /// The estimated wind [m/s].
    #[must_use]
    pub fn wind(&self) -> [f64; 3] {
        self.wind
    }

    /// Errors of bank, pitch and heading \[rad\] in this tick.
    #[must_use]
    pub fn attitude_errors(&self) -> [f64; 3] {
        self.attitude.map(|it| it.value)
    }

    /// The estimate of this tick.
    pub fn step(&mut self, aircraft: &SpaceAircraft) -> SpaceMotion {
        let (state, draws) = (aircraft.state(), &mut self.draws);
        let truth = true_path(state);
        let attitude = self.attitude.each_mut().map(|it| it.advance(draws));
        let velocity = self.velocity.each_mut().map(|it| it.advance(draws));
        let airspeed = truth.airspeed + self.airspeed.advance(draws);
        let attack = self.attack.advance(draws);
        let true_ground = truth.ground_velocity(&aircraft.wind());
        let ground: [f64; 3] = core::array::from_fn(|axis| true_ground[axis] + velocity[axis]);
        // The air data and the attitude give the velocity through the air; nobody measures the sideslip.
        let seen = SpacePath {
            airspeed,
            flight_path: truth.flight_path + attitude[1],
            course: truth.course - state.lateral.sideslip + attitude[2],
            ..truth
        };
        let air = seen.ground_velocity(&[0.0; 3]);
        for axis in 0..3 {
            let now = ground[axis] - air[axis];
            self.wind[axis] += TICK_PERIOD / WIND_TIME * (now - self.wind[axis]);
            self.drift[axis] += TICK_PERIOD * velocity[axis];
        }
        self.fix();
        let rates = [
            state.lateral.roll_rate,
            state.plane.air.pitch_rate,
            state.lateral.yaw_rate,
        ];
        // A plan starts with the velocity over ground, whatever the error of the wind.
        let through: [f64; 3] = core::array::from_fn(|axis| ground[axis] - self.wind[axis]);
        let [x, y, z] = through;
        SpaceMotion {
            path: SpacePath {
                position: core::array::from_fn(|axis| truth.position[axis] + self.drift[axis]),
                airspeed: libm::sqrt(x * x + y * y + z * z),
                angle_of_attack: truth.angle_of_attack + attack,
                bank: truth.bank + attitude[0],
                flight_path: libm::atan2(z, libm::hypot(x, y)),
                course: libm::atan2(y, x),
            },
            rates: rates.map(|rate| rate + self.errors.rates * gaussian(&mut self.draws)),
        }
    }

    /// Takes up a late fix, if one arrives.
    fn fix(&mut self) {
        self.past.push_back(self.drift);
        if self.past.len() > FIX_LATE + 1 {
            self.past.pop_front();
        }
        if self.tick.is_multiple_of(FIX_PERIOD) && self.errors.position > 0.0 {
            let then = self.past.front().copied().unwrap_or_default();
            for (axis, then) in then.into_iter().enumerate() {
                let noise = self.errors.position * gaussian(&mut self.draws);
                let by = FIX_SHARE * (noise - then);
                self.drift[axis] += by;
                self.past.iter_mut().for_each(|past| past[axis] += by);
            }
        }
        self.tick += 1;
    }
}

/// The true motion as a point mass sees it.
#[must_use]
pub fn true_path(state: &SpaceState) -> SpacePath {
    let [x, y, down] = state.lateral.attitude.in_world(state.air_velocity());
    let air = &state.plane.air;
    SpacePath {
        position: [state.plane.x, state.lateral.y, state.plane.z],
        airspeed: air.airspeed,
        angle_of_attack: air.angle_of_attack(),
        bank: state.bank(),
        flight_path: libm::atan2(-down, libm::hypot(x, y)),
        course: libm::atan2(y, x),
    }
}
