//! Extended Kalman filter on `(v, theta, theta', gamma)` from airspeed and pitch (paper, II-B).

use super::{Innovation, MeasurementStatus};
use crate::sense::Measurement;
use crate::vehicle::{
    AirState, Airframe, Control, Directions, JacobianForm, air_rate_along, linearize_along,
};
use nalgebra::{Matrix4, Vector4};

/// Tuning of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EkfTuning {
    /// Diagonal of the process noise that each prediction adds [(m/s)^2, rad^2, (rad/s)^2, rad^2]. Larger
    /// values make the estimate follow the sensors more closely.
    pub process_noise: [f64; 4],
    /// Variance of the airspeed error [(m/s)^2].
    pub airspeed_variance: f64,
    /// Variance of the pitch error [rad^2].
    pub pitch_variance: f64,
    /// Initial variance of every state.
    pub initial_variance: f64,
    /// Greatest accepted innovation, in standard deviations [-].
    pub gate: f64,
    /// Jacobian used for the covariance.
    pub jacobian: JacobianForm,
}

impl EkfTuning {
    /// The authors' noise with the exact Jacobian. The gate is ours: a healthy sensor exceeds it once in 5e8
    /// samples.
    pub const EXACT: Self = {
        // The authors write 0.1/180*pi^2. They misplaced pi in a squared degree, but this is their tuning.
        let angle = 0.1 / 180.0 * (core::f64::consts::PI * core::f64::consts::PI);
        let pitch_sigma = 0.25 / 180.0 * core::f64::consts::PI;
        Self {
            process_noise: [0.01, angle, angle, angle],
            airspeed_variance: 0.25,
            pitch_variance: pitch_sigma * pitch_sigma,
            initial_variance: 0.01,
            gate: 6.0,
            jacobian: JacobianForm::Exact,
        }
    };

    /// The authors' noise with the authors' Jacobian.
    #[cfg(feature = "paper")]
    pub const AUTHORS: Self = Self {
        jacobian: JacobianForm::Authors,
        ..Self::EXACT
    };

    /// Tuning after the true accuracy of the sensors and of the equations of motion. The process noise is
    /// small, so that the flight path angle, which no sensor measures, follows from the equations. Only the
    /// moments are uncertain: a tenth of the pitch stiffness turns the reference airframe by up to 0.3 rad/s
    /// within a tick.
    pub const SENSORS: Self = Self {
        process_noise: [1e-4, 1e-6, 1e-1, 1e-6],
        ..Self::EXACT
    };
}

/// The prediction is not finite, for instance because the airspeed is zero. The filter keeps its last
/// estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the estimator's prediction is not finite: check the control and the time since the last")]
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
    /// The filter's tuning.
    #[must_use]
    pub fn tuning(&self) -> &EkfTuning {
        &self.tuning
    }

    /// A filter that starts from an estimate.
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

    /// The airframe of the predictions.
    #[must_use]
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// Sets the airframe for the predictions from now on.
    pub fn set_airframe(&mut self, airframe: &Airframe) {
        self.airframe = *airframe;
    }

    /// The current covariance, 4 x 4, in the order and units of the state.
    #[must_use]
    pub fn covariance(&self) -> &Matrix4<f64> {
        &self.covariance
    }

    /// Advances the estimate by `period` \[s\] (forward Euler) under the control flown in that time:
    /// `x <- x + f(x, u) dt`, `P <- F P F' + Q` with `F = I + A dt`.
    ///
    /// # Errors
    /// [`Diverged`] if the prediction is not finite.
    pub fn predict(&mut self, control: Control, period: f64) -> Result<(), Diverged> {
        let directions = Directions::of(&self.estimate);
        let linear = linearize_along(
            &directions,
            &self.airframe,
            &self.estimate,
            control,
            self.tuning.jacobian,
        );
        let transition = Matrix4::identity() + linear.a * period;
        let rate = air_rate_along(&directions, &self.airframe, &self.estimate, control);
        let predicted =
            AirState::from_vector(&(self.estimate.to_vector() + rate.to_vector() * period));
        let covariance = symmetric(&(transition * self.covariance * transition.transpose()))
            + Matrix4::from_diagonal(&Vector4::from(self.tuning.process_noise));
        if !predicted.is_finite() || !covariance.iter().all(|value| value.is_finite()) {
            return Err(Diverged);
        }
        self.estimate = predicted;
        self.covariance = covariance;
        Ok(())
    }

    /// Doubts the motion, because the aircraft was not controlled for some time: adds the squares of these standard
    /// deviations \[m/s, rad, rad/s, rad\] to the covariance.
    pub fn doubt(&mut self, sigmas: [f64; 4]) {
        for (index, sigma) in sigmas.into_iter().enumerate() {
            self.covariance[(index, index)] += sigma * sigma;
        }
    }

    /// Moves the estimated airspeed by a known error [m/s].
    pub fn shift_airspeed(&mut self, by: f64) {
        self.estimate.airspeed += by;
    }

    /// Turns the estimated motion by a known error of the pitch \[rad\]. The angle of attack stays.
    pub fn turn(&mut self, by: f64) {
        self.estimate.pitch += by;
        self.estimate.flight_path += by;
    }

    /// Replaces the estimated path \[rad\] and angle of attack \[rad\], because the pitch that taught them was wrong. The pitch
    /// rate begins at 0.
    pub fn restart_pitch(&mut self, flight_path: f64, angle_of_attack: f64) {
        self.estimate.flight_path = flight_path;
        self.estimate.pitch = flight_path + angle_of_attack;
        self.estimate.pitch_rate = 0.0;
    }

    /// Corrects the estimate by a measurement. The two errors are independent, so the filter processes one
    /// value after the other. The result equals the joint update and needs no matrix inverse.
    pub fn update(&mut self, measurement: &Measurement) -> Innovation {
        self.update_by(measurement, [true, true])
    }

    /// Does the same, but uses airspeed and pitch only where `used` says so. The other value gets a verdict
    /// too.
    pub fn update_by(&mut self, measurement: &Measurement, used: [bool; 2]) -> Innovation {
        let Measurement { airspeed, pitch } = *measurement;
        Innovation {
            airspeed: self.correct::<0>(airspeed, self.tuning.airspeed_variance, used[0]),
            pitch: self.correct::<1>(pitch, self.tuning.pitch_variance, used[1]),
        }
    }

    /// Scalar update by a measurement of state `INDEX`. Joseph's form keeps the covariance positive.
    fn correct<const INDEX: usize>(
        &mut self,
        measured: f64,
        variance: f64,
        used: bool,
    ) -> MeasurementStatus {
        if !measured.is_finite() {
            return MeasurementStatus::NotFinite;
        }
        let mut state = self.estimate.to_vector();
        let innovation = measured - state[INDEX];
        let innovation_variance = self.covariance[(INDEX, INDEX)] + variance;
        if innovation * innovation > self.tuning.gate * self.tuning.gate * innovation_variance {
            return MeasurementStatus::Gated;
        }
        if !used {
            return MeasurementStatus::Distrusted;
        }
        let gain: Vector4<f64> = self.covariance.column(INDEX) / innovation_variance;
        state += gain * innovation;
        self.estimate = AirState::from_vector(&state);

        // `(I - k h') P (I - k h')' + k r k'`, whose products with the zeros of `h` are left out.
        let known = self.covariance;
        let kept = 1.0 - gain[INDEX];
        let shrunk = Matrix4::from_fn(|row, col| match row {
            row if row == INDEX => kept * known[(INDEX, col)],
            row => known[(row, col)] - gain[row] * known[(INDEX, col)],
        });
        let corrected = Matrix4::from_fn(|row, col| {
            let part = match col {
                col if col == INDEX => shrunk[(row, INDEX)] * kept,
                col => shrunk[(row, col)] - shrunk[(row, INDEX)] * gain[col],
            };
            part + gain[row] * variance * gain[col]
        });
        self.covariance = symmetric(&corrected);
        MeasurementStatus::Accepted
    }
}

/// The symmetric part of a matrix. Rounding makes the products slightly asymmetric, and this error would
/// grow over a long flight.
fn symmetric(matrix: &Matrix4<f64>) -> Matrix4<f64> {
    (matrix + matrix.transpose()) * 0.5
}
