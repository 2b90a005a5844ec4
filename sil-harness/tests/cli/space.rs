//! Turns in six degrees of freedom.

use crate::common::{harness, place, scratch};
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

/// A straight flight meets the first trunk of a row on its way.
#[test]
fn a_world_is_measured_and_the_first_hit_is_told() {
    let forest = told("--aircraft ultrastick --world forest --seed 7");
    assert_eq!(forest["bank_deg"], 0.0);
    let world = &forest["world"];
    assert!(world["bodies"].as_u64().unwrap() > 800, "{world}");
    let path = world["mean_free_path"].as_f64().unwrap();
    // 1 / (2 w density), where w is half of the span and the mean radius.
    assert!(
        (path * 2.0 * (0.635 + 0.275) * 0.04 - 1.0).abs() < 0.2,
        "{world}"
    );
    assert!(world["first_hit"]["x"].as_f64().unwrap() > 14.0, "{world}");
    let map = scratch("stems").join("stems.csv");
    let row = "id,x,y,diameter\n1,200,0,0.4\n2,90,0.5,0.3\n3,60,1.5,0.3\n4,40,-5,0.3\n";
    std::fs::write(&map, row).unwrap();
    let flags = format!("--aircraft ultrastick --stems {}", map.display());
    let hit = &told(&flags)["world"]["first_hit"];
    assert!((hit["x"].as_f64().unwrap() - 89.85).abs() < 0.02, "{hit}");
    std::fs::write(&map, "x,y,diameter\n40,5,0.3\n").unwrap();
    let output = space(&flags);
    let talk = String::from_utf8_lossy(&output.stdout);
    assert!(talk.contains("first hit                  -"), "{talk}");
    for (row, hint) in [
        ("40,5,nan", "line 2, diameter `nan`: give a number"),
        ("0,0.3,0.4", "touches a body or the ground at its start"),
    ] {
        std::fs::write(&map, format!("x,y,diameter\n{row}\n")).unwrap();
        let output = space(&flags);
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(output.stdout.is_empty() && talk.contains(hint), "{talk}");
    }
    std::fs::remove_file(map).unwrap();
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
        (
            "--aircraft x8 --world forest --density 5",
            "density: give more than 0 and at most 1 (trunks/m^2)",
        ),
        ("--aircraft x8 --density 0.1", "--world"),
        ("--aircraft x8 --stems nosuch.csv", "cannot read nosuch.csv"),
    ] {
        let output = space(flags);
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(output.stdout.is_empty() && talk.contains(hint), "{talk}");
    }
}
