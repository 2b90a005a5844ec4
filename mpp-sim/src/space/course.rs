//! A plant that flies the vertical plane of the planner in six degrees of freedom: the lateral regulator holds course and
//! track, and the core sees the motion in the plane.

use super::{LateralState, SpaceAircraft, SpaceState, WindConfig};
use crate::file_error::ScenarioError;
use crate::plant::{Plant, PlantError};
use crate::scenario::Scenario;
use mpp_core::control::LateralRegulator;
use mpp_core::units::Units;
use mpp_core::vehicle::{AirState, Control, GRAVITY, VehicleState};

/// Distance from the track at which the wanted course is 45 deg \[m\], and time in which the course is reached \[s\], both of
/// the reference aircraft. Less of either needs more bank in gusts; more lets them carry the aircraft farther. Source: chosen.
const CAPTURE: f64 = 20.0;
const TURN_TIME: f64 = 1.5;
/// Greatest wanted bank \[rad\]: 30 deg. More costs lift. Source: chosen.
const MOST_BANK: f64 = core::f64::consts::FRAC_PI_6;

/// The aircraft, its regulator, and its motion in the plane.
#[derive(Clone, Debug)]
pub struct CourseHold {
    aircraft: SpaceAircraft,
    regulator: LateralRegulator,
    units: Units,
    seen: VehicleState,
}

impl CourseHold {
    /// The aircraft of a scenario, whose gusts blow as hard to the side as upwards.
    ///
    /// # Errors
    /// [`ScenarioError`] when the aircraft's file has no lateral table, or no gain holds a bank.
    pub fn new(scenario: &Scenario) -> Result<Self, ScenarioError> {
        let wind = WindConfig {
            lateral_gusts: scenario.faults.gusts.intensity,
            ..WindConfig::default()
        };
        let aircraft = SpaceAircraft::new(scenario, wind)?;
        Ok(Self {
            regulator: super::regulator(scenario)?,
            units: scenario.aircraft.units(),
            seen: in_plane(aircraft.state()),
            aircraft,
        })
    }

    /// The true state.
    #[must_use]
    pub fn space(&self) -> &SpaceState {
        self.aircraft.state()
    }

    /// The bank \[rad\] that turns the course over ground to the track.
    fn wanted_bank(&self) -> f64 {
        let state = self.aircraft.state();
        let [ahead, right, _] = state.lateral.attitude.in_world(state.air_velocity());
        let [wind_ahead, wind_right, _] = self.aircraft.wind();
        let (ahead, right) = (ahead + wind_ahead, right + wind_right);
        let wanted = -libm::atan(state.lateral.y / (CAPTURE * self.units.length));
        let turn = (wanted - libm::atan2(right, ahead)) / (TURN_TIME * self.units.time);
        libm::atan(libm::hypot(ahead, right) * turn / GRAVITY).clamp(-MOST_BANK, MOST_BANK)
    }
}

impl Plant for CourseHold {
    fn state(&self) -> &VehicleState {
        &self.seen
    }

    fn wind(&self) -> (f64, f64) {
        let [ahead, _, up] = self.aircraft.wind();
        (ahead, up)
    }

    fn step(&mut self, command: Control) -> Result<Control, PlantError> {
        let motion = self.aircraft.state().lateral_motion();
        let lateral = self.regulator.step(&motion, self.wanted_bank());
        let (given, _) = self.aircraft.step(command, lateral)?;
        self.seen = in_plane(self.aircraft.state());
        Ok(given)
    }
}

/// What sensors in the vertical plane see: the pitch of the nose, the climb through the air.
fn in_plane(state: &SpaceState) -> VehicleState {
    if state.lateral == LateralState::NONE {
        return state.plane;
    }
    let [nose_x, nose_y, nose_down] = state.attitude().in_world([1.0, 0.0, 0.0]);
    let [x, y, down] = state.lateral.attitude.in_world(state.air_velocity());
    let (sin_bank, cos_bank) = libm::sincos(state.bank());
    let air = &state.plane.air;
    VehicleState {
        air: AirState {
            airspeed: air.airspeed,
            pitch: libm::atan2(-nose_down, libm::hypot(nose_x, nose_y)),
            pitch_rate: air.pitch_rate * cos_bank - state.lateral.yaw_rate * sin_bank,
            flight_path: libm::atan2(-down, libm::hypot(x, y)),
        },
        ..state.plane
    }
}
