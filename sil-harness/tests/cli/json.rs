//! Whether `docs/logs.md` names what `--json` prints.

use crate::common::{harness, scratch};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// A wall in which every flight ends.
const WALL: &str =
    "[[polygon]]\npoints = [[30.0, -900.0], [32.0, -900.0], [32.0, 900.0], [30.0, 900.0]]";

/// The paths of all values: `a.b` in an object, `a[].b` in a list of objects, `a` of what is empty.
fn paths(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) if !object.is_empty() => {
            let dot = if path.is_empty() { "" } else { "." };
            for (name, value) in object {
                paths(value, &format!("{path}{dot}{name}"), found);
            }
        }
        Value::Array(items) if items.first().is_some_and(Value::is_object) => {
            let path = format!("{path}[]");
            items.iter().for_each(|item| paths(item, &path, found));
        }
        _ => {
            found.insert(path.to_owned());
        }
    }
}

/// The paths of what these commands print.
#[expect(
    clippy::panic,
    clippy::unwrap_used,
    reason = "the helpers of tests fail as tests do"
)]
fn printed(directory: &Path, commands: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for command in commands {
        let flags = command.split(' ').chain(["--json"]);
        let mut harness = harness();
        let output = harness.args(flags).current_dir(directory).output().unwrap();
        let talk = String::from_utf8_lossy(&output.stderr);
        let json = serde_json::from_slice(&output.stdout);
        paths(
            &json.unwrap_or_else(|_| panic!("{command}: {talk}")),
            "",
            &mut found,
        );
    }
    found
}

/// The names in the table of a command; a row may have several.
fn documented(command: &str) -> Vec<&'static str> {
    let page = include_str!("../../../docs/logs.md");
    let (_, section) = page.split_once(&format!("### `{command}`\n")).unwrap();
    let section = section.split("\n##").next().unwrap();
    let rows = section.lines().filter_map(|line| line.strip_prefix("|`"));
    let cells = rows.map(|row| row.split('|').next().unwrap());
    cells
        .flat_map(|cell| cell.split('`').step_by(2))
        .filter(|name| !name.is_empty())
        .collect()
}

/// Whether a documented name stands for this path: it is the path, or an object or a list around it.
fn covers(name: &str, path: &str) -> bool {
    let inside = path.strip_prefix(name);
    inside.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

#[test]
fn every_name_that_json_prints_is_documented_and_no_other() {
    let directory = scratch("names");
    std::fs::write(directory.join("wall.toml"), WALL).unwrap();
    let odd = include_str!("../../../aircraft/example.toml");
    let odd = odd.replace("air_density = 1.225", "air_density = 1.5");
    std::fs::write(directory.join("odd.toml"), odd).unwrap();
    let ends = "--field wall.toml --generator walls --obstacles 1 --duration 3";
    let campaign = format!("campaign {ends} --trials 1 --oracle --ceiling --timing");
    let faults = format!("campaign --faults pitch-bias {ends} --trials 1");
    let pairs = format!("campaign --faults pitch-bias,thrust-lost-3s --pairs {ends} --trials 1");
    let pairs = pairs.replace("--duration 3", "--duration 13");
    let tables: [(&str, &[&str]); 6] = [
        ("fly --json", &[&format!("fly {ends}")]),
        ("campaign --json", &[&campaign]),
        ("campaign --faults --json", &[&faults]),
        ("campaign --faults --pairs --json", &[&pairs]),
        (
            "ceiling --json",
            &[
                &format!("ceiling {ends} --fields 1"),
                "ceiling --preset space --density 0.005 --trials 1",
            ],
        ),
        (
            "aircraft --json",
            &["aircraft odd.toml --flights 1 --obstacles 1"],
        ),
    ];
    for (table, commands) in tables {
        let (names, paths) = (documented(table), printed(&directory, commands));
        // An empty list shows none of its names.
        let told = |name: &str, path: &str| covers(name, path) || covers(path, name);
        let covered = |path: &&String| names.iter().any(|name| told(name, path));
        let missing: Vec<_> = paths.iter().filter(|path| !covered(path)).collect();
        assert!(missing.is_empty(), "{table} has no {missing:?}");
        let there = |name: &&&str| paths.iter().any(|path| covers(name, path));
        let gone: Vec<_> = names.iter().filter(|name| !there(name)).collect();
        assert!(
            gone.is_empty(),
            "{table} has {gone:?}, which nothing prints"
        );
    }
    std::fs::remove_dir_all(directory).unwrap();
}
