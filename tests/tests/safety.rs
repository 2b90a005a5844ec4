//! Whether the safety page holds together: numbers without gaps, requirements that exist, tests that are tests.

use mpp_tests::project::root;
use std::collections::BTreeSet;
use std::fs;

/// The rows of a table whose numbers begin with this letter: number and cells.
fn rows(page: &str, letter: char) -> Vec<(usize, Vec<&str>)> {
    let rows = page.lines().filter_map(|line| {
        let mut cells = line.strip_prefix("| ")?.split(" | ");
        let number = cells.next()?.strip_prefix(letter)?.parse().ok()?;
        Some((number, cells.collect()))
    });
    rows.collect()
}

/// Numbers with this letter in a text, such as `R3`.
fn named(text: &str, letter: char) -> BTreeSet<usize> {
    let words = text.split(|c: char| !c.is_alphanumeric());
    words
        .filter_map(|word| word.strip_prefix(letter)?.parse().ok())
        .collect()
}

/// What is wrong with the tests that a cell of links names.
fn faults(cell: &str) -> Vec<String> {
    let links: Vec<(&str, &str)> = cell
        .split("[`")
        .skip(1)
        .filter_map(|link| {
            link.split_once("`](../")?
                .1
                .split_once(')')
                .map(|(file, _)| (link, file))
        })
        .map(|(link, file)| (link.split('`').next().unwrap_or_default(), file))
        .collect();
    let mut faults: Vec<String> = links
        .iter()
        .filter(|(name, file)| {
            let text = fs::read_to_string(root().join(file)).unwrap_or_default();
            !text.contains(&format!("#[test]\nfn {name}()"))
        })
        .map(|(name, file)| format!("{file} has no test {name}"))
        .collect();
    if links.is_empty() {
        faults.push(format!("no test in: {cell}"));
    }
    faults
}

#[test]
fn the_safety_page_names_tests_that_exist() {
    let page = fs::read_to_string(root().join("docs/safety.md")).unwrap();
    for letter in ['A', 'H', 'R'] {
        let numbers: Vec<usize> = rows(&page, letter).iter().map(|row| row.0).collect();
        assert_eq!(numbers, (1..=numbers.len()).collect::<Vec<_>>(), "{letter}");
        assert!(numbers.len() >= 10, "{letter}");
    }
    let requirements = rows(&page, 'R');
    let all: BTreeSet<usize> = requirements.iter().map(|row| row.0).collect();
    for (number, cells) in &requirements {
        assert_eq!(cells.len(), 3, "R{number}");
        assert_eq!(faults(cells[2]), Vec::<String>::new(), "R{number}");
    }
    // Each hazard has requirements that exist, and each requirement a hazard or an assumption.
    let mut used = BTreeSet::new();
    for (number, cells) in [rows(&page, 'H'), rows(&page, 'A')].concat() {
        let here = named(&cells.join(" "), 'R');
        assert!(here.is_subset(&all), "{number}: {here:?}");
        used.extend(here);
    }
    for (number, cells) in rows(&page, 'H') {
        assert!(!named(cells[2], 'R').is_empty(), "H{number}");
    }
    assert_eq!(used, all);
}

#[test]
fn a_test_that_is_gone_is_found() {
    let there = "[`a_test_that_is_gone_is_found`](../tests/tests/safety.rs)";
    assert_eq!(faults(there), Vec::<String>::new());
    assert_eq!(
        faults("[`no_such_test`](../tests/tests/safety.rs)").len(),
        1
    );
    // A helper is no test.
    assert_eq!(faults("[`rows`](../tests/tests/safety.rs)").len(), 1);
    assert_eq!(faults("checked by hand").len(), 1);
}
