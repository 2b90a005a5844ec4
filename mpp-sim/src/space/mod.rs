//! The plant in six degrees of freedom: an aircraft with a lateral table behind its actuators, in wind on three axes. In
//! the vertical plane it is the [`Aircraft`](crate::aircraft::Aircraft), bit for bit.

mod baseline;
mod course;
mod host;
mod hull;
mod instruments;
mod judge;
pub mod lidar;
mod look;
mod motion;
mod paper;
mod pipe;
mod place;
mod pose;
mod scenario;
mod sensors;
mod servo;
#[cfg(test)]
mod tests;
mod wind;
pub mod world;

pub use baseline::BaselineName;
pub use course::CourseHold;
pub use host::{SpaceFlight, fly_space, fly_space_again, fly_space_with};
pub use hull::Hull;
pub use judge::STRAY;
pub use look::{Look, Moment, SpaceCycle, moment, scenario as scenario_of};
pub use motion::{LateralState, MOST_SIDESLIP, SpaceDynamics, SpaceState};
pub use mpp_core::vehicle::Quaternion;
pub use pipe::{STACK, SpacePipe};
pub use place::ModeName;
pub use pose::Pose;
pub use scenario::{Deskew, SPACE, SpaceFile, SpaceScenario};
pub use sensors::{Sensed, SensorErrors, SpaceSensors, true_path};
pub use servo::{RollHold, Servo};
pub use wind::{SpaceWind, WindConfig};

use crate::aircraft::Actuation;
use crate::aircraft_file::Lateral;
use crate::dynamics::Aerodynamics;
use crate::file_error::ScenarioError;
use crate::plant::PlantError;
use crate::scenario::Scenario;
use core::f64::consts::TAU;
use mpp_core::config::TICK_PERIOD;
use mpp_core::control::LateralRegulator;
use mpp_core::vehicle::{Control, LateralControl};

/// Motion, actuators and air of one flight.
#[derive(Clone, Debug)]
pub struct SpaceAircraft {
    body: SpaceDynamics,
    actuation: Actuation,
    aileron: Servo,
    rudder: Option<Servo>,
    /// The autopilot in place of the servos.
    hold: Option<RollHold>,
    wind: Option<SpaceWind>,
}

impl SpaceAircraft {
    /// The aircraft of a scenario at its start, wings level. Gusts in the vertical plane are those of the scenario.
    ///
    /// # Errors
    /// [`ScenarioError`] when the aircraft's file has no lateral table, or the core's airframe no level flight.
    pub fn new(scenario: &Scenario, wind: WindConfig) -> Result<Self, ScenarioError> {
        let file = &scenario.aircraft.file;
        let table = lateral(scenario)?;
        let no_trim = |error: mpp_core::vehicle::TrimError| {
            ScenarioError::Value("aircraft", error.to_string())
        };
        let (faults, seed) = (&scenario.faults, scenario.seed);
        let known = scenario.aircraft.known.airframe;
        Ok(Self {
            body: SpaceDynamics {
                airframe: faults.model_error.airframe(seed, known),
                lateral: table.airframe(),
                more: Aerodynamics::of(file),
                gust_roll: 0.0,
                state: SpaceState {
                    plane: scenario.start().map_err(no_trim)?,
                    lateral: LateralState::NONE,
                },
            },
            actuation: Actuation::new(scenario).map_err(no_trim)?,
            aileron: Servo::new(&table.aileron),
            rudder: table.rudder.as_ref().map(Servo::new),
            hold: table.roll_loop.map(RollHold::new),
            wind: SpaceWind::new(seed, faults.gusts, wind, table.span, TICK_PERIOD),
        })
    }

    /// Moves the aircraft to another height \[m\] before it flies.
    pub fn start_at(&mut self, height: f64) {
        self.body.state.plane.z = height;
    }

    /// The true state.
    #[must_use]
    pub fn state(&self) -> &SpaceState {
        &self.body.state
    }

    /// Motion of the air ahead, to the right and up [m/s].
    #[must_use]
    pub fn wind(&self) -> [f64; 3] {
        let height = self.body.state.plane.z;
        self.wind.as_ref().map_or([0.0; 3], |wind| wind.at(height))
    }

    /// Flies one tick of the flight loop. Returns the controls that the actuators gave.
    ///
    /// # Errors
    /// [`PlantError`] when the plant cannot step.
    pub fn step(
        &mut self,
        command: Control,
        lateral: LateralControl,
    ) -> Result<(Control, LateralControl), PlantError> {
        if !(lateral.aileron.is_finite() && lateral.rudder.is_finite()) {
            return Err(PlantError::NonFiniteControl);
        }
        let given = self.actuation.given(command);
        let (surfaces, deflected) = self.deflect(lateral);
        self.body.gust_roll = self.wind.as_ref().map_or(0.0, SpaceWind::roll_rate);
        let height = self.body.state.plane.z;
        self.body.step(given, deflected, TICK_PERIOD)?;
        self.actuation.flown += 1;
        if let Some(wind) = &mut self.wind {
            let before = wind.at(height);
            wind.advance();
            drift(&mut self.body.state, before, TICK_PERIOD);
            let after = wind.at(self.body.state.plane.z);
            let change = [0, 1, 2].map(|axis| after[axis] - before[axis]);
            meet(&mut self.body.state, change);
        }
        Ok((given, surfaces))
    }

    /// What servos or autopilot give, and what turns the body: of an autopilot, these are the bank that it holds and what is
    /// missing of it.
    fn deflect(&mut self, command: LateralControl) -> (LateralControl, LateralControl) {
        if let Some(hold) = &mut self.hold {
            let aileron = hold.follow(command.aileron);
            let held = LateralControl {
                aileron,
                rudder: 0.0,
            };
            return (held, hold.deflections(&self.body.state, aileron));
        }
        let rudder = self.rudder.as_mut();
        let surfaces = LateralControl {
            aileron: self.aileron.follow(command.aileron, TICK_PERIOD),
            rudder: rudder.map_or(0.0, |it| it.follow(command.rudder, TICK_PERIOD)),
        };
        (surfaces, surfaces)
    }
}

/// The lateral regulator of a scenario's aircraft.
///
/// # Errors
/// [`ScenarioError`] when the aircraft's file has no lateral table, or no gain holds a bank.
pub fn regulator(scenario: &Scenario) -> Result<LateralRegulator, ScenarioError> {
    let model = &scenario.aircraft;
    let lateral = lateral(scenario)?;
    if lateral.roll_loop.is_some() {
        let advice =
            "the autopilot holds the bank: only `fly` and `campaign` know it, with --preset space"
                .to_owned();
        return Err(ScenarioError::Value("aircraft.roll_loop", advice));
    }
    let rudder = lateral.rudder.map_or(0.0, |it| it.range.to_radians());
    let limits = [lateral.aileron.range.to_radians(), rudder];
    let airframe = &model.known.airframe;
    LateralRegulator::design(airframe, &lateral.airframe(), &model.trim, limits)
        .map_err(|error| ScenarioError::Value("aircraft.lateral", error.to_string()))
}

fn lateral(scenario: &Scenario) -> Result<&Lateral, ScenarioError> {
    scenario.aircraft.file.lateral.as_ref().ok_or_else(|| {
        let advice = "give this table: an aircraft without it flies in the vertical plane alone";
        ScenarioError::Value("aircraft.lateral", advice.to_owned())
    })
}

/// Moves the position with the wind [m/s] for `dt` \[s\].
fn drift(state: &mut SpaceState, [x, y, z]: [f64; 3], dt: f64) {
    state.plane.x += x * dt;
    state.plane.z += z * dt;
    state.lateral.y += y * dt;
}

/// Applies a change of the wind [m/s]. Velocity over ground, attitude and its rates stay the same.
fn meet(state: &mut SpaceState, [x, y, z]: [f64; 3]) {
    let [ahead, right, down] = state.air_velocity();
    let [change_x, change_y, change_z] = state.lateral.attitude.world_in([x, y, -z]);
    let (ahead, right, climb) = (ahead - change_x, right - change_y, -(down - change_z));
    let in_plane = libm::hypot(ahead, climb);
    let air = &mut state.plane.air;
    air.airspeed = libm::hypot(in_plane, right);
    // In turns the pitch in the carried plane grows beyond half a turn, and the flight path with it.
    let path = libm::atan2(climb, ahead);
    let turns = libm::round((air.flight_path - path) / TAU);
    air.flight_path = if turns == 0.0 {
        path
    } else {
        path + turns * TAU
    };
    state.lateral.sideslip = libm::atan2(right, in_plane);
}
