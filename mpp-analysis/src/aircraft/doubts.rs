//! Numbers of an aircraft file that are possible but rare: a slip of the pen looks like this.

use super::Modes;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::GRAVITY;
use mpp_sim::aircraft_file::AircraftModel;
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

/// Every doubt about an aircraft. The bounds are those of aircraft between a toy and an airliner, after the
/// tables of derivatives in Roskam, "Airplane Flight Dynamics", part I, appendix B, and Beard, McLain, "Small
/// Unmanned Aircraft", appendix E.
pub(super) fn doubts(model: &AircraftModel, modes: &Modes) -> Vec<Doubt> {
    let (file, known, trim) = (&model.file, &model.known, &model.trim);
    let a = &known.airframe;
    let mut doubts = Vec::new();
    let mut doubt = |key, rare: bool, what: String| {
        if rare {
            doubts.push(Doubt { key, what });
        }
    };
    let outside = |value: f64, least: f64, most: f64| !(least..=most).contains(&value);

    let loading = a.mass / a.wing_area;
    doubt(
        "wing_area",
        outside(loading, 1.0, 800.0),
        format!("{loading:.2} kg on each square metre: check mass in kg and area in m^2"),
    );
    let span = 8.0 * a.wing_area.sqrt();
    let gyration = (a.pitch_inertia / a.mass).sqrt();
    doubt(
        "pitch_inertia",
        outside(gyration, 0.02 * span, 0.3 * span),
        format!(
            "a radius of gyration of {gyration:.3} m does not fit a wing of {:.2} m^2",
            a.wing_area
        ),
    );
    doubt(
        "lift.alpha",
        outside(a.lift_alpha, 1.5, 7.0),
        format!(
            "{:.2} per radian: thin wings have 3 to 6; check `derivatives`",
            a.lift_alpha
        ),
    );
    let lift = a.level_lift(known.cruise);
    doubt(
        "cruise",
        outside(lift, 0.1, 1.5),
        format!("level flight needs a lift coefficient of {lift:.2}"),
    );
    let glide = lift / (a.drag_zero + a.drag_induced * lift * lift);
    doubt(
        "drag.zero",
        outside(glide, 4.0, 45.0),
        format!("lift over drag is {glide:.1} in level flight"),
    );
    if let Some(stall) = known.stall {
        doubt(
            "lift.stall",
            stall < 3_f64.to_radians(),
            format!(
                "level flight is only {:.1} deg below the stall",
                stall.to_degrees()
            ),
        );
    }
    if let Some(thrust) = known.actuators.thrust_max {
        let ratio = thrust / (a.mass * GRAVITY);
        doubt(
            "thrust.max",
            outside(ratio, 0.1, 2.0) || thrust < 1.2 * trim.control.thrust,
            format!(
                "{ratio:.2} of the weight, {:.1} N of it for level flight",
                trim.control.thrust
            ),
        );
    }
    let rooms = [
        known.actuators.elevator_below,
        known.actuators.elevator_above,
    ];
    let total: f64 = rooms.iter().flatten().sum();
    let nearest = rooms.into_iter().flatten().reduce(f64::min);
    doubt(
        "elevator",
        nearest.is_some_and(|room| room < 0.15 * total),
        format!(
            "level flight needs {:.3}, near the end of the range",
            trim.control.elevator
        ),
    );
    let Modes { short_period, .. } = modes;
    doubt(
        "moment",
        short_period.damping < 0.2,
        format!("the short period is little damped: {short_period}"),
    );
    let phase = short_period.frequency * TICK_PERIOD;
    doubt(
        "moment.alpha",
        phase > 0.6,
        format!("the short period turns {phase:.1} rad in a tick of the core: {short_period}"),
    );
    let body = known.body_radius / model.units().length;
    doubt(
        "body_radius",
        body > 1.0,
        format!(
            "the aircraft is {body:.1} times as large as the obstacles to which its speed fits"
        ),
    );
    doubt(
        "air_density",
        outside(file.air_density, 0.3, 1.4),
        format!("{:.3} kg/m^3", file.air_density),
    );
    doubts
}
