//! The nonlinear longitudinal equations of motion (paper, section II-A).
//!
//! The paper prints `L/(mv) - cos(gamma)/v - T sin(alpha)/(mv)` for the flight path rate. The balance of
//! lift, weight and thrust gives `(L - m g cos(gamma) + T sin(alpha)) / (m v)` instead. The authors' code
//! integrates this second form too.

use mpp_data::{Airframe, Control, GRAVITY};
use nalgebra::Vector4;

/// Motion through the air. The estimator estimates it, and the regulator controls it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AirState {
    /// Airspeed `v` [m/s].
    pub airspeed: f64,
    /// Pitch `theta` \[rad\], nose-up positive.
    pub pitch: f64,
    /// Pitch rate `theta'` [rad/s].
    pub pitch_rate: f64,
    /// Flight path angle `gamma` \[rad\], climbing positive.
    pub flight_path: f64,
}

impl AirState {
    /// At rest: the value in a planner that is not set up.
    pub(crate) const NONE: Self = Self {
        airspeed: 0.0,
        pitch: 0.0,
        pitch_rate: 0.0,
        flight_path: 0.0,
    };

    /// Angle of attack `alpha = theta - gamma` \[rad\].
    #[must_use]
    pub fn angle_of_attack(&self) -> f64 {
        self.pitch - self.flight_path
    }

    /// The motion as a vector `(v, theta, theta', gamma)`.
    #[must_use]
    pub fn to_vector(&self) -> Vector4<f64> {
        Vector4::new(self.airspeed, self.pitch, self.pitch_rate, self.flight_path)
    }

    /// The motion from a vector `(v, theta, theta', gamma)`.
    #[must_use]
    pub fn from_vector(vector: &Vector4<f64>) -> Self {
        Self {
            airspeed: vector.x,
            pitch: vector.y,
            pitch_rate: vector.z,
            flight_path: vector.w,
        }
    }

    /// Whether every component is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.to_vector().iter().all(|value| value.is_finite())
    }
}

/// The whole vehicle state: position in the world and motion through the air.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VehicleState {
    /// Downrange distance \[m\].
    pub x: f64,
    /// Height \[m\], up positive.
    pub z: f64,
    /// Motion through the air.
    pub air: AirState,
}

impl VehicleState {
    /// Whether every value is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.x.is_finite() && self.z.is_finite() && self.air.is_finite()
    }
}

/// Time derivative of the motion through the air, in the units of [`AirState`] per second.
///
/// The result is not finite at zero airspeed, where the equations have no meaning.
#[must_use]
pub fn air_rate(airframe: &Airframe, state: &AirState, control: Control) -> AirState {
    air_rate_along(&Directions::of(state), airframe, state, control)
}

/// Sine and cosine of the flight path angle and of the angle of attack.
pub(crate) struct Directions {
    pub(super) path: (f64, f64),
    pub(super) alpha: (f64, f64),
}

impl Directions {
    pub(crate) fn of(state: &AirState) -> Self {
        Self {
            path: libm::sincos(state.flight_path),
            alpha: libm::sincos(state.angle_of_attack()),
        }
    }
}

/// Does the work of [`air_rate`] with the directions of the state.
pub(crate) fn air_rate_along(
    directions: &Directions,
    airframe: &Airframe,
    state: &AirState,
    control: Control,
) -> AirState {
    let a = airframe;
    let (sin_path, cos_path) = directions.path;
    let (sin_alpha, cos_alpha) = directions.alpha;
    let alpha = state.angle_of_attack();
    let pressure_area = 0.5 * a.air_density * (state.airspeed * state.airspeed) * a.wing_area;

    let lift_coefficient = a.lift_zero + a.lift_alpha * alpha + a.lift_elevator * control.elevator;
    let drag_coefficient = a.drag_zero + a.drag_induced * (lift_coefficient * lift_coefficient);
    let lift = pressure_area * lift_coefficient;
    let drag = pressure_area * drag_coefficient;

    // `alpha' = theta' - gamma'` puts the path rate on both sides of the balance of forces.
    let rate_lift = pressure_area * ((a.lift_alpha_rate + a.lift_pitch_rate) * state.pitch_rate);
    let flight_path = (lift + rate_lift - a.mass * GRAVITY * cos_path + control.thrust * sin_alpha)
        / (a.mass * state.airspeed + pressure_area * a.lift_alpha_rate);
    let moment_coefficient = a.moment_zero
        + a.moment_alpha * alpha
        + a.moment_alpha_rate * (state.pitch_rate - flight_path)
        + a.moment_pitch_rate * state.pitch_rate
        + a.moment_elevator * control.elevator;
    AirState {
        airspeed: (-drag - a.mass * GRAVITY * sin_path + control.thrust * cos_alpha) / a.mass,
        pitch: state.pitch_rate,
        pitch_rate: pressure_area * a.moment_length * moment_coefficient / a.pitch_inertia,
        flight_path,
    }
}

/// Time derivative of the whole vehicle state.
#[must_use]
pub fn vehicle_rate(airframe: &Airframe, state: &VehicleState, control: Control) -> VehicleState {
    let directions = Directions::of(&state.air);
    let (sin_path, cos_path) = directions.path;
    VehicleState {
        x: state.air.airspeed * cos_path,
        z: state.air.airspeed * sin_path,
        air: air_rate_along(&directions, airframe, &state.air, control),
    }
}
