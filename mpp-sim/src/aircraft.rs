//! The plant of this crate: a rigid aircraft behind its actuators, in moving air.
//!
//! In wind, airspeed and flight path angle describe the motion through the air. The position moves
//! with this motion and with the wind. When the wind changes, the aircraft keeps its velocity over
//! ground. Its velocity through the air then changes by the opposite amount.

use crate::disturbance::Disturbance;
use crate::dynamics::{Aerodynamics, Dynamics};
use crate::faults::{Actuators, GustConfig, Gusts, Signal, SignalFault};
use crate::plant::{Plant, PlantError};
use crate::random::Stream;
use crate::scenario::Scenario;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{Control, TrimError, VehicleState};

/// The actuators of one flight and their faults.
#[derive(Clone, Debug)]
pub(crate) struct Actuation {
    seed: u64,
    actuators: Actuators,
    /// Faults of what the actuators give: the distance of the elevator from trim, and the thrust.
    elevator: Signal,
    thrust: Signal,
    trim: Control,
    /// Ticks flown.
    pub(crate) flown: u32,
}

impl Actuation {
    /// Actuators that rest at the trim of a scenario.
    pub(crate) fn new(scenario: &Scenario) -> Result<Self, TrimError> {
        let (faults, seed) = (&scenario.faults, scenario.seed);
        let trim = scenario.trim()?.control;
        Ok(Self {
            seed,
            actuators: Actuators::new(
                scenario.limits(),
                faults.actuators.untold_delay.unwrap_or(0.0),
                trim,
            ),
            elevator: Signal::new(seed, Stream::ElevatorFault, faults.elevator),
            thrust: Signal::new(seed, Stream::ThrustFault, faults.thrust),
            trim,
            flown: 0,
        })
    }

    /// The control that acts in the next tick.
    pub(crate) fn given(&mut self, command: Control) -> Control {
        let mut given = self.actuators.give(command, TICK_PERIOD);
        let (tick, neutral) = (self.flown, self.trim.elevator);
        if self.elevator.acts(tick) {
            given.elevator = neutral + self.elevator.pass(tick, given.elevator - neutral);
        }
        given.thrust = self.thrust.pass(tick, given.thrust);
        given
    }
}

/// Motion, actuators and air of one flight.
#[derive(Clone, Debug)]
pub struct Aircraft {
    body: Dynamics,
    actuation: Actuation,
    gusts: Option<Gusts>,
}

impl Aircraft {
    /// The aircraft of a scenario at its start. It flies in the core's level trim; the air may
    /// move.
    ///
    /// # Errors
    /// [`TrimError`] when the core's airframe has no level flight.
    pub fn new(scenario: &Scenario) -> Result<Self, TrimError> {
        let known = scenario.aircraft.known.airframe;
        let (faults, seed) = (&scenario.faults, scenario.seed);
        Ok(Self {
            body: Dynamics {
                airframe: faults.model_error.airframe(seed, known),
                more: Aerodynamics::of(&scenario.aircraft.file),
                state: scenario.start()?,
            },
            actuation: Actuation::new(scenario)?,
            gusts: Gusts::new(seed, faults.gusts, TICK_PERIOD),
        })
    }

    /// Air with another intensity of its gusts [m/s]. The velocity over ground stays the same.
    fn set_gusts(&mut self, intensity: f64) {
        let before = self.wind();
        let seed = self.actuation.seed;
        self.gusts = Gusts::new(seed, GustConfig { intensity }, TICK_PERIOD);
        let after = self.wind();
        meet(
            &mut self.body.state,
            (after.0 - before.0, after.1 - before.1),
        );
    }
}

impl Plant for Aircraft {
    fn state(&self) -> &VehicleState {
        &self.body.state
    }

    fn wind(&self) -> (f64, f64) {
        self.gusts.as_ref().map_or((0.0, 0.0), Gusts::wind)
    }

    fn step(&mut self, command: Control) -> Result<Control, PlantError> {
        let given = self.actuation.given(command);
        self.body.step(given, TICK_PERIOD)?;
        self.actuation.flown += 1;
        if let Some(gusts) = &mut self.gusts {
            let before = gusts.wind();
            gusts.advance();
            let after = gusts.wind();
            drift(&mut self.body.state, before, TICK_PERIOD);
            meet(
                &mut self.body.state,
                (after.0 - before.0, after.1 - before.1),
            );
        }
        Ok(given)
    }

    fn disturb(&mut self, disturbance: &Disturbance) -> bool {
        if let Some(intensity) = disturbance.gusts {
            self.set_gusts(intensity);
        }
        if let Some(frozen) = disturbance.elevator_stuck {
            let fault = SignalFault {
                frozen,
                ..SignalFault::default()
            };
            self.actuation.elevator =
                Signal::new(self.actuation.seed, Stream::ElevatorFault, fault);
        }
        true
    }
}

/// Moves the position with the wind [m/s] for `dt` \[s\].
fn drift(state: &mut VehicleState, wind: (f64, f64), dt: f64) {
    state.x += wind.0 * dt;
    state.z += wind.1 * dt;
}

/// Applies a change of the wind [m/s]. Velocity over ground, pitch and pitch rate stay the same.
fn meet(state: &mut VehicleState, change: (f64, f64)) {
    let air = &mut state.air;
    let (sin, cos) = libm::sincos(air.flight_path);
    let forward = air.airspeed * cos - change.0;
    let climb = air.airspeed * sin - change.1;
    air.airspeed = libm::hypot(forward, climb);
    air.flight_path = libm::atan2(climb, forward);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Preset;

    fn scenario() -> Scenario {
        Scenario::new(Preset::Flight, 4)
    }

    /// Velocity over ground [m/s].
    fn ground_velocity(state: &VehicleState, wind: (f64, f64)) -> (f64, f64) {
        let (sin, cos) = libm::sincos(state.air.flight_path);
        (
            state.air.airspeed * cos + wind.0,
            state.air.airspeed * sin + wind.1,
        )
    }

    #[test]
    fn a_gust_changes_the_airspeed_and_not_the_velocity_over_ground() {
        let mut state = scenario().start().unwrap();
        state.air.flight_path = 0.3;
        let before = state;
        meet(&mut state, (1.5, -2.0));
        let (was, is) = (
            ground_velocity(&before, (0.0, 0.0)),
            ground_velocity(&state, (1.5, -2.0)),
        );
        assert!((was.0 - is.0).abs() < 1e-12 && (was.1 - is.1).abs() < 1e-12);
        // The change is a tail wind with sinking air. The aircraft is then slower through the air
        // and climbs more steeply through it.
        assert!(state.air.airspeed < before.air.airspeed);
        assert!(state.air.flight_path > before.air.flight_path);
        assert!((state.air.pitch - before.air.pitch).abs() < 1e-15);
    }

    #[test]
    fn position_moves_with_air_and_wind() {
        let mut windy = scenario();
        windy.faults.gusts.intensity = 2.0;
        let mut aircraft = Aircraft::new(&windy).unwrap();
        let command = windy.trim().unwrap().control;
        for _ in 0..300 {
            let (before, wind) = (*aircraft.state(), aircraft.wind());
            aircraft.step(command).unwrap();
            let after = *aircraft.state();
            let velocity = ground_velocity(&before, wind);
            // The velocity over ground changes by no more than a tick's acceleration.
            assert!(((after.x - before.x) / TICK_PERIOD - velocity.0).abs() < 0.2);
            assert!(((after.z - before.z) / TICK_PERIOD - velocity.1).abs() < 0.2);
        }
        assert_ne!(aircraft.wind(), (0.0, 0.0));
    }

    #[test]
    fn rising_air_raises_the_angle_of_attack_and_the_tail_takes_it_back() {
        let still = scenario();
        let mut aircraft = Aircraft::new(&still).unwrap();
        let trim = still.trim().unwrap();
        meet(&mut aircraft.body.state, (0.0, 1.0));
        let angle_of_attack = aircraft.state().air.angle_of_attack();
        assert!(angle_of_attack > trim.state.angle_of_attack() + 0.05);
        for _ in 0..100 {
            aircraft.step(trim.control).unwrap();
        }
        let settled = aircraft.state().air.angle_of_attack();
        assert!(
            (settled - trim.state.angle_of_attack()).abs() < 0.02,
            "{settled}"
        );
    }

    #[test]
    fn a_heavier_aircraft_sinks_from_the_cores_trim() {
        let mut heavy = scenario();
        heavy.faults.model_error.mass = 0.1;
        let trim = heavy.trim().unwrap();
        let height = |scenario: &Scenario| {
            let mut aircraft = Aircraft::new(scenario).unwrap();
            for _ in 0..100 {
                aircraft.step(trim.control).unwrap();
            }
            aircraft.state().z
        };
        assert!(height(&heavy) < height(&scenario()) - 0.2);
    }

    #[test]
    fn without_faults_it_is_the_rigid_aircraft_to_the_last_bit() {
        let ideal = scenario();
        let mut aircraft = Aircraft::new(&ideal).unwrap();
        let mut body = Dynamics {
            airframe: ideal.aircraft.known.airframe,
            more: Aerodynamics::NONE,
            state: ideal.start().unwrap(),
        };
        for tick in 0..200 {
            let command = Control {
                thrust: 5.0 + 0.01 * f64::from(tick),
                elevator: 3.8,
            };
            assert_eq!(aircraft.step(command), Ok(command));
            body.step(command, TICK_PERIOD).unwrap();
            assert_eq!(*aircraft.state(), body.state);
        }
    }
}
