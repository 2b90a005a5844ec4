//! `ceiling` and `campaign --ceiling` as a user meets them. What the verdicts mean is tested in `mpp-analysis`.

use crate::common::harness;
use serde_json::Value;
use std::process::Output;

fn answer(arguments: &[&str]) -> Output {
    harness().args(arguments).output().unwrap()
}

#[test]
fn every_field_has_one_verdict_in_any_number_of_threads() {
    let cells = |threads: &str| {
        let given = "ceiling --generator sealed --obstacles 40,1000 --margin 0.3 --fields 2 --seed 7 --json --threads";
        let output = answer(&given.split(' ').chain([threads]).collect::<Vec<_>>());
        assert!(output.status.success());
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["cells"].clone()
    };
    let cells = [cells("1"), cells("2")];
    assert_eq!(cells[0], cells[1]);
    for (cell, (obstacles, verdict)) in [(40, "passable"), (1000, "blocked")].iter().enumerate() {
        let cell = &cells[0][cell];
        assert_eq!(cell["field"], "sealed");
        assert_eq!(cell["obstacles"], *obstacles);
        assert_eq!(cell["margin"], 0.3);
        assert_eq!(
            (&cell["fields"], &cell[*verdict]),
            (&2.into(), &2.into()),
            "{cell}"
        );
    }
}

#[test]
fn a_campaign_tells_its_share_of_the_passable_fields() {
    let given = "campaign --obstacles 20 --trials 2 --seed 1 --duration 3 --ceiling --json";
    let output = answer(&given.split(' ').collect::<Vec<_>>());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let cell = &report["cells"][0];
    assert_eq!(cell["against_ceiling"]["passable"], 2);
    assert_eq!(cell["against_ceiling"]["flown"], cell["strict_successes"]);
    assert!(cell["clearance_p5"].as_f64().unwrap() <= cell["clearance_median"].as_f64().unwrap());
}

#[test]
fn what_cannot_be_judged_is_refused_with_what_to_do() {
    for (given, advice) in [
        ("ceiling --margin=-1", "give 0 or a positive distance"),
        ("ceiling --scenario docs/none.toml", "docs/none.toml"),
    ] {
        let output = answer(&given.split(' ').collect::<Vec<_>>());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{given}");
        assert!(said.contains(advice) && output.stdout.is_empty(), "{said}");
    }
}
