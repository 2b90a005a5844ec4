//! The wind on three axes, and the angles to the flow.
//!
//! The wind is the velocity over ground less that through the air. Airspeed, attitude and the two angles to the flow give the
//! latter. Nothing measures the angles; the forces tell them: the lift line gives the angle of attack, the side force the
//! sideslip. Two filters take the same measured winds, as in the plane (decision 34): the *quick* one follows gusts, and the angles
//! to the flow are those of the velocity over ground less its wind; plans count on the *smooth* one.

use crate::config::TICK_PERIOD;
use crate::estimate::MeasurementStatus;
use crate::tuning::navigation::{FIRST_WIND, GATE, RESTART_TIME};
use crate::tuning::space_air::{
    LEAST_SHARE, MOST_ANGLE, MOST_SHARE, QUICK, RUNAWAY, SIDE_FORCE, SIDESLIP, SIGMA, SMOOTH, TIME,
};
use crate::vehicle::{LateralAirframe, LateralControl, Quaternion, SpaceModel, within};

/// Number of measurements of which the errors are alike [-]: the variance of one of them, as if they were white, is so much more.
const ALIKE: f64 = 2.0 * TIME / TICK_PERIOD;

/// Kalman filter on a wind that changes by chance. One variance serves all axes.
#[derive(Clone, Copy, Debug)]
struct RandomWalk {
    wind: [f64; 3],
    variance: f64,
    /// Variance of its change in a second [(m/s)^2].
    noise: f64,
}

impl RandomWalk {
    const fn new(noise: f64) -> Self {
        Self {
            wind: [0.0; 3],
            variance: FIRST_WIND * FIRST_WIND,
            noise,
        }
    }

    fn restart(&mut self, wind: [f64; 3], variance: f64) {
        (self.wind, self.variance) = (wind, variance);
    }

    fn predict(&mut self) {
        let most = FIRST_WIND * FIRST_WIND;
        self.variance = (self.variance + self.noise * TICK_PERIOD).min(most);
    }

    /// Takes a wind that is off by `off` [m/s] and has a variance of its own.
    fn observe(&mut self, off: [f64; 3], own: f64) {
        let gain = self.variance / (self.variance + ALIKE * own);
        for (wind, off) in self.wind.iter_mut().zip(off) {
            *wind += gain * off;
        }
        self.variance *= 1.0 - gain;
    }
}

/// What the airspeed of a tick is compared with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow {
    /// Attitude.
    pub(super) attitude: Quaternion,
    /// Roll rate, pitch rate, yaw rate [rad/s].
    pub(super) rates: [f64; 3],
    /// Specific force along the body axes [m/s^2].
    pub(super) force: [f64; 3],
    /// Velocity over ground [m/s], and its variance along an axis.
    pub(super) velocity: [f64; 3],
    /// See [`Self::velocity`].
    pub(super) variance: f64,
}

/// The air.
#[derive(Clone, Copy, Debug)]
pub(super) struct AirFilter {
    model: SpaceModel,
    lateral: LateralAirframe,
    quick: RandomWalk,
    smooth: RandomWalk,
    /// Whether there was a wind, and ticks since the last one.
    started: bool,
    silent: u32,
    /// Angle of attack and sideslip that the forces tell \[rad\].
    told: [f64; 2],
}

impl AirFilter {
    pub(super) fn new(model: &SpaceModel, lateral: &LateralAirframe) -> Self {
        Self {
            model: *model,
            lateral: *lateral,
            quick: RandomWalk::new(QUICK),
            smooth: RandomWalk::new(SMOOTH),
            started: false,
            silent: 0,
            told: [model.trim.state.angle_of_attack(), 0.0],
        }
    }

    /// The wind for plans [m/s].
    pub(super) fn wind(&self) -> [f64; 3] {
        self.smooth.wind
    }

    /// The wind with its gusts [m/s].
    pub(super) fn gusty_wind(&self) -> [f64; 3] {
        self.quick.wind
    }

    /// Variance of the wind for plans along an axis [(m/s)^2].
    pub(super) fn variance(&self) -> f64 {
        self.smooth.variance
    }

    /// Angle of attack and sideslip \[rad\].
    pub(super) fn angles(&self, attitude: Quaternion, velocity: [f64; 3]) -> [f64; 2] {
        let through = [0, 1, 2].map(|axis| velocity[axis] - self.quick.wind[axis]);
        let [ahead, right, down] = attitude.world_in([through[0], through[1], -through[2]]);
        [
            libm::atan2(down, ahead),
            libm::atan2(right, libm::hypot(ahead, down)),
        ]
    }

    /// Moves on by a tick.
    pub(super) fn predict(&mut self) {
        self.quick.predict();
        self.smooth.predict();
        self.silent = self.silent.saturating_add(1);
    }

    /// Takes the airspeed of a tick, with the lateral command that the surfaces have.
    pub(super) fn observe(
        &mut self,
        airspeed: f64,
        surfaces: &LateralControl,
        flow: &Flow,
    ) -> MeasurementStatus {
        let level = self.model.trim.state.airspeed;
        if airspeed.is_nan() {
            return MeasurementStatus::Missing;
        }
        if !(airspeed > LEAST_SHARE * level && airspeed < level / LEAST_SHARE) {
            return MeasurementStatus::Gated;
        }
        self.told = self.forces(airspeed, surfaces, flow);
        let (sin, cos) = libm::sincos(self.told[0]);
        let (sin_slip, cos_slip) = libm::sincos(self.told[1]);
        let body = [cos * cos_slip, sin_slip, sin * cos_slip].map(|it| it * airspeed);
        let [x, y, down] = flow.attitude.in_world(body);
        let [u, v, w] = flow.velocity;
        let measured = [u - x, v - y, w + down].map(|it| within(it, MOST_SHARE * level));
        let off = [0, 1, 2].map(|axis| measured[axis] - self.quick.wind[axis]);
        let own = SIGMA * SIGMA + flow.variance;
        let most = GATE * GATE * (self.smooth.variance + own);
        let agrees = off.iter().all(|it| it * it <= most);
        if self.started && !agrees && f64::from(self.silent) * TICK_PERIOD <= RESTART_TIME {
            return MeasurementStatus::Gated;
        }
        if !self.started || !agrees {
            self.quick.restart(measured, own);
            self.smooth.restart(measured, own);
        } else {
            self.quick.observe(off, own);
            let off = [0, 1, 2].map(|axis| measured[axis] - self.smooth.wind[axis]);
            self.smooth.observe(off, own);
        }
        (self.started, self.silent) = (true, 0);
        MeasurementStatus::Accepted
    }

    /// Angle of attack and sideslip \[rad\] by the forces at an airspeed [m/s].
    fn forces(&self, airspeed: f64, surfaces: &LateralControl, flow: &Flow) -> [f64; 2] {
        let [ahead, right, down] = flow.force;
        let (sin, cos) = libm::sincos(self.told[0]);
        let attack = self.model.angle_for(airspeed, ahead * sin - down * cos);
        let a = &self.model.airframe;
        let per_mass = 0.5 * a.air_density * (airspeed * airspeed) * a.wing_area / a.mass;
        let [roll, _, yaw] = flow.rates;
        let per_rate = self.lateral.span / (2.0 * airspeed);
        let rates = [roll * per_rate, yaw * per_rate];
        let other = self.lateral.side.coefficient(0.0, rates, *surfaces);
        // The most probable sideslip: little force for a radian tells little.
        let slope = per_mass * self.lateral.side.sideslip;
        let [usual, most] = match self.model.nose {
            Some(_) => RUNAWAY,
            None => [SIDESLIP, MOST_ANGLE],
        };
        let (known, unknown) = (slope * usual, SIDE_FORCE);
        let share = known * known / (known * known + unknown * unknown);
        let slip = if share > 0.0 {
            share * (right - per_mass * other) / slope
        } else {
            0.0
        };
        [within(attack, MOST_ANGLE), within(slip, most)]
    }
}
