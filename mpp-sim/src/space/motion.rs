//! The motion of a rigid aircraft in six degrees of freedom, composed of the longitudinal motion and a lateral one.
//!
//! The attitude is a turn after a pitch: the quaternion `attitude` turns a *carried plane*, and in this plane the aircraft
//! has the pitch and the flight path angle of [`AirState`]. The carried plane turns with roll rate and yaw rate, and never
//! with the pitch rate. So the longitudinal equations hold in it with gravity seen from there, and no attitude is
//! singular. The sideslip is: the equations divide by its cosine, and beyond 90 deg drag would push. So a flight ends at
//! [`MOST_SIDESLIP`] with [`PlantError::Departed`].
//! Without lateral state and command each sum has the same terms as in [`Dynamics`](crate::dynamics::Dynamics), or zeros besides:
//! the motion is that of the vertical plane, bit for bit.
//!
//! ```text
//! e  = (cos beta cos gamma, sin beta, -cos beta sin gamma)     direction of flight in the carried plane
//! m v'             = -D cos beta + Y sin beta + T cos alpha cos beta + m g.e
//! m v cos beta (gamma' + tan beta w.n)   = L + T sin alpha - m g (g_x sin gamma + g_z cos gamma)
//! m v (beta' - p sin alpha + r cos alpha) = D sin beta + Y cos beta - T cos alpha sin beta + m g.b
//! ```
//!
//! Lift and drag lie in the plane of symmetry, the side force along the body's y axis (Beard, McLain, "Small Unmanned
//! Aircraft", 2012, section 4.2). Axes: x ahead, y to the right, z down.

use super::Quaternion;
use crate::aircraft_file::AircraftModel;
use crate::dynamics::{Aerodynamics, SUBSTEPS, moved as moved_plane, runge_kutta};
use crate::plant::PlantError;
use core::f64::consts::PI;
use mpp_core::control::LateralMotion;
use mpp_core::vehicle::{
    AirState, Airframe, Control, GRAVITY, LateralAirframe, LateralControl, VehicleState,
};

/// Sideslip at which a flight ends \[rad\]: 80 deg. No step reaches the pole at 90 deg from there, unless it turns by more than
/// 17 rad/s.
pub const MOST_SIDESLIP: f64 = 80.0 * (PI / 180.0);

/// What a vertical plane does not know of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralState {
    /// Position to the right of the first vertical plane \[m\].
    pub y: f64,
    /// Turn of the carried plane.
    pub attitude: Quaternion,
    /// Sideslip `beta` \[rad\], positive if the air comes from the right.
    pub sideslip: f64,
    /// Roll rate `p` [rad/s].
    pub roll_rate: f64,
    /// Yaw rate `r` [rad/s].
    pub yaw_rate: f64,
}

impl LateralState {
    /// Flight in the vertical plane.
    pub const NONE: Self = Self {
        y: 0.0,
        attitude: Quaternion::ONE,
        sideslip: 0.0,
        roll_rate: 0.0,
        yaw_rate: 0.0,
    };
}

/// The whole state: longitudinal and lateral. Pitch and flight path angle are those in the carried plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceState {
    /// Longitudinal part.
    pub plane: VehicleState,
    /// Lateral part.
    pub lateral: LateralState,
}

impl SpaceState {
    /// Attitude of the body: the pitch, turned with the carried plane.
    #[must_use]
    pub fn attitude(&self) -> Quaternion {
        self.lateral
            .attitude
            .times(Quaternion::pitch(self.plane.air.pitch))
    }

    /// Velocity through the air [m/s], in the carried plane.
    #[must_use]
    pub fn air_velocity(&self) -> [f64; 3] {
        let (sin_path, cos_path) = libm::sincos(self.plane.air.flight_path);
        let (sin_slip, cos_slip) = libm::sincos(self.lateral.sideslip);
        let v = self.plane.air.airspeed;
        [
            v * cos_slip * cos_path,
            v * sin_slip,
            -(v * cos_slip * sin_path),
        ]
    }

    /// Bank \[rad\] about the direction of flight, to the right positive: the turn of the lift from the vertical.
    #[must_use]
    pub fn bank(&self) -> f64 {
        let (sin_path, cos_path) = libm::sincos(self.plane.air.flight_path);
        let (sin_slip, cos_slip) = libm::sincos(self.lateral.sideslip);
        let [x, y, z] = self.lateral.attitude.world_in([0.0, 0.0, 1.0]);
        let slide = cos_slip * y + sin_slip * (z * sin_path - x * cos_path);
        libm::atan2(slide, x * sin_path + z * cos_path)
    }

    /// What the lateral regulator knows of the motion.
    #[must_use]
    pub fn lateral_motion(&self) -> LateralMotion {
        LateralMotion {
            airspeed: self.plane.air.airspeed,
            bank: self.bank(),
            roll_rate: self.lateral.roll_rate,
            yaw_rate: self.lateral.yaw_rate,
            sideslip: self.lateral.sideslip,
        }
    }

    /// Course through the air \[rad\], to the right positive.
    #[must_use]
    pub fn course(&self) -> f64 {
        let [x, y, _] = self.lateral.attitude.in_world(self.air_velocity());
        libm::atan2(y, x)
    }

    /// Refuses a state in which the equations of motion do not hold.
    fn check_departure(&self) -> Result<(), PlantError> {
        let slips = self.lateral.sideslip.abs() >= MOST_SIDESLIP;
        if slips || self.plane.air.airspeed <= 0.0 {
            return Err(PlantError::Departed);
        }
        Ok(())
    }

    /// Whether every value is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let LateralState {
            y,
            attitude,
            sideslip,
            roll_rate,
            yaw_rate,
        } = self.lateral;
        let numbers = [y, sideslip, roll_rate, yaw_rate];
        self.plane.is_finite() && numbers.iter().chain(&attitude.0).all(|it| it.is_finite())
    }
}

/// A rigid aircraft in still air, and its true state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceDynamics {
    /// Longitudinal parameters of the true aircraft.
    pub airframe: Airframe,
    /// Lateral parameters.
    pub lateral: LateralAirframe,
    /// What the core's equations leave out. The stall is that of lift; side force and lateral moments do not stall.
    pub more: Aerodynamics,
    /// Roll rate of the air about the body's x axis [rad/s].
    pub gust_roll: f64,
    /// True state.
    pub state: SpaceState,
}

impl SpaceDynamics {
    /// An aircraft in level flight at a height of 50 m; none without a lateral table.
    #[must_use]
    pub fn level(model: &AircraftModel) -> Option<Self> {
        let plane = VehicleState {
            x: 0.0,
            z: 50.0,
            air: model.trim.state,
        };
        let lateral = LateralState::NONE;
        Some(Self {
            airframe: model.known.airframe,
            lateral: model.file.lateral.as_ref()?.airframe(),
            more: Aerodynamics::of(&model.file),
            gust_roll: 0.0,
            state: SpaceState { plane, lateral },
        })
    }

    /// Flies `dt` \[s\] with constant controls, as [`Dynamics::step`](crate::dynamics::Dynamics::step) does.
    ///
    /// # Errors
    /// [`PlantError`]; the state is then as before.
    pub fn step(
        &mut self,
        control: Control,
        lateral: LateralControl,
        dt: f64,
    ) -> Result<(), PlantError> {
        let commands = [
            control.thrust,
            control.elevator,
            lateral.aileron,
            lateral.rudder,
        ];
        if !commands.iter().all(|command| command.is_finite()) {
            return Err(PlantError::NonFiniteControl);
        }
        let substep = dt / f64::from(SUBSTEPS);
        let rate = |at: &SpaceState| self.rate(at, control, lateral);
        let mut state = self.state;
        state.check_departure()?;
        for _ in 0..SUBSTEPS {
            state = runge_kutta(rate, moved, &state, substep);
            state.lateral.attitude = state.lateral.attitude.normalised();
            if !state.is_finite() {
                return Err(PlantError::NonFiniteState);
            }
            state.check_departure()?;
        }
        self.state = state;
        Ok(())
    }

    /// Time derivative of the state.
    #[must_use]
    pub fn rate(&self, at: &SpaceState, control: Control, surfaces: LateralControl) -> SpaceState {
        let a = &self.more.at(&self.airframe, &at.plane.air);
        let (state, side) = (&at.plane.air, &at.lateral);
        let v = state.airspeed;
        let alpha = state.angle_of_attack();
        let (sin_path, cos_path) = libm::sincos(state.flight_path);
        let (sin_alpha, cos_alpha) = libm::sincos(alpha);
        let (sin_slip, cos_slip) = libm::sincos(side.sideslip);
        let (p, q, r) = (side.roll_rate, state.pitch_rate, side.yaw_rate);
        let pressure_area = 0.5 * a.air_density * (v * v) * a.wing_area;

        // Forces, in the order of the core's `air_rate`.
        let lift_coefficient =
            a.lift_zero + a.lift_alpha * alpha + a.lift_elevator * control.elevator;
        let drag_coefficient = a.drag_zero + a.drag_induced * (lift_coefficient * lift_coefficient);
        let lift = pressure_area * lift_coefficient;
        let drag = pressure_area * drag_coefficient;
        let per_rate = self.lateral.span / (2.0 * v);
        let rates = [(p - self.gust_roll) * per_rate, r * per_rate];
        let of = |coefficient: &mpp_core::vehicle::Derivatives| {
            coefficient.coefficient(side.sideslip, rates, surfaces)
        };
        let side_force = pressure_area * of(&self.lateral.side);

        // Gravity and the turn of the carried plane, as it sees them.
        let [down_x, down_y, down_z] = side.attitude.world_in([0.0, 0.0, 1.0]);
        let (sin_pitch, cos_pitch) = libm::sincos(state.pitch);
        let (turn_x, turn_z) = (p * cos_pitch + r * sin_pitch, r * cos_pitch - p * sin_pitch);
        // Components of gravity against the flight, against the lift, and to the right.
        let climb = cos_slip * (down_z * sin_path - down_x * cos_path) - sin_slip * down_y;
        let carry = down_x * sin_path + down_z * cos_path;
        let slide = cos_slip * down_y + sin_slip * (down_z * sin_path - down_x * cos_path);
        // What the turn of the carried plane takes from the flight path angle, as an acceleration times the mass.
        let mass_speed = a.mass * v * cos_slip;
        let carried = a.mass * v * sin_slip * (turn_z * sin_path - turn_x * cos_path);

        let rate_lift = pressure_area * ((a.lift_alpha_rate + a.lift_pitch_rate) * q);
        let flight_path =
            (lift + rate_lift - a.mass * GRAVITY * carry + control.thrust * sin_alpha - carried)
                / (mass_speed + pressure_area * a.lift_alpha_rate);
        let moment_coefficient = a.moment_zero
            + a.moment_alpha * alpha
            + a.moment_alpha_rate * (q - flight_path)
            + a.moment_pitch_rate * q
            + a.moment_elevator * control.elevator;
        let thrust_ahead = control.thrust * cos_alpha;
        let airspeed = (side_force * sin_slip - drag * cos_slip - a.mass * GRAVITY * climb
            + thrust_ahead * cos_slip)
            / a.mass;
        let sideslip =
            (side_force * cos_slip + (drag - thrust_ahead) * sin_slip + a.mass * GRAVITY * slide)
                / (a.mass * v)
                + (p * sin_alpha - r * cos_alpha);

        let arm = pressure_area * self.lateral.span;
        let moments = [arm * of(&self.lateral.roll), arm * of(&self.lateral.yaw)];
        let [roll, pitch, yaw] = self.gyroscopic([p, q, r]);
        let [roll_rate, yaw_rate] = self
            .lateral
            .acceleration([moments[0] + roll, moments[1] + yaw]);
        let moment = pressure_area * a.moment_length * moment_coefficient;
        let [x, y, z] = side.attitude.in_world(at.air_velocity());
        SpaceState {
            plane: VehicleState {
                x,
                z: -z,
                air: AirState {
                    airspeed,
                    pitch: q,
                    pitch_rate: (moment + pitch) / a.pitch_inertia,
                    flight_path,
                },
            },
            lateral: LateralState {
                y,
                attitude: side.attitude.rate([turn_x, 0.0, turn_z]),
                sideslip,
                roll_rate,
                yaw_rate,
            },
        }
    }

    /// Moments of the turning body itself, `-w x J w` [N m].
    fn gyroscopic(&self, [p, q, r]: [f64; 3]) -> [f64; 3] {
        let (x, z, xz) = (
            self.lateral.roll_inertia,
            self.lateral.yaw_inertia,
            self.lateral.product_inertia,
        );
        let spin = [
            x * p - xz * r,
            self.airframe.pitch_inertia * q,
            z * r - xz * p,
        ];
        [
            r * spin[1] - q * spin[2],
            p * spin[2] - r * spin[0],
            q * spin[0] - p * spin[1],
        ]
    }
}

/// `state + h rate`.
fn moved(state: &SpaceState, rate: &SpaceState, h: f64) -> SpaceState {
    let (from, by) = (&state.lateral, &rate.lateral);
    SpaceState {
        plane: moved_plane(&state.plane, &rate.plane, h),
        lateral: LateralState {
            y: from.y + h * by.y,
            attitude: from.attitude.moved(by.attitude, h),
            sideslip: from.sideslip + h * by.sideslip,
            roll_rate: from.roll_rate + h * by.roll_rate,
            yaw_rate: from.yaw_rate + h * by.yaw_rate,
        },
    }
}
