//! Numbers of an aircraft file that are possible but rare: a slip of the pen looks like this.

use super::Modes;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::GRAVITY;
use mpp_sim::aircraft_file::AircraftModel;
use mpp_sim::navigation::NavigationConfig;
use serde::Serialize;
use std::fmt;

/// A doubt about one key of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Doubt {
    /// The key.
    pub key: &'static str,
    /// What is rare about it, and what to check.
    pub what: String,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.key, self.what)
    }
}

/// Aspect ratio \[-\] of a wing whose span the file does not give.
const TYPICAL_ASPECT: f64 = 8.0;

/// Every doubt about an aircraft. The bounds are those of aircraft between a toy and an airliner, after the
/// tables of derivatives in Roskam, "Airplane Flight Dynamics", part I, appendix B, and Beard, McLain, "Small
/// Unmanned Aircraft", appendix E.
pub(super) fn doubts(model: &AircraftModel, modes: &Modes) -> Vec<Doubt> {
    let all = of_airframe(model).into_iter();
    let all = all.chain(of_lift(model)).chain(of_actuators(model));
    let all = all.chain(of_modes(modes)).chain(of_world(model));
    all.flatten().collect()
}

/// A doubt about a key if its value is rare.
pub(super) fn doubt(key: &'static str, rare: bool, what: String) -> Option<Doubt> {
    rare.then_some(Doubt { key, what })
}

pub(super) fn outside(value: f64, least: f64, most: f64) -> bool {
    !(least..=most).contains(&value)
}

/// Numbers of the airframe that do not fit each other.
fn of_airframe(model: &AircraftModel) -> [Option<Doubt>; 4] {
    let (a, cruise) = (&model.known.airframe, model.known.cruise);
    let loading = a.mass / a.wing_area;
    let span =
        (model.file.lateral.as_ref()).map_or((TYPICAL_ASPECT * a.wing_area).sqrt(), |it| it.span);
    let gyration = (a.pitch_inertia / a.mass).sqrt();
    let damping = a.turn_stiffness(cruise) / a.moment_alpha - 1.0;
    [
        doubt(
            "moment.pitch_rate",
            damping > 1.5,
            format!(
                "in a pull-up the damping takes {damping:.1} times the elevator of the balance; plans leave it out"
            ),
        ),
        doubt(
            "wing_area",
            outside(loading, 1.0, 800.0),
            format!("{loading:.2} kg on each square metre: check mass in kg and area in m^2"),
        ),
        doubt(
            "pitch_inertia",
            outside(gyration, 0.04 * span, 0.35 * span),
            format!("a radius of gyration of {gyration:.3} m does not fit a span of {span:.2} m"),
        ),
        doubt(
            "lift.alpha",
            outside(a.lift_alpha, 1.5, 7.0),
            format!(
                "{:.2} per radian: thin wings have 3 to 6; check `derivatives`",
                a.lift_alpha
            ),
        ),
    ]
}

/// Lift and drag of level flight.
fn of_lift(model: &AircraftModel) -> [Option<Doubt>; 3] {
    let known = &model.known;
    let a = &known.airframe;
    let lift = a.level_lift(known.cruise);
    let glide = lift / (a.drag_zero + a.drag_induced * lift * lift);
    let stall = known.stall.map(f64::to_degrees);
    let near = |stall: f64| {
        let what = format!("level flight is only {stall:.1} deg below the stall");
        doubt("lift.stall", stall < 3.0, what)
    };
    [
        doubt(
            "cruise",
            outside(lift, 0.1, 1.5),
            format!("level flight needs a lift coefficient of {lift:.2}"),
        ),
        doubt(
            "drag.zero",
            outside(glide, 4.0, 45.0),
            format!("lift over drag is {glide:.1} in level flight"),
        ),
        stall.and_then(near),
    ]
}

/// What level flight leaves to motor and elevator.
fn of_actuators(model: &AircraftModel) -> [Option<Doubt>; 3] {
    let (actuators, needed) = (&model.actuators, model.trim.control);
    let weight = model.known.airframe.mass * GRAVITY;
    let motor = |most: f64| {
        let ratio = most / weight;
        let rare = outside(ratio, 0.1, 2.0) || most < 1.2 * needed.thrust;
        let what = format!(
            "{ratio:.2} of the weight, {:.1} N of it for level flight",
            needed.thrust
        );
        doubt("thrust.max", rare, what)
    };
    let rooms = [actuators.elevator_below, actuators.elevator_above];
    let total: f64 = rooms.iter().flatten().sum();
    let nearest = rooms.into_iter().flatten().reduce(f64::min);
    let balanced = actuators.angle_of_attack(&model.known.airframe);
    let balanced = balanced.map(f64::to_degrees).into_iter();
    let farthest = balanced.filter(|it| it.is_finite()).fold(0.0, f64::max);
    [
        actuators.thrust_max.and_then(motor),
        doubt(
            "elevator",
            nearest.is_some_and(|room| room < 0.15 * total),
            format!(
                "level flight needs {:.3}, near the end of the range",
                needed.elevator
            ),
        ),
        doubt(
            "elevator.moment",
            farthest > 75.0,
            format!(
                "it balances {farthest:.1} deg of angle of attack: check `unit`, `derivatives` and moment.alpha"
            ),
        ),
    ]
}

/// The short period against the tick of the core.
fn of_modes(modes: &Modes) -> [Option<Doubt>; 2] {
    let short_period = &modes.short_period;
    let phase = short_period.frequency * TICK_PERIOD;
    [
        doubt(
            "moment",
            short_period.damping < 0.2,
            format!("the short period is little damped: {short_period}"),
        ),
        doubt(
            "moment.alpha",
            phase > 0.6,
            format!("the short period turns {phase:.1} rad in a tick of the core: {short_period}"),
        ),
    ]
}

/// The aircraft against its obstacles and its air.
fn of_world(model: &AircraftModel) -> [Option<Doubt>; 3] {
    let unit = model.units().length;
    let body = model.known.body_radius / unit;
    let positions = NavigationConfig::RTK;
    let error = libm::hypot(positions.sigma, positions.wander);
    let density = model.file.air_density;
    [
        doubt(
            "body_radius",
            body > 1.0,
            format!(
                "the aircraft is {body:.1} times as large as the obstacles to which its speed fits"
            ),
        ),
        // A quarter of the margin of 0.8 units.
        doubt(
            "cruise",
            error > 0.2 * unit,
            format!(
                "obstacles that fit its speed have a radius of {unit:.2} m, and positions of `rtk` err by {error:.3} m: fly with `ideal`"
            ),
        ),
        doubt(
            "air_density",
            outside(density, 0.3, 1.4),
            format!("{density:.3} kg/m^3"),
        ),
    ]
}
