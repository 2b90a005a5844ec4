//! Aircraft from files.

use crate::common::{harness, run, scratch};
use serde_json::Value;

#[test]
fn an_aircraft_file_that_makes_no_sense_is_refused_by_file_and_key() {
    let usual = include_str!("../../../aircraft/example.toml");
    let folder = scratch("bad-aircraft");
    let path = folder.join("my.toml");
    for (from, to, told) in [
        (
            "mass = 2.0 ",
            "mass = -2.0 ",
            "my.toml: aircraft.mass: give 0.01 to 1000000 kg",
        ),
        ("mass = 2.0 ", "# ", "missing field `mass`"),
        (
            "body_radius = 0.15",
            "body_radius = 30.0",
            "my.toml: aircraft.body_radius: give 0 to 2 m",
        ),
        (
            "max = 20.0",
            "max = -5.0",
            "my.toml: aircraft.elevator.max: level flight",
        ),
        (
            "aileron = 0.17",
            "aileron = -0.17",
            "my.toml: aircraft.lateral.roll.aileron: give 0.000001 to 10 1/rad: positive turns",
        ),
        ("span = 1.5", "# ", "missing field `span`"),
    ] {
        std::fs::write(&path, usual.replacen(from, to, 1)).unwrap();
        let file = path.display().to_string();
        for command in [["fly", "--aircraft"], ["campaign", "--aircraft"]] {
            let (output, out) = run("bad-aircraft-flown", &[command[0], command[1], &file]);
            let text = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{text}");
            assert!(
                text.contains(told) && text.contains("my.toml"),
                "{told}: {text}"
            );
            assert!(!out.exists() || std::fs::read_dir(out).unwrap().next().is_none());
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_aircraft_is_told_as_an_object_and_flown() {
    let arguments = [
        "aircraft",
        "zagi",
        "--flights",
        "2",
        "--obstacles",
        "20",
        "--json",
    ];
    let output = harness().args(arguments).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let answer: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(answer["aircraft"]["name"], "zagi");
    assert_eq!(answer["flights"][0]["strict"], 2, "{text}");
}
