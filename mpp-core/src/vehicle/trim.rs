//! Steady flight: the operating points that the planner and the controller are built around.

use super::{AirState, Airframe, Control, GRAVITY};

/// Steady straight flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trim {
    /// The steady motion; its pitch rate is zero.
    pub state: AirState,
    /// The controls that hold it.
    pub control: Control,
}

/// No steady flight exists there, or it was not found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TrimError {
    /// A parameter or a result is not finite, or an airspeed not positive. The vehicle does not
    /// start: check the airframe.
    NonFinite,
    /// The iteration did not settle within its bound. The vehicle does not start.
    NotConverged,
}

/// Bound of the substitutions; each gains more than a digit at the paper's airspeeds.
const MAX_ITERATIONS: usize = 60;

/// Change of the angle of attack [rad] that counts as settled.
const TOLERANCE: f64 = 1e-14;

impl Trim {
    /// The operating point of the authors' code: where its root finder gave up looking for level
    /// flight at 4.3 N. None exists below 4.40 N with this drag polar; here the aircraft slows down by
    /// 0.03 m/s^2.
    #[must_use]
    pub fn of_authors(airframe: &Airframe) -> Self {
        let state = AirState {
            airspeed: 11.933_923_418_676_219,
            pitch: 0.158_432_957_191_868_98,
            pitch_rate: 0.0,
            flight_path: 0.0,
        };
        Self {
            state,
            control: Control {
                thrust: 4.3,
                elevator: airframe.elevator_for(state.pitch),
            },
        }
    }

    /// Steady straight flight at an airspeed [m/s] and a flight path angle [rad]: `alpha` and `T`
    /// from lift and drag balance. A steep descent may need a negative thrust.
    ///
    /// # Errors
    /// [`TrimError`] when no such flight is found.
    pub fn at_speed(airframe: &Airframe, airspeed: f64, path: f64) -> Result<Self, TrimError> {
        let a = airframe;
        if airspeed.is_nan() || airspeed <= 0.0 {
            return Err(TrimError::NonFinite);
        }
        let pressure_area = 0.5 * a.air_density * (airspeed * airspeed) * a.wing_area;
        let (sin_path, cos_path) = libm::sincos(path);
        let mut alpha = 0.0;
        for _ in 0..MAX_ITERATIONS {
            // Thrust carries a few percent of the weight, so substitution contracts quickly.
            let (sin_alpha, cos_alpha) = libm::sincos(alpha);
            let lift_coefficient = a.lift_zero + a.lift_alpha * alpha;
            let drag = pressure_area
                * (a.drag_zero + a.drag_induced * lift_coefficient * lift_coefficient);
            let thrust = (drag + a.mass * GRAVITY * sin_path) / cos_alpha;
            let lift = a.mass * GRAVITY * cos_path - thrust * sin_alpha;
            let next = (lift / pressure_area - a.lift_zero) / a.lift_alpha;
            let change = next - alpha;
            alpha = next;
            if change.abs() < TOLERANCE {
                return finite(Self {
                    state: AirState {
                        airspeed,
                        pitch: path + alpha,
                        pitch_rate: 0.0,
                        flight_path: path,
                    },
                    control: Control {
                        thrust,
                        elevator: a.elevator_for(alpha),
                    },
                });
            }
        }
        Err(TrimError::NotConverged)
    }

    /// Steady level flight at an angle of attack [rad]: airspeed and thrust from `L + T sin alpha = m g`
    /// and `T cos alpha = D`.
    ///
    /// # Errors
    /// [`TrimError::NonFinite`] when the wing does not carry the aircraft at that angle.
    pub fn at_angle_of_attack(airframe: &Airframe, alpha: f64) -> Result<Self, TrimError> {
        let a = airframe;
        let (sin_alpha, cos_alpha) = libm::sincos(alpha);
        let lift = a.lift_zero + a.lift_alpha * alpha;
        let drag = a.drag_zero + a.drag_induced * lift * lift;
        let carried = lift + drag * sin_alpha / cos_alpha;
        let speed_squared = 2.0 * a.mass * GRAVITY / (a.air_density * a.wing_area * carried);
        let pressure_area = 0.5 * a.air_density * speed_squared * a.wing_area;
        finite(Self {
            state: AirState {
                airspeed: libm::sqrt(speed_squared),
                pitch: alpha,
                pitch_rate: 0.0,
                flight_path: 0.0,
            },
            control: Control {
                thrust: pressure_area * drag / cos_alpha,
                elevator: a.elevator_for(alpha),
            },
        })
    }
}

fn finite(trim: Trim) -> Result<Trim, TrimError> {
    if trim.state.is_finite()
        && trim.control.thrust.is_finite()
        && trim.control.elevator.is_finite()
    {
        Ok(trim)
    } else {
        Err(TrimError::NonFinite)
    }
}
