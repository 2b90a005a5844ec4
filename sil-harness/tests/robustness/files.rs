//! Full disks, and files that hold something else.

use crate::common::{harness, run_in, scratch, talk};
use std::fs::File;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the harness where no file may grow beyond so many blocks of 512 bytes, which needs no root:
/// the write that would is done in part, and the next one fails.
#[cfg(target_os = "linux")]
fn run_on_full_disk(directory: &Path, blocks: u32, arguments: &str) -> Output {
    let harness = env!("CARGO_BIN_EXE_sil-harness");
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec {harness} {arguments}");
    let mut command = Command::new("sh");
    command.current_dir(directory).args(["-c", &script]);
    command.output().unwrap()
}

#[test]
fn a_campaign_does_not_erase_a_file_of_another_kind() {
    let directory = scratch("foreign");
    let log = directory.join("flight.json");
    let text = "{\"schema\":2,\"header\":{}}".repeat(100);
    std::fs::write(&log, &text).unwrap();
    let arguments = "campaign --trials 1 --duration 1 --out flight.json";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let output = run_in(&directory, &arguments);
    assert_eq!(output.status.code(), Some(2), "{}", talk(&output));
    let told = "flight.json is no row file of this campaign";
    assert!(talk(&output).contains(told), "{}", talk(&output));
    assert!(output.stdout.is_empty());
    assert_eq!(std::fs::read_to_string(&log).unwrap(), text);
    std::fs::remove_dir_all(directory).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_campaign_on_a_full_disk_keeps_whole_rows_and_goes_on_when_there_is_room() {
    let directory = scratch("full-rows");
    let flags = "campaign --trials 12 --duration 1 --threads 2";
    let arguments = format!("{flags} --out rows.jsonl");
    let output = run_on_full_disk(&directory, 4, &arguments);
    assert_eq!(output.status.code(), Some(1), "{}", talk(&output));
    assert!(talk(&output).contains("make room"), "{}", talk(&output));
    let rows = std::fs::read_to_string(directory.join("rows.jsonl")).unwrap();
    assert!(rows.ends_with('\n') && rows.len() <= 2048, "{rows}");
    let known = rows.lines().count() - 1;
    assert!((1..12).contains(&known), "{known}");
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let output = run_in(&directory, &arguments);
    assert!(output.status.success(), "{}", talk(&output));
    let told = format!("{known} of 12 flights are there");
    assert!(talk(&output).contains(&told), "{}", talk(&output));
    // The same rows as of one run, but for their order.
    let fresh = format!("{flags} --out fresh.jsonl");
    run_in(&directory, &fresh.split(' ').collect::<Vec<_>>());
    let sorted = |name: &str| {
        let text = std::fs::read_to_string(directory.join(name)).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted("rows.jsonl"), sorted("fresh.jsonl"));
    std::fs::remove_dir_all(directory).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_log_that_does_not_fit_leaves_the_one_before() {
    let directory = scratch("full-log");
    let flags = "fly --duration 1 --out .";
    let first = run_in(&directory, &flags.split(' ').collect::<Vec<_>>());
    assert!(first.status.success(), "{}", talk(&first));
    let files = || {
        let mut files: Vec<_> = std::fs::read_dir(&directory)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| (path.clone(), std::fs::read(path).unwrap()))
            .collect();
        files.sort();
        files
    };
    let before = files();
    assert_eq!(before.len(), 2);
    let again = run_on_full_disk(&directory, 8, flags);
    assert_eq!(again.status.code(), Some(1), "{}", talk(&again));
    assert!(talk(&again).contains("cannot write"), "{}", talk(&again));
    assert_eq!(files(), before);
    // The flight was flown, so its result is told.
    assert_eq!(again.stdout, first.stdout);
    std::fs::remove_dir_all(directory).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_recording_on_a_full_disk_does_not_cost_the_log() {
    let directory = scratch("full-tlog");
    let flags = "fly --duration 1 --tlog /dev/full --json --out .";
    let output = run_in(&directory, &flags.split(' ').collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(1), "{}", talk(&output));
    assert!(talk(&output).contains("--tlog"), "{}", talk(&output));
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let log = directory.join(result["log"].as_str().unwrap());
    assert!(sil_harness::files::read_log(&log).is_ok());
    std::fs::remove_dir_all(directory).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_nobody_gets_is_a_failure() {
    let directory = scratch("full-stdout");
    for arguments in [
        "fly --duration 1",
        "fly --duration 1 --json",
        "campaign --trials 1 --duration 1",
        "campaign --trials 1 --duration 1 --json",
        "params",
    ] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let mut command = harness();
        command.current_dir(&directory).args(arguments.split(' '));
        let output = command.stdout(full).output().unwrap();
        assert_eq!(
            output.status.code(),
            Some(1),
            "{arguments}: {}",
            talk(&output)
        );
        assert!(
            talk(&output).contains("standard output"),
            "{}",
            talk(&output)
        );
    }
    std::fs::remove_dir_all(directory).unwrap();
}
