//! What the companion asks and commands besides setpoints.

use super::{Companion, Told};
use crate::autopilot::{AUTOPILOT, Kind, SYSTEM, hold_course};
use crate::guard::State;
use crate::wire::Mav;
use mavlink::dialects::common::{
    COMMAND_LONG_DATA, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavType, PARAM_REQUEST_READ_DATA,
    TIMESYNC_DATA,
};

/// Time between two questions \[us\].
const SECOND: u64 = 1_000_000;

impl Companion {
    /// Asks what is due.
    pub(super) fn ask(&mut self, now: u64, send: &mut dyn FnMut(&[u8])) {
        let due = |last: Option<u64>, period| last.is_none_or(|last| now >= last + period);
        let sync = if self.clock.is_in_step() {
            SECOND
        } else {
            SECOND / 10
        };
        if due(self.asked.sync, sync) {
            self.asked.sync = Some(now);
            let ts1 = i64::try_from(now).unwrap_or(i64::MAX).saturating_mul(1000);
            let question = TIMESYNC_DATA {
                ts1,
                ..TIMESYNC_DATA::DEFAULT
            };
            self.send(&Mav::TIMESYNC(question), send);
        }
        if due(self.asked.second, SECOND) {
            self.asked.second = Some(now);
            self.beat(send);
            self.ask_parameters(send);
            self.told.extend(self.lidar.trouble().map(Told::Lidar));
        }
        self.hold_course(now, send);
    }

    fn beat(&mut self, send: &mut dyn FnMut(&[u8])) {
        let beat = HEARTBEAT_DATA {
            mavtype: MavType::MAV_TYPE_ONBOARD_CONTROLLER,
            autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
            mavlink_version: 3,
            ..HEARTBEAT_DATA::DEFAULT
        };
        self.send(&Mav::HEARTBEAT(beat), send);
    }

    /// Asks for the parameters that are not known, and tells what is verified.
    fn ask_parameters(&mut self, send: &mut dyn FnMut(&[u8])) {
        let unknown: Vec<_> = self.checked.unknown().collect();
        for name in unknown {
            let request = PARAM_REQUEST_READ_DATA {
                param_index: -1,
                target_system: SYSTEM,
                target_component: AUTOPILOT,
                param_id: name.into(),
            };
            self.send(&Mav::PARAM_REQUEST_READ(request), send);
        }
        if self.guard.state == State::Off {
            for &[param1, param2] in self.asked_kind().manners().streams {
                let command = COMMAND_LONG_DATA {
                    param1,
                    param2,
                    command: MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL,
                    target_system: SYSTEM,
                    target_component: AUTOPILOT,
                    ..COMMAND_LONG_DATA::DEFAULT
                };
                self.send(&Mav::COMMAND_LONG(command), send);
            }
        }
        let flaw = self.flaw();
        if flaw.is_some() && flaw != self.asked.flaw {
            let text = format!("not ready: {}", flaw.as_deref().unwrap_or_default());
            self.told.push(Told::Verified(text));
        }
        if flaw.is_none() && !self.asked.told {
            self.asked.told = true;
            let text = format!("verified: {}", self.checked.summary());
            self.told.push(Told::Verified(text));
        }
        self.asked.flaw = flaw;
    }

    /// Asks the autopilot to hold the course, and to come back to its line.
    fn hold_course(&mut self, now: u64, send: &mut dyn FnMut(&[u8])) {
        let holds = matches!(
            self.guard.state,
            State::Listening | State::Flying | State::Climb
        );
        if !holds || self.asked_kind() != Kind::ArduPlane {
            return;
        }
        let (Some(course), Some(flown)) = (self.course(), &mut self.flown) else {
            return;
        };
        if flown.headed.is_some_and(|headed| now < headed + SECOND / 2) {
            return;
        }
        flown.headed = Some(now);
        self.send(&hold_course(course), send);
    }

    /// Gives the aircraft to the autopilot. The companion falls silent after that.
    pub(super) fn give_back(&mut self, send: &mut dyn FnMut(&[u8])) {
        let here = self.heard.position.as_ref().zip(self.heard.origin);
        let height = here.map(|(position, origin)| origin - position.z);
        let height = height.filter(|height| height.is_finite());
        let file = &self.config.model.file;
        let equivalent = file.cruise / crate::frames::true_airspeed(1.0, file.air_density);
        for message in self.asked_kind().give_back(height, equivalent as f32) {
            self.send(&message, send);
        }
    }
}
