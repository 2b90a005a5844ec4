//! Doubts about the lateral part of an aircraft file.

use super::LateralReport;
use super::doubts::{Doubt, doubt, outside};
use mpp_core::vehicle::LateralAirframe;
use mpp_sim::aircraft_file::AircraftModel;

/// Every doubt about the lateral table of an aircraft.
pub(super) fn lateral_doubts(
    model: &AircraftModel,
    lateral: &LateralAirframe,
    report: &LateralReport,
) -> Vec<Doubt> {
    let all = of_body(model, lateral).into_iter();
    let all = all.chain(of_signs(lateral)).chain(of_modes(report));
    all.flatten().collect()
}

/// Span and inertia. The bounds of the radius of gyration hold the aircraft of the tables in Roskam, "Airplane Flight
/// Dynamics", part I, appendix B, and in Beard, McLain, "Small Unmanned Aircraft", appendix E.
fn of_body(model: &AircraftModel, lateral: &LateralAirframe) -> [Option<Doubt>; 4] {
    let (a, span) = (&model.known.airframe, lateral.span);
    let aspect = span * span / a.wing_area;
    let [x, y, z] = [lateral.roll_inertia, a.pitch_inertia, lateral.yaw_inertia];
    let gyration = (x / a.mass).sqrt() / span;
    let coupling = lateral.product_inertia.abs() / (x * z).sqrt();
    let most = x.max(y).max(z);
    [
        doubt(
            "lateral.span",
            outside(aspect, 1.0, 30.0),
            format!("an aspect ratio of {aspect:.1}"),
        ),
        doubt(
            "lateral.roll_inertia",
            outside(gyration, 0.06, 0.25),
            format!("the radius of gyration is {gyration:.2} of the span"),
        ),
        doubt(
            "lateral.yaw_inertia",
            2.0 * most > 1.001 * (x + y + z),
            format!(
                "no body has the moments of inertia {x}, {y} and {z}: one exceeds the sum of the others"
            ),
        ),
        doubt(
            "lateral.product_inertia",
            coupling > 0.3,
            format!(
                "{coupling:.2} of the root of roll_inertia times yaw_inertia: each roll becomes a yaw"
            ),
        ),
    ]
}

/// Signs that nearly all aircraft have.
fn of_signs(lateral: &LateralAirframe) -> [Option<Doubt>; 5] {
    let (side, roll, yaw) = (&lateral.side, &lateral.roll, &lateral.yaw);
    // The lateral control departure parameter: the stiffness in yaw while the ailerons hold the bank.
    let departure = yaw.sideslip - roll.sideslip * yaw.aileron / roll.aileron;
    [
        doubt(
            "lateral.yaw.aileron",
            departure < 0.0,
            "ailerons that hold the bank let the nose run away".to_owned(),
        ),
        doubt(
            "lateral.yaw.sideslip",
            yaw.sideslip < 0.005,
            format!("{}: the nose hardly turns into the wind", yaw.sideslip),
        ),
        doubt(
            "lateral.yaw.yaw_rate",
            yaw.yaw_rate >= 0.0,
            "nothing damps the yaw".to_owned(),
        ),
        doubt(
            "lateral.roll.sideslip",
            roll.sideslip > 0.0,
            "a sideslip rolls the aircraft into the wind".to_owned(),
        ),
        doubt(
            "lateral.side.rudder",
            side.rudder * yaw.rudder > 0.0,
            "a rudder behind the centre of gravity pushes to the left when it turns to the right"
                .to_owned(),
        ),
    ]
}

/// Modes beyond MIL-F-8785C, section 3.3.1: damping of the Dutch roll and roll time constant of level 1, spiral of level 3.
fn of_modes(report: &LateralReport) -> [Option<Doubt>; 3] {
    let modes = &report.modes;
    let dutch = modes.dutch_roll;
    let doubles = modes.spiral_time.map(|time| -time * std::f64::consts::LN_2);
    let fast = doubles.filter(|time| (0.0..4.0).contains(time));
    [
        doubt(
            "lateral.yaw",
            dutch.is_none_or(|mode| mode.damping < 0.08),
            dutch.map_or("a motion in yaw grows".to_owned(), |mode| {
                format!("the Dutch roll is little damped: {mode}")
            }),
        ),
        doubt(
            "lateral.roll",
            modes.roll_time.is_none_or(|time| outside(time, 0.0, 1.4)),
            "the roll mode is slow or none".to_owned(),
        ),
        doubt(
            "lateral.roll.yaw_rate",
            fast.is_some(),
            format!("the spiral mode doubles in {:.1} s", fast.unwrap_or(0.0)),
        ),
    ]
}
