//! Steady flight: the operating points of the planner and of the regulator.

use super::{AirState, Airframe, Control, GRAVITY};

/// Steady straight flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trim {
    /// The steady motion; its pitch rate is zero.
    pub state: AirState,
    /// The controls that hold the steady motion.
    pub control: Control,
}

impl Trim {
    /// No trim: the value in a planner that is not set up.
    pub(crate) const NONE: Self = Self {
        state: AirState::NONE,
        control: Control {
            thrust: 0.0,
            elevator: 0.0,
        },
    };
}

/// The reason why there is no trim. The vehicle then does not start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TrimError {
    /// The airspeed is not a positive, finite number.
    #[error(
        "the airspeed of level flight is not a positive, finite number: check cruise and airframe"
    )]
    Airspeed,
    /// The angle of the flight path or of attack is not a finite number.
    #[error("the angle of steady flight is not a finite number: give it in radians")]
    Angle,
    /// A parameter of the airframe is not a finite number.
    #[error("a parameter of the airframe is not a finite number: check the airframe")]
    Airframe,
    /// The balance of forces gives a number that is not finite: the wing does not carry the aircraft.
    #[error("the wing does not carry the aircraft in steady flight: check cruise and airframe")]
    NotCarried,
    /// The elevator command that balances the moments is not a finite number: the elevator has no effect.
    #[error("the elevator has no effect on steady flight: check the moments of the airframe")]
    NoElevator,
    /// The iteration did not settle within its bound.
    #[error("no steady flight was found at the airspeed: check cruise and airframe")]
    NotConverged,
}

/// Greatest number of substitutions. Each one gains more than a digit at the paper's airspeeds.
const MAX_ITERATIONS: usize = 60;

/// Change of the angle of attack \[rad\] below which the iteration has settled.
const TOLERANCE: f64 = 1e-14;

impl Trim {
    /// The operating point of the authors' code. Their root finder searched for level flight at 4.3 N and
    /// stopped at this point. With this drag polar no level flight exists below 4.40 N; at this point the
    /// aircraft slows down by 0.03 m/s^2.
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

    /// Steady straight flight at an airspeed [m/s] and a flight path angle \[rad\]. The balances of lift and
    /// drag give `alpha` and `T`. A steep descent may need a negative thrust.
    ///
    /// # Errors
    /// [`TrimError`] if the iteration finds no such flight.
    pub fn at_speed(airframe: &Airframe, airspeed: f64, path: f64) -> Result<Self, TrimError> {
        let a = &airframe.balanced();
        if !(airspeed > 0.0 && airspeed.is_finite()) {
            return Err(TrimError::Airspeed);
        }
        let pressure_area = 0.5 * a.air_density * (airspeed * airspeed) * a.wing_area;
        let (sin_path, cos_path) = libm::sincos(path);
        let mut alpha = 0.0;
        for _ in 0..MAX_ITERATIONS {
            // The thrust carries only a few percent of the weight, so the substitution converges quickly.
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
                let trim = Self {
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
                };
                return trim.checked(airframe, path);
            }
        }
        Err(cause(airframe, path, TrimError::NotConverged))
    }

    /// Steady level flight at an angle of attack \[rad\]. Airspeed and thrust follow from
    /// `L + T sin alpha = m g` and `T cos alpha = D`.
    ///
    /// # Errors
    /// [`TrimError`]: for example [`TrimError::NotCarried`] if the wing does not carry the aircraft at that
    /// angle.
    pub fn at_angle_of_attack(airframe: &Airframe, alpha: f64) -> Result<Self, TrimError> {
        let a = &airframe.balanced();
        let (sin_alpha, cos_alpha) = libm::sincos(alpha);
        let lift = a.lift_zero + a.lift_alpha * alpha;
        let drag = a.drag_zero + a.drag_induced * lift * lift;
        let carried = lift + drag * sin_alpha / cos_alpha;
        let speed_squared = 2.0 * a.mass * GRAVITY / (a.air_density * a.wing_area * carried);
        let pressure_area = 0.5 * a.air_density * speed_squared * a.wing_area;
        let trim = Self {
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
        };
        trim.checked(airframe, alpha)
    }

    /// Returns the trim if all its numbers are finite, and otherwise the cause.
    fn checked(self, airframe: &Airframe, angle: f64) -> Result<Self, TrimError> {
        let Control { thrust, elevator } = self.control;
        if !self.state.is_finite() || !thrust.is_finite() {
            Err(cause(airframe, angle, TrimError::NotCarried))
        } else if !elevator.is_finite() {
            Err(cause(airframe, angle, TrimError::NoElevator))
        } else {
            Ok(self)
        }
    }
}

/// The cause of a failed trim: a number of the input that is not finite, or else `otherwise`.
fn cause(airframe: &Airframe, angle: f64, otherwise: TrimError) -> TrimError {
    if !angle.is_finite() {
        TrimError::Angle
    } else if !airframe.is_finite() {
        TrimError::Airframe
    } else {
        otherwise
    }
}
