//! The two kinds of autopilot: what differs between them, and nothing else.

mod ardu_plane;
mod manners;
pub(crate) mod px4;

pub(crate) use ardu_plane::{LOITER, hold_course};
pub(crate) use manners::{AUTOPILOT, Check, Manners, SYSTEM};

use crate::setpoint::Setpoint;
use crate::wire::Mav;
use mavlink::dialects::common::{
    AttitudeTargetTypemask, HEARTBEAT_DATA, MavAutopilot, MavType, PARAM_VALUE_DATA,
};

/// A kind of autopilot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// `ArduPlane`, in GUIDED. It holds course, and height while it gets no setpoints.
    #[value(name = "arduplane")]
    ArduPlane,
    /// A fixed wing of PX4, in OFFBOARD. It takes a whole attitude, and holds nothing by itself.
    Px4,
}

impl Kind {
    /// The kind of an aircraft that says this of itself.
    pub(crate) fn of(beat: &HEARTBEAT_DATA) -> Option<Self> {
        match beat.autopilot {
            MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA => Some(Self::ArduPlane),
            // By this type PX4 takes the thrust for one along the body.
            MavAutopilot::MAV_AUTOPILOT_PX4 if beat.mavtype == MavType::MAV_TYPE_FIXED_WING => {
                Some(Self::Px4)
            }
            _ => None,
        }
    }

    pub(crate) fn manners(self) -> &'static Manners {
        match self {
            Self::ArduPlane => &ardu_plane::MANNERS,
            Self::Px4 => &px4::MANNERS,
        }
    }

    /// The value of a parameter.
    pub(crate) fn value(self, told: &PARAM_VALUE_DATA) -> f32 {
        match self {
            Self::ArduPlane => told.param_value,
            Self::Px4 => px4::value(told),
        }
    }

    /// Quaternion and mask of a setpoint at a yaw \[rad\].
    pub(crate) fn target(self, asked: Setpoint, yaw: f64) -> ([f32; 4], AttitudeTargetTypemask) {
        match self {
            Self::ArduPlane => ardu_plane::target(asked),
            Self::Px4 => px4::target(asked, yaw),
        }
    }

    /// What is sent to give the aircraft back at a height above home \[m\] and an equivalent airspeed [m/s].
    pub(crate) fn give_back(self, height: Option<f32>, speed: f32) -> Vec<Mav> {
        match self {
            Self::ArduPlane => ardu_plane::give_back(height, speed),
            Self::Px4 => vec![px4::set_hold()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heartbeat_says_the_kind() {
        let of = |autopilot, mavtype| {
            Kind::of(&HEARTBEAT_DATA {
                autopilot,
                mavtype,
                ..HEARTBEAT_DATA::DEFAULT
            })
        };
        let (plane, copter) = (MavType::MAV_TYPE_FIXED_WING, MavType::MAV_TYPE_QUADROTOR);
        let px4 = MavAutopilot::MAV_AUTOPILOT_PX4;
        let ardu_pilot = MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA;
        assert_eq!(of(px4, plane), Some(Kind::Px4));
        assert_eq!(of(ardu_pilot, plane), Some(Kind::ArduPlane));
        assert_eq!(of(px4, copter), None);
        assert_eq!(of(MavAutopilot::MAV_AUTOPILOT_GENERIC, plane), None);
    }
}
