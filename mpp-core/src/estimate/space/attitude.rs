//! The attitude: that of a reference, carried on by the gyroscopes, and its slow error of the bank.
//!
//! The error of a told attitude wanders within seconds; gyroscopes tell turns of seconds well, and drift over minutes. A Kalman
//! filter on the turn to the true attitude and on the bias of the gyroscopes takes from both what is good. All axes have the same
//! errors, so one covariance serves all. It lives at the time of the last sample, because rates that come late would turn it
//! late. Source: Markley, Crassidis, "Fundamentals of Spacecraft Attitude Determination and Control", 6.2 (multiplicative filter);
//! errors that are alike over a time count as white ones of the same spectral density.

use crate::config::TICK_PERIOD;
use crate::estimate::history::MOST_AGE;
use crate::estimate::{MeasurementStatus, StuckDetector};
use crate::tuning::navigation::GATE;
use crate::tuning::sensors::EXCLUDED_AFTER;
use crate::tuning::space_inertial::{
    ATTITUDE_TIME, BIAS_TIME, FIRST_DRIFT, GYRO_DRIFT, GYRO_NOISE, GYRO_SHARE, LEAST_SIGMA,
    MOST_BIAS, MOST_CHANGE, MOST_FORCE, MOST_RATE,
};
use crate::vehicle::{Quaternion, within};

/// What an attitude reference, its gyroscopes and its accelerometers tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialSample {
    /// Ticks since the measurement.
    pub age: u32,
    /// Bank, pitch, heading \[rad\]. A heading of 0 looks downrange.
    pub attitude: [f64; 3],
    /// Declared standard deviation of the attitude's error about an axis \[rad\].
    pub sigma: f64,
    /// Roll rate, pitch rate, yaw rate [rad/s].
    pub rates: [f64; 3],
    /// Specific force along the body axes, ahead, to the right, down [m/s^2].
    pub force: [f64; 3],
}

impl InertialSample {
    fn is_sound(&self) -> bool {
        let attitude = self.attitude.iter().all(|it| it.is_finite());
        let rates = self.rates.iter().all(|it| it.abs() <= MOST_RATE);
        let force = self.force.iter().all(|it| it.abs() <= MOST_FORCE);
        attitude && rates && force && (0.0..=1.0).contains(&self.sigma)
    }
}

/// The attitude now, and what moves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct AttitudeFilter {
    attitude: Quaternion,
    /// Rates without their bias [rad/s].
    rates: [f64; 3],
    force: [f64; 3],
    sigma: f64,
    /// The estimate at the time of the last sample; `None` before the first one.
    fused: Option<Fused>,
    /// Ticks since before the oldest sample that may come, and ticks since the last one that agreed.
    ticks: u32,
    silent: u32,
    /// Bias of the bank \[rad\].
    bank_bias: f64,
    stuck: StuckDetector,
}

/// The filter's state at the time of a sample.
#[derive(Clone, Copy, Debug)]
struct Fused {
    /// Tick of the sample, and its rates [rad/s].
    tick: u32,
    rates: [f64; 3],
    attitude: Quaternion,
    /// Bias of the rates [rad/s].
    drift: [f64; 3],
    /// Variances of attitude and drift about an axis, and their covariance between.
    covariance: [f64; 3],
}

impl Fused {
    /// Believes a told attitude, and knows nothing of the drift.
    fn start(tick: u32, told: Quaternion, rates: [f64; 3], sigma: f64) -> Self {
        Self {
            tick,
            rates,
            attitude: told,
            drift: [0.0; 3],
            covariance: [sigma * sigma, 0.0, FIRST_DRIFT * FIRST_DRIFT],
        }
    }

    /// Moves on to the tick of the next sample, `dt` \[s\] later, by the mean of the rates of both.
    fn predict(&mut self, tick: u32, dt: f64, rates: [f64; 3]) {
        let turn = core::array::from_fn(|axis| {
            dt * (0.5 * (self.rates[axis] + rates[axis]) - self.drift[axis])
        });
        self.attitude = self.attitude.times(Quaternion::about(turn)).normalised();
        let fast: f64 = rates.iter().map(|it| it * it).sum();
        let noise = GYRO_NOISE * GYRO_NOISE + GYRO_SHARE * GYRO_SHARE * fast;
        let [own, both, drift] = self.covariance;
        self.covariance = [
            own - 2.0 * dt * both + dt * dt * drift + noise * dt,
            both - dt * drift,
            drift + GYRO_DRIFT * GYRO_DRIFT * dt,
        ];
        (self.tick, self.rates) = (tick, rates);
    }

    /// Takes up a told attitude of this tick, `dt` \[s\] after the one before: fewer of them tell as much in a second.
    fn correct(&mut self, told: Quaternion, dt: f64, sigma: f64) {
        let off = self.attitude.turn_to(told);
        let white = sigma * sigma * 2.0 * ATTITUDE_TIME / dt;
        let [own, both, drift] = self.covariance;
        let gain = [own, both].map(|it| it / (own + white));
        self.covariance = [
            own - gain[0] * own,
            both - gain[0] * both,
            drift - gain[1] * both,
        ];
        let turn = Quaternion::about(off.map(|it| gain[0] * it));
        self.attitude = self.attitude.times(turn).normalised();
        self.drift = core::array::from_fn(|axis| self.drift[axis] + gain[1] * off[axis]);
    }
}

impl AttitudeFilter {
    pub(super) const fn new() -> Self {
        Self {
            attitude: Quaternion::ONE,
            rates: [0.0; 3],
            force: [0.0; 3],
            sigma: 0.0,
            fused: None,
            ticks: MOST_AGE,
            silent: 0,
            bank_bias: 0.0,
            stuck: StuckDetector::new(),
        }
    }

    /// The attitude; `None` before the first sample, and when none has agreed for the greatest age of a measurement.
    pub(super) fn attitude(&self) -> Option<Quaternion> {
        (self.fused.is_some() && self.silent <= MOST_AGE).then_some(self.attitude)
    }

    pub(super) fn rates(&self) -> [f64; 3] {
        self.rates
    }

    /// Specific force along the body axes [m/s^2].
    pub(super) fn force(&self) -> [f64; 3] {
        self.force
    }

    /// Declared standard deviation of the attitude \[rad\].
    pub(super) fn sigma(&self) -> f64 {
        self.sigma.max(LEAST_SIGMA)
    }

    pub(super) fn bank_bias(&self) -> f64 {
        self.bank_bias
    }

    /// Learns the bias of the bank from the part of it that the acceleration's error shows \[rad\]. The estimate, which is a mean of
    /// told attitudes, has had the same bias.
    pub(super) fn learn(&mut self, bank_error: f64) {
        let before = self.bank_bias;
        let by = bank_error * (TICK_PERIOD / BIAS_TIME);
        self.bank_bias = within(before + by, MOST_BIAS);
        let turn = Quaternion::roll(before - self.bank_bias);
        self.attitude = self.attitude.times(turn);
        if let Some(fused) = &mut self.fused {
            fused.attitude = fused.attitude.times(turn);
        }
    }

    /// Moves on by a tick, and takes its sample.
    pub(super) fn step(&mut self, sample: Option<&InertialSample>) -> MeasurementStatus {
        self.ticks = self.ticks.saturating_add(1);
        self.silent = self.silent.saturating_add(1);
        let status = sample.map_or(MeasurementStatus::Missing, |it| self.take(it));
        if let Some(fused) = &self.fused {
            let since = f64::from(self.ticks.saturating_sub(fused.tick)) * TICK_PERIOD;
            let turned = Quaternion::about(self.rates.map(|it| it * since));
            self.attitude = fused.attitude.times(turned);
        }
        status
    }

    fn take(&mut self, sample: &InertialSample) -> MeasurementStatus {
        if !sample.is_sound() {
            return MeasurementStatus::NotFinite;
        }
        if sample.age > MOST_AGE {
            return MeasurementStatus::Late;
        }
        let all = sample.attitude.iter().chain(&sample.rates).sum();
        if self.stuck.take(all).is_nan() {
            return MeasurementStatus::Frozen;
        }
        (self.force, self.sigma) = (sample.force, sample.sigma);
        let told = Quaternion::attitude(sample.attitude).times(Quaternion::roll(-self.bank_bias));
        let tick = self.ticks.saturating_sub(sample.age);
        // An attitude that goes on to differ is believed: nothing else tells another one.
        let known = self.silent <= u32::from(EXCLUDED_AFTER);
        let (fused, agrees) = match self.fused.filter(|_| known) {
            Some(fused) if tick <= fused.tick => return MeasurementStatus::Late,
            Some(mut fused) => {
                let dt = f64::from(tick - fused.tick) * TICK_PERIOD;
                // The rates of an attitude that jumps still tell how the aircraft turns.
                fused.predict(tick, dt, sample.rates);
                let most = GATE * self.sigma() + MOST_CHANGE * f64::from(self.silent);
                let agrees = fused.attitude.angle_to(told) <= most;
                if agrees {
                    fused.correct(told, dt, self.sigma());
                }
                (fused, agrees)
            }
            None => (Fused::start(tick, told, sample.rates, self.sigma()), true),
        };
        self.rates = core::array::from_fn(|axis| sample.rates[axis] - fused.drift[axis]);
        self.fused = Some(fused);
        if !agrees {
            return MeasurementStatus::Gated;
        }
        self.silent = 0;
        MeasurementStatus::Accepted
    }
}
