//! Any aircraft of a configuration, and any limits of its actuators.

use hil_protocol::{ActuatorLimits, Aircraft};
use proptest::num::f64;
use proptest::prelude::*;

pub(super) fn aircraft() -> impl Strategy<Value = Aircraft> {
    let numbers = proptest::array::uniform19(f64::ANY);
    (numbers, proptest::option::of(f64::ANY)).prop_map(|(numbers, stall)| {
        let [
            mass,
            pitch_inertia,
            wing_area,
            moment_length,
            air_density,
            lift_zero,
            lift_alpha,
            lift_alpha_rate,
            lift_pitch_rate,
            lift_elevator,
            drag_zero,
            drag_induced,
            moment_zero,
            moment_alpha,
            moment_alpha_rate,
            moment_pitch_rate,
            moment_elevator,
            cruise,
            body_radius,
        ] = numbers;
        Aircraft {
            mass,
            pitch_inertia,
            wing_area,
            moment_length,
            air_density,
            lift_zero,
            lift_alpha,
            lift_alpha_rate,
            lift_pitch_rate,
            lift_elevator,
            drag_zero,
            drag_induced,
            moment_zero,
            moment_alpha,
            moment_alpha_rate,
            moment_pitch_rate,
            moment_elevator,
            cruise,
            body_radius,
            stall,
        }
    })
}

pub(super) fn limits() -> impl Strategy<Value = ActuatorLimits> {
    proptest::array::uniform5(proptest::option::of(f64::ANY)).prop_map(
        |[
            thrust_max,
            thrust_lag,
            elevator_below,
            elevator_above,
            elevator_rate,
        ]| ActuatorLimits {
            thrust_max,
            thrust_lag,
            elevator_below,
            elevator_above,
            elevator_rate,
        },
    )
}
