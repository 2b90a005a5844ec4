//! Files and flags as people bring them: with marks of editors, with endings, with numbers that they read somewhere.

use crate::common::{harness, run, scratch};
use serde_json::Value;
use std::process::Output;

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn answer(command: &str) -> Output {
    harness().args(command.split(' ')).output().unwrap()
}

/// The result of a short flight with these flags.
fn result(name: &str, flags: &[&str]) -> (Value, String) {
    let flight = ["fly", "--duration", "2", "--json"];
    let (output, out) = run(name, &[&flight[..], flags].concat());
    std::fs::remove_dir_all(out).unwrap();
    let result = serde_json::from_slice(&output.stdout).unwrap();
    (result, text(&output.stderr))
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_file() {
    let folder = scratch("marks");
    let flown = |flag: &str, name: &str, content: &str| {
        let file = folder.join(name);
        std::fs::write(&file, content).unwrap();
        result("marked", &[flag, file.to_str().unwrap()]).0["log_hash"].clone()
    };
    let plain = flown("--params", "plain", "MPP_PATHS,5\n");
    assert_eq!(
        flown("--params", "marked", "\u{feff}MPP_PATHS,5\r\n"),
        plain
    );
    let plain = flown("--scenario", "plain.toml", "paths = 5\n");
    let marked = flown("--scenario", "marked.toml", "\u{feff}paths = 5\r\n");
    assert_eq!(marked, plain);
    std::fs::remove_dir_all(folder).unwrap();
}

/// What no cycle finds changes nothing, the name of the files and the hash included.
#[test]
fn more_paths_than_there_are_give_the_usual_flight() {
    let (usual, said) = result("paths", &[]);
    assert!(said.contains("preset flight, 7 paths, core"), "{said}");
    for paths in ["8", "26", "50"] {
        let (more, said) = result("paths", &["--paths", paths]);
        assert_eq!(more, usual, "{paths}");
        assert!(said.contains("7 paths"), "{said}");
    }
    let (fewer, said) = result("paths", &["--paths", "5"]);
    assert_ne!(fewer["log_hash"], usual["log_hash"]);
    assert!(said.contains("5 paths"), "{said}");
    let (paper, said) = result("paths", &["--preset", "paper", "--paths", "26"]);
    assert!(paper["paths"] == 26 && said.contains("26 paths"), "{said}");
}

#[test]
fn a_flight_is_not_begun_if_something_about_it_cannot_be() {
    let folder = scratch("before");
    let file = folder.join("file");
    std::fs::write(&file, "MPP_PATHS,many\n").unwrap();
    let (file, below) = (file.display(), file.join("out"));
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap();
    for (flags, code, hint) in [
        ("--live 8288".to_owned(), 2, "give HOST:PORT, such as"),
        ("--live ::1:8288".to_owned(), 2, "give HOST:PORT, such as"),
        ("--mavlink 14550".to_owned(), 2, "give udp:HOST:PORT"),
        ("--mavlink udp:14550".to_owned(), 2, "give udp:HOST:PORT"),
        ("--link tcp:5790".to_owned(), 2, "give tcp:HOST:PORT or"),
        (format!("--live {taken}"), 6, "--live"),
        (
            "--mavlink udp:no.such.host.invalid:1".to_owned(),
            6,
            "--mavlink",
        ),
        (format!("--params {file}"), 2, "is not NAME,VALUE"),
        (
            format!("--out {}", below.display()),
            1,
            "give a path that can be written",
        ),
    ] {
        let out = folder.join("out");
        let output = answer(&format!("fly --duration 1 --out {} {flags}", out.display()));
        let output = match flags.starts_with("--out") {
            true => answer(&format!("fly --duration 1 {flags}")),
            false => output,
        };
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{flags}: {said}");
        assert!(said.contains(hint), "{flags}: {said}");
        assert!(
            !said.contains("flying") && output.stdout.is_empty(),
            "{said}"
        );
    }
    for place in ["0.0.0.0", "5790", "127.0.0.1:", ":5790", "localhost:99999"] {
        let output = answer(&format!("core --once --listen {place}"));
        assert_eq!(output.status.code(), Some(2), "{place}");
        assert!(text(&output.stderr).contains("give HOST:PORT"), "{place}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_table_names_the_scene_that_was_flown_through() {
    let campaign = "campaign --trials 1 --duration 1 --scene flytrap";
    let table = text(&answer(campaign).stdout);
    assert!(
        table.contains("flight    flytrap ") && !table.contains("paper"),
        "{table}"
    );
    let table = text(&answer(&format!("{campaign} --obstacles 3")).stdout);
    assert!(table.contains("flight    flytrap, paper "), "{table}");
}

/// Most named faults begin after the two seconds by which a row file knows its program.
#[test]
fn rows_of_a_fault_that_begins_late_are_written() {
    let folder = scratch("late");
    let rows = folder.join("rows.jsonl");
    let faults = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/scenarios/faults");
    let flags = format!(
        "campaign --scenario {faults}/lidar-silent.toml --trials 2 --duration 6 --out {}",
        rows.display()
    );
    for _ in 0..2 {
        let output = answer(&flags);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert_eq!(std::fs::read_to_string(&rows).unwrap().lines().count(), 3);
    }
    std::fs::remove_dir_all(folder).unwrap();
}
