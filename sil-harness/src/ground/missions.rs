//! Missions, of which the vehicle has only the empty one. A station that gets no answer asks again for seconds.

use super::demands::Address;
use super::vehicle::Vehicle;
use hil_protocol::mavlink::Frame;
use hil_protocol::mavlink::messages::*;

/// MAV_MISSION_ACCEPTED, MAV_MISSION_UNSUPPORTED and MAV_MISSION_INVALID_SEQUENCE.
const ACCEPTED: u8 = 0;
const UNSUPPORTED: u8 = 3;
const NO_SUCH_ITEM: u8 = 13;

impl Vehicle {
    /// Answers a request about a mission.
    pub(super) fn answer_mission(&mut self, frame: &Frame<'_>, from: Address) {
        if let Some(request) = frame.decode::<MISSION_REQUEST_LIST_DATA>() {
            if self.is_target(request.target_system, request.target_component) {
                self.send(&MISSION_COUNT_DATA {
                    target_system: from.system,
                    target_component: from.component,
                    count: 0,
                    mission_type: request.mission_type,
                    ..MISSION_COUNT_DATA::DEFAULT
                });
            }
        } else if let Some((system, component, mission_type, verdict)) = verdict(frame)
            && self.is_target(system, component)
        {
            self.send(&MISSION_ACK_DATA {
                target_system: from.system,
                target_component: from.component,
                mavtype: verdict,
                mission_type,
                ..MISSION_ACK_DATA::DEFAULT
            });
        }
    }
}

/// The target of what is acknowledged, its kind of mission, and the acknowledgement.
fn verdict(frame: &Frame<'_>) -> Option<(u8, u8, u8, u8)> {
    macro_rules! of {
        ($message:ident, $verdict:expr) => {{
            (
                $message.target_system,
                $message.target_component,
                $message.mission_type,
                $verdict,
            )
        }};
    }
    Some(if let Some(upload) = frame.decode::<MISSION_COUNT_DATA>() {
        let is_empty = upload.count == 0;
        of!(upload, if is_empty { ACCEPTED } else { UNSUPPORTED })
    } else if let Some(clear) = frame.decode::<MISSION_CLEAR_ALL_DATA>() {
        of!(clear, ACCEPTED)
    } else if let Some(part) = frame.decode::<MISSION_WRITE_PARTIAL_LIST_DATA>() {
        of!(part, UNSUPPORTED)
    } else if let Some(item) = frame.decode::<MISSION_REQUEST_DATA>() {
        of!(item, NO_SUCH_ITEM)
    } else if let Some(item) = frame.decode::<MISSION_REQUEST_INT_DATA>() {
        of!(item, NO_SUCH_ITEM)
    } else {
        let item = frame.decode::<MISSION_SET_CURRENT_DATA>()?;
        (item.target_system, item.target_component, 0, NO_SUCH_ITEM)
    })
}
