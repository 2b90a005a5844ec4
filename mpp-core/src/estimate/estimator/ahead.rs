//! The aircraft when the next command acts (Smith, "Closer control of loops with dead time", 1957).

use super::{Ahead, Estimator};
use crate::config::TICK_PERIOD;
use crate::vehicle::{AirState, Trim, VehicleState, air_rate};

impl Ahead {
    /// Level flight at an altitude \[m\].
    #[must_use]
    pub fn level(altitude: f64, trim: &Trim) -> Self {
        let state = VehicleState {
            x: 0.0,
            z: altitude,
            air: trim.state,
        };
        Self {
            state,
            given: trim.control,
        }
    }
}

impl Estimator {
    /// Flies from the present through the commands that have been sent and do not act yet (forward Euler). Without a dead time
    /// it is the present.
    #[must_use]
    pub fn ahead(&self) -> Ahead {
        let actuators = &self.actuators;
        let (mut state, mut given) = (self.state(), actuators.given());
        let airframe = self.conditions().airframe(&self.airframe);
        let wind = self.conditions().wind;
        for tick in 1..=actuators.line().dead_time() {
            let command = actuators.line().acting(tick);
            given = actuators.limits().given(command, given, TICK_PERIOD);
            let effective = actuators.effect_of(given);
            let rate = air_rate(&airframe, &state.air, effective).to_vector();
            let air = AirState::from_vector(&(state.air.to_vector() + rate * TICK_PERIOD));
            if !air.is_finite() {
                break;
            }
            let (before, after) = (wind.ground_velocity(&state.air), wind.ground_velocity(&air));
            state.x += 0.5 * TICK_PERIOD * (before.0 + after.0);
            state.z += 0.5 * TICK_PERIOD * (before.1 + after.1);
            state.air = air;
        }
        Ahead { state, given }
    }
}
