//! Telemetry as a ground station sees it: read back by the MAVLink crate's own reader, which
//! checks the CRC.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "the helpers of tests fail as tests do"
)]

use hil_protocol::telemetry::{Datagram, MavSeverity, STATUS_TEXT_MAX, Telemetry};
use mavlink::dialects::common::*;
use mavlink::{MavHeader, MavlinkReader, MavlinkVersion};
use proptest::prelude::*;

fn read(datagram: &Datagram) -> (MavHeader, MavMessage) {
    MavlinkReader::new(datagram.as_bytes())
        .read_message::<MavMessage>(MavlinkVersion::V2)
        .unwrap()
}

fn status(text: &str) -> String {
    let sent = Telemetry::new().status_text(MavSeverity::MAV_SEVERITY_WARNING, text);
    let (_, MavMessage::STATUSTEXT(data)) = read(&sent) else {
        panic!("{sent:?}")
    };
    assert_eq!(data.severity, MavSeverity::MAV_SEVERITY_WARNING);
    data.text.to_str().unwrap().to_string()
}

#[test]
fn heartbeat_bytes_are_frozen() {
    let mut telemetry = Telemetry::new();
    let hex = |datagram: Datagram| -> String {
        datagram
            .as_bytes()
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    };
    assert_eq!(
        hex(telemetry.heartbeat(true, true)),
        "fd0900000001010000000a0000000100b5040357f8"
    );
    assert_eq!(
        hex(telemetry.heartbeat(false, false)),
        "fd0900000101010000000a00000001001503037f58"
    );
}

#[test]
fn heartbeat_is_a_fixed_wing_in_auto() {
    let (header, message) = read(&Telemetry::new().heartbeat(true, true));
    assert_eq!(
        header,
        MavHeader {
            system_id: 1,
            component_id: 1,
            sequence: 0
        }
    );
    let MavMessage::HEARTBEAT(data) = message else {
        panic!("{message:?}")
    };
    assert_eq!(data.custom_mode, 10);
    assert_eq!(data.mavtype, MavType::MAV_TYPE_FIXED_WING);
    assert_eq!(data.autopilot, MavAutopilot::MAV_AUTOPILOT_GENERIC);
    assert_eq!(data.system_status, MavState::MAV_STATE_ACTIVE);
    assert!(
        data.base_mode
            .contains(MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED)
    );
    assert!(
        data.base_mode
            .contains(MavModeFlag::MAV_MODE_FLAG_AUTO_ENABLED)
    );
    assert!(
        data.base_mode
            .contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)
    );
    assert!(
        data.base_mode
            .contains(MavModeFlag::MAV_MODE_FLAG_HIL_ENABLED)
    );
}

#[test]
fn heartbeat_flags_follow_the_arguments() {
    for (armed, in_the_loop) in [(false, true), (true, false)] {
        let (_, message) = read(&Telemetry::new().heartbeat(armed, in_the_loop));
        let MavMessage::HEARTBEAT(data) = message else {
            panic!("{message:?}")
        };
        let mode = data.base_mode;
        assert_eq!(
            mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED),
            armed
        );
        assert_eq!(
            mode.contains(MavModeFlag::MAV_MODE_FLAG_HIL_ENABLED),
            in_the_loop
        );
        assert_eq!(data.system_status == MavState::MAV_STATE_ACTIVE, armed);
    }
}

#[test]
fn frames_are_numbered_across_messages_and_wrap() {
    let mut telemetry = Telemetry::new();
    for number in 0..=300_u16 {
        let sent = if number % 2 == 0 {
            telemetry.attitude(0, 0.0, 0.0)
        } else {
            telemetry.heartbeat(false, true)
        };
        assert_eq!(read(&sent).0.sequence, (number % 256) as u8);
    }
}

#[test]
fn height_and_climb_turn_down() {
    let sent = Telemetry::new().local_position_ned(1234, 56.0, 30.0, 9.0, 0.5);
    let expected = LOCAL_POSITION_NED_DATA {
        time_boot_ms: 1234,
        x: 56.0,
        y: 0.0,
        z: -30.0,
        vx: 9.0,
        vy: 0.0,
        vz: -0.5,
    };
    assert_eq!(read(&sent).1, MavMessage::LOCAL_POSITION_NED(expected));
}

#[test]
fn hud_keeps_up_as_up() {
    let sent = Telemetry::new().vfr_hud(9.5, 9.0, 30.0, 0.5, 42);
    let expected = VFR_HUD_DATA {
        airspeed: 9.5,
        groundspeed: 9.0,
        alt: 30.0,
        climb: 0.5,
        heading: 0,
        throttle: 42,
    };
    assert_eq!(read(&sent).1, MavMessage::VFR_HUD(expected));
}

#[test]
fn a_long_text_ends_with_a_whole_character() {
    assert_eq!(status(""), "");
    assert_eq!(status("no feasible plan"), "no feasible plan");
    assert_eq!(status(&"a".repeat(50)), "a".repeat(50));
    assert_eq!(status(&"a".repeat(51)), "a".repeat(50));
    assert_eq!(status(&format!("{}é", "a".repeat(49))), "a".repeat(49));
    assert_eq!(
        status(&format!("{}é", "a".repeat(48))),
        format!("{}é", "a".repeat(48))
    );
}

proptest! {
    #[test]
    fn attitude_comes_back(time in any::<u32>(), pitch in any::<f32>(), rate in any::<f32>()) {
        let sent = Telemetry::new().attitude(time, pitch.into(), rate.into());
        let expected = ATTITUDE_DATA {
            time_boot_ms: time,
            roll: 0.0,
            pitch,
            yaw: 0.0,
            rollspeed: 0.0,
            pitchspeed: rate,
            yawspeed: 0.0,
        };
        prop_assert_eq!(read(&sent).1, MavMessage::ATTITUDE(expected));
    }

    #[test]
    fn any_text_is_a_prefix_of_at_most_fifty_bytes(text in "[^\0]{0,80}") {
        let received = status(&text);
        prop_assert!(text.starts_with(&received));
        prop_assert!(received.len() <= STATUS_TEXT_MAX);
        prop_assert!(received == text || received.len() > STATUS_TEXT_MAX - 4);
    }
}
