//! Campaigns that are killed, or that cannot write their rows.

use crate::common::{harness, run_in, scratch, talk};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// How often the campaign is killed.
const KILLS: u64 = 20;

/// A random number below a bound that depends on its place alone (splitmix64).
fn random(place: u64, below: u64) -> u64 {
    let mut bits = place.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (bits ^ (bits >> 31)) % below
}

fn size(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |found| found.len())
}

/// The lines of a row file that are whole.
fn whole_lines(path: &Path) -> Vec<String> {
    let bytes = std::fs::read(path).unwrap_or_default();
    let end = bytes.iter().rposition(|byte| *byte == b'\n');
    let text = std::str::from_utf8(&bytes[..end.map_or(0, |end| end + 1)]).unwrap();
    text.lines().map(str::to_owned).collect()
}

fn sorted(path: &Path) -> Vec<String> {
    let mut lines = whole_lines(path);
    lines.sort();
    lines
}

/// Starts a campaign and kills it when its row file has grown by so many bytes.
fn kill_after(directory: &Path, arguments: &[&str], rows: &Path, growth: u64) {
    let until = size(rows) + growth;
    let mut command = harness();
    command.current_dir(directory).args(arguments);
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while size(rows) < until && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    // This is SIGKILL, which no process can heed.
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_campaign_that_is_killed_loses_no_row_and_doubles_none() {
    let directory = scratch("killed");
    let rows = directory.join("rows.jsonl");
    // So many flights that a busy machine, which kills late, does not fly them all.
    let flags = "campaign --trials 500 --duration 1 --threads 2 --out rows.jsonl";
    let arguments: Vec<&str> = flags.split(' ').collect();
    let mut before: Vec<String> = vec![];
    for place in 0..KILLS {
        // From the middle of the header to some rows later.
        kill_after(&directory, &arguments, &rows, 1 + random(place, 3000));
        let now = whole_lines(&rows);
        assert!(now.starts_with(&before), "a row was lost or changed");
        let different: BTreeSet<&String> = now.iter().collect();
        assert_eq!(different.len(), now.len(), "a row is there twice");
        before = now;
    }
    let flown = before.len() - 1;
    assert!((10..500).contains(&flown), "{flown}");
    let output = run_in(&directory, &arguments);
    assert!(output.status.success(), "{}", talk(&output));
    assert!(talk(&output).contains(&format!("{flown} of 500 flights are there")));
    assert!(whole_lines(&rows).starts_with(&before));
    // The same rows as of an undisturbed run, but for their order.
    let fresh = flags.replace("rows.jsonl", "fresh.jsonl");
    let fresh: Vec<&str> = fresh.split(' ').collect();
    assert!(run_in(&directory, &fresh).status.success());
    assert_eq!(sorted(&rows), sorted(&directory.join("fresh.jsonl")));
    assert_eq!(sorted(&rows).len(), 501);
    std::fs::remove_dir_all(directory).unwrap();
}

/// A folder in which nobody can make a file: root can do so in a read-only one, but not in `/proc`.
#[cfg(target_os = "linux")]
fn read_only(directory: &Path) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(directory, std::fs::Permissions::from_mode(0o555)).unwrap();
    match std::fs::write(directory.join("probe"), "") {
        Ok(()) => PathBuf::from("/proc"),
        Err(_) => directory.to_owned(),
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_file_is_named() {
    let directory = scratch("read-only");
    let place = read_only(&directory).join("rows.jsonl");
    let place = place.to_str().unwrap();
    let arguments = [
        "campaign",
        "--trials",
        "1",
        "--duration",
        "1",
        "--out",
        place,
    ];
    let output = run_in(Path::new("/"), &arguments);
    assert_eq!(output.status.code(), Some(1), "{}", talk(&output));
    let told = talk(&output);
    let expected = format!("cannot open {place}: ");
    assert!(
        told.contains(&expected) && told.contains("give a path"),
        "{told}"
    );
    let mode = Command::new("chmod").arg("755").arg(&directory).status();
    assert!(mode.unwrap().success());
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn two_campaigns_do_not_share_a_row_file() {
    let directory = scratch("shared");
    let rows = directory.join("rows.jsonl");
    let flags = "campaign --trials 1000000 --duration 1 --threads 1 --out rows.jsonl";
    let arguments: Vec<&str> = flags.split(' ').collect();
    let mut command = harness();
    command.current_dir(&directory).args(&arguments);
    let mut first = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while size(&rows) == 0 {
        assert!(first.try_wait().unwrap().is_none());
        std::thread::yield_now();
    }
    let second = run_in(&directory, &arguments);
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(second.status.code(), Some(2), "{}", talk(&second));
    let told = "rows.jsonl is being written by another process: wait for it, or give another file";
    assert!(talk(&second).contains(told), "{}", talk(&second));
    std::fs::remove_dir_all(directory).unwrap();
}
