//! Tests the structure of the workspace: the allowed dependencies of each crate, and no circle of
//! imports inside a crate.

mod imports;

use imports::{circles, edges};
use mpp_tests::project::{PUBLISHED, files, root};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::Command;

/// The allowed dependencies of a crate.
struct Rule {
    name: &'static str,
    /// Our own crates that this crate may need.
    ours: &'static [&'static str],
    /// Crates of others that this crate must not need.
    not: &'static [&'static str],
}

/// Crates that draw, compute in parallel, or speak to a person. They do not belong on a flight
/// computer.
const HOST: &[&str] = &[
    "clap",
    "clarabel",
    "indicatif",
    "plotters",
    "rayon",
    "serde_json",
    "toml",
];

/// The same without the files of a flight.
const PEOPLE: &[&str] = &["clap", "rayon", "indicatif", "clarabel", "plotters"];

/// One rule for each crate of the workspace.
const RULES: [Rule; 16] = [
    rule("mpp-data", &[], HOST),
    rule("mpp-core", lowest(1), HOST),
    rule("hil-protocol", lowest(1), HOST),
    rule("mpp-node", lowest(3), HOST),
    rule("mpp-sim", lowest(4), PEOPLE),
    rule("mpp-analysis", lowest(5), &["clap", "rayon", "indicatif"]),
    rule("mpp-export", lowest(6), PEOPLE),
    rule("sil-harness", lowest(7), &["clarabel", "plotters"]),
    rule("mpp-c", lowest(4), HOST),
    rule("mpp-c-plant", &["hil-protocol", "mpp-c", "mpp-sim"], PEOPLE),
    rule("mpp-web", &["mpp-core", "mpp-node", "mpp-sim"], PEOPLE),
    rule("mpp-tests", lowest(8), &[]),
    rule("xtask", &["hil-protocol"], &[]),
    rule("mpp-companion", lowest(5), &[]),
    rule("mpp-python", lowest(6), PEOPLE),
    rule("mpp-ros", lowest(5), PEOPLE),
];

/// So many of the published crates, the lowest first.
const fn lowest(count: usize) -> &'static [&'static str] {
    PUBLISHED.split_at(count).0
}

const fn rule(
    name: &'static str,
    ours: &'static [&'static str],
    not: &'static [&'static str],
) -> Rule {
    Rule { name, ours, not }
}

/// Finds the offences in the dependencies, and returns a sentence for each.
fn offences(metadata: &serde_json::Value) -> Vec<String> {
    let list = |value: &serde_json::Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_owned();
    let packages = list(&metadata["packages"]);
    let is_ours = |name: &str| RULES.iter().any(|rule| rule.name == name);
    let mut offences = Vec::new();
    for package in &packages {
        let name = text(&package["name"]);
        let Some(rule) = RULES.iter().find(|rule| rule.name == name) else {
            offences.push(format!("{name} has no rule: say in RULES what it may need"));
            continue;
        };
        for dependency in list(&package["dependencies"]) {
            let needed = text(&dependency["name"]);
            // A crate's tests may ask for features of the crate itself.
            let allowed =
                !is_ours(&needed) || needed == name || rule.ours.contains(&needed.as_str());
            if !allowed || rule.not.contains(&needed.as_str()) {
                offences.push(format!("{name} must not need {needed}"));
            }
        }
    }
    offences
}

#[test]
fn no_crate_needs_what_it_must_not() {
    for workspace in ["", "bindings/python", "bindings/ros"] {
        let output = Command::new(env!("CARGO"))
            .args([
                "metadata",
                "--format-version",
                "1",
                "--no-deps",
                "--offline",
            ])
            .current_dir(root().join(workspace))
            .output()
            .expect("cargo runs");
        let metadata = serde_json::from_slice(&output.stdout).expect("cargo metadata gives JSON");
        assert_eq!(offences(&metadata), Vec::<String>::new());
    }
}

/// Names and versions of the packages in a lock file.
#[expect(clippy::expect_used, reason = "the helpers of tests fail as tests do")]
fn locked(path: &str) -> BTreeSet<(String, String)> {
    let text = std::fs::read_to_string(root().join(path)).expect("there is a lock file");
    let lines: Vec<&str> = text.lines().collect();
    let value = |line: &str, key: &str| {
        let rest = line.strip_prefix(key)?.strip_prefix(" = ")?;
        Some(rest.trim_matches('"').to_owned())
    };
    let pairs = lines.windows(2);
    pairs
        .filter_map(|pair| Some((value(pair[0], "name")?, value(pair[1], "version")?)))
        .collect()
}

/// The part of a version in which Cargo takes one version for another.
fn line_of(version: &str) -> Vec<&str> {
    let parts = if version.starts_with("0.") { 2 } else { 1 };
    version.split('.').take(parts).collect()
}

/// Another version of a crate, above all of `libm`, may give other bits. A crate of others may want one that cannot agree.
#[test]
fn the_lock_files_agree() {
    let ours = locked("Cargo.lock");
    for workspace in ["bindings/python", "bindings/ros"] {
        let theirs = locked(&format!("{workspace}/Cargo.lock"));
        let differs = |(name, version): &&(String, String)| {
            let of_line =
                |(own, its): &&(String, String)| own == name && line_of(its) == line_of(version);
            ours.iter().any(|own| of_line(&own)) && !ours.contains(&(name.clone(), version.clone()))
        };
        let other: Vec<_> = theirs.iter().filter(differs).collect();
        assert!(
            theirs.len() > 50 && other.is_empty(),
            "{workspace}: {other:?}"
        );
    }
}

#[test]
fn a_forbidden_dependency_and_a_crate_without_a_rule_are_found() {
    let package = |name: &str, needed: &[&str]| {
        let needs = |name: &&str| serde_json::json!({ "name": name });
        let dependencies: Vec<_> = needed.iter().map(needs).collect();
        serde_json::json!({ "name": name, "dependencies": dependencies })
    };
    let metadata = serde_json::json!({ "packages": [
        package("mpp-core", &["libm", "hil-protocol", "rayon"]),
        package("hil-protocol", &["serde"]),
        package("mpp-node", &["mpp-core", "hil-protocol"]),
        package("stranger", &[]),
    ]});
    let found = offences(&metadata);
    assert_eq!(
        found,
        [
            "mpp-core must not need hil-protocol",
            "mpp-core must not need rayon",
            "stranger has no rule: say in RULES what it may need",
        ]
    );
}

/// The crates whose files must not import each other in a circle, with their first file.
const COVERED: [(&str, &str); 13] = [
    ("mpp-data", "lib.rs"),
    ("hil-protocol", "lib.rs"),
    ("mpp-core", "lib.rs"),
    ("mpp-node", "lib.rs"),
    ("mpp-sim", "lib.rs"),
    ("mpp-analysis", "lib.rs"),
    ("mpp-export", "lib.rs"),
    ("sil-harness", "lib.rs"),
    ("xtask", "main.rs"),
    ("bindings/python", "lib.rs"),
    ("bindings/ros", "main.rs"),
    ("firmware", "lib.rs"),
    ("mpp-companion", "lib.rs"),
];

#[test]
fn no_files_import_each_other_in_a_circle() {
    for (name, first) in COVERED {
        let source = root().join(name).join("src");
        let read = |file: &str| std::fs::read_to_string(source.join(file)).ok();
        let edges = edges(first, &read);
        assert!(edges.len() > 2, "{name} was not read");
        let circles = circles(&edges);
        assert!(
            circles.is_empty(),
            "{name} has circles of imports; move what both sides need to a file of its own:\n{}",
            circles.join("\n")
        );
    }
}

/// Cargo does not look for tests beside `all.rs`: one that it does not name would never run.
#[test]
fn all_rs_names_every_integration_test() {
    let mut sources = files(root(), "rs");
    sources.retain(|file| file.ends_with("tests/all.rs"));
    assert_eq!(sources.len(), 6, "crates with one test binary");
    for file in sources {
        let text = std::fs::read_to_string(&file).unwrap();
        let module = |line: &str| Some(line.strip_prefix("mod ")?.strip_suffix(';')?.to_owned());
        let named: BTreeSet<_> = text.lines().filter_map(module).collect();
        let stem = |entry: PathBuf| entry.file_stem().unwrap().to_string_lossy().into_owned();
        let entries = std::fs::read_dir(file.parent().unwrap()).unwrap();
        let mut found: BTreeSet<_> = entries.map(|entry| stem(entry.unwrap().path())).collect();
        assert!(found.remove("all"));
        assert_eq!(named, found, "{}", file.display());
    }
}

/// Greatest number of lines of a source file. What is longer has more than one task.
const MOST_LINES: usize = 400;

#[test]
fn no_source_file_is_too_long() {
    let mut sources = files(root(), "rs");
    assert!(sources.len() > 300, "the repository was not read");
    let lines = |file: &PathBuf| std::fs::read_to_string(file).unwrap().lines().count();
    sources.retain(|file| lines(file) > MOST_LINES);
    assert!(sources.is_empty(), "split by task: {sources:?}");
}

/// The circles of a crate with the given files.
fn circles_of(files: &[(&str, &str)]) -> Vec<String> {
    let files: BTreeMap<_, _> = files.iter().copied().collect();
    circles(&edges("lib.rs", &|file| {
        files.get(file).map(|source| (*source).to_owned())
    }))
}

#[test]
fn a_circle_is_told_by_its_files_and_names() {
    let two = [
        ("lib.rs", "mod a; mod b; pub use a::A; pub use b::B;"),
        ("a.rs", "use crate::B; pub struct A(B);"),
        (
            "b.rs",
            "pub struct B; fn f() { let _ = super::a::A::new(); }",
        ),
    ];
    assert_eq!(
        circles_of(&two),
        ["a.rs uses B of b.rs; b.rs uses A of a.rs"]
    );
    let child = [
        ("lib.rs", "mod a;"),
        (
            "a/mod.rs",
            "mod b; pub use b::B; struct A; fn f() -> B { B }",
        ),
        ("a/b.rs", "use super::A; pub struct B; fn f(_: A) {}"),
    ];
    assert_eq!(
        circles_of(&child),
        ["a/b.rs uses A of a/mod.rs; a/mod.rs uses B of a/b.rs"]
    );
    let three = [
        ("lib.rs", "mod a; mod b; mod c; fn f() { a::f() }"),
        ("a.rs", "pub fn f() { crate::b::f() }"),
        ("b.rs", "use crate::c; pub fn f() { c::f() }"),
        ("c.rs", "pub fn f() { assert!(crate::a::f() == ()) }"),
    ];
    assert_eq!(
        circles_of(&three),
        ["a.rs uses f of b.rs; b.rs uses f of c.rs; c.rs uses f of a.rs"]
    );
}

#[test]
fn a_clean_tree_passes() {
    let clean = [
        (
            "lib.rs",
            "mod a; mod d; pub use a::{B, C}; pub struct Root;",
        ),
        (
            "a/mod.rs",
            "mod b; mod c; pub use b::B; pub use c::C; pub mod e { pub struct E; }",
        ),
        // The edge leads through the parent, which only passes on, to the file that has the name.
        (
            "a/b.rs",
            "use super::C; use crate::Root; pub struct B(C, Root);",
        ),
        // In tests everything may be used.
        (
            "a/c.rs",
            "pub struct C; #[cfg(test)] mod tests { use super::super::B; }",
        ),
        (
            "d.rs",
            "use crate::a::{self, e::E}; fn f(_: a::B, _: E) { use std::fmt; }",
        ),
    ];
    assert_eq!(circles_of(&clean), Vec::<String>::new());
}
