//! Fields as a user meets them: read, written, refused, flown in campaigns.

use crate::common::{harness, scratch};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::read::GzDecoder;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;

fn run(arguments: &[&str], files: &[(&str, &Path)]) -> Output {
    let mut command = harness();
    command.args(arguments);
    for (flag, file) in files {
        command.arg(flag).arg(file);
    }
    command.output().unwrap()
}

/// The flights of a page: its longest text, through base64 and gzip.
fn unpacked(page: &str) -> String {
    let packed = page.split('"').max_by_key(|text| text.len()).unwrap();
    let bytes = BASE64_STANDARD.decode(packed).unwrap();
    std::io::read_to_string(GzDecoder::new(&bytes[..])).unwrap()
}

fn result(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn log(output: &Output) -> Value {
    let path = result(output)["log"].as_str().unwrap().to_owned();
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// A field that was drawn is flown again from its file, to the same ticks.
#[test]
fn a_saved_field_is_the_field_that_was_flown() {
    let folder = scratch("saved");
    let scenario = folder.join("moving.toml");
    std::fs::write(&scenario, "[generator]\nvelocity = [-2.0, 1.0]").unwrap();
    for generator in ["paper", "forest", "canyon", "walls", "wires"] {
        let (saved, out) = (folder.join("field.toml"), folder.join("out"));
        let flags = ["fly", "--json", "--duration", "4", "--replan-hz", "4"];
        let drawing = ["--obstacles", "30", "--generator", generator];
        let mut files: Vec<(&str, &Path)> = vec![("--save-field", &saved), ("--out", &out)];
        if ["paper", "wires"].contains(&generator) {
            files.push(("--scenario", &scenario));
        }
        let drawn = run(&[&flags[..], &drawing].concat(), &files);
        let drawn = log(&drawn);
        let read = log(&run(&flags, &[("--field", &saved), ("--out", &out)]));
        assert_eq!(drawn["ticks"], read["ticks"], "{generator}");
        assert_eq!(drawn["header"]["field"], read["header"]["field"]);
        assert_eq!(read["header"]["obstacles"], 0);
        assert!(!read["header"]["field"].as_object().unwrap().is_empty());
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// The documented fields are flown, drawn, replayed, and flown again from their logs.
#[test]
fn a_documented_field_is_flown_drawn_and_flown_again() {
    let folder = scratch("documented");
    for name in ["example", "gate"] {
        let field =
            PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../docs/fields/{name}.toml"));
        let out = folder.join(name);
        let flags = ["fly", "--json", "--duration", "8", "--replan-hz", "4"];
        let flown = run(&flags, &[("--field", &field), ("--out", &out)]);
        let flown = result(&flown);
        let picture = std::fs::read_to_string(flown["figure"].as_str().unwrap()).unwrap();
        assert!(picture.matches("<polygon").count() >= 2, "{name}");
        let log = PathBuf::from(flown["log"].as_str().unwrap());
        let page = folder.join("page.html");
        let replayed = run(&["replay", &log.display().to_string()], &[("--out", &page)]);
        assert!(replayed.status.success(), "{replayed:?}");
        let page = std::fs::read_to_string(page).unwrap();
        // The page could fly it again, so it has the details of the planning.
        let flights = unpacked(&page);
        assert!(flights.contains("\"polygon\":[") && flights.contains("\"corridor\":["));
        let again = run(
            &["fly", "--json"],
            &[("--orders", &log), ("--out", &folder)],
        );
        assert_eq!(result(&again)["log_hash"], flown["log_hash"], "{name}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_bad_field_is_refused_by_file_and_key_and_nothing_is_written() {
    let folder = scratch("bad");
    let (field, out, saved) = (
        folder.join("bad.toml"),
        folder.join("out"),
        folder.join("saved"),
    );
    for (text, hint) in [
        (
            "[[circle]]\nx = nan\nz = 50.0\nradius = 1.0",
            "circle 1, x and z: give",
        ),
        (
            "[[circle]]\nx = 30.0\nz = 50.0\nradius = -1.0",
            "circle 1, radius: give",
        ),
        (
            "[[circle]]\nx = 0.5\nz = 50.0\nradius = 1.0",
            "circle 1, place: it covers the start",
        ),
        (
            "[[polygon]]\npoints = [[30.0, 50.0], [31.0, 50.0]]",
            "polygon 1, points: it has 2",
        ),
        (
            "[[polygon]]\npoints = [[30.0, 50.0], [31.0, 51.0], [31.0, 50.0], [30.0, 51.0]]",
            "does not cut itself",
        ),
        ("[[square]]\nside = 1.0", "unknown field `square`"),
        ("circle", "TOML parse error"),
    ] {
        std::fs::write(&field, text).unwrap();
        for command in ["fly", "campaign"] {
            let saving = ("--save-field", saved.as_path());
            let files = [("--field", field.as_path()), ("--out", &out), saving];
            let files = if command == "fly" {
                &files[..]
            } else {
                &files[..2]
            };
            let output = run(&[command], files);
            let talk = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(2), "{command} {text}: {talk}");
            assert!(talk.contains("bad.toml") && talk.contains(hint), "{talk}");
            assert!(output.stdout.is_empty() && !out.exists() && !saved.exists());
        }
    }
    let output = run(
        &["fly"],
        &[("--field", &folder.join("none.toml")), ("--out", &out)],
    );
    assert_eq!(output.status.code(), Some(2));
    std::fs::remove_dir_all(folder).unwrap();
}

/// Fields and generators are cells; a row names its field and is flown again by it; another field
/// under the same name is another campaign.
#[test]
fn a_field_is_a_cell_of_a_campaign() {
    let folder = scratch("cells");
    let (a, b, rows) = (
        folder.join("a.toml"),
        folder.join("b.toml"),
        folder.join("rows.jsonl"),
    );
    std::fs::write(&a, "[[circle]]\nx = 30.0\nz = 50.0\nradius = 1.0").unwrap();
    std::fs::write(&b, "[[ground]]\npoints = [[0.0, 47.0]]").unwrap();
    let flags = [
        "campaign",
        "--json",
        "--duration",
        "2",
        "--trials",
        "2",
        "--seed",
        "5",
    ];
    let fly = || {
        run(
            &flags,
            &[("--field", &a), ("--field", &b), ("--out", &rows)],
        )
    };
    let whole = fly();
    let report = result(&whole);
    let cells = report["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 2);
    for (cell, field) in cells.iter().zip([&a, &b]) {
        assert_eq!(cell["field"], field.display().to_string());
        assert_eq!(
            (&cell["trials"], &cell["obstacles"]),
            (&2.into(), &0.into())
        );
    }
    let text = std::fs::read_to_string(&rows).unwrap();
    for line in text.lines().skip(1) {
        let row: Value = serde_json::from_str(line).unwrap();
        let again = run(
            &[
                "fly",
                "--json",
                "--duration",
                "2",
                "--seed",
                &row["seed"].to_string(),
            ],
            &[
                ("--field", Path::new(row["field"].as_str().unwrap())),
                ("--out", &folder),
            ],
        );
        assert_eq!(result(&again)["log_hash"], row["log_hash"]);
    }
    // A cut file is gone on with, whatever field its last row was of.
    let lines: Vec<&str> = text.lines().collect();
    std::fs::write(&rows, lines[..4].join("\n") + "\n").unwrap();
    assert_eq!(fly().stdout, whole.stdout);
    std::fs::write(&a, "[[circle]]\nx = 31.0\nz = 50.0\nradius = 1.0").unwrap();
    let other = fly();
    assert_eq!(other.status.code(), Some(2));
    let talk = String::from_utf8_lossy(&other.stderr).into_owned();
    assert!(
        talk.contains("holds another campaign: its field is"),
        "{talk}"
    );

    let generators = [
        "--generator",
        "sealed,walls",
        "--obstacles",
        "3,4",
        "--oracle",
    ];
    let report = result(&run(&[&flags[..], &generators].concat(), &[]));
    let names = report["cells"].as_array().unwrap().iter();
    let names: Vec<(String, u64, bool)> = names
        .map(|cell| {
            let name = cell["generator"].as_str().unwrap().to_owned();
            let count = cell["obstacles"].as_u64().unwrap();
            (name, count, cell["oracle"].as_bool().unwrap())
        })
        .collect();
    assert_eq!(names.len(), 8);
    for (generator, count) in [("sealed", 3), ("sealed", 4), ("walls", 3), ("walls", 4)] {
        for oracle in [false, true] {
            assert!(names.contains(&(generator.to_owned(), count, oracle)));
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// A body that does not fit is refused; one that fits collides earlier than a point does.
#[test]
fn the_body_counts_in_every_check() {
    let folder = scratch("body");
    let (wall, out) = (folder.join("wall.toml"), folder.join("out"));
    // Nothing leads round it.
    std::fs::write(
        &wall,
        "[[capsule]]\nfrom = [30.0, -100.0]\nto = [30.0, 200.0]\nradius = 0.05",
    )
    .unwrap();
    let end = |body: &str| {
        let scenario = folder.join("body.toml");
        std::fs::write(&scenario, format!("body_radius = {body}")).unwrap();
        let files = [
            ("--scenario", scenario.as_path()),
            ("--field", &wall),
            ("--out", &out),
        ];
        let output = run(&["fly", "--json"], &files);
        assert_eq!(output.status.code(), Some(3));
        let result = result(&output);
        assert!(result["min_clearance"].as_f64().unwrap() < 0.0);
        result["x_end"].as_f64().unwrap()
    };
    let (point, body) = (end("0.0"), end("2.0"));
    assert!((29.9..30.1).contains(&point), "{point}");
    assert!((27.9..28.1).contains(&body), "{body}");
    std::fs::remove_dir_all(folder).unwrap();
}

/// A lidar's file goes before the scenario; a bad one is refused by file and key.
#[test]
fn a_lidar_comes_from_a_file() {
    let folder = scratch("lidar");
    let (scenario, out) = (folder.join("scenario.toml"), folder.join("out"));
    std::fs::write(&scenario, "[lidar]\nbeams = 31\nrange_max = 30.0").unwrap();
    let lidar = folder.join("lidar.toml");
    std::fs::write(&lidar, "range_max = 60.0\nfield_of_view_deg = 90.0").unwrap();
    let files = [
        ("--scenario", scenario.as_path()),
        ("--lidar", &lidar),
        ("--out", &out),
    ];
    let flown = log(&run(&["fly", "--json", "--duration", "1"], &files));
    let flown = &flown["header"]["lidar"];
    assert_eq!(
        (&flown["beams"], &flown["range_max"]),
        (&31.into(), &60.0.into())
    );
    let view = flown["field_of_view"].as_f64().unwrap();
    assert!((view - 90_f64.to_radians()).abs() < 1e-12);
    std::fs::remove_dir_all(&out).unwrap();
    for (text, hint) in [
        ("beams = 129", "lidar.beams: give 1 to 128"),
        ("range_max = nan", "lidar.range_max: give"),
        ("field_of_view_deg = 400.0", "lidar.field_of_view_deg: give"),
        ("range_error = -1.0", "lidar.range_error: give"),
        ("rate = 4.0", "unknown field `rate`"),
    ] {
        std::fs::write(&lidar, text).unwrap();
        let output = run(&["fly"], &[("--lidar", &lidar), ("--out", &out)]);
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(
            talk.contains("lidar.toml") && talk.contains(hint) && !out.exists(),
            "{talk}"
        );
    }
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/lidars/example.toml");
    let output = run(
        &["fly", "--duration", "1"],
        &[("--lidar", &example), ("--out", &out)],
    );
    assert!(output.status.success());
    std::fs::remove_dir_all(folder).unwrap();
}
