//! The estimator in space: motion over ground and through the air, the wind, and the poses of the last 0.3 s.
//!
//! ```text
//! attitude, rates, force -> AttitudeFilter -> acceleration -> InertialFilter <- fixes, brought to their time by Poses
//!                                                                  | velocity over ground
//!                    airspeed, lift line, side force ---------> AirFilter -> wind, angles to the flow
//! ```
//!
//! A plan starts from the velocity over ground, whatever the error of the wind: [`SpaceEstimator::motion`] is the velocity over
//! ground less the wind for plans. Every innovation is tested, and what does not pass is not used; [`SpaceEstimator::trust`] and
//! [`SpaceEstimator::refused`] tell.

mod air;
mod attitude;
mod inertial;
mod poses;

pub use attitude::InertialSample;
pub use poses::SpacePose;

use super::history::MOST_AGE;
use super::{MeasurementStatus, PositionVerdict, SensorMonitor, Sensors, StuckDetector};
use crate::config::TICK_PERIOD;
use crate::control::SpaceMotion;
use crate::tuning::navigation::{FIRST_WIND, RESTART_TIME};
use crate::tuning::sensors::POSITION_PERIOD;
use crate::tuning::space_inertial::{DOUBTED_BIAS, VELOCITY_DOUBT};
use crate::vehicle::{GRAVITY, LateralAirframe, LateralControl, Quaternion, SpaceModel, SpacePath};
use air::{AirFilter, Flow};
use attitude::AttitudeFilter;
use inertial::InertialFilter;
use poses::Poses;

/// A position in space, and perhaps the velocity over ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceFix {
    /// Ticks since the measurement.
    pub age: u32,
    /// Position: ahead, to the right, up \[m\].
    pub position: [f64; 3],
    /// Declared standard deviation of the white error along an axis \[m\].
    pub sigma: f64,
    /// Velocity over ground at the same time [m/s], and the standard deviation of its error along an axis [m/s].
    pub velocity: Option<([f64; 3], f64)>,
}

impl SpaceFix {
    fn is_sound(&self) -> bool {
        let number = |values: &[f64; 3]| values.iter().all(|it| it.is_finite());
        let error = |sigma: f64| sigma.is_finite() && sigma >= 0.0;
        let velocity = self
            .velocity
            .is_none_or(|(velocity, sigma)| number(&velocity) && error(sigma));
        number(&self.position) && error(self.sigma) && velocity
    }
}

/// Numbers of values that were not used since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SpaceRefused {
    /// Samples of the attitude reference.
    pub inertial: u32,
    /// Airspeeds.
    pub airspeed: u32,
    /// Positions.
    pub position: u32,
    /// Velocities over ground.
    pub velocity: u32,
}

/// The estimators of a flight in space. In each tick [`predict`](Self::predict) comes first, then the observations.
#[derive(Clone, Debug)]
pub struct SpaceEstimator {
    attitude: AttitudeFilter,
    /// Position and velocity, since the first fix.
    inertial: Option<InertialFilter>,
    air: AirFilter,
    poses: Poses,
    /// The last airspeed [m/s], from which the velocity starts if no source measures it.
    airspeed: Option<f64>,
    frozen: StuckDetector,
    /// Ticks so far, tick of the last fix, and its position.
    ticks: u32,
    fix: Option<(u32, [f64; 3])>,
    /// Ticks since the last position that passed its gate.
    silent: u32,
    refused: SpaceRefused,
    monitors: [SensorMonitor; 3],
}

impl SpaceEstimator {
    /// The estimator of an aircraft, before its flight.
    #[must_use]
    pub fn new(model: &SpaceModel, lateral: &LateralAirframe) -> Self {
        Self {
            attitude: AttitudeFilter::new(),
            inertial: None,
            air: AirFilter::new(model, lateral),
            poses: Poses::new(),
            airspeed: None,
            frozen: StuckDetector::new(),
            ticks: 0,
            fix: None,
            silent: 0,
            refused: SpaceRefused::default(),
            monitors: [1, 1, POSITION_PERIOD].map(SensorMonitor::new),
        }
    }

    /// Moves on by a tick, with the inertial sample that arrived in it. Without one the last rates and forces go on.
    pub fn predict(&mut self, sample: Option<&InertialSample>) -> MeasurementStatus {
        self.ticks = self.ticks.saturating_add(1);
        self.silent = self.silent.saturating_add(1);
        self.air.predict();
        let status = self.attitude.step(sample);
        self.note(0, status);
        let (Some(attitude), Some(filter)) = (self.attitude.attitude(), &mut self.inertial) else {
            return status;
        };
        let [x, y, down] = attitude.in_world(self.attitude.force());
        let acceleration = [x, y, -down - GRAVITY];
        let force = libm::sqrt(x * x + y * y + down * down);
        filter.predict(acceleration, self.attitude.sigma() * force, TICK_PERIOD);
        let rates = self.attitude.rates();
        self.poses
            .push(filter.position(), filter.velocity(), attitude, rates);
        if let (MeasurementStatus::Accepted, Some(sample)) = (status, sample) {
            self.poses.turn(sample.age, attitude, rates);
        }
        // A bank that is wrong turns the lift out of its plane.
        let [_, _, pull] = self.attitude.force();
        if -pull > 0.5 * GRAVITY {
            let [right_x, right_y, right_down] = attitude.in_world([0.0, 1.0, 0.0]);
            let [x, y, z] = filter.bias();
            self.attitude
                .learn((x * right_x + y * right_y - z * right_down) / -pull);
        }
        status
    }

    /// Takes the airspeed of this tick [m/s], and the lateral command that the surfaces have.
    pub fn observe_airspeed(
        &mut self,
        airspeed: Option<f64>,
        surfaces: &LateralControl,
    ) -> MeasurementStatus {
        let told = airspeed.map(|it| self.frozen.take(it));
        let finite = airspeed.is_none_or(f64::is_finite);
        let flow = self.flow();
        let status = match (told, flow) {
            (Some(_), _) if !finite => MeasurementStatus::NotFinite,
            (Some(_), _) if self.frozen.frozen() => MeasurementStatus::Frozen,
            (Some(told), _) if !self.monitors[1].uses() => self.distrusted(told),
            (Some(told), Some(flow)) => {
                self.airspeed = Some(told);
                self.air.observe(told, surfaces, &flow)
            }
            (Some(told), None) => {
                self.airspeed = Some(told);
                MeasurementStatus::Accepted
            }
            (None, _) => MeasurementStatus::Missing,
        };
        self.note(1, status);
        status
    }

    /// Takes a fix.
    pub fn observe_fix(&mut self, fix: Option<&SpaceFix>) -> Option<PositionVerdict> {
        let verdict = fix.map(|fix| self.fixed(fix));
        let good =
            verdict.map(|it| matches!(it, PositionVerdict::Accepted | PositionVerdict::Restarted));
        self.monitors[2].tick(good);
        if good == Some(false) {
            self.refused.position = self.refused.position.saturating_add(1);
        }
        verdict
    }

    fn fixed(&mut self, fix: &SpaceFix) -> PositionVerdict {
        if !fix.is_sound() {
            return PositionVerdict::NotFinite;
        }
        let measured = self.ticks.saturating_sub(fix.age);
        match self.fix {
            Some((last, _)) if measured <= last => return PositionVerdict::Late,
            Some((_, held)) if held.map(f64::to_bits) == fix.position.map(f64::to_bits) => {
                return PositionVerdict::Held;
            }
            _ => {}
        }
        if fix.age > MOST_AGE {
            return PositionVerdict::Late;
        }
        self.fix = Some((measured, fix.position));
        let Some(filter) = &mut self.inertial else {
            return self.start(fix);
        };
        let age = f64::from(fix.age) * TICK_PERIOD;
        let Some((position, velocity)) = self.poses.then(fix.age) else {
            return PositionVerdict::Late;
        };
        let off = [0, 1, 2].map(|axis| fix.position[axis] - position[axis]);
        let Some(by) = filter.observe_position(off, age, fix.sigma) else {
            if f64::from(self.silent) * TICK_PERIOD <= RESTART_TIME {
                return PositionVerdict::Gated;
            }
            let now = filter.position();
            filter.restart([0, 1, 2].map(|axis| now[axis] + off[axis]), fix.sigma);
            self.poses.clear();
            self.silent = 0;
            return PositionVerdict::Restarted;
        };
        self.silent = 0;
        let Some((told, sigma)) = fix.velocity else {
            self.poses.correct(&[by]);
            return PositionVerdict::Accepted;
        };
        let off = [0, 1, 2].map(|axis| told[axis] - (velocity[axis] + by.velocity_then(axis, age)));
        match filter.observe_velocity(off, age, VELOCITY_DOUBT * sigma) {
            Some(more) => self.poses.correct(&[by, more]),
            None => {
                self.poses.correct(&[by]);
                self.refused.velocity = self.refused.velocity.saturating_add(1);
            }
        }
        PositionVerdict::Accepted
    }

    /// Starts from the first fix. Without a measured velocity it is the airspeed along the body, in still air.
    fn start(&mut self, fix: &SpaceFix) -> PositionVerdict {
        let Some(attitude) = self.attitude.attitude() else {
            return PositionVerdict::Late;
        };
        let along = self.airspeed.map(|airspeed| {
            let [x, y, down] = attitude.in_world([airspeed, 0.0, 0.0]);
            ([x, y, -down], FIRST_WIND)
        });
        let Some((velocity, doubt)) = fix.velocity.or(along) else {
            return PositionVerdict::Late;
        };
        let age = f64::from(fix.age) * TICK_PERIOD;
        let position = [0, 1, 2].map(|axis| fix.position[axis] + age * velocity[axis]);
        let sigma = libm::hypot(fix.sigma, age * doubt);
        self.inertial = Some(InertialFilter::start(position, sigma, velocity, doubt));
        self.poses.clear();
        self.poses
            .push(position, velocity, attitude, self.attitude.rates());
        self.silent = 0;
        PositionVerdict::Restarted
    }

    /// The verdict on an airspeed while its sensor is not trusted: whether the known wind agrees.
    fn distrusted(&self, airspeed: f64) -> MeasurementStatus {
        let through = self.motion().map(|it| it.path.airspeed);
        let most = 2.0 * FIRST_WIND;
        if through.is_none_or(|it| (airspeed - it).abs() <= most) {
            MeasurementStatus::Distrusted
        } else {
            MeasurementStatus::Gated
        }
    }

    fn note(&mut self, sensor: usize, status: MeasurementStatus) {
        if let Some(monitor) = self.monitors.get_mut(sensor) {
            let missing = status == MeasurementStatus::Missing;
            monitor.tick((!missing).then_some(status.is_good()));
            if !missing && !status.is_good() {
                let [inertial, airspeed] = [&mut self.refused.inertial, &mut self.refused.airspeed];
                let count = if sensor == 0 { inertial } else { airspeed };
                *count = count.saturating_add(1);
            }
        }
    }

    fn flow(&self) -> Option<Flow> {
        let filter = self.inertial.as_ref()?;
        let [_, variance] = filter.variances();
        Some(Flow {
            attitude: self.attitude.attitude()?,
            rates: self.attitude.rates(),
            force: self.attitude.force(),
            velocity: filter.velocity(),
            variance,
        })
    }

    /// The motion through the air that moves with the wind for plans; `None` before the first fix, and without an attitude.
    #[must_use]
    pub fn motion(&self) -> Option<SpaceMotion> {
        self.motion_in(&self.air.wind())
    }

    /// The motion through air that moves with a wind [m/s]: the two together are the velocity over ground.
    #[must_use]
    pub fn motion_in(&self, wind: &[f64; 3]) -> Option<SpaceMotion> {
        let flow = self.flow()?;
        let [x, y, z] = [0, 1, 2].map(|axis| flow.velocity[axis] - wind[axis]);
        let level = libm::hypot(x, y);
        let [angle_of_attack, sideslip] = self.air.angles(flow.attitude, flow.velocity);
        let mut path = SpacePath {
            position: self.position()?,
            airspeed: libm::hypot(level, z),
            angle_of_attack,
            bank: 0.0,
            flight_path: libm::atan2(z, level),
            course: libm::atan2(y, x),
        };
        path.bank = bank(flow.attitude, &path);
        Some(SpaceMotion {
            path,
            rates: flow.rates,
            sideslip,
        })
    }

    /// Wind for plans [m/s].
    #[must_use]
    pub fn wind(&self) -> [f64; 3] {
        self.air.wind()
    }

    /// Wind with its gusts [m/s].
    #[must_use]
    pub fn gusty_wind(&self) -> [f64; 3] {
        self.air.gusty_wind()
    }

    /// Position \[m\].
    #[must_use]
    pub fn position(&self) -> Option<[f64; 3]> {
        self.inertial.as_ref().map(InertialFilter::position)
    }

    /// Velocity over ground [m/s].
    #[must_use]
    pub fn ground_velocity(&self) -> Option<[f64; 3]> {
        self.inertial.as_ref().map(InertialFilter::velocity)
    }

    /// Variances along an axis: of position [m^2], velocity over ground and wind [(m/s)^2].
    #[must_use]
    pub fn variances(&self) -> Option<[f64; 3]> {
        let [position, velocity] = self.inertial.as_ref()?.variances();
        Some([position, velocity, self.air.variance()])
    }

    /// Angle of attack and sideslip \[rad\].
    #[must_use]
    pub fn flow_angles(&self) -> Option<[f64; 2]> {
        let flow = self.flow()?;
        Some(self.air.angles(flow.attitude, flow.velocity))
    }

    /// Bias of the told bank \[rad\], which the motion is free of.
    #[must_use]
    pub fn bank_bias(&self) -> f64 {
        self.attitude.bank_bias()
    }

    /// The pose `age` \[s\] ago; a time after this tick is negative. `None` if it is not known.
    #[must_use]
    pub fn pose(&self, age: f64) -> Option<SpacePose> {
        self.poses.at(age)
    }

    /// Trust in the sensors; that in the attitude reference is `pitch`.
    #[must_use]
    pub fn trust(&self) -> Sensors {
        let [inertial, airspeed, position] = self.monitors.map(|it| it.trust());
        let biased = self.attitude.bank_bias().abs() > DOUBTED_BIAS;
        Sensors {
            airspeed,
            pitch: if biased { inertial.doubted() } else { inertial },
            position,
            ..Sensors::default()
        }
    }

    /// Numbers of values that were not used.
    #[must_use]
    pub fn refused(&self) -> SpaceRefused {
        self.refused
    }
}

/// Bank about the direction of flight \[rad\]: the turn of the wing from the horizontal.
fn bank(attitude: Quaternion, path: &SpacePath) -> f64 {
    let [x, y, down] = attitude.in_world([0.0, 1.0, 0.0]);
    let [_, up, right] = path.axes();
    let along = |axis: [f64; 3]| x * axis[0] + y * axis[1] - down * axis[2];
    libm::atan2(-along(up), along(right))
}
