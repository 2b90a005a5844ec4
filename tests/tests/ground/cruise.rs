//! Tests the mode in which the vehicle does not look.

use super::radio::{CONFIG, Radio, command, heard};
use hil_protocol::mavlink::messages::*;
use mpp_sim::scenario::ScenarioFile;

const LIDAR: u32 = 0x100;
const PREARM: u32 = 0x1000_0000;
const WARNING: u8 = 4;

/// A text with its tick and severity.
type Text = (u32, u8, String);

/// Flies in CRUISE from 4 s to 8 s of 16 s. Returns what was told of the lidar, and `SYS_STATUS`.
fn cruise(keys: &str) -> (Vec<Text>, Vec<(u32, SYS_STATUS_DATA)>) {
    let text = format!("seed = 1\nobstacles = 0\nduration = 16\n{keys}");
    let file = ScenarioFile::parse("cruise", &text).unwrap();
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(400, &command(176, 1.0, 7.0))
        .at(450, &command(176, 1.0, 7.0))
        .at(800, &command(176, 1.0, 10.0));
    radio.fly(&file.build().unwrap());
    let texts = heard!(radio, STATUSTEXT, |status| (
        status.severity,
        status.text.to_str().unwrap().to_owned()
    ));
    let told = |text: &str| text.contains("lidar") || text.contains("CRUISE");
    let texts = texts.into_iter().filter(|(_, (_, text))| told(text));
    let status = heard!(radio, SYS_STATUS, |status| status.clone());
    let texts = texts.map(|(tick, (severity, text))| (tick, severity, text));
    (texts.collect(), status)
}

/// No scan is due, so its absence is no fault. The vehicle says once that it does not look.
#[test]
fn a_lidar_that_is_not_asked_has_not_failed() {
    for pace in [
        "replan_hz = 10.0",
        "replan_hz = 1.0",
        "replan_hz = 4.0\nlatency_ms = 200",
    ] {
        let (texts, status) = cruise(pace);
        let line = "CRUISE: it does not look for obstacles".to_owned();
        assert_eq!(texts, [(400, WARNING, line)], "{pace}");
        let bits = LIDAR | PREARM;
        for (tick, status) in status {
            assert_eq!(status.onboard_control_sensors_health & bits, bits, "{tick}");
            let looks = status.onboard_control_sensors_enabled & LIDAR != 0;
            assert_eq!(looks, !(400..800).contains(&tick), "{tick}");
        }
    }
}

/// A lidar that fails meanwhile is told of when the mode asks for scans again.
#[test]
fn a_lidar_that_fails_meanwhile_is_told_of_afterwards() {
    let (texts, _) =
        cruise("replan_hz = 4.0\n[faults.scan]\nfrom = 6.0\nuntil = 15.9\nmissing = true");
    let [_, (tick, _, text)] = &texts[..] else {
        panic!("{texts:?}");
    };
    assert_eq!(text, "Sensor lidar failed");
    assert!((800..1000).contains(tick), "{tick}");
}
