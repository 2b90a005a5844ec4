//! What is refused before anything is flown, and with which sentence.

use crate::common::{harness, place, run, scratch};
use serde_json::Value;
use std::path::Path;

/// What a command that must be refused says.
fn refused(command: &str) -> String {
    let output = harness().args(command.split(' ')).output().unwrap();
    let talk = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{command}: {talk}");
    assert!(output.stdout.is_empty(), "{command}");
    talk
}

#[test]
fn more_threads_than_a_machine_can_have_are_refused() {
    for command in [
        "campaign --trials 1 --threads 1000000",
        "ceiling --fields 1 --threads 1025",
        "aircraft zagi --flights 1 --threads 1025",
    ] {
        let talk = refused(command);
        assert!(
            talk.contains("give a whole number from 0 to 1024"),
            "{talk}"
        );
    }
    // One flight takes one thread, however many are allowed.
    let command = "campaign --trials 1 --duration 1 --threads 1024";
    let output = harness().args(command.split(' ')).output().unwrap();
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn a_report_takes_no_flag_that_says_what_is_flown() {
    for flag in [
        "--obstacles 20",
        "--scene flytrap",
        "--aircraft zagi",
        "--duration 3",
        "--field a.toml",
        "--world-scale 2",
        "--paths 5",
        "--latency-ms 20",
        "--oracle",
        "--trials 3",
        "--seed 3",
        "--shard 1/2",
        "--timing",
    ] {
        let talk = refused(&format!("campaign {flag} --report rows.jsonl"));
        assert!(talk.contains("cannot be used with"), "{talk}");
    }
    let talk = refused("campaign --threads 2 --report rows.jsonl");
    assert!(
        talk.contains("leave --threads out, or give --ceiling"),
        "{talk}"
    );
}

#[test]
fn an_unknown_aircraft_is_refused_with_the_known_ones() {
    for command in ["aircraft nosuch", "fly --aircraft nosuch"] {
        let talk = refused(command);
        let hint = "give reference, paper, example, aerosonde, zagi, cessna182, aerosonde2, x8, ultrastick, rascal, delta or a file";
        assert!(talk.contains("no aircraft `nosuch`"), "{talk}");
        assert!(talk.contains(hint), "{talk}");
    }
}

#[test]
fn a_row_file_is_no_log() {
    let rows = place("rows-for-logs.jsonl");
    std::fs::write(&rows, "{\"rows\":3}\n").unwrap();
    for command in ["replay", "fly --orders"] {
        let talk = refused(&format!("{command} {}", rows.display()));
        assert!(
            talk.contains("is a row file: give a flight's log"),
            "{talk}"
        );
    }
    std::fs::remove_file(rows).unwrap();
}

#[test]
fn a_flag_that_nothing_could_follow_is_refused() {
    for (command, hint) in [
        ("fly --instance 3", "without --mavlink, --live or --tlog"),
        (
            "fly --home 47,8,488,0",
            "without --mavlink, --live or --tlog",
        ),
        ("fly --patience 3", "--link"),
        ("fly --patience 3 --link fifo:none", "leave it out"),
        ("fly --obstacles -3", "give a whole number of 0 or more"),
        ("fly --paths -1", "give a whole number of 0 or more"),
        ("fly --paths 99999", "give a smaller number"),
        ("fly --obstacles some", "give a whole number of 0 or more"),
        (
            "campaign --obstacles -3",
            "give a whole number of 0 or more",
        ),
        ("fly --replan-hz x", "give a number, such as 1.5"),
        ("fly --instance 400", "give a whole number from 0 to 253"),
        ("bench cycle --flights 0", "give a whole number from 1 to"),
        (
            "aircraft zagi --flights 1.5",
            "give a whole number of 0 or more",
        ),
        ("ceiling --margin 0,a", "give a number, such as 1.5"),
        (
            "campaign --preset space --gusts x",
            "give a number, such as 1.5",
        ),
        (
            "campaign --preset space --candidates 300",
            "give a whole number from 0 to 255",
        ),
        ("campaign --paths 0 --trials 1", "always refines its paths"),
        (
            "campaign --preset flight,space",
            "give `--preset space` alone",
        ),
        ("fly --replan-hz -4", "replan_hz: give a rate"),
        ("fly --duration -1", "duration: give 0.01"),
        ("campaign --report none.jsonl", "cannot read none.jsonl"),
        (
            "fly --generator endless --obstacles 200 --duration 900",
            "about 12591, and may have 5000",
        ),
    ] {
        let talk = refused(command);
        assert!(talk.contains(hint), "{talk}");
    }
}

#[test]
fn a_home_that_is_no_place_is_refused_with_what_to_give() {
    for home in ["Zurich", "47,8", "-91,8,488,0", "47,8,488,400"] {
        let talk = refused(&format!("fly --mavlink --home {home}"));
        assert!(talk.contains("give LAT,LON,ALT,HEADING"), "{talk}");
    }
}

#[test]
fn files_that_would_fly_something_else_are_refused_by_name() {
    let directory = scratch("refused");
    let write = |name: &str, text: &str| {
        let path = directory.join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let field = write("empty.toml", "# nothing\n");
    let example = include_str!("../../../aircraft/example.toml");
    let named = example.replacen("\"example\"", "\"a/b\"", 1);
    let aircraft = write("named.toml", &named);
    let lidar = write("lidar.toml", "range_max = 0.5\n");
    let late = "[faults.scan]\nfrom = 30.0\nuntil = 50.0\nmissing = true\n";
    let late = write("late.toml", late);
    for (command, hint) in [
        (format!("fly --field {field}"), "holds no obstacle"),
        (format!("campaign --field {field}"), "empty.toml holds no"),
        (
            format!("fly --aircraft {aircraft}"),
            "named.toml: aircraft.name: give",
        ),
        (
            format!("aircraft {aircraft}"),
            "aircraft.name: give 1 to 64",
        ),
        (
            format!("fly --lidar {lidar}"),
            "lidar.toml: lidar.range_max: give 1 to",
        ),
        (
            format!("fly --scenario {late}"),
            "faults.scan: it begins after",
        ),
        (
            "fly --world-scale nan".to_owned(),
            "world_scale: give 0.001",
        ),
        (
            "fly --world-scale 1e10".to_owned(),
            "world_scale: give 0.001",
        ),
    ] {
        let talk = refused(&command);
        assert!(talk.contains(hint), "{command}: {talk}");
    }
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn items_of_a_list_may_have_spaces_around_them() {
    let flags = [
        ["campaign", "--trials", "1"],
        ["--duration", "1", "--json"],
        ["--obstacles", "20, 40", "--generator"],
    ];
    let mut harness = harness();
    let output = harness.args(flags.concat()).arg("paper, walls").output();
    let output = output.unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["cells"].as_array().unwrap().len(), 4);
}

/// The log of a flight with other parameters does not take the place of the plain flight's.
#[test]
fn a_flight_with_parameters_has_files_of_its_own() {
    let parameters = place("own.params");
    std::fs::write(&parameters, "MPP_PATHS,5\n").unwrap();
    let log = |flags: &[&str]| {
        let (output, _) = run(
            "own",
            &[&["fly", "--duration", "1", "--json"], flags].concat(),
        );
        let result: Value = serde_json::from_slice(&output.stdout).unwrap();
        result["log"].as_str().unwrap().to_owned()
    };
    let plain = log(&[]);
    let before = std::fs::read(&plain).unwrap();
    let tuned = log(&["--params", parameters.to_str().unwrap()]);
    assert_ne!(plain, tuned);
    assert_eq!(std::fs::read(&plain).unwrap(), before);
    // The same orders again are the same flight, with the same name.
    assert_eq!(log(&["--orders", &tuned]), tuned);
    std::fs::remove_dir_all(Path::new(&plain).parent().unwrap()).unwrap();
    std::fs::remove_file(parameters).unwrap();
}

#[test]
fn a_bench_takes_the_obstacles_of_its_scenario() {
    let scenario = place("bench.toml");
    let obstacles = |text: &str, flags: &str| {
        std::fs::write(&scenario, text).unwrap();
        let command = format!("bench cycle --flights 1 --runs 1 --duration 1 --json{flags}");
        let mut harness = harness();
        let output = harness
            .args(command.split(' '))
            .arg("--scenario")
            .arg(&scenario);
        let output = output.output().unwrap();
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        report["obstacles"].clone()
    };
    assert_eq!(obstacles("obstacles = 7", ""), 7);
    assert_eq!(obstacles("obstacles = 7", " --obstacles 9"), 9);
    assert_eq!(obstacles("scene = \"flytrap\"", ""), 0);
    std::fs::remove_file(scenario).unwrap();
}

#[test]
fn a_file_of_another_form_is_named_by_its_form() {
    for (name, text, form) in [
        ("a.xml", "<aircraft><mass/></aircraft>\n", "XML"),
        ("a.json", "{\"mass\": 1}\n", "JSON"),
        ("a.csv", "x,z,radius\n1,2,3\n", "CSV"),
        ("a.wkt", "POLYGON ((0 0, 1 0, 1 1, 0 0))\n", "WKT"),
    ] {
        let path = std::env::temp_dir().join(format!("{}-{name}", std::process::id()));
        std::fs::write(&path, text).unwrap();
        for command in ["fly --field", "fly --scenario", "fly --lidar", "aircraft"] {
            let talk = refused(&format!("{command} {}", path.display()));
            let said = format!("it is {form}, and this file has to be TOML");
            assert!(talk.contains(&said), "{command} {name}: {talk}");
        }
        std::fs::remove_file(path).unwrap();
    }
}
