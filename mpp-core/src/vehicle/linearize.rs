//! Analytic Jacobians of the equations of motion.

use super::dynamics::Directions;
use super::{AirState, Airframe, Control, GRAVITY};
use nalgebra::{Matrix4, Matrix4x2};

/// Form of the Jacobian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JacobianForm {
    /// The Jacobian with every partial derivative.
    Exact,
    /// The Jacobian of the authors' code, for comparison. It leaves out `d theta''/d theta'`,
    /// `d theta''/dT`, the share of `d gamma'/dv` that comes from the division by `v`, and the share of
    /// `d theta''/dv` that comes from `d gamma'/dv`.
    #[cfg(feature = "paper")]
    Authors,
}

/// Linear model `d/dt dx = a dx + b du` about an operating point. The order of the state is
/// `(v, theta, theta', gamma)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearization {
    /// State Jacobian, 4 x 4.
    pub a: Matrix4<f64>,
    /// Control Jacobian, 4 x 2, columns `(thrust, elevator)`.
    pub b: Matrix4x2<f64>,
}

/// Linearises [`super::air_rate`] about `state` and `control`.
#[must_use]
pub fn linearize(
    airframe: &Airframe,
    state: &AirState,
    control: Control,
    form: JacobianForm,
) -> Linearization {
    linearize_along(&Directions::of(state), airframe, state, control, form)
}

/// Does the work of [`linearize`] with the directions of the state.
pub(crate) fn linearize_along(
    directions: &Directions,
    airframe: &Airframe,
    state: &AirState,
    control: Control,
    form: JacobianForm,
) -> Linearization {
    let a = airframe;
    let v = state.airspeed;
    let alpha = state.angle_of_attack();
    let (sin_path, cos_path) = directions.path;
    let (sin_alpha, cos_alpha) = directions.alpha;
    let thrust = control.thrust;
    let pressure_area = 0.5 * a.air_density * (v * v) * a.wing_area;
    // The lift by the rate of the angle of attack adds to the momentum: its share of `m v` grows with `v`.
    let momentum = a.mass * v + pressure_area * a.lift_alpha_rate;
    let added = pressure_area * a.lift_alpha_rate / momentum;

    let lift_coefficient = a.lift_zero + a.lift_alpha * alpha + a.lift_elevator * control.elevator;
    let drag_coefficient = a.drag_zero + a.drag_induced * (lift_coefficient * lift_coefficient);
    let rate_lift = (a.lift_alpha_rate + a.lift_pitch_rate) * state.pitch_rate;
    let lift = pressure_area * lift_coefficient + pressure_area * rate_lift;
    let lift_v = a.air_density * v * a.wing_area * (lift_coefficient + rate_lift);
    let lift_alpha = pressure_area * a.lift_alpha;
    let drag_v = a.air_density * v * a.wing_area * drag_coefficient;
    let drag_alpha = 2.0 * a.drag_induced * pressure_area * lift_coefficient * a.lift_alpha;

    // gamma' = (L + q S (C_La' + C_Lq) theta' - m g cos(gamma) + T sin(alpha)) / (m v + q S C_La')
    let path_rate = (lift - a.mass * GRAVITY * cos_path + thrust * sin_alpha) / momentum;
    let path_v = match form {
        JacobianForm::Exact => lift_v / momentum - path_rate / v * (1.0 + added),
        #[cfg(feature = "paper")]
        JacobianForm::Authors => lift_v / momentum,
    };
    let path_pitch = (lift_alpha + thrust * cos_alpha) / momentum;
    let path_path = (-lift_alpha - thrust * cos_alpha + a.mass * GRAVITY * sin_path) / momentum;
    let path_thrust = sin_alpha / momentum;
    let path_turn = pressure_area * (a.lift_alpha_rate + a.lift_pitch_rate) / momentum;
    let path_elevator = pressure_area * a.lift_elevator / momentum;

    // theta'' = q S l / I (C_M0 + C_Ma alpha + C_Ma' (theta' - gamma') + C_Mq theta' + C_Me delta_e)
    let moment_scale = pressure_area * a.moment_length / a.pitch_inertia;
    let moment_coefficient = a.moment_zero
        + a.moment_alpha * alpha
        + a.moment_alpha_rate * (state.pitch_rate - path_rate)
        + a.moment_pitch_rate * state.pitch_rate
        + a.moment_elevator * control.elevator;
    let moment_v =
        a.air_density * v * a.wing_area * a.moment_length / a.pitch_inertia * moment_coefficient;
    let (pitch_v, pitch_rate, pitch_thrust) = match form {
        JacobianForm::Exact => (
            moment_v - moment_scale * a.moment_alpha_rate * path_v,
            moment_scale * (a.moment_alpha_rate * (1.0 - path_turn) + a.moment_pitch_rate),
            -moment_scale * a.moment_alpha_rate * path_thrust,
        ),
        #[cfg(feature = "paper")]
        JacobianForm::Authors => (moment_v, 0.0, 0.0),
    };
    let pitch_pitch = moment_scale * (a.moment_alpha - a.moment_alpha_rate * path_pitch);
    let pitch_path = moment_scale * (-a.moment_alpha - a.moment_alpha_rate * path_path);

    // v' = (-D - m g sin(gamma) + T cos(alpha)) / m
    let speed_alpha = (-drag_alpha - thrust * sin_alpha) / a.mass;
    let drag_elevator = 2.0 * a.drag_induced * pressure_area * lift_coefficient * a.lift_elevator;
    let pitch_elevator = moment_scale * (a.moment_elevator - a.moment_alpha_rate * path_elevator);
    #[rustfmt::skip]
    let state_jacobian = Matrix4::new(
        -drag_v / a.mass, speed_alpha, 0.0,        -speed_alpha - GRAVITY * cos_path,
        0.0,              0.0,         1.0,        0.0,
        pitch_v,          pitch_pitch, pitch_rate, pitch_path,
        path_v,           path_pitch,  path_turn,  path_path,
    );
    #[rustfmt::skip]
    let control_jacobian = Matrix4x2::new(
        cos_alpha / a.mass, -drag_elevator / a.mass,
        0.0,                0.0,
        pitch_thrust,       pitch_elevator,
        path_thrust,        path_elevator,
    );
    Linearization {
        a: state_jacobian,
        b: control_jacobian,
    }
}
