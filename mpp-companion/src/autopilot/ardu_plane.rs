//! `ArduPlane` in GUIDED: pitch and throttle alone are proposed, and it holds the course that it was asked for.

use super::manners::{AUTOPILOT, Manners, SYSTEM, check};
use crate::setpoint::Setpoint;
use crate::wire::Mav;
use mavlink::dialects::common::{AttitudeTargetTypemask, COMMAND_INT_DATA, MavCmd, MavFrame};

/// LOITER, for a take-over.
pub(crate) const LOITER: u32 = 12;

pub(super) const MANNERS: Manners = Manners {
    name: "ArduPlane",
    mode: 15,
    checks: &[
        check("GUIDED_TIMEOUT", 0.1, 0.5, "set 0.3 to 0.5"),
        check("SCHED_LOOP_RATE", 63.0, 1000.0, "set 100 or more"),
        check("TRIM_THROTTLE", 2.0, 100.0, "set more than 1"),
        check("PTCH_LIM_MAX_DEG", 5.0, 80.0, "set 5 to 80"),
        check("PTCH_LIM_MIN_DEG", -80.0, -5.0, "set -80 to -5"),
        check("THR_MAX", 100.0, 100.0, "set 100"),
    ],
    pitch: ["PTCH_LIM_MIN_DEG", "PTCH_LIM_MAX_DEG"],
    flows: false,
    bank: 0.0,
    // ATTITUDE, LOCAL_POSITION_NED, VFR_HUD, GLOBAL_POSITION_INT.
    streams: &[[30.0, 2e4], [32.0, 2e4], [74.0, 2e4], [33.0, 2e5]],
};

/// By this mask it takes the pitch from the quaternion and the throttle, and holds the heading by itself.
pub(super) fn target(asked: Setpoint) -> ([f32; 4], AttitudeTargetTypemask) {
    let (sin, cos) = libm::sincos(0.5 * asked.pitch);
    let mask = AttitudeTargetTypemask::from_bits_retain(133);
    ([cos as f32, 0.0, sin as f32, 0.0], mask)
}

/// Sets its own height and speed: it returns to them when the setpoints end.
pub(super) fn give_back(height: Option<f32>, speed: f32) -> Vec<Mav> {
    let change = |height| {
        let order = MavCmd::MAV_CMD_GUIDED_CHANGE_ALTITUDE;
        command(order, [0.0; 3], height)
    };
    let speed = [0.0, speed, 0.0];
    let speed = command(MavCmd::MAV_CMD_GUIDED_CHANGE_SPEED, speed, 0.0);
    height.map(change).into_iter().chain([speed]).collect()
}

/// Asks for a course over ground \[rad\].
pub(crate) fn hold_course(course: f64) -> Mav {
    // Type 0 is a course over ground.
    let asked = [0.0, degrees(course), 5.0];
    command(MavCmd::MAV_CMD_GUIDED_CHANGE_HEADING, asked, 0.0)
}

fn command(command: MavCmd, [param1, param2, param3]: [f32; 3], z: f32) -> Mav {
    Mav::COMMAND_INT(COMMAND_INT_DATA {
        param1,
        param2,
        param3,
        z,
        command,
        target_system: SYSTEM,
        target_component: AUTOPILOT,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        ..COMMAND_INT_DATA::DEFAULT
    })
}

/// A course in degrees, 0 to less than 360: the autopilot denies 360, to which a course just left of north would be rounded.
fn degrees(course: f64) -> f32 {
    let degrees = course.to_degrees().rem_euclid(360.0) as f32;
    if degrees < 360.0 { degrees } else { 0.0 }
}

#[cfg(test)]
mod tests {
    #[test]
    fn no_course_is_360_degrees() {
        for course in [-1e-9, 0.0, 1e-9, 6.0, -6.0] {
            let degrees = super::degrees(course);
            assert!((0.0..360.0).contains(&degrees), "{course}: {degrees}");
        }
    }
}
