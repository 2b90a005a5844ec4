//! Tests the filter against a simulated aircraft, and against its own textbook form.

use crate::common::draw::Draw;
use mpp_core::estimate::{Diverged, Ekf, EkfTuning, MeasurementStatus};
use mpp_core::sense::Measurement;
use mpp_core::vehicle::{AirState, Airframe, Control, JacobianForm, Trim, air_rate};
use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};

const AIRFRAME: Airframe = Airframe::REFERENCE;
const PERIOD: f64 = 0.01;

/// Noise of a calm flight. The paper's values are so large that the true aircraft would tumble.
const CALM: EkfTuning = EkfTuning {
    process_noise: [4e-4, 1e-6, 4e-4, 1e-6],
    airspeed_variance: 0.25,
    pitch_variance: 2e-5,
    initial_variance: 0.01,
    gate: 6.0,
    jacobian: JacobianForm::Exact,
};

fn trim() -> Trim {
    Trim::of_authors(&AIRFRAME)
}

/// A standard normal random number (Box, Muller).
fn normal(draw: &mut Draw) -> f64 {
    let radius = libm::sqrt(-2.0 * libm::log(1.0 - draw.unit()));
    radius * libm::cos(draw.between(0.0, core::f64::consts::TAU))
}

fn normals(draw: &mut Draw, variances: [f64; 4]) -> Vector4<f64> {
    Vector4::from(variances.map(|variance| libm::sqrt(variance) * normal(draw)))
}

/// A nonlinear aircraft with noise, and its sensors.
struct Aircraft {
    state: AirState,
    draw: Draw,
    tuning: EkfTuning,
}

impl Aircraft {
    /// Starts somewhere about trim, as uncertain as the filter believes.
    fn new(seed: u64, tuning: EkfTuning) -> Self {
        let mut draw = Draw::new(seed);
        let start = trim().state.to_vector() + normals(&mut draw, [tuning.initial_variance; 4]);
        Self {
            state: AirState::from_vector(&start),
            draw,
            tuning,
        }
    }

    fn fly(&mut self, control: Control) {
        let rate = air_rate(&AIRFRAME, &self.state, control).to_vector();
        let noise = normals(&mut self.draw, self.tuning.process_noise);
        self.state = AirState::from_vector(&(self.state.to_vector() + rate * PERIOD + noise));
    }

    fn measure(&mut self) -> Measurement {
        Measurement {
            airspeed: self.state.airspeed
                + libm::sqrt(self.tuning.airspeed_variance) * normal(&mut self.draw),
            pitch: self.state.pitch
                + libm::sqrt(self.tuning.pitch_variance) * normal(&mut self.draw),
        }
    }
}

fn settled(tuning: EkfTuning) -> Ekf {
    let mut ekf = Ekf::new(AIRFRAME, tuning, trim().state);
    for _ in 0..300 {
        ekf.predict(trim().control, PERIOD).unwrap();
        ekf.update(&at_trim());
    }
    ekf
}

fn at_trim() -> Measurement {
    Measurement {
        airspeed: trim().state.airspeed,
        pitch: trim().state.pitch,
    }
}

fn assert_covariance(covariance: &Matrix4<f64>) {
    let skew = (covariance - covariance.transpose()).amax();
    assert!(skew <= 1e-12 * covariance.amax(), "not symmetric by {skew}");
    let symmetric = (covariance + covariance.transpose()) * 0.5;
    assert!(symmetric.cholesky().is_some(), "{covariance}");
}

#[test]
fn errors_are_as_large_as_the_covariance_says() {
    // Over 300 runs the squared error, normalised by the covariance, averages 4; the interval is
    // that of a chi-square with 1,200 degrees of freedom at 3.5 standard deviations.
    const RUNS: u64 = 300;
    let half_width = 3.5 * libm::sqrt(2.0 * 4.0 / RUNS as f64);
    let checkpoints = [10, 50, 100, 200, 400];
    let mut squared = [0.0; 5];
    for seed in 0..RUNS {
        let mut aircraft = Aircraft::new(seed, CALM);
        let mut ekf = Ekf::new(AIRFRAME, CALM, trim().state);
        for step in 1..=400 {
            let mut control = trim().control;
            control.elevator += 2.0 * libm::sin(0.05 * f64::from(step));
            control.thrust += 2.0 * libm::cos(0.02 * f64::from(step));
            aircraft.fly(control);
            ekf.predict(control, PERIOD).unwrap();
            ekf.update(&aircraft.measure());
            if let Some(index) = checkpoints.iter().position(|at| *at == step) {
                let error = aircraft.state.to_vector() - ekf.estimate().to_vector();
                let information = ekf.covariance().try_inverse().unwrap();
                squared[index] += (error.transpose() * information * error).x / RUNS as f64;
            }
        }
    }
    for (mean, step) in squared.iter().zip(checkpoints) {
        assert!((mean - 4.0).abs() < half_width, "{mean} after {step} steps");
    }
}

#[test]
fn the_covariance_stays_symmetric_and_positive_on_long_rough_flights() {
    for tuning in [CALM, EkfTuning::EXACT, EkfTuning::AUTHORS] {
        let mut aircraft = Aircraft::new(7, CALM);
        let mut ekf = Ekf::new(AIRFRAME, tuning, trim().state);
        for step in 0..20_000 {
            let mut control = trim().control;
            control.elevator += 3.0 * libm::sin(0.03 * f64::from(step));
            aircraft.fly(control);
            ekf.predict(control, PERIOD).unwrap();
            let mut measurement = aircraft.measure();
            match aircraft.draw.unit() {
                share if share < 0.05 => measurement.airspeed = f64::NAN,
                share if share < 0.10 => measurement.pitch = f64::INFINITY,
                share if share < 0.12 => measurement.pitch += 9.0,
                _ => {}
            }
            ekf.update(&measurement);
            assert_covariance(ekf.covariance());
        }
        let error = (ekf.estimate().to_vector() - aircraft.state.to_vector()).abs();
        assert!(error.x < 2.0 && error.y < 0.1 && error.w < 0.2, "{error:?}");
    }
}

#[test]
fn one_value_after_the_other_equals_the_joint_update() {
    let mut aircraft = Aircraft::new(3, CALM);
    let mut ekf = Ekf::new(AIRFRAME, CALM, trim().state);
    for _ in 0..200 {
        aircraft.fly(trim().control);
        ekf.predict(trim().control, PERIOD).unwrap();
        let measurement = aircraft.measure();
        let (before, p) = (ekf.estimate().to_vector(), *ekf.covariance());
        ekf.update(&measurement);

        let h = Matrix2x4::identity();
        let noise =
            Matrix2::from_diagonal(&Vector2::new(CALM.airspeed_variance, CALM.pitch_variance));
        let gain = p * h.transpose() * (h * p * h.transpose() + noise).try_inverse().unwrap();
        let measured = Vector2::new(measurement.airspeed, measurement.pitch);
        let expected = before + gain * (measured - h * before);
        assert!((ekf.estimate().to_vector() - expected).amax() < 1e-10);
        let covariance = (Matrix4::identity() - gain * h) * p;
        assert!((ekf.covariance() - covariance).amax() < 1e-12);
    }
}

#[test]
fn predictions_move_state_and_covariance_by_the_nonlinear_model() {
    let mut ekf = settled(CALM);
    let control = Control {
        thrust: 6.0,
        elevator: 5.0,
    };
    let (before, p) = (*ekf.estimate(), *ekf.covariance());
    let flow = |x: Vector4<f64>| {
        let rate = air_rate(&AIRFRAME, &AirState::from_vector(&x), control).to_vector();
        x + rate * PERIOD
    };
    let mut transition = Matrix4::zeros();
    for index in 0..4 {
        let mut step = Vector4::zeros();
        step[index] = 1e-5;
        let x = before.to_vector();
        transition.set_column(index, &((flow(x + step) - flow(x - step)) / 2e-5));
    }
    ekf.predict(control, PERIOD).unwrap();
    assert!((ekf.estimate().to_vector() - flow(before.to_vector())).amax() < 1e-12);
    let noise = Matrix4::from_diagonal(&Vector4::from(CALM.process_noise));
    let expected = transition * p * transition.transpose() + noise;
    assert!((ekf.covariance() - expected).amax() < 1e-8);
}

#[test]
fn a_spike_is_gated_and_changes_nothing() {
    for tuning in [CALM, EkfTuning::EXACT, EkfTuning::AUTHORS] {
        let mut ekf = settled(tuning);
        let (state, covariance) = (*ekf.estimate(), *ekf.covariance());
        let spike = Measurement {
            airspeed: 40.0,
            pitch: 2.5,
        };
        let verdicts = ekf.update(&spike);
        assert_eq!(
            [verdicts.airspeed, verdicts.pitch],
            [MeasurementStatus::Gated; 2]
        );
        assert_eq!((*ekf.estimate(), *ekf.covariance()), (state, covariance));
        let verdicts = ekf.update(&at_trim());
        assert_eq!(
            [verdicts.airspeed, verdicts.pitch],
            [MeasurementStatus::Accepted; 2]
        );
    }
}

#[test]
fn the_gate_stands_where_the_tuning_puts_it() {
    for (factor, expected) in [
        (0.999, MeasurementStatus::Accepted),
        (1.001, MeasurementStatus::Gated),
    ] {
        for sign in [-1.0, 1.0] {
            let mut ekf = settled(CALM);
            let sigma = libm::sqrt(ekf.covariance()[(0, 0)] + CALM.airspeed_variance);
            let edge = Measurement {
                airspeed: ekf.estimate().airspeed + sign * factor * CALM.gate * sigma,
                pitch: f64::NAN,
            };
            assert_eq!(ekf.update(&edge).airspeed, expected);
        }
    }
}

#[test]
fn a_lasting_change_is_taken_in_after_a_while() {
    let mut ekf = settled(EkfTuning::EXACT);
    let changed = Measurement {
        airspeed: trim().state.airspeed + 8.0,
        pitch: trim().state.pitch,
    };
    let mut gated = 0;
    for _ in 0..500 {
        ekf.predict(trim().control, PERIOD).unwrap();
        gated += usize::from(ekf.update(&changed).airspeed == MeasurementStatus::Gated);
    }
    assert!((1..300).contains(&gated), "{gated} values were gated");
    let rest = ekf.estimate().airspeed - changed.airspeed;
    assert!(rest.abs() < 2.0, "{rest} m/s are left");
}

#[test]
fn values_that_are_none_are_told_apart_and_change_nothing() {
    let good = at_trim();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut ekf = settled(CALM);
        let (state, covariance) = (*ekf.estimate(), *ekf.covariance());
        let verdicts = ekf.update(&Measurement {
            airspeed: bad,
            pitch: bad,
        });
        assert_eq!(
            [verdicts.airspeed, verdicts.pitch],
            [MeasurementStatus::NotFinite; 2]
        );
        assert_eq!((*ekf.estimate(), *ekf.covariance()), (state, covariance));

        let verdicts = ekf.update(&Measurement {
            airspeed: bad,
            ..good
        });
        assert_eq!(
            (verdicts.airspeed, verdicts.pitch),
            (MeasurementStatus::NotFinite, MeasurementStatus::Accepted)
        );
        assert_ne!(*ekf.covariance(), covariance, "the pitch was used");
    }
}

#[test]
fn predictions_without_meaning_are_refused_and_change_nothing() {
    let still = AirState {
        airspeed: 0.0,
        ..trim().state
    };
    let mut ekf = Ekf::new(AIRFRAME, CALM, still);
    assert_eq!(ekf.predict(trim().control, PERIOD), Err(Diverged));
    assert_eq!(*ekf.estimate(), still);

    let mut ekf = settled(CALM);
    let (state, covariance) = (*ekf.estimate(), *ekf.covariance());
    let broken = Control {
        thrust: f64::NAN,
        elevator: 0.0,
    };
    assert_eq!(ekf.predict(broken, PERIOD), Err(Diverged));
    assert_eq!(ekf.predict(trim().control, f64::INFINITY), Err(Diverged));
    assert_eq!((*ekf.estimate(), *ekf.covariance()), (state, covariance));
}
