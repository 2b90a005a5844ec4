//! Flights and campaigns that are interrupted.

use crate::common::{harness, run_in, scratch};
use mpp_sim::outcome::Outcome;
use sil_harness::files::read_log;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Time after which a wait has failed. It is far longer than any wait takes on a busy machine.
const LONGEST: Duration = Duration::from_secs(120);

fn start(directory: &Path, arguments: &str) -> Child {
    let mut command = harness();
    command.current_dir(directory).args(arguments.split(' '));
    let (out, error) = (Stdio::piped(), Stdio::piped());
    command.stdout(out).stderr(error).spawn().unwrap()
}

/// Waits until something holds that the process will bring about, and ends the process if it does not.
#[expect(clippy::panic, reason = "a helper of tests fails as tests do")]
fn until(child: &mut Child, awaited: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        if begun.elapsed() > LONGEST {
            child.kill().unwrap();
            panic!("waited {LONGEST:?} in vain for {awaited}");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Sends a signal once the process heeds it.
fn signal(mut child: Child, name: &str, number: u32) -> Output {
    let status = format!("/proc/{}/status", child.id());
    until(&mut child, &format!("a handler of {name}"), || {
        let text = std::fs::read_to_string(&status).unwrap();
        let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = u64::from_str_radix(caught.unwrap().trim(), 16).unwrap();
        caught & (1 << (number - 1)) != 0
    });
    let sent = Command::new("kill")
        .args(["-s", name, &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    child.wait_with_output().unwrap()
}

#[test]
fn an_interrupted_flight_keeps_what_was_flown() {
    for (name, number, code) in [("INT", 2, 130), ("TERM", 15, 143)] {
        let directory = scratch(&format!("interrupt-{name}"));
        let flags = "fly --speed 10 --duration 3600 --tlog a.tlog --json --out .";
        let mut child = start(&directory, flags);
        // It has flown for a while when the recording has its first block.
        until(&mut child, "the recording's first block", || {
            std::fs::metadata(directory.join("a.tlog")).is_ok_and(|found| found.len() > 0)
        });
        let output = signal(child, name, number);
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let log = read_log(&directory.join(result["log"].as_str().unwrap())).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Interrupted);
        assert!(!log.summary.strict && log.summary.failure.is_none());
        assert!(log.ticks.t.len() > 10 && log.ticks.t.len() < 360_000);
        assert!(directory.join(result["figure"].as_str().unwrap()).exists());
        std::fs::remove_dir_all(directory).unwrap();
    }
}

#[test]
fn a_flight_that_waits_is_interrupted_too() {
    let directory = scratch("interrupt-hold");
    let flags = "fly --mavlink udp:127.0.0.1:9 --hold --json --out .";
    let output = signal(start(&directory, flags), "INT", 2);
    assert_eq!(output.status.code(), Some(130), "{output:?}");
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["outcome"], "interrupted");
    assert_eq!(result["figure"], serde_json::Value::Null);
    let log = read_log(&directory.join(result["log"].as_str().unwrap())).unwrap();
    assert!(log.ticks.t.is_empty());
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn an_interrupted_campaign_says_how_to_go_on() {
    let directory = scratch("interrupt-campaign");
    let flags = "campaign --trials 1000000 --duration 1 --threads 2";
    let mut child = start(&directory, &format!("{flags} --out rows.jsonl"));
    let rows = || std::fs::read_to_string(directory.join("rows.jsonl")).unwrap_or_default();
    until(&mut child, "the rows of four flights", || {
        rows().lines().count() > 3
    });
    let output = signal(child, "INT", 2);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(
        told.contains("rows.jsonl holds what was flown; give the same command"),
        "{told}"
    );
    assert!(output.stdout.is_empty());
    assert!(rows().ends_with('\n') && !rows().contains("interrupted"));
    let report = run_in(&directory, &["campaign", "--report", "rows.jsonl"]);
    assert!(report.status.success(), "{report:?}");
    let output = signal(start(&directory, flags), "TERM", 15);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(143), "{told}");
    assert!(told.contains("nothing is kept; give --out FILE"), "{told}");
    std::fs::remove_dir_all(directory).unwrap();
}
