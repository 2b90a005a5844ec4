//! What a kind of autopilot does with modes, setpoints and parameters.

use crate::autopilot::{Kind, LOITER, px4};
use mavlink::dialects::common::{MavAutopilot, MavParamType, PARAM_VALUE_DATA};

/// Ticks for which setpoints must flow before OFFBOARD is entered.
const FLOWS: u32 = 100;

/// What the kinds differ in.
pub(super) struct Rules {
    pub(super) autopilot: MavAutopilot,
    /// The mode of a take-over.
    pub(super) other: u32,
    /// The time after which a setpoint is not obeyed any more.
    pub(super) timeout: &'static str,
    pub(super) parameters: &'static [(&'static str, f32)],
}

const ARDU_PLANE: Rules = Rules {
    autopilot: MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
    other: LOITER,
    timeout: "GUIDED_TIMEOUT",
    parameters: &[
        ("GUIDED_TIMEOUT", 0.5),
        ("SCHED_LOOP_RATE", 200.0),
        ("TRIM_THROTTLE", 30.0),
        ("PTCH_LIM_MAX_DEG", 35.0),
        ("PTCH_LIM_MIN_DEG", -35.0),
        ("THR_MAX", 100.0),
    ],
};

const PX4: Rules = Rules {
    autopilot: MavAutopilot::MAV_AUTOPILOT_PX4,
    other: px4::HOLD,
    timeout: "COM_OF_LOSS_T",
    parameters: &[
        ("COM_OF_LOSS_T", 0.5),
        ("COM_OBL_RC_ACT", 5.0),
        ("MAV_FWDEXTSP", 1.0),
        ("SYS_HAS_NUM_ASPD", 1.0),
        ("FW_P_LIM_MAX", 30.0),
        ("FW_P_LIM_MIN", -30.0),
        ("FW_R_LIM", 50.0),
        ("FW_THR_MAX", 1.0),
    ],
};

/// PX4's integers among the parameters.
const INTEGERS: [&str; 3] = ["COM_OBL_RC_ACT", "MAV_FWDEXTSP", "SYS_HAS_NUM_ASPD"];

pub(super) fn of(kind: Kind) -> &'static Rules {
    match kind {
        Kind::ArduPlane => &ARDU_PLANE,
        Kind::Px4 => &PX4,
    }
}

/// The answer with a parameter: PX4 sends an integer byte for byte.
pub(super) fn told(name: &str, value: f32) -> PARAM_VALUE_DATA {
    let (param_value, param_type) = if INTEGERS.contains(&name) {
        let bits = (value as i32).cast_unsigned();
        (f32::from_bits(bits), MavParamType::MAV_PARAM_TYPE_INT32)
    } else {
        (value, PARAM_VALUE_DATA::DEFAULT.param_type)
    };
    PARAM_VALUE_DATA {
        param_value,
        param_type,
        param_id: name.into(),
        ..PARAM_VALUE_DATA::DEFAULT
    }
}

/// PX4's watch on the setpoints, in ticks.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watch {
    begun: u32,
    last: Option<u32>,
}

impl Watch {
    /// A setpoint came.
    pub(super) fn hear(&mut self, tick: u32, kept: u32) {
        if !self.lives(tick, kept) {
            self.begun = tick;
        }
        self.last = Some(tick);
    }

    /// Whether setpoints flow.
    pub(super) fn lives(&self, tick: u32, kept: u32) -> bool {
        self.last.is_some_and(|last| tick - last <= kept)
    }

    /// Whether OFFBOARD may be entered.
    pub(super) fn admits(&self, tick: u32, kept: u32) -> bool {
        self.lives(tick, kept) && tick - self.begun >= FLOWS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offboard_is_entered_after_a_second_of_setpoints_and_left_when_they_end() {
        let mut watch = Watch::default();
        assert!(!watch.lives(0, 50) && !watch.admits(0, 50));
        for tick in (200..300).step_by(2) {
            watch.hear(tick, 50);
            assert!(watch.lives(tick, 50) && !watch.admits(tick, 50));
        }
        watch.hear(300, 50);
        assert!(watch.admits(300, 50) && watch.lives(350, 50));
        assert!(!watch.lives(351, 50));
        watch.hear(400, 50);
        assert!(!watch.admits(400, 50));
    }
}
