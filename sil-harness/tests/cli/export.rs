//! `export` as a user meets it. What the files hold is tested in `mpp-export`.

use crate::common::{harness, run};
use std::path::Path;
use std::process::Output;

fn export(arguments: &[&str], file: &Path) -> Output {
    harness()
        .arg("export")
        .args(arguments)
        .arg(file)
        .output()
        .unwrap()
}

#[test]
fn csv_goes_to_the_standard_output_or_into_a_file() {
    let (_, out) = run("export", &["fly", "--duration", "1", "--seed", "5"]);
    let log = out.join("flight-seed5-1s.json");
    let printed = export(&[], &log);
    assert!(printed.status.success() && printed.stdout.starts_with(b"t,x,z,airspeed,"));
    assert_eq!(
        printed.stdout.iter().filter(|byte| **byte == b'\n').count(),
        101
    );
    let file = out.join("tables/ticks.csv");
    let written = export(&["--out", file.to_str().unwrap()], &log);
    assert!(written.status.success() && written.stdout.is_empty());
    assert_eq!(std::fs::read(&file).unwrap(), printed.stdout);
    let plans = export(&["--table", "plans"], &log);
    assert!(plans.stdout.starts_with(b"tick,used_from_tick,outcome,"));
    std::fs::remove_dir_all(out).unwrap();
}

/// People name the file that they want. Without the feature `formats` only CSV can be had, and this is said.
#[test]
fn the_ending_of_a_file_says_its_format() {
    let (_, out) = run("endings", &["fly", "--duration", "1"]);
    let log = out.join("flight-seed1-1s.json");
    let to = |name: &str, flags: &[&str]| {
        let file = out.join(name);
        let output = export(&[&["--out", file.to_str().unwrap()], flags].concat(), &log);
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), talk, std::fs::read(file).ok())
    };
    for (name, format, magic) in [
        ("x.mcap", "MCAP", &b"\x89MCAP"[..]),
        ("x.PARQUET", "Parquet", b"PAR1"),
    ] {
        let (code, talk, bytes) = to(name, &[]);
        // Other crates of the workspace may have asked for the formats.
        if let Some(bytes) = bytes {
            assert!(bytes.starts_with(magic), "{name}");
        } else {
            assert_eq!(code, Some(2), "{talk}");
            assert!(talk.contains(&format!("built without {format}")), "{talk}");
        }
        let (code, talk, bytes) = to(&format!("2{name}"), &["--format", "csv"]);
        assert_eq!((code, bytes), (Some(2), None), "{talk}");
        assert!(talk.contains("leave --format out"), "{talk}");
    }
    for name in ["x.csv", "x.txt", "x"] {
        let (code, _, bytes) = to(name, &[]);
        assert_eq!(code, Some(0));
        assert!(bytes.unwrap().starts_with(b"t,x,z,"), "{name}");
    }
    std::fs::remove_dir_all(out).unwrap();
}

/// A pipe gives its bytes once only.
#[cfg(unix)]
#[test]
fn a_log_and_rows_come_through_a_pipe() {
    let (_, out) = run("piped", &["fly", "--duration", "1"]);
    let log = out.join("flight-seed1-1s.json");
    let rows = out.join("rows.jsonl");
    let campaign = "campaign --trials 1 --duration 1 --out";
    let mut campaign_of = harness();
    let flown = campaign_of.args(campaign.split(' ')).arg(&rows).output();
    assert!(flown.unwrap().status.success());
    for file in [&log, &rows] {
        let mut cat = std::process::Command::new("cat");
        let mut cat = cat
            .arg(file)
            .stdout(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        let mut harness = harness();
        let piped = harness.args(["export", "/dev/stdin"]);
        let piped = piped.stdin(cat.stdout.take().unwrap()).output().unwrap();
        cat.wait().unwrap();
        assert!(piped.status.success(), "{piped:?}");
        assert_eq!(piped.stdout, export(&[], file).stdout);
    }
    std::fs::remove_dir_all(out).unwrap();
}

#[test]
fn what_cannot_be_exported_is_refused_with_what_to_do() {
    let (_, out) = run("no-export", &["fly", "--duration", "1"]);
    let log = out.join("flight-seed1-1s.json");
    let rows = out.join("rows.jsonl");
    let campaign = ["campaign", "--trials", "1", "--duration", "1", "--out"];
    assert!(
        harness()
            .args(campaign)
            .arg(&rows)
            .output()
            .unwrap()
            .status
            .success()
    );
    assert!(
        export(&[], &rows)
            .stdout
            .starts_with(b"preset,field,generator,")
    );
    let noise = out.join("noise.json");
    std::fs::write(&noise, "{\"schema\": 3}").unwrap();
    for (flags, file, hint) in [
        (
            &["--format", "mcap"][..],
            &rows,
            "take --format csv or parquet",
        ),
        (&["--table", "plans"], &rows, "leave --table out"),
        (
            &["--format", "mcap", "--table", "plans"],
            &log,
            "leave --table out",
        ),
        (&[], &noise, "flight log has schema 3"),
        (&[], &out.join("none.json"), "cannot read"),
    ] {
        let output = export(flags, file);
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(talk.contains(hint) && output.stdout.is_empty(), "{talk}");
    }
    std::fs::remove_dir_all(out).unwrap();
}
