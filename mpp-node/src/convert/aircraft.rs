//! The aircraft of a configuration, as the core has it.

use hil_protocol::{ActuatorLimits as WireLimits, Aircraft as WireAircraft};
use mpp_core::settings::Aircraft;
use mpp_core::vehicle::{ActuatorLimits, Airframe};

/// Limits of the actuators.
pub(super) fn actuators(wire: &WireLimits) -> ActuatorLimits {
    let WireLimits {
        thrust_max,
        thrust_lag,
        elevator_below,
        elevator_above,
        elevator_rate,
    } = *wire;
    ActuatorLimits {
        thrust_max,
        thrust_lag,
        elevator_below,
        elevator_above,
        elevator_rate,
    }
}

/// The aircraft of a configuration.
pub(super) fn aircraft(wire: &WireAircraft, limits: &WireLimits) -> Aircraft {
    Aircraft {
        airframe: Airframe {
            mass: wire.mass,
            pitch_inertia: wire.pitch_inertia,
            wing_area: wire.wing_area,
            moment_length: wire.moment_length,
            air_density: wire.air_density,
            lift_zero: wire.lift_zero,
            lift_alpha: wire.lift_alpha,
            lift_alpha_rate: wire.lift_alpha_rate,
            lift_pitch_rate: wire.lift_pitch_rate,
            lift_elevator: wire.lift_elevator,
            drag_zero: wire.drag_zero,
            drag_induced: wire.drag_induced,
            moment_zero: wire.moment_zero,
            moment_alpha: wire.moment_alpha,
            moment_alpha_rate: wire.moment_alpha_rate,
            moment_pitch_rate: wire.moment_pitch_rate,
            moment_elevator: wire.moment_elevator,
        },
        actuators: actuators(limits),
        cruise: wire.cruise,
        body_radius: wire.body_radius,
        stall: wire.stall,
    }
}
