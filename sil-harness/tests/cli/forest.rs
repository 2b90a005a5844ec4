//! Flights in space by `fly` and `campaign`.

use crate::common::harness;
use serde_json::Value;

fn told(flags: &str) -> (Option<i32>, String) {
    let output = harness().args(flags.split(' ')).output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8(text).unwrap())
}

fn folder(name: &str) -> String {
    let folder = std::env::temp_dir().join(format!("mpp-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder.display().to_string()
}

#[test]
fn a_light_forest_is_flown_logged_and_exported() {
    let out = folder("fly-in-space");
    let flags = format!("fly --preset space --density 0.005 --seed 5 --out {out}");
    let (code, text) = told(&flags);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("result: seed 5, survived (strict)"), "{text}");
    let file = std::fs::read_dir(&out).unwrap().find_map(|entry| {
        let path = entry.unwrap().path();
        (path.extension()? == "json").then(|| path.display().to_string())
    });
    let log = file.unwrap();
    let (code, table) = told(&format!("export {log} --table lateral"));
    assert_eq!(code, Some(0), "{table}");
    let first = table.lines().next().unwrap();
    assert!(first.starts_with("t,y,bank,course,"), "{first}");
    assert!(table.lines().count() > 1500);
    let (code, text) = told(&format!("replay {log} --out {out}/page.html"));
    assert_eq!(code, Some(0), "{text}");
    let page = std::fs::read_to_string(format!("{out}/page.html")).unwrap();
    assert!(page.contains("id=\"attitude\"") && !page.contains("/*DATA*/null"));
    // What it cannot show is refused, with what to do.
    let (code, text) = told(&format!(
        "replay {log} --against {log} --out {out}/two.html"
    ));
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("--against: give flights in the vertical plane"),
        "{text}"
    );
    let other = std::fs::read_to_string(&log).unwrap();
    let changed = format!("{out}/changed.json");
    std::fs::write(&changed, other.replacen("\"seed\":5", "\"seed\":6", 1)).unwrap();
    let (code, text) = told(&format!("replay {changed} --out {out}/changed.html"));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("does not come out the same"), "{text}");
    let (code, text) = told(&format!("fly --orders {log} --out {out}"));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("of a flight in space"), "{text}");
    std::fs::remove_dir_all(out).unwrap();
}

/// As a page saves it: the trees of a log are planted again, in the same flight alone.
#[test]
fn the_trees_of_a_log_are_planted_again() {
    let out = folder("planted");
    let flags = format!("fly --preset space --density 0.005 --seed 5 --json --out {out}");
    let hash = |flags: &str| {
        let (code, text) = told(flags);
        assert_eq!(code, Some(0), "{text}");
        let object = &text[text.find('{').unwrap()..text.rfind('}').unwrap() + 1];
        serde_json::from_str::<Value>(object).unwrap()
    };
    let plain = hash(&flags);
    let log = std::fs::read_to_string(plain["log"].as_str().unwrap()).unwrap();
    let tree = r#""orders":[{"tick":100,"order":"trunk","x":60.0,"y":0.5,"radius":0.3}],"summary""#;
    let file = format!("{out}/trees.json");
    std::fs::write(&file, log.replace(r#""summary""#, tree)).unwrap();
    let planted = hash(&format!("{flags} --orders {file}"));
    assert_ne!(planted["log_hash"], plain["log_hash"]);
    let again = planted["log"].as_str().unwrap();
    assert_ne!(again, plain["log"]);
    let again = hash(&format!("{flags} --orders {again}"));
    assert_eq!(again["log_hash"], planted["log_hash"]);
    let (code, text) = told(&format!("{flags} --gusts 1 --orders {file}"));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("other flags"), "{text}");
    std::fs::remove_dir_all(out).unwrap();
}

#[test]
fn a_campaign_counts_its_cells_and_writes_its_rows() {
    let out = folder("campaign-in-space");
    let flags = format!(
        "campaign --preset space --density 0.005,0.006 --sphere 0.4 --trials 2 --seed 5 --json --out {out}/rows.jsonl"
    );
    let output = harness().args(flags.split(' ')).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let cells: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(cells[1]["density"], 0.006);
    assert_eq!(cells[0]["flights"], 2);
    let rows = std::fs::read_to_string(format!("{out}/rows.jsonl")).unwrap();
    let mut hashes: Vec<String> = rows
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap()["log_hash"].to_string())
        .collect();
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), 4);
    let (code, text) = told(&flags);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("rows.jsonl"), "{text}");
    std::fs::remove_dir_all(out).unwrap();
}

#[test]
fn a_baseline_flies_a_cell_in_place_of_the_planner() {
    let flags = "campaign --preset space --density 0.02 --trials 2 --seed 5 --baseline straight";
    let (code, text) = told(flags);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("0 of 2 flights arrived"), "{text}");
    assert!(text.contains("2 collisions (2 no-way), "), "{text}");
}

#[test]
fn what_makes_no_sense_is_one_sentence() {
    let stems = std::env::temp_dir().join(format!("mpp-stems-{}.csv", std::process::id()));
    std::fs::write(&stems, "x,y,diameter\n60,NaN,0.4\n").unwrap();
    let stems = stems.display().to_string();
    for (flags, hint) in [
        ("--density=-1", "density: give more than 0 and at most 1"),
        ("--density 0", "density: give more than 0 and at most 1"),
        ("--world jungle", "jungle"),
        ("--baseline library-8", "invalid value 'library-8'"),
        (
            "--baseline straight --candidates 3",
            "baseline: leave candidates",
        ),
        ("--aircraft cessna182", "give this table"),
        ("--candidates 8", "candidates: give 1 to 7"),
        ("--sphere=-1", "sphere: give more than 0"),
        ("--sight 4", "sight: give 5 m or more"),
        ("--lidar pushbroom --sight 9", "least range of 9.5 m"),
        ("--latency-ms 7", "latency_ms: give a multiple of 10"),
        ("--latency-ms 0", "latency_ms: give a multiple of 10"),
        ("--world walls --sphere 3", "wider than every gap"),
        ("--obstacles 5", "--obstacles"),
        (&*format!("--stems {stems}"), "line 2, y `NaN`"),
    ] {
        for command in ["fly", "campaign --trials 1"] {
            let (code, text) = told(&format!("{command} --preset space {flags}"));
            assert_eq!(code, Some(2), "{command} {flags}: {text}");
            assert!(text.contains(hint), "{command} {flags}: {text}");
        }
    }
    std::fs::remove_file(stems).unwrap();
}
