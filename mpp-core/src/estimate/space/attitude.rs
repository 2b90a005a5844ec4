//! The attitude as a reference gives it, tested by the rates, and its slow error of the bank.

use crate::config::TICK_PERIOD;
use crate::estimate::history::MOST_AGE;
use crate::estimate::{MeasurementStatus, StuckDetector};
use crate::tuning::navigation::GATE;
use crate::tuning::sensors::EXCLUDED_AFTER;
use crate::tuning::space_inertial::{
    BIAS_TIME, LEAST_SIGMA, MOST_BIAS, MOST_CHANGE, MOST_FORCE, MOST_RATE,
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
    rates: [f64; 3],
    force: [f64; 3],
    sigma: f64,
    /// Whether there was a sample.
    started: bool,
    /// Ticks since the last sample that agreed.
    silent: u32,
    /// Bias of the bank \[rad\].
    bank_bias: f64,
    stuck: StuckDetector,
}

impl AttitudeFilter {
    pub(super) const fn new() -> Self {
        Self {
            attitude: Quaternion::ONE,
            rates: [0.0; 3],
            force: [0.0; 3],
            sigma: 0.0,
            started: false,
            silent: 0,
            bank_bias: 0.0,
            stuck: StuckDetector::new(),
        }
    }

    /// The attitude; `None` before the first sample, and when none has agreed for the greatest age of a measurement.
    pub(super) fn attitude(&self) -> Option<Quaternion> {
        (self.started && self.silent <= MOST_AGE).then_some(self.attitude)
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

    /// Learns the bias of the bank from the part of it that the acceleration's error shows \[rad\].
    pub(super) fn learn(&mut self, bank_error: f64) {
        let by = bank_error * (TICK_PERIOD / BIAS_TIME);
        self.bank_bias = within(self.bank_bias + by, MOST_BIAS);
    }

    /// Moves on by a tick, and takes its sample.
    pub(super) fn step(&mut self, sample: Option<&InertialSample>) -> MeasurementStatus {
        self.silent = self.silent.saturating_add(1);
        let turned = Quaternion::about(self.rates.map(|it| it * TICK_PERIOD));
        self.attitude = self.attitude.times(turned).normalised();
        let Some(sample) = sample else {
            return MeasurementStatus::Missing;
        };
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
        (self.rates, self.force, self.sigma) = (sample.rates, sample.force, sample.sigma);
        let since = f64::from(sample.age) * TICK_PERIOD;
        let told = Quaternion::attitude(sample.attitude)
            .times(Quaternion::roll(-self.bank_bias))
            .times(Quaternion::about(sample.rates.map(|it| it * since)));
        let change = self.attitude.angle_to(told);
        let most = GATE * self.sigma() + MOST_CHANGE * f64::from(self.silent);
        // An attitude that goes on to differ is believed: nothing else tells another one.
        if self.started && self.silent <= u32::from(EXCLUDED_AFTER) && change > most {
            return MeasurementStatus::Gated;
        }
        (self.attitude, self.started, self.silent) = (told, true, 0);
        MeasurementStatus::Accepted
    }
}
