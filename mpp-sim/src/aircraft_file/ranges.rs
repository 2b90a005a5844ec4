//! The ranges of an aircraft file, which docs/aircraft.md lists. Those of the vertical plane are the core's own.

use super::{AircraftFile, Lateral, Surface};
use crate::file_error::{ScenarioError, ensure};
use mpp_core::settings::{OutOfRange, Setting};

/// Makes a list of settings, each with its key and with the unit of its range.
macro_rules! of_core {
    ($($setting:ident, $key:literal, $unit:literal;)*) => {
        const OF_CORE: &[(Setting, &str, &str)] =
            &[$((Setting::$setting, concat!("aircraft.", $key), $unit)),*];
    };
}

of_core! {
    Mass, "mass", "kg";
    PitchInertia, "pitch_inertia", "kg m^2";
    WingArea, "wing_area", "m^2";
    MomentLength, "chord", "m";
    AirDensity, "air_density", "kg/m^3";
    CruiseAirspeed, "cruise", "m/s";
    BodyRadius, "body_radius", "m, times (cruise / 12 m/s)^2";
    LiftZero, "lift.zero", "1";
    LiftAlpha, "lift.alpha", "1/rad";
    LiftAlphaRate, "lift.alpha_rate", "1/rad, times 4 mass / (air_density wing_area chord)";
    LiftPitchRate, "lift.pitch_rate", "1/rad, times 4 mass / (air_density wing_area chord)";
    Stall, "lift.stall", "rad above the angle of attack of level flight";
    DragZero, "drag.zero", "1";
    DragInduced, "drag.induced", "1";
    MomentZero, "moment.zero", "1";
    MomentAlpha, "moment.alpha", "1/rad, which is stable in pitch";
    MomentPitchRate, "moment.pitch_rate", "1/rad, times 2 cruise / chord";
    MomentAlphaRate, "moment.alpha_rate", "1/rad, times 2 cruise / chord";
    MomentAlphaRate, "moment.alpha_rate_time", "s/rad, with moment.alpha_rate";
    MomentElevator, "elevator.moment", "per unit of the command, with either sign";
    LiftElevator, "elevator.lift", "per unit of the command";
    ElevatorBelow, "elevator.min", "units below level flight";
    ElevatorAbove, "elevator.max", "units above level flight";
    ElevatorRate, "elevator.rate", "units/s";
    ElevatorDelay, "elevator.delay", "s";
    MotorThrust, "thrust.max", "N";
    ThrustLag, "thrust.lag", "s";
    ThrustDelay, "thrust.delay", "s";
}

impl AircraftFile {
    /// The refusal of a number of the core's settings by the key from which it comes.
    pub(super) fn refusal(&self, setting: Setting) -> ScenarioError {
        let mut rows = OF_CORE.iter().filter(|(of, ..)| *of == setting);
        // Two keys add up to one number.
        let row = if self.moment.alpha_rate_time == 0.0 {
            rows.next()
        } else {
            rows.next_back()
        };
        let [least, most] = setting.range();
        match (row, setting) {
            (Some((_, key, unit)), _) => ScenarioError::Value(key, advice([least, most], unit)),
            (None, Setting::AngleOfAttackLimit | Setting::PlanElevatorWeight) => {
                derived("aircraft.lift.alpha", setting)
            }
            (None, Setting::ElevatorWeight) => derived("aircraft.elevator.moment", setting),
            (None, _) => derived("aircraft", setting),
        }
    }
}

fn advice([least, most]: [f64; 2], unit: &str) -> String {
    match unit {
        "1" => format!("give {least} to {most}"),
        unit => format!("give {least} to {most} {unit}"),
    }
}

/// The refusal of what follows from a key.
fn derived(key: &'static str, setting: Setting) -> ScenarioError {
    let what = format!(
        "it gives the planner a number that it cannot use: {}",
        OutOfRange(setting)
    );
    ScenarioError::Value(key, what)
}

/// Makes a list of keys, each with unit, range and place. A place that is not there has no number.
macro_rules! of_turns {
    ($($key:literal, $unit:literal, $range:expr, $value:expr;)*) => {
        const OF_TURNS: &[(&str, &str, [f64; 2], fn(&Lateral) -> Option<f64>)] =
            &[$((concat!("aircraft.", $key), $unit, $range, $value)),*];
    };
}

of_turns! {
    "roll_loop.span", "m", [0.01, 200.0], |it| Some(it.roll_loop?.span);
    "roll_loop.frequency", "rad/s", [0.5, 60.0], |it| Some(it.roll_loop?.frequency);
    "roll_loop.damping", "1", [0.05, 5.0], |it| Some(it.roll_loop?.damping);
    "roll_loop.delay", "s", [0.0, 0.3], |it| Some(it.roll_loop?.delay);
    "roll_loop.max_bank", "rad", [0.1, 1.4], |it| Some(it.roll_loop?.max_bank);
    "roll_loop.max_rate", "rad/s", [0.1, 20.0], |it| Some(it.roll_loop?.max_rate);
    "lateral.span", "m", [0.01, 200.0], |it| Some(it.span);
    "lateral.roll_inertia", "kg m^2", [1e-6, 1e9], |it| Some(it.roll_inertia);
    "lateral.yaw_inertia", "kg m^2", [1e-6, 1e9], |it| Some(it.yaw_inertia);
    "lateral.product_inertia", "kg m^2", [-1e9, 1e9], |it| Some(it.product_inertia);
    "lateral.side.sideslip", "1/rad", [-10.0, 10.0], |it| Some(it.side.sideslip);
    "lateral.side.roll_rate", "1/rad", [-10.0, 10.0], |it| Some(it.side.roll_rate);
    "lateral.side.yaw_rate", "1/rad", [-10.0, 10.0], |it| Some(it.side.yaw_rate);
    "lateral.side.aileron", "1/rad", [-10.0, 10.0], |it| Some(it.side.aileron);
    "lateral.side.rudder", "1/rad", [-10.0, 10.0], |it| it.side.rudder;
    "lateral.roll.sideslip", "1/rad", [-10.0, 10.0], |it| Some(it.roll.sideslip);
    "lateral.roll.yaw_rate", "1/rad", [-10.0, 10.0], |it| Some(it.roll.yaw_rate);
    "lateral.roll.rudder", "1/rad", [-10.0, 10.0], |it| it.roll.rudder;
    "lateral.yaw.sideslip", "1/rad", [-10.0, 10.0], |it| Some(it.yaw.sideslip);
    "lateral.yaw.roll_rate", "1/rad", [-10.0, 10.0], |it| Some(it.yaw.roll_rate);
    "lateral.yaw.yaw_rate", "1/rad", [-10.0, 10.0], |it| Some(it.yaw.yaw_rate);
    "lateral.yaw.aileron", "1/rad", [-10.0, 10.0], |it| Some(it.yaw.aileron);
    "lateral.roll.roll_rate", "1/rad, a damping", [-10.0, -1e-4], |it| Some(it.roll.roll_rate);
    "lateral.roll.aileron", "1/rad: positive turns to the right; if not, turn the signs of all derivatives by the surface", [1e-6, 10.0], |it| Some(it.roll.aileron);
    "lateral.yaw.rudder", "1/rad: positive turns to the right; if not, turn the signs of all derivatives by the surface", [1e-6, 10.0], |it| it.yaw.rudder;
    "lateral.aileron.range", "deg", [0.1, 89.0], |it| Some(it.aileron.range);
    "lateral.rudder.range", "deg", [0.1, 89.0], |it| rudder(it, |of| of.range);
    "lateral.aileron.rate", "deg/s", [0.1, 1e6], |it| Some(it.aileron.rate);
    "lateral.rudder.rate", "deg/s", [0.1, 1e6], |it| rudder(it, |of| of.rate);
    "lateral.aileron.bandwidth", "rad/s", [0.1, 200.0], |it| Some(it.aileron.bandwidth);
    "lateral.rudder.bandwidth", "rad/s", [0.1, 200.0], |it| rudder(it, |of| of.bandwidth);
    "lateral.aileron.damping", "1", [0.01, 2.0], |it| it.aileron.damping;
    "lateral.rudder.damping", "1", [0.01, 2.0], |it| it.rudder?.damping;
}

fn rudder(lateral: &Lateral, value: fn(&Surface) -> f64) -> Option<f64> {
    lateral.rudder.as_ref().map(value)
}

/// Checks each number of the lateral table by itself.
pub(super) fn check_turns(lateral: &Lateral) -> Result<(), ScenarioError> {
    OF_TURNS.iter().try_for_each(|(key, unit, range, value)| {
        let [least, most] = *range;
        let holds = value(lateral).is_none_or(|it| (least..=most).contains(&it));
        ensure(holds, key, advice(*range, unit))
    })
}
