//! The aircraft of a configuration.

use hil_protocol::{ActuatorLimits, Aircraft};

/// The aircraft, by its coefficients: `L = q S (C_L + C_La' alpha' + C_Lq theta')`,
/// `C_L = C_L0 + C_La alpha + C_Le delta_e`, `C_D = C_D0 + K C_L^2`, `M = q S l C_M`,
/// `C_M = C_M0 + C_Ma alpha + C_Ma' alpha' + C_Mq theta' + C_Me delta_e`, with `q = rho V^2 / 2`.
///
/// The elevator may be in any unit. Command, limits and derivatives have the same one.
///
/// The four derivatives by rates are in s/rad: the usual coefficient, which counts per radian of `rate c / (2 V)`,
/// times `c / (2 V)` at cruise. With `c` = 0.2 m and `V` = 15 m/s a usual `C_Mq` of -10 becomes -0.067. The usual
/// number itself is about 150 times too large, and the core does not refuse it. An aircraft file (docs/aircraft.md)
/// takes the usual numbers; `sil-harness aircraft FILE` converts them itself and prints the modes that follow.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppAircraft {
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia in pitch [kg m^2].
    pub pitch_inertia: f64,
    /// Wing area `S` [m^2].
    pub wing_area: f64,
    /// Reference length of the pitching moment `l` [m].
    pub moment_length: f64,
    /// Air density `rho` [kg/m^3].
    pub air_density: f64,
    /// `C_L0` [-].
    pub lift_zero: f64,
    /// `C_La` [1/rad].
    pub lift_alpha: f64,
    /// `C_La'` [s/rad]: the usual coefficient times `c / (2 V)` at cruise.
    pub lift_alpha_rate: f64,
    /// `C_Lq` [s/rad]: the usual coefficient times `c / (2 V)` at cruise.
    pub lift_pitch_rate: f64,
    /// `C_Le` [1 per unit of elevator].
    pub lift_elevator: f64,
    /// `C_D0` [-].
    pub drag_zero: f64,
    /// `K` [-].
    pub drag_induced: f64,
    /// `C_M0` [-].
    pub moment_zero: f64,
    /// `C_Ma` [1/rad], negative.
    pub moment_alpha: f64,
    /// `C_Ma'` [s/rad]: the usual coefficient times `c / (2 V)` at cruise; 0 or negative.
    pub moment_alpha_rate: f64,
    /// `C_Mq` [s/rad]: the usual coefficient times `c / (2 V)` at cruise; 0 or negative.
    pub moment_pitch_rate: f64,
    /// `C_Me` [1 per unit of elevator]. If it is positive, a greater elevator raises the nose.
    pub moment_elevator: f64,
    /// Airspeed of level flight [m/s].
    pub cruise: f64,
    /// Radius of the circle that holds the aircraft [m].
    pub body_radius: f64,
    /// Distance of the stall from the angle of attack of level flight [rad]; 0 if it is not known.
    pub stall: f64,
    /// Greatest thrust [N]; 0 for no limit. The same holds for the four limits below.
    pub thrust_max: f64,
    /// Time constant of the thrust [s].
    pub thrust_lag: f64,
    /// Greatest distance of the elevator below its trim, which is that of level flight at cruise [unit of elevator].
    pub elevator_below: f64,
    /// Greatest distance of the elevator above its trim [unit of elevator].
    pub elevator_above: f64,
    /// Greatest rate of the elevator [unit of elevator per s].
    pub elevator_rate: f64,
}

impl MppAircraft {
    pub(crate) const REFERENCE: Self = {
        let own = Aircraft::REFERENCE;
        Self {
            mass: own.mass,
            pitch_inertia: own.pitch_inertia,
            wing_area: own.wing_area,
            moment_length: own.moment_length,
            air_density: own.air_density,
            lift_zero: own.lift_zero,
            lift_alpha: own.lift_alpha,
            lift_alpha_rate: own.lift_alpha_rate,
            lift_pitch_rate: own.lift_pitch_rate,
            lift_elevator: own.lift_elevator,
            drag_zero: own.drag_zero,
            drag_induced: own.drag_induced,
            moment_zero: own.moment_zero,
            moment_alpha: own.moment_alpha,
            moment_alpha_rate: own.moment_alpha_rate,
            moment_pitch_rate: own.moment_pitch_rate,
            moment_elevator: own.moment_elevator,
            cruise: own.cruise,
            body_radius: own.body_radius,
            stall: 0.0,
            thrust_max: 0.0,
            thrust_lag: 0.0,
            elevator_below: 0.0,
            elevator_above: 0.0,
            elevator_rate: 0.0,
        }
    };

    pub(crate) fn told(&self) -> (Aircraft, ActuatorLimits) {
        // Not a number is not "no limit": the core's checks refuse it.
        let unless_zero = |value: f64| if value == 0.0 { None } else { Some(value) };
        let aircraft = Aircraft {
            mass: self.mass,
            pitch_inertia: self.pitch_inertia,
            wing_area: self.wing_area,
            moment_length: self.moment_length,
            air_density: self.air_density,
            lift_zero: self.lift_zero,
            lift_alpha: self.lift_alpha,
            lift_alpha_rate: self.lift_alpha_rate,
            lift_pitch_rate: self.lift_pitch_rate,
            lift_elevator: self.lift_elevator,
            drag_zero: self.drag_zero,
            drag_induced: self.drag_induced,
            moment_zero: self.moment_zero,
            moment_alpha: self.moment_alpha,
            moment_alpha_rate: self.moment_alpha_rate,
            moment_pitch_rate: self.moment_pitch_rate,
            moment_elevator: self.moment_elevator,
            cruise: self.cruise,
            body_radius: self.body_radius,
            stall: unless_zero(self.stall),
        };
        let actuators = ActuatorLimits {
            thrust_max: unless_zero(self.thrust_max),
            thrust_lag: unless_zero(self.thrust_lag),
            elevator_below: unless_zero(self.elevator_below),
            elevator_above: unless_zero(self.elevator_above),
            elevator_rate: unless_zero(self.elevator_rate),
        };
        (aircraft, actuators)
    }
}
