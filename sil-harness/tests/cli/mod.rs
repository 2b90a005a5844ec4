//! The command line as a user meets it: exit codes, what is printed where, what is written.

mod aircraft;
mod brought;
mod ceiling;
mod export;
mod forest;
mod json;
mod pages;
mod peers;
mod refused;
mod space;
mod speech;
mod until_width;

use crate::common::{harness, place, run, scratch};
use serde_json::Value;

#[test]
fn a_flight_prints_one_json_object_and_writes_log_and_picture() {
    let (output, out) = run("json", &["--seed", "3", "--json"]);
    assert!(output.status.success());
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["seed"], 3);
    assert_eq!(result["outcome"], "survived");
    let log = std::fs::read(out.join("flight-seed3.json")).unwrap();
    let log: Value = serde_json::from_slice(&log).unwrap();
    assert_eq!(log["ticks"]["t"].as_array().unwrap().len(), 2000);
    let picture = std::fs::read_to_string(out.join("flight-seed3.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
    std::fs::remove_dir_all(out).unwrap();
}

#[test]
fn without_json_one_line_says_it_all() {
    let (output, out) = run("line", &["fly", "--seed", "3", "--duration", "2"]);
    let line = String::from_utf8(output.stdout).unwrap();
    assert_eq!(line.lines().count(), 1, "{line}");
    assert!(
        line.starts_with("result: seed 3, survived (strict) after 2.00 s, clearance "),
        "{line}"
    );
    std::fs::remove_dir_all(out).unwrap();
}

/// Seeds that end badly, found by flying; the outcome and the exit code must fit.
#[test]
fn exit_codes_tell_how_a_flight_ended() {
    let mut seen = std::collections::BTreeSet::new();
    for seed in 0..40 {
        if seen.len() == 3 {
            break;
        }
        let (output, out) = run(
            "codes",
            &[
                "--preset",
                "reference",
                "--paths",
                "1",
                "--seed",
                &seed.to_string(),
                "--json",
            ],
        );
        let result: Value = serde_json::from_slice(&output.stdout).unwrap();
        let expected = match result["outcome"].as_str().unwrap() {
            "survived" => 0,
            "collision" => 3,
            _ => 4,
        };
        assert_eq!(output.status.code(), Some(expected), "{result}");
        seen.insert(expected);
        std::fs::remove_dir_all(out).unwrap();
    }
    assert_eq!(seen.into_iter().collect::<Vec<_>>(), [0, 3, 4]);
}

#[test]
fn absurd_flags_are_usage_errors_that_say_what_to_do() {
    let absurd: [(&[&str], &str); 11] = [
        (&["--paths", "51"], "paths: give at most 50"),
        (&["--obstacles", "-1"], "a whole number of 0 or more"),
        (&["--obstacles", "100000"], "obstacles: give at most 1000"),
        (&["--replan-hz", "3"], "whole multiple"),
        (&["--replan-hz", "0"], "whole multiple"),
        (&["--replan-hz", "nan"], "whole multiple"),
        (&["--latency-ms", "15"], "multiple of 10"),
        (
            &["--latency-ms", "2000"],
            "no longer than the time between two plans",
        ),
        (&["--speed", "1e-300"], "0.01 to 1000"),
        (&["--link", "carrier-pigeon"], "tcp:HOST:PORT"),
        (&["--mavlink", "127.0.0.1:14550"], "udp:HOST:PORT"),
    ];
    for (flags, hint) in absurd {
        let (output, _) = run("absurd", flags);
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{flags:?}: {talk}");
        assert!(talk.contains(hint), "{flags:?}: {talk}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_scenario_file_is_flown_and_flags_go_before_it() {
    let file = place("scenario.toml");
    let text = "seed = 5\nduration = 2\nscene = \"dynamics\"\n[faults.gusts]\nintensity = 1.0\n";
    std::fs::write(&file, text).unwrap();
    let path = file.to_str().unwrap();
    let (output, out) = run(
        "scenario",
        &["--scenario", path, "--json", "--obstacles", "3"],
    );
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&result["seed"], &result["obstacles"]),
        (&5.into(), &3.into())
    );
    let log = std::fs::read(result["log"].as_str().unwrap()).unwrap();
    let log: Value = serde_json::from_slice(&log).unwrap();
    assert_eq!(log["header"]["scene"], "dynamics");
    assert!(log["ticks"]["wind_z"][100].as_f64().unwrap() != 0.0);
    std::fs::remove_dir_all(out).unwrap();
    std::fs::write(&file, "obstacels = 3").unwrap();
    let (output, _) = run("typo", &["--scenario", path]);
    let talk = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{talk}");
    assert!(talk.contains("unknown field `obstacels`"), "{talk}");
    std::fs::remove_file(file).unwrap();
}

/// Any row of a campaign is flown again, to the same bytes, by `fly` with its flags and seed.
#[test]
fn a_campaigns_row_is_flown_again_in_full() {
    let file = place("all.toml");
    let text = include_str!("../../../docs/scenarios/all-together.toml");
    std::fs::write(&file, text.replace("replan_hz = 4.0", "duration = 3")).unwrap();
    let rows = place("rows.jsonl");
    let flags = ["--scenario", file.to_str().unwrap()];
    let output = harness()
        .arg("campaign")
        .args(flags)
        .args([
            "--obstacles",
            "20,40",
            "--paths",
            "5",
            "--preset",
            "paper,flight",
        ])
        .args([
            "--replan-hz",
            "2",
            "--trials",
            "2",
            "--seed",
            "70",
            "--threads",
            "2",
            "--oracle",
            "--json",
        ])
        .arg("--out")
        .arg(&rows)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["cells"].as_array().unwrap().len(), 4 + 2);
    let text = std::fs::read_to_string(&rows).unwrap();
    assert_eq!(text.lines().count(), 1 + 8 + 4);
    for line in text.lines().skip(1) {
        let row: Value = serde_json::from_str(line).unwrap();
        let number = |key: &str| row[key].to_string();
        let (seed, obstacles) = (number("seed"), number("obstacles"));
        let (paths, replan_hz) = (number("paths"), number("replan_hz"));
        let own = [
            ["--seed", &seed],
            ["--obstacles", &obstacles],
            ["--paths", &paths],
            ["--replan-hz", &replan_hz],
            ["--preset", row["preset"].as_str().unwrap()],
        ];
        let oracle: &[&str] = match row["oracle"].as_bool() {
            Some(true) => &["--oracle"],
            _ => &[],
        };
        let (again, out) = run(
            "again",
            &[&["fly", "--json"], &flags[..], &own.concat(), oracle].concat(),
        );
        let again: Value = serde_json::from_slice(&again.stdout).unwrap();
        for key in [
            "log_hash",
            "class",
            "strict",
            "min_clearance",
            "candidates",
            "t_end",
        ] {
            assert_eq!(again[key], row[key], "{key} of {line}");
        }
        std::fs::remove_dir_all(out).unwrap();
    }
    // The report of the file is that of the run.
    let again = harness()
        .args(["campaign", "--json", "--report"])
        .arg(&rows)
        .output()
        .unwrap();
    assert_eq!(again.stdout, output.stdout);
    std::fs::remove_file(file).unwrap();
    std::fs::remove_file(rows).unwrap();
}

#[test]
fn a_cycle_is_benched_by_stage_in_both_presets() {
    let arguments = "bench cycle --flights 1 --runs 1 --duration 3 --json";
    let output = harness().args(arguments.split(' ')).output().unwrap();
    assert!(output.status.success());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&report["obstacles"], &report["cycles"]),
        (&40.into(), &3.into())
    );
    for (preset, name) in report["presets"]
        .as_array()
        .unwrap()
        .iter()
        .zip(["reference", "flight"])
    {
        assert_eq!(preset["preset"], name);
        for stage in ["map", "candidates", "corridor", "QP", "rest", "cycle"] {
            assert!(preset[stage]["p99_us"].as_f64().unwrap() > 0.0, "{stage}");
        }
    }
    assert!(report["ratio"]["median"].as_f64().unwrap() > 0.0);
}

#[test]
fn figures_are_drawn_into_a_directory() {
    let (output, out) = run("figures", &["figures"]);
    assert!(output.status.success(), "{output:?}");
    let names = [
        "challenge",
        "flight",
        "scan",
        "rays",
        "trajectory",
        "candidates",
    ];
    for name in names {
        let svg = std::fs::read_to_string(out.join(name).with_extension("svg")).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{name}"
        );
    }
    // Success rates are only drawn from rows.
    assert!(!out.join("success.svg").exists());
    std::fs::remove_dir_all(out).unwrap();
}

#[test]
fn two_flights_come_onto_one_page_and_a_log_that_is_none_is_refused() {
    let (_, out) = run("against", &["fly", "--duration", "2", "--obstacles", "0"]);
    let log = out.join("flight-seed1-o0-2s.json");
    let page = |against: &std::path::Path| {
        let mut replay = harness();
        replay.arg("replay").arg(&log).arg("--against").arg(against);
        replay.arg("--out").arg(out.join("two.html"));
        replay.output().unwrap()
    };
    let output = page(&log);
    assert!(output.status.success(), "{output:?}");
    assert!(std::fs::metadata(out.join("two.html")).unwrap().len() > 20_000);
    assert_eq!(page(&out.join("none.json")).status.code(), Some(2));
    std::fs::remove_dir_all(out).unwrap();
}

#[cfg(not(feature = "formats"))]
#[test]
fn a_build_without_pdf_says_so_before_it_flies() {
    let (output, out) = run("pdf", &["figures", "--pdf"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--features formats"));
    assert!(!out.join("flight.svg").exists());
    let _ = std::fs::remove_dir_all(out);
}

#[test]
fn the_reference_check_refuses_what_is_no_reference() {
    let missing = harness()
        .args(["check-reference", "no-such-directory"])
        .output()
        .unwrap();
    assert_eq!(missing.status.code(), Some(2));
    let empty = scratch("empty");
    let output = harness()
        .arg("check-reference")
        .arg(&empty)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    std::fs::write(empty.join("ray_000.json"), "{\"occupied\": 3}").unwrap();
    let broken = harness()
        .arg("check-reference")
        .arg(&empty)
        .output()
        .unwrap();
    assert_eq!(broken.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&broken.stdout).contains("does not parse"));
    std::fs::remove_dir_all(empty).unwrap();
}

#[test]
fn the_readme_shows_what_the_main_job_prints() {
    let (output, out) = run("readme", &[]);
    std::fs::remove_dir_all(out).unwrap();
    let readme = include_str!("../../../README.md");
    let line = String::from_utf8(output.stdout).unwrap();
    assert!(
        readme.contains(line.trim_end()),
        "README.md shows another flight than {line}"
    );
}

/// A campaign of faults prints one object, and says what it does not do.
#[test]
fn a_campaign_of_faults_reports_pairs_and_refuses_what_it_cannot_do() {
    let campaign = |flags: &[&str]| {
        let begin = ["campaign", "--trials", "1", "--duration", "1", "--faults"];
        harness().args(begin).args(flags).output().unwrap()
    };
    let output = campaign(&["rtk,clock-wrap", "--obstacles", "5", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = report["faults"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    assert_eq!(
        (&rows[0]["name"], &rows[0]["pairs"]),
        (&"rtk".into(), &1.into())
    );
    assert_eq!(
        (&rows[1]["obstacles"], &rows[1]["lost_points"]),
        (&5.into(), &0.0.into())
    );
    assert_eq!(rows[0]["oracle"], Value::Null);
    let output = campaign(&["rtk", "--obstacles", "5", "--oracle", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["faults"][0]["oracle"], 1);
    for (flags, hint) in [
        (
            ["rtx", "--json"].as_slice(),
            "there is no fault `rtx`: give all, rtk",
        ),
        (&["rtk", "--out", "rows.jsonl"], "cannot be used with"),
        (
            &["rtk", "--paths", "3,5"],
            "at most one --preset and one --paths",
        ),
    ] {
        let output = campaign(flags);
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(talk.contains(hint), "{talk}");
    }
}
