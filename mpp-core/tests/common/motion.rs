//! Motion by the equations of the core, in small steps.

use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{AirState, Airframe, Control, VehicleState, air_rate, vehicle_rate};

const SUBSTEPS: u32 = 10;
const SUBSTEP: f64 = TICK_PERIOD / SUBSTEPS as f64;

/// The motion through the air after a tick.
pub(crate) fn air_after_tick(airframe: &Airframe, air: &AirState, control: Control) -> AirState {
    (0..SUBSTEPS).fold(*air, |air, _| {
        let rate = air_rate(airframe, &air, control).to_vector();
        AirState::from_vector(&(air.to_vector() + rate * SUBSTEP))
    })
}

/// The state after a tick in still air.
pub(crate) fn after_tick(
    airframe: &Airframe,
    state: &VehicleState,
    control: Control,
) -> VehicleState {
    (0..SUBSTEPS).fold(*state, |state, _| {
        let rate = vehicle_rate(airframe, &state, control);
        let air = state.air.to_vector() + rate.air.to_vector() * SUBSTEP;
        VehicleState {
            x: state.x + rate.x * SUBSTEP,
            z: state.z + rate.z * SUBSTEP,
            air: AirState::from_vector(&air),
        }
    })
}
