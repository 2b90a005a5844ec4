//! The entries of a flight's log: ticks, plans, refused inputs.
//!
//! JSON has no NaN and no infinity. A field where they can occur is an `Option`, and the log then
//! holds `null`.

use crate::sensors::Measurement;
use mpp_core::vehicle::{Conditions, Control, VehicleState};
use serde::{Deserialize, Serialize};

/// The logged values of one tick. Every value except the reference must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Time since the start \[s\].
    pub t: f64,
    /// True state at `t`.
    pub state: VehicleState,
    /// The sensors' measurement of this state.
    pub measured: Measurement,
    /// The core's estimate from the measurements.
    pub estimate: VehicleState,
    /// Wind and lift that the core estimates.
    pub conditions: Conditions,
    /// The state that the core's trajectory asks for at `t`; `None` while the core tracks no plan.
    pub reference: Option<VehicleState>,
    /// The control that the core commanded.
    pub control: Control,
    /// The control that the actuators gave. The aircraft flies with it until the next tick.
    pub applied: Control,
    /// Motion of the air, downrange and up [m/s].
    pub wind: (f64, f64),
}

/// One column per quantity, one row per tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Columns {
    /// Time since the start \[s\].
    pub t: Vec<f64>,
    /// True downrange distance \[m\].
    pub x: Vec<f64>,
    /// True height \[m\].
    pub z: Vec<f64>,
    /// True airspeed [m/s].
    pub airspeed: Vec<f64>,
    /// True pitch \[rad\].
    pub pitch: Vec<f64>,
    /// True pitch rate [rad/s].
    pub pitch_rate: Vec<f64>,
    /// True flight path angle \[rad\].
    pub flight_path: Vec<f64>,
    /// Measured airspeed [m/s].
    pub measured_airspeed: Vec<f64>,
    /// Measured pitch \[rad\].
    pub measured_pitch: Vec<f64>,
    /// Estimated airspeed [m/s].
    pub est_airspeed: Vec<f64>,
    /// Estimated pitch \[rad\].
    pub est_pitch: Vec<f64>,
    /// Estimated pitch rate [rad/s].
    pub est_pitch_rate: Vec<f64>,
    /// Estimated flight path angle \[rad\].
    pub est_flight_path: Vec<f64>,
    /// Estimated downrange distance \[m\].
    pub est_x: Vec<f64>,
    /// Estimated height \[m\].
    pub est_z: Vec<f64>,
    /// Estimated motion of the air downrange [m/s].
    pub est_wind_x: Vec<f64>,
    /// Estimated motion of the air upwards [m/s].
    pub est_wind_z: Vec<f64>,
    /// Estimated excess of the lift coefficient over that of the known airframe [-].
    pub est_lift: Vec<f64>,
    /// Reference downrange distance \[m\]. This and the other references are null without a plan.
    pub ref_x: Vec<Option<f64>>,
    /// Reference height \[m\].
    pub ref_z: Vec<Option<f64>>,
    /// Reference airspeed [m/s].
    pub ref_airspeed: Vec<Option<f64>>,
    /// Reference pitch \[rad\].
    pub ref_pitch: Vec<Option<f64>>,
    /// Reference pitch rate [rad/s].
    pub ref_pitch_rate: Vec<Option<f64>>,
    /// Reference flight path angle \[rad\].
    pub ref_flight_path: Vec<Option<f64>>,
    /// Commanded thrust \[N\].
    pub thrust: Vec<f64>,
    /// Commanded elevator [-].
    pub elevator: Vec<f64>,
    /// Thrust that the actuators gave \[N\]. It equals the command unless the actuators are
    /// limited. The same holds for the elevator below.
    pub applied_thrust: Vec<f64>,
    /// Elevator that the actuators gave [-].
    pub applied_elevator: Vec<f64>,
    /// Motion of the air downrange [m/s].
    pub wind_x: Vec<f64>,
    /// Motion of the air upwards [m/s].
    pub wind_z: Vec<f64>,
}

impl Columns {
    /// Appends one row.
    pub fn push(&mut self, tick: &Tick) {
        let reference = |pick: fn(&VehicleState) -> f64| finite(tick.reference.as_ref().map(pick));
        self.t.push(tick.t);
        self.x.push(tick.state.x);
        self.z.push(tick.state.z);
        self.airspeed.push(tick.state.air.airspeed);
        self.pitch.push(tick.state.air.pitch);
        self.pitch_rate.push(tick.state.air.pitch_rate);
        self.flight_path.push(tick.state.air.flight_path);
        self.measured_airspeed.push(tick.measured.airspeed);
        self.measured_pitch.push(tick.measured.pitch);
        self.est_airspeed.push(tick.estimate.air.airspeed);
        self.est_pitch.push(tick.estimate.air.pitch);
        self.est_pitch_rate.push(tick.estimate.air.pitch_rate);
        self.est_flight_path.push(tick.estimate.air.flight_path);
        self.est_x.push(tick.estimate.x);
        self.est_z.push(tick.estimate.z);
        self.est_wind_x.push(tick.conditions.wind.x);
        self.est_wind_z.push(tick.conditions.wind.z);
        self.est_lift.push(tick.conditions.lift);
        self.ref_x.push(reference(|r| r.x));
        self.ref_z.push(reference(|r| r.z));
        self.ref_airspeed.push(reference(|r| r.air.airspeed));
        self.ref_pitch.push(reference(|r| r.air.pitch));
        self.ref_pitch_rate.push(reference(|r| r.air.pitch_rate));
        self.ref_flight_path.push(reference(|r| r.air.flight_path));
        self.thrust.push(tick.control.thrust);
        self.elevator.push(tick.control.elevator);
        self.applied_thrust.push(tick.applied.thrust);
        self.applied_elevator.push(tick.applied.elevator);
        self.wind_x.push(tick.wind.0);
        self.wind_z.push(tick.wind.1);
    }
}

/// The lateral part of a tick in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateralTick {
    /// True position to the right, bank, course through the air, sideslip, roll rate, yaw rate.
    pub state: [f64; 6],
    /// Estimated position to the right, bank, course, and motion of the air to the right.
    pub estimate: [f64; 4],
    /// Position to the right, bank and course of the plan; `None` while the core tracks no plan.
    pub reference: Option<[f64; 3]>,
    /// Commanded aileron and rudder.
    pub control: [f64; 2],
    /// Aileron and rudder that the servos gave.
    pub applied: [f64; 2],
    /// Motion of the air to the right.
    pub wind: f64,
}

/// One column per lateral quantity, one row per tick. Positive is to the right.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LateralColumns {
    /// True position to the right of the start \[m\].
    pub y: Vec<f64>,
    /// True bank about the direction of flight \[rad\].
    pub bank: Vec<f64>,
    /// True course through the air \[rad\].
    pub course: Vec<f64>,
    /// True sideslip \[rad\].
    pub sideslip: Vec<f64>,
    /// True roll rate [rad/s].
    pub roll_rate: Vec<f64>,
    /// True yaw rate [rad/s].
    pub yaw_rate: Vec<f64>,
    /// Estimated position to the right \[m\].
    pub est_y: Vec<f64>,
    /// Estimated bank \[rad\].
    pub est_bank: Vec<f64>,
    /// Estimated course through the air \[rad\].
    pub est_course: Vec<f64>,
    /// Estimated motion of the air to the right [m/s].
    pub est_wind_y: Vec<f64>,
    /// Reference position to the right \[m\]. This and the other references are null without a plan.
    pub ref_y: Vec<Option<f64>>,
    /// Reference bank \[rad\].
    pub ref_bank: Vec<Option<f64>>,
    /// Reference course through the air \[rad\].
    pub ref_course: Vec<Option<f64>>,
    /// Commanded aileron \[rad\].
    pub aileron: Vec<f64>,
    /// Commanded rudder \[rad\].
    pub rudder: Vec<f64>,
    /// Aileron that the servo gave, or bank that the autopilot holds \[rad\].
    pub applied_aileron: Vec<f64>,
    /// Rudder that the servo gave \[rad\].
    pub applied_rudder: Vec<f64>,
    /// Motion of the air to the right [m/s].
    pub wind_y: Vec<f64>,
}

impl LateralColumns {
    /// Whether the flight was one in the vertical plane.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.y.is_empty()
    }

    /// Appends one row.
    pub fn push(&mut self, tick: &LateralTick) {
        let [y, bank, course, sideslip, roll_rate, yaw_rate] = tick.state;
        self.y.push(y);
        self.bank.push(bank);
        self.course.push(course);
        self.sideslip.push(sideslip);
        self.roll_rate.push(roll_rate);
        self.yaw_rate.push(yaw_rate);
        let [y, bank, course, wind] = tick.estimate;
        self.est_y.push(y);
        self.est_bank.push(bank);
        self.est_course.push(course);
        self.est_wind_y.push(wind);
        let reference = |at: usize| finite(tick.reference.map(|it| it[at]));
        self.ref_y.push(reference(0));
        self.ref_bank.push(reference(1));
        self.ref_course.push(reference(2));
        self.aileron.push(tick.control[0]);
        self.rudder.push(tick.control[1]);
        self.applied_aileron.push(tick.applied[0]);
        self.applied_rudder.push(tick.applied[1]);
        self.wind_y.push(tick.wind);
    }
}

/// One plan that the core delivered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanEntry {
    /// Tick of the scan from which the core made the plan, or of the start of a cycle without a scan.
    pub tick: u64,
    /// First tick that flew the plan; null if no tick did.
    pub used_from_tick: Option<u64>,
    /// The outcome that the planner reports.
    pub outcome: String,
    /// Candidates considered.
    pub candidates: u32,
    /// Candidates whose trajectory met every constraint.
    pub feasible: u32,
    /// Runs of the path search.
    pub tree_runs: u32,
    /// Slices of planning work used.
    pub slices: u32,
    /// Cost of the chosen trajectory [-]; null if none was chosen.
    pub cost: Option<f64>,
    /// Worst constraint violation of the chosen trajectory \[m\]; null if none was chosen.
    pub violation: Option<f64>,
    /// Time for which a plan in space has a way out \[s\]; not written in the plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub way_out: Option<f64>,
}

impl PlanEntry {
    /// Whether the planning cycle found no new plan. The core then flies an older plan or holds
    /// level trim.
    #[must_use]
    pub fn had_nothing(&self) -> bool {
        matches!(self.outcome.as_str(), "KeptPrevious" | "TrimHold")
    }
}

/// One input that the core refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RejectionEntry {
    /// Tick of the input.
    pub tick: u64,
    /// Cause of the refusal.
    pub cause: String,
}

/// A change of the core's trust in a sensor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SensorEntry {
    /// The tick of the change.
    pub tick: u64,
    /// Name of the sensor: `airspeed`, `pitch`, `position` or `lidar`; or `elevator` or `motor`.
    pub sensor: String,
    /// Its state from this tick on: `healthy`, `suspected`, `excluded` or `recovering`.
    pub state: String,
}

/// Returns the value if JSON can write it, that is, if it is finite.
#[must_use]
pub fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}
