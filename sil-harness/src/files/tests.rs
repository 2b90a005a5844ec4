//! Tests files that are read and written.

use super::*;
use mpp_sim::flight::fly;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};

#[test]
fn the_named_conditions_are_sound() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/scenarios");
    let mut names: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            read_scenario(&path).unwrap().build().unwrap();
            names.push(path.file_stem().unwrap().to_string_lossy().into_owned());
        }
    }
    names.sort();
    assert_eq!(
        names,
        [
            "actuators",
            "actuators-elevator",
            "actuators-thrust",
            "all-together",
            "example",
            "gusts",
            "known-map",
            "lidar-faults",
            "model-error",
        ]
    );
}

#[test]
fn a_logs_file_holds_the_hashed_bytes() {
    let path = std::env::temp_dir().join(format!("mpp-log-test-{}.json", std::process::id()));
    let scenario = Scenario {
        ticks: 10,
        ..Scenario::new(Preset::Flight, 1)
    };
    let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
    write_log(&path, &log).unwrap();
    let (bytes, read) = (std::fs::read(&path).unwrap(), read_log(&path).unwrap());
    std::fs::remove_file(&path).unwrap();
    assert_eq!(bytes, log.to_json().unwrap());
    assert_eq!(read, log);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let path = Path::new("no-such-scenario.toml");
    let error = read_scenario(path).unwrap_err().to_string();
    assert!(
        error.starts_with("cannot read no-such-scenario.toml: "),
        "{error}"
    );
}

#[test]
fn a_folder_is_tried_before_it_is_needed() {
    let folder = std::env::temp_dir().join(format!("mpp-tried-{}", std::process::id()));
    try_directory(&folder.join("deep")).unwrap();
    assert_eq!(std::fs::read_dir(folder.join("deep")).unwrap().count(), 0);
    std::fs::write(folder.join("file"), "").unwrap();
    let error = try_directory(&folder.join("file")).unwrap_err().to_string();
    assert!(error.starts_with("cannot write "), "{error}");
    std::fs::remove_dir_all(folder).unwrap();
}

/// What was there stays until the new bytes are, and nothing else is left behind.
#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let directory = std::env::temp_dir().join(format!("mpp-whole-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let path = directory.join("log.json");
    std::fs::write(&path, "good").unwrap();
    // No file can be made beside it: a directory is in the way.
    std::fs::create_dir(beside(&path)).unwrap();
    let error = write_whole(&path, b"torn").unwrap_err();
    assert!(error.to_string().starts_with("cannot write"), "{error}");
    assert_eq!(std::fs::read(&path).unwrap(), b"good");
    std::fs::remove_dir(beside(&path)).unwrap();
    write_whole(&path, b"better").unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"better");
    assert_eq!(std::fs::read_dir(&directory).unwrap().count(), 1);
    std::fs::remove_dir_all(directory).unwrap();
}

/// Every file of a fault has a line in the table of the named faults, and the other way round.
#[test]
fn every_file_of_a_fault_is_in_the_table() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/scenarios/faults");
    let files = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<String> = files
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let table = mpp_analysis::campaign::NamedFault::ALL.iter();
    let mut expected: Vec<String> = table.map(|fault| format!("{}.toml", fault.name)).collect();
    expected.sort();
    assert_eq!(names, expected);
}
