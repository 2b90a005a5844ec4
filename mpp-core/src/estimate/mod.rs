//! Extended Kalman filter on `(v, theta, theta', gamma)` from airspeed and pitch (paper, II-B).

mod conditions;
mod lift;
mod wind;

use crate::vehicle::{AirState, Airframe, Control, JacobianForm, air_rate, linearize};
pub use conditions::{Conditions, ConditionsEstimator};
pub use lift::LiftEstimator;
use nalgebra::{Matrix4, SMatrix, Vector4};
pub use wind::WindEstimator;

/// Airspeed and pitch as measured; the two errors are independent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Pitch [rad].
    pub pitch: f64,
}

/// Tuning of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EkfTuning {
    /// Process noise added at each prediction, diagonal [(m/s)^2, rad^2, (rad/s)^2, rad^2]. Larger
    /// values make the estimate follow the sensors more closely.
    pub process_noise: [f64; 4],
    /// Variance of the airspeed error [(m/s)^2].
    pub airspeed_variance: f64,
    /// Variance of the pitch error [rad^2].
    pub pitch_variance: f64,
    /// Initial variance of every state.
    pub initial_variance: f64,
    /// An innovation beyond this many standard deviations is rejected [-].
    pub gate: f64,
    /// Jacobian used for the covariance.
    pub jacobian: JacobianForm,
}

impl EkfTuning {
    /// The authors' values; the gate is ours (a healthy sensor meets it once in 5e8 samples).
    pub const AUTHORS: Self = {
        // The authors write 0.1/180*pi^2, a squared degree with pi misplaced; it is their tuning.
        let angle = 0.1 / 180.0 * (core::f64::consts::PI * core::f64::consts::PI);
        let pitch_sigma = 0.25 / 180.0 * core::f64::consts::PI;
        Self {
            process_noise: [0.01, angle, angle, angle],
            airspeed_variance: 0.25,
            pitch_variance: pitch_sigma * pitch_sigma,
            initial_variance: 0.01,
            gate: 6.0,
            jacobian: JacobianForm::Authors,
        }
    };

    /// As the sensors and the equations of motion are: little noise in the process, so that the flight
    /// path angle, which no sensor sees, follows from the equations. Only the moments are uncertain: a
    /// tenth of the pitch stiffness turns the reference airframe by up to 0.3 rad/s within a tick.
    pub const SENSORS: Self = Self {
        process_noise: [1e-4, 1e-6, 1e-1, 1e-6],
        ..Self::EXACT
    };

    /// The same noise with the exact Jacobian.
    pub const EXACT: Self = Self {
        jacobian: JacobianForm::Exact,
        ..Self::AUTHORS
    };
}

/// What became of one measured value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Used.
    Accepted,
    /// Beyond the innovation gate: not used; the covariance grows until such values pass again.
    Gated,
    /// Not a finite number: not used.
    NotFinite,
}

/// The verdicts on one measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Innovation {
    /// On the airspeed.
    pub airspeed: Verdict,
    /// On the pitch.
    pub pitch: Verdict,
}

/// The prediction is not finite (for instance at no airspeed): the filter keeps its last estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Diverged;

/// Extended Kalman filter with the state order `(v, theta, theta', gamma)`.
#[derive(Clone, Debug)]
pub struct Ekf {
    airframe: Airframe,
    tuning: EkfTuning,
    estimate: AirState,
    covariance: Matrix4<f64>,
}

impl Ekf {
    /// Starts from an estimate.
    #[must_use]
    pub fn new(airframe: Airframe, tuning: EkfTuning, estimate: AirState) -> Self {
        Self {
            airframe,
            tuning,
            estimate,
            covariance: Matrix4::from_diagonal_element(tuning.initial_variance),
        }
    }

    /// The current estimate.
    #[must_use]
    pub fn estimate(&self) -> &AirState {
        &self.estimate
    }

    /// Goes by another airframe from now on.
    pub fn set_airframe(&mut self, airframe: &Airframe) {
        self.airframe = *airframe;
    }

    /// The current covariance, 4 x 4, in the order and units of the state.
    #[must_use]
    pub fn covariance(&self) -> &Matrix4<f64> {
        &self.covariance
    }

    /// Moves the estimate on by `period` [s] (forward Euler) under the control flown since:
    /// `x <- x + f(x, u) dt`, `P <- F P F' + Q` with `F = I + A dt`.
    ///
    /// # Errors
    /// [`Diverged`] when the prediction is not finite.
    pub fn predict(&mut self, control: Control, period: f64) -> Result<(), Diverged> {
        let linear = linearize(
            &self.airframe,
            &self.estimate,
            control,
            self.tuning.jacobian,
        );
        let transition = Matrix4::identity() + linear.a * period;
        let rate = air_rate(&self.airframe, &self.estimate, control).to_vector();
        let predicted = AirState::from_vector(&(self.estimate.to_vector() + rate * period));
        let covariance = symmetric(&(transition * self.covariance * transition.transpose()))
            + Matrix4::from_diagonal(&Vector4::from(self.tuning.process_noise));
        if !predicted.is_finite() || !covariance.iter().all(|value| value.is_finite()) {
            return Err(Diverged);
        }
        self.estimate = predicted;
        self.covariance = covariance;
        Ok(())
    }

    /// Corrects the estimate by a measurement. The errors are independent, so the two values are
    /// taken one after the other, which equals the joint update and needs no matrix inverse.
    pub fn update(&mut self, measurement: &Measurement) -> Innovation {
        Innovation {
            airspeed: self.correct::<0>(measurement.airspeed, self.tuning.airspeed_variance),
            pitch: self.correct::<1>(measurement.pitch, self.tuning.pitch_variance),
        }
    }

    /// Scalar update by a measurement of state `INDEX`, covariance in Joseph's form, which keeps
    /// it positive.
    fn correct<const INDEX: usize>(&mut self, measured: f64, variance: f64) -> Verdict {
        if !measured.is_finite() {
            return Verdict::NotFinite;
        }
        let mut state = self.estimate.to_vector();
        let innovation = measured - state[INDEX];
        let innovation_variance = self.covariance[(INDEX, INDEX)] + variance;
        if innovation * innovation > self.tuning.gate * self.tuning.gate * innovation_variance {
            return Verdict::Gated;
        }
        let gain: Vector4<f64> = self.covariance.column(INDEX) / innovation_variance;
        state += gain * innovation;
        self.estimate = AirState::from_vector(&state);

        let mut observation = SMatrix::<f64, 1, 4>::zeros();
        observation[INDEX] = 1.0;
        let shrink = Matrix4::identity() - gain * observation;
        self.covariance = symmetric(
            &(shrink * self.covariance * shrink.transpose() + gain * variance * gain.transpose()),
        );
        Verdict::Accepted
    }
}

/// Products are symmetric but for rounding, which would grow over a long flight.
fn symmetric(matrix: &Matrix4<f64>) -> Matrix4<f64> {
    (matrix + matrix.transpose()) * 0.5
}
