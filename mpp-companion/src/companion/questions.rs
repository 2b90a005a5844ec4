//! What the companion asks and commands besides setpoints.

use super::{AUTOPILOT, Companion, GUIDED, SYSTEM, Told};
use crate::guard::State;
use crate::wire::Mav;
use mavlink::dialects::common::{
    COMMAND_INT_DATA, COMMAND_LONG_DATA, HEARTBEAT_DATA, MavAutopilot, MavCmd, MavFrame, MavType,
    PARAM_REQUEST_READ_DATA, TIMESYNC_DATA,
};

/// Time between two questions \[us\].
const SECOND: u64 = 1_000_000;
/// Messages that are asked for, and their periods \[us\]: ATTITUDE, LOCAL_POSITION_NED, VFR_HUD, GLOBAL_POSITION_INT.
const STREAMS: [[f32; 2]; 4] = [[30.0, 2e4], [32.0, 2e4], [74.0, 2e4], [33.0, 2e5]];
/// Distance over which the course leads back to the line \[m\].
const BACK: f64 = 60.0;

/// When what was asked for.
#[derive(Default)]
pub(super) struct Asked {
    second: Option<u64>,
    sync: Option<u64>,
    /// Whether the user was told what was verified.
    pub(super) told: bool,
    flaw: Option<String>,
}

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
            self.send(&Mav::TIMESYNC(TIMESYNC_DATA { tc1: 0, ts1 }), send);
        }
        if due(self.asked.second, SECOND) {
            self.asked.second = Some(now);
            self.beat(send);
            self.ask_parameters(send);
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
            for [param1, param2] in STREAMS {
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
            let text = format!("verified: mode {GUIDED}, {}", self.checked.summary());
            self.told.push(Told::Verified(text));
        }
        self.asked.flaw = flaw;
    }

    /// Asks the autopilot to hold the course, and to come back to its line.
    fn hold_course(&mut self, now: u64, send: &mut dyn FnMut(&[u8])) {
        if !matches!(
            self.guard.state,
            State::Listening | State::Flying | State::Climb
        ) {
            return;
        }
        let Some(flown) = &mut self.flown else {
            return;
        };
        let Some(placed) = flown.placed else {
            return;
        };
        if flown.headed.is_some_and(|headed| now < headed + SECOND / 2) {
            return;
        }
        flown.headed = Some(now);
        let course = flown.frame.course - libm::atan(placed.cross / BACK);
        let degrees = degrees(course);
        // Type 0 is a course over ground.
        self.command(
            MavCmd::MAV_CMD_GUIDED_CHANGE_HEADING,
            [0.0, degrees, 5.0],
            0.0,
            send,
        );
    }

    /// Sets the autopilot's own targets. The companion falls silent after that.
    pub(super) fn give_back(&mut self, send: &mut dyn FnMut(&[u8])) {
        let here = self.heard.position.as_ref().zip(self.heard.origin);
        let height = here.map(|(position, origin)| origin - position.z);
        let cruise = self.config.model.file.cruise;
        let equivalent =
            cruise / crate::frames::true_airspeed(1.0, self.config.model.file.air_density);
        if let Some(height) = height.filter(|height| height.is_finite()) {
            self.command(
                MavCmd::MAV_CMD_GUIDED_CHANGE_ALTITUDE,
                [0.0; 3],
                height,
                send,
            );
        }
        let speed = [0.0, equivalent as f32, 0.0];
        self.command(MavCmd::MAV_CMD_GUIDED_CHANGE_SPEED, speed, 0.0, send);
    }

    fn command(&mut self, command: MavCmd, p: [f32; 3], z: f32, send: &mut dyn FnMut(&[u8])) {
        let [param1, param2, param3] = p;
        let command = COMMAND_INT_DATA {
            param1,
            param2,
            param3,
            z,
            command,
            target_system: SYSTEM,
            target_component: AUTOPILOT,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            ..COMMAND_INT_DATA::DEFAULT
        };
        self.send(&Mav::COMMAND_INT(command), send);
    }
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
