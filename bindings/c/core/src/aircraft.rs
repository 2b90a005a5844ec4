//! The aircraft of a configuration.

use hil_protocol::{ActuatorLimits, Aircraft, Airframe};

/// The aircraft and the limits of its actuators.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct MppAircraft {
    /// Mass, inertia and aerodynamics.
    pub airframe: Airframe,
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
    /// Dead time from a command of the elevator to its effect, at most 0.3 [s]; 0 for none.
    pub elevator_delay: f64,
    /// Dead time of the thrust, at most 0.3 [s]; 0 for none.
    pub thrust_delay: f64,
}

impl MppAircraft {
    pub(crate) const REFERENCE: Self = Self {
        airframe: Airframe::REFERENCE,
        cruise: Aircraft::REFERENCE.cruise,
        body_radius: Aircraft::REFERENCE.body_radius,
        stall: 0.0,
        thrust_max: 0.0,
        thrust_lag: 0.0,
        elevator_below: 0.0,
        elevator_above: 0.0,
        elevator_rate: 0.0,
        elevator_delay: 0.0,
        thrust_delay: 0.0,
    };

    pub(crate) fn told(&self) -> (Aircraft, ActuatorLimits) {
        // Not a number is not "no limit": the core's checks refuse it.
        let unless_zero = |value: f64| if value == 0.0 { None } else { Some(value) };
        let aircraft = Aircraft {
            airframe: self.airframe,
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
            elevator_delay: unless_zero(self.elevator_delay),
            thrust_delay: unless_zero(self.thrust_delay),
        };
        (aircraft, actuators)
    }
}
