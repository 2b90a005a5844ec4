//! Any aircraft of a configuration, and any limits of its actuators.

use hil_protocol::{ActuatorLimits, Aircraft, Airframe};
use proptest::array::{uniform, uniform5};
use proptest::num::f64;
use proptest::option::of;
use proptest::prelude::*;

pub(super) fn aircraft() -> impl Strategy<Value = Aircraft> {
    let numbers = uniform::<_, { Airframe::COUNT }>(f64::ANY);
    (numbers, f64::ANY, f64::ANY, of(f64::ANY)).prop_map(|(numbers, cruise, body_radius, stall)| {
        Aircraft {
            airframe: Airframe::of_numbers(numbers),
            cruise,
            body_radius,
            stall,
        }
    })
}

pub(super) fn limits() -> impl Strategy<Value = ActuatorLimits> {
    uniform5(of(f64::ANY)).prop_map(
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
