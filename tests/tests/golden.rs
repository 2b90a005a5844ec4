//! Tests whether any golden flight changed.

use mpp_tests::golden::{flights, flights_in_space, table, table_path};

#[test]
fn golden_flights_are_what_they_were() {
    let expected = std::fs::read_to_string(table_path()).unwrap();
    let flown = table().unwrap();
    let changed: Vec<_> = expected
        .lines()
        .zip(flown.lines())
        .filter(|(was, is)| was != is)
        .map(|(was, is)| format!("was {was}\n is {is}"))
        .collect();
    assert!(
        changed.is_empty() && expected.lines().count() == flown.lines().count(),
        "{} golden flights changed. If that is meant, run `cargo xtask golden --save` and name them in \
         the changelog:\n{}",
        changed.len(),
        changed.join("\n")
    );
}

#[test]
fn golden_flights_have_names_of_their_own() {
    let mut names: Vec<_> = flights()
        .unwrap()
        .into_iter()
        .map(|golden| golden.name)
        .collect();
    names.extend(
        flights_in_space()
            .unwrap()
            .into_iter()
            .map(|golden| golden.name),
    );
    names.sort();
    let count = names.len();
    names.dedup();
    assert!(names.len() == count && count >= 45);
}

/// The first golden flight is the flight of README's first command.
#[test]
fn readme_shows_the_first_golden_flight() {
    let readme = include_str!("../../README.md");
    let table = std::fs::read_to_string(table_path()).unwrap();
    let hash = table
        .lines()
        .nth(1)
        .and_then(|line| line.split_whitespace().nth(1))
        .unwrap();
    assert!(readme.contains(&format!("log {hash}\n")), "{hash}");
}
