//! Turns in six degrees of freedom.

use crate::common::{harness, place};
use serde_json::Value;
use std::process::Output;

fn space(flags: &str) -> Output {
    let mut harness = harness();
    harness
        .arg("space")
        .args(flags.split(' '))
        .output()
        .unwrap()
}

fn told(flags: &str) -> Value {
    let output = space(&format!("{flags} --json"));
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

#[test]
fn a_bank_is_held_and_told() {
    for bank in [30.0, -20.0] {
        let turn = told(&format!("--aircraft ultrastick --bank {bank} --wind 0,4,0"));
        let number = |key: &str| turn[key].as_f64().unwrap();
        assert!(number("bank_rms_deg") < 1.0, "{turn}");
        assert!(number("most_sideslip_deg") < 10.0, "{turn}");
        let share = number("radius") / number("radius_level");
        assert!((share - 1.0).abs() < 0.1, "{turn}");
    }
    let level = told("--aircraft ultrastick --bank 0");
    assert_eq!(level["radius"], Value::Null);
    assert!(
        level["altitude_change"].as_f64().unwrap().abs() < 0.1,
        "{level}"
    );
}

#[test]
fn the_planner_flies_its_plane_in_space() {
    let output = space("--aircraft x8 --flights 2 --gusts light --seed 780000");
    let talk = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(talk.matches("in the plane 2 [").count(), 2, "{talk}");
    assert_eq!(talk.matches("in space 2 [").count(), 2, "{talk}");
}

#[test]
fn gusts_follow_the_seed_and_ticks_are_written() {
    let out = place("turn.csv");
    let flown = |seed: u32| {
        let flags = format!(
            "--aircraft x8 --gusts light --seed {seed} --out {}",
            out.display()
        );
        let output = space(&flags);
        assert!(output.status.success());
        let table = String::from_utf8(output.stdout).unwrap();
        assert!(table.contains("greatest sideslip"), "{table}");
        std::fs::read_to_string(&out).unwrap()
    };
    let first = flown(1);
    assert_eq!(first.lines().count(), 2001);
    assert_eq!(flown(1), first);
    assert_ne!(flown(2), first);
    std::fs::remove_file(out).unwrap();
}

#[test]
fn what_cannot_be_flown_is_refused_in_one_sentence() {
    for (flags, hint) in [
        (
            "--aircraft cessna182",
            "error: aircraft.lateral: give this table",
        ),
        ("--aircraft nosuch", "no aircraft `nosuch`"),
        ("--aircraft x8 --bank 70", "give -60 to 60 deg"),
        ("--aircraft x8 --wind 1,2", "give X,Y,Z"),
    ] {
        let output = space(flags);
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(output.stdout.is_empty() && talk.contains(hint), "{talk}");
    }
}
