//! Flights of the planner in space.

use crate::common::harness;

fn forest(flags: &str) -> (Option<i32>, String) {
    let output = harness()
        .arg("forest")
        .args(flags.split(' '))
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(text).unwrap())
}

#[test]
fn a_light_forest_is_flown_and_told() {
    let (code, text) = forest("--airspeed 13 --density 0.005 --flights 2 --seed 5 --each");
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.contains("seed 5: ") && text.contains("seed 6: "),
        "{text}"
    );
    assert!(text.contains("of 2 flights arrived"), "{text}");
}

#[test]
fn what_makes_no_sense_is_one_sentence() {
    for (flags, hint) in [
        ("--density=-1", "density: give more than 0 and at most 1"),
        ("--world jungle", "jungle"),
        ("--aircraft cessna182 --flights 1", "give this table"),
        ("--candidates 8", "1..=7"),
    ] {
        let (code, text) = forest(flags);
        assert_eq!(code, Some(2), "{flags}: {text}");
        assert!(text.contains(hint), "{flags}: {text}");
    }
}
