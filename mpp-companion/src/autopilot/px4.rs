//! A fixed wing of PX4 in OFFBOARD. The rules are from its documentation and sources of 1.15 and 1.16; none of this was flown
//! with PX4, not even in its own simulation.
//!
//! OFFBOARD takes a whole attitude: the companion must bank, and hold height until the core flies. It does not cut setpoints by
//! the limits of its other modes, so the companion does. It is entered only while setpoints flow, and left when they end.

use super::manners::{AUTOPILOT, Manners, SYSTEM, check};
use crate::setpoint::Setpoint;
use crate::wire::Mav;
use mavlink::dialects::common::{
    AttitudeTargetTypemask, COMMAND_LONG_DATA, MavCmd, MavParamType, PARAM_VALUE_DATA,
};
use mpp_core::vehicle::GRAVITY;
use std::f64::consts::{PI, TAU};

/// Main mode AUTO and its sub-mode LOITER, which it calls Hold.
const AUTO_LOITER: [u8; 2] = [4, 3];
/// Hold, as heartbeats tell it: the main mode is the third byte, the sub-mode the fourth.
pub(crate) const HOLD: u32 = u32::from_le_bytes([0, 0, AUTO_LOITER[0], AUTO_LOITER[1]]);
/// Time in which the course turns to the wanted one \[s\].
const TURN: f64 = 1.5;
/// `CURRENT_MODE`. PX4 sends it at once when the mode changes; its heartbeat comes each second, and no command changes that.
pub(crate) const CURRENT_MODE: f32 = 436.0;

pub(super) const MANNERS: Manners = Manners {
    name: "PX4",
    mode: u32::from_le_bytes([0, 0, 6, 0]),
    checks: &[
        check("COM_OF_LOSS_T", 0.1, 0.5, "set 0.3 to 0.5"),
        check("COM_OBL_RC_ACT", 5.0, 5.0, "set 5, Hold"),
        check("MAV_FWDEXTSP", 1.0, 1.0, "set 1"),
        check("SYS_HAS_NUM_ASPD", 1.0, 9.0, "fit an airspeed sensor"),
        check("FW_P_LIM_MAX", 5.0, 80.0, "set 5 to 80"),
        check("FW_P_LIM_MIN", -80.0, -5.0, "set -80 to -5"),
        check("FW_R_LIM", 20.0, 80.0, "set 35 or more"),
        check("FW_THR_MAX", 1.0, 1.0, "set 1"),
    ],
    pitch: ["FW_P_LIM_MIN", "FW_P_LIM_MAX"],
    flows: true,
    bank: 0.26,
    // ATTITUDE, LOCAL_POSITION_NED, VFR_HUD, GLOBAL_POSITION_INT.
    streams: &[
        [30.0, 2e4],
        [32.0, 2e4],
        [74.0, 2e4],
        [33.0, 2e5],
        [CURRENT_MODE, 2e4],
    ],
};

/// An integer is sent byte for byte in the place of the number.
pub(super) fn value(told: &PARAM_VALUE_DATA) -> f32 {
    match told.param_type {
        MavParamType::MAV_PARAM_TYPE_INT32 => told.param_value.to_bits().cast_signed() as f32,
        _ => told.param_value,
    }
}

/// The whole attitude; only the body rates are not given. A fixed wing does not fly the yaw.
pub(super) fn target(asked: Setpoint, yaw: f64) -> ([f32; 4], AttitudeTargetTypemask) {
    let half = [asked.roll, asked.pitch, yaw].map(|angle| libm::sincos(0.5 * angle));
    let [(sr, cr), (sp, cp), (sy, cy)] = half;
    let q = [
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    ];
    let mask = AttitudeTargetTypemask::from_bits_retain(7);
    (q.map(|part| part as f32), mask)
}

/// The bank that turns a course over ground to the wanted one at a ground speed. The gate limits it.
pub(crate) fn bank(wanted: f64, course: f64, speed: f64) -> f64 {
    let off = (wanted - course + PI).rem_euclid(TAU) - PI;
    libm::atan(off * speed / (GRAVITY * TURN))
}

/// Chooses Hold. If that is lost, `COM_OBL_RC_ACT` does the same when setpoints end.
pub(super) fn set_hold() -> Mav {
    let [main, sub] = AUTO_LOITER.map(f32::from);
    Mav::COMMAND_LONG(COMMAND_LONG_DATA {
        // The modes are PX4's own ones.
        param1: 1.0,
        param2: main,
        param3: sub,
        command: MavCmd::MAV_CMD_DO_SET_MODE,
        target_system: SYSTEM,
        target_component: AUTOPILOT,
        ..COMMAND_LONG_DATA::DEFAULT
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::roll_pitch;

    #[test]
    fn an_integer_parameter_is_read_from_its_bytes() {
        let told = |param_value, param_type| {
            value(&PARAM_VALUE_DATA {
                param_value,
                param_type,
                ..PARAM_VALUE_DATA::DEFAULT
            })
        };
        let int = MavParamType::MAV_PARAM_TYPE_INT32;
        assert_eq!(told(f32::from_bits(5), int).to_bits(), 5_f32.to_bits());
        let minus = told(f32::from_bits(u32::MAX), int);
        assert_eq!(minus.to_bits(), (-1_f32).to_bits());
        let real = told(0.5, MavParamType::MAV_PARAM_TYPE_REAL32);
        assert_eq!(real.to_bits(), 0.5_f32.to_bits());
    }

    #[test]
    fn the_quaternion_has_roll_and_pitch_at_each_yaw() {
        for yaw in [-3.0, 0.0, 0.7, 2.0] {
            let asked = Setpoint {
                pitch: -0.3,
                roll: 0.2,
                throttle: 0.5,
            };
            let (q, mask) = target(asked, yaw);
            let (roll, pitch) = roll_pitch(q);
            assert!((roll - 0.2).abs() < 1e-6 && (pitch + 0.3).abs() < 1e-6);
            // Attitude and throttle are not among what is left out.
            assert_eq!(mask.bits() & (64 + 128), 0);
        }
    }

    #[test]
    fn the_bank_turns_the_shorter_way() {
        assert!(bank(0.1, 0.0, 15.0) > 0.0);
        assert!(bank(-3.1, 3.1, 15.0) > 0.0);
        assert!(bank(3.1, -3.1, 15.0) < 0.0);
        assert_eq!(HOLD, 0x0304_0000);
        assert_eq!(MANNERS.mode, 0x0006_0000);
    }
}
