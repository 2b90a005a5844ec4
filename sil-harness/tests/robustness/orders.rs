//! Flights that are flown again from their logs, and logs that cannot be.

use crate::common::{run_in, scratch, talk};
use serde_json::Value;
use std::path::Path;
use std::process::Output;

fn run(directory: &Path, arguments: &str) -> Output {
    run_in(directory, &arguments.split(' ').collect::<Vec<_>>())
}

fn result(output: &Output) -> Value {
    assert!(output.status.success(), "{}", talk(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_logs_orders_are_flown_with_its_header() {
    let directory = scratch("orders");
    std::fs::write(directory.join("plane.params"), "MPP_ALT_M,52\n").unwrap();
    std::fs::write(
        directory.join("gusts.toml"),
        "[faults.gusts]\nintensity = 1.0\n",
    )
    .unwrap();
    let flown = "--seed 3 --obstacles 12 --paths 5 --replan-hz 2 --latency-ms 20 --duration 3";
    let flags =
        format!("fly {flown} --scenario gusts.toml --params plane.params --json --out first");
    let first = result(&run(&directory, &flags));
    let log = first["log"].as_str().unwrap();
    // With no flags, and with flags that say the same.
    for flags in [
        "",
        " --seed 3 --obstacles 12 --duration 3",
        &format!(" {flown} --scenario gusts.toml"),
    ] {
        let again = format!("fly --orders {log} --json --out again{flags}");
        let again = result(&run(&directory, &again));
        assert_eq!(again["log_hash"], first["log_hash"], "{flags}");
    }
    std::fs::write(directory.join("calm.toml"), "seed = 3\n").unwrap();
    for (flag, value) in [
        ("--seed", "4"),
        ("--obstacles", "20"),
        ("--paths", "25"),
        ("--preset", "paper"),
        ("--replan-hz", "1"),
        ("--latency-ms", "10"),
        ("--duration", "20"),
        ("--scene", "flytrap"),
        ("--aircraft", "paper"),
        ("--slices-per-tick", "9"),
        ("--scenario", "calm.toml"),
    ] {
        let arguments = format!("fly --orders {log} {flag} {value} --out none");
        let output = run(&directory, &arguments);
        assert_eq!(output.status.code(), Some(2), "{flag}: {}", talk(&output));
        let told = format!("another {flag}: leave {flag} out");
        assert!(talk(&output).contains(&told), "{flag}: {}", talk(&output));
    }
    assert!(!directory.join("none").exists());
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn a_log_that_cannot_be_flown_is_refused_by_the_field() {
    let directory = scratch("hostile");
    let first = result(&run(&directory, "fly --duration 1 --json --out ."));
    let text = std::fs::read(directory.join(first["log"].as_str().unwrap())).unwrap();
    let log: Value = serde_json::from_slice(&text).unwrap();
    for (key, value) in [
        ("obstacles", Value::from(1_u64 << 63)),
        ("obstacles", Value::from(1_000_000_000_000_u64)),
        ("paths", Value::from(1_u64 << 40)),
        ("duration", Value::from(4e7)),
        ("duration", Value::from(-1.0)),
        ("replan_hz", Value::from(0.0)),
        ("replan_hz", Value::from(1e-300)),
        ("latency", Value::from(1e300)),
        ("slices_per_tick", Value::from(0)),
        ("preset", Value::from("best")),
        ("world_scale", Value::from(0.0)),
        ("aircraft.mass", Value::from(-1.0)),
    ] {
        let mut hostile = log.clone();
        match key.split_once('.') {
            Some((table, inner)) => hostile["header"][table][inner] = value,
            None => hostile["header"][key] = value,
        }
        std::fs::write(directory.join("hostile.json"), hostile.to_string()).unwrap();
        for command in [
            "replay hostile.json --out none.html",
            "fly --orders hostile.json --out none",
        ] {
            let output = run(&directory, command);
            assert_eq!(output.status.code(), Some(2), "{key}: {}", talk(&output));
            let told = format!("header.{key}: ");
            assert!(talk(&output).contains(&told), "{key}: {}", talk(&output));
        }
    }
    assert!(!directory.join("none.html").exists() && !directory.join("none").exists());
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn flights_that_differ_do_not_overwrite_each_other() {
    let directory = scratch("differing");
    std::fs::write(
        directory.join("gusts.toml"),
        "[faults.gusts]\nintensity = 1.0\n",
    )
    .unwrap();
    // The first command of the README, and its answer.
    let output = run_in(&directory, &[]);
    let readme = include_str!("../../../README.md");
    let line = "log out/flight-seed1.json, picture out/flight-seed1.svg";
    assert!(talk(&output).contains(line), "{}", talk(&output));
    assert!(readme.contains(line));
    for flags in [
        "--latency-ms 20",
        "--scene flytrap",
        "--preset paper",
        "--scenario gusts.toml",
    ] {
        let output = run(&directory, &format!("fly --duration 1 {flags}"));
        assert!(output.status.success(), "{}", talk(&output));
    }
    let files = std::fs::read_dir(directory.join("out")).unwrap().count();
    assert_eq!(files, 2 * 5);
    std::fs::remove_dir_all(directory).unwrap();
}
