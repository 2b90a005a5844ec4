//! Whether the crates can be published: what their packages say of themselves and hold, and whether the licences of
//! all dependencies are ones that `deny.toml` allows.

use mpp_tests::project::{PUBLISHED, files, root};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs cargo at the top of the project and returns what it prints. It downloads what the lock file names and no build
/// needed so far: packages for other machines, and those of optional features.
fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .arg("--locked")
        .current_dir(root())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo {arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

fn packages(more: &[&str]) -> Vec<Value> {
    let text = cargo(&[&["metadata", "--format-version", "1"], more].concat());
    let metadata: Value = serde_json::from_str(&text).unwrap();
    metadata["packages"].as_array().unwrap().clone()
}

/// The crates that are published. `publish = false` is an empty list.
fn published() -> Vec<Value> {
    let mut packages = packages(&["--no-deps"]);
    packages.retain(|package| package["publish"].is_null());
    packages
}

#[test]
fn every_published_crate_says_what_it_is_and_brings_its_licences() {
    let published = published();
    let names: Vec<&str> = published
        .iter()
        .filter_map(|package| package["name"].as_str())
        .collect();
    assert_eq!(names, PUBLISHED);
    for package in &published {
        let name = package["name"].as_str().unwrap();
        for key in [
            "description",
            "license",
            "repository",
            "readme",
            "rust_version",
        ] {
            assert!(package[key].is_string(), "{name} has no {key}");
        }
        let count = |key: &str| package[key].as_array().map_or(0, Vec::len);
        assert!((1..=5).contains(&count("keywords")), "{name}: keywords");
        assert!((1..=5).contains(&count("categories")), "{name}: categories");
        assert_eq!(package["version"], env!("CARGO_PKG_VERSION"), "{name}");
        let list = cargo(&["package", "--list", "--allow-dirty", "--package", name]);
        for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "src/lib.rs"] {
            assert!(
                list.lines().any(|line| line == file),
                "{name} has no {file}"
            );
        }
    }
}

/// A crate of which the package lacks a file that its source includes does not build.
#[test]
fn no_published_source_includes_a_file_from_outside_its_crate() {
    let mut found = Vec::new();
    for package in published() {
        let manifest = Path::new(package["manifest_path"].as_str().unwrap());
        let folder = manifest.parent().unwrap();
        for path in files(&folder.join("src"), "rs") {
            let depth = path.strip_prefix(folder).unwrap().components().count() - 1;
            let outside = format!("\"{}", "../".repeat(depth + 1));
            let text = std::fs::read_to_string(&path).unwrap();
            let mut includes = text.lines().filter(|line| line.contains("include_"));
            if includes.any(|line| line.contains(&outside)) && !is_test(&path) {
                found.push(path);
            }
        }
    }
    assert_eq!(found, Vec::<PathBuf>::new());
}

fn is_test(path: &Path) -> bool {
    path.components()
        .any(|part| part.as_os_str() == "tests" || part.as_os_str() == "tests.rs")
}

/// Whether an expression of SPDX is met by the allowed licences. An old form has a bar for `OR`. With brackets only
/// choices joined by `AND` are read.
fn met(expression: &str, allowed: &[&str]) -> bool {
    let expression = expression.replace('/', " OR ");
    let is_allowed = |licence: &str| allowed.contains(&licence.trim_matches(['(', ')', ' ']));
    if expression.contains('(') {
        let mut parts = expression.split(" AND ");
        return parts.all(|choice| choice.split(" OR ").any(is_allowed));
    }
    let mut choices = expression.split(" OR ");
    choices.any(|choice| choice.split(" AND ").all(is_allowed))
}

#[test]
fn every_dependency_has_a_licence_that_is_allowed() {
    let text = include_str!("../../deny.toml");
    let deny: toml::Table = text.parse().unwrap();
    let allowed = deny["licenses"]["allow"].as_array().unwrap();
    let allowed: Vec<&str> = allowed.iter().filter_map(toml::Value::as_str).collect();
    let mut seen = 0;
    for package in packages(&["--all-features"]) {
        let licence = package["license"].as_str();
        let licence = licence.unwrap_or_else(|| panic!("{} names no licence", package["name"]));
        assert!(met(licence, &allowed), "{}: {licence}", package["name"]);
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}

#[test]
fn expressions_of_licences_are_read() {
    let allowed = ["MIT", "Apache-2.0"];
    for (expression, expected) in [
        ("MIT", true),
        ("MIT/Apache-2.0", true),
        ("GPL-3.0 OR MIT", true),
        ("(MIT OR Apache-2.0) AND GPL-3.0", false),
        ("(GPL-3.0 OR MIT) AND Apache-2.0", true),
        ("MIT AND GPL-3.0", false),
        ("GPL-3.0", false),
    ] {
        assert_eq!(met(expression, &allowed), expected, "{expression}");
    }
}

#[test]
fn the_citation_has_the_version_and_the_day_of_the_changelog() {
    let read = |name: &str| std::fs::read_to_string(root().join(name)).unwrap();
    let (citation, changelog) = (read("CITATION.cff"), read("CHANGELOG.md"));
    let after = |text: &str, start: &str| {
        let found = text.lines().find_map(|line| line.strip_prefix(start));
        found.map(str::to_owned)
    };
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(after(&citation, "version: ").as_deref(), Some(version));
    let told = after(&changelog, &format!("## {version} (")).unwrap();
    let day = told.trim_end_matches(')');
    let released = (day != "not released yet").then_some(day);
    assert_eq!(after(&citation, "date-released: ").as_deref(), released);
}
