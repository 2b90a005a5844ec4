//! Whether the documents say what the code says: links, names in links, and numbers.

#![expect(clippy::panic, reason = "the helpers of tests fail as tests do")]

use mpp_core::vehicle::{Airframe, Trim};
use mpp_tests::project::{files, root};
use std::fs;
use std::path::{Path, PathBuf};

#[path = "../../xtask/src/numbers/ranges.rs"]
mod page_of_ranges;

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// README, ARCHITECTURE, CONTRIBUTING, and every page below `docs`.
fn pages() -> Vec<PathBuf> {
    let pages = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"].map(|page| root().join(page));
    [&pages[..], &files(&root().join("docs"), "md")].concat()
}

/// Text and target of each link of a page; what stands in a block of code is none.
fn links(page: &str) -> Vec<(&str, &str)> {
    let outside = page.split("\n```").step_by(2);
    outside
        .flat_map(|part| part.match_indices("](").map(move |(at, _)| (part, at)))
        .filter_map(|(part, at)| {
            let text = part[..at].rsplit_once('[')?.1;
            let target = part[at + 2..].split_once(')')?.0;
            Some((text, target))
        })
        .collect()
}

/// The anchor of a heading: small letters, no marks, bars for spaces.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    text.chars()
        .filter(kept)
        .collect::<String>()
        .replace(' ', "-")
}

/// What is wrong with a link of a page, if anything.
///
/// A target is a file or folder, and perhaps a heading of a page. Where the text is a name or a line of code and the target is a source
/// file, the file holds it: who renames a function finds the page that speaks of it.
fn fault(page: &Path, text: &str, target: &str) -> Option<String> {
    if target.contains("://") {
        return None;
    }
    let (file, wanted) = target.split_once('#').unwrap_or((target, ""));
    let path = match file {
        "" => page.to_owned(),
        file => page.parent()?.join(file),
    };
    if !path.exists() {
        return Some(format!("there is no {target}"));
    }
    if !wanted.is_empty() {
        let is_there = read(&path)
            .lines()
            .any(|line| line.starts_with('#') && anchor(line) == wanted);
        return (!is_there).then(|| format!("there is no heading {target}"));
    }
    // In a table a bar is escaped.
    let code = text
        .strip_prefix('`')?
        .strip_suffix('`')?
        .replace("\\|", "|");
    let is_source = path.extension().is_some_and(|extension| extension == "rs");
    let is_name = code
        .chars()
        .all(|c| c.is_alphanumeric() || "_:".contains(c));
    let is_line = code.contains(' ') || code.contains('(');
    if !is_source || !(is_name || is_line) || path.file_stem().is_some_and(|stem| stem == &code[..])
    {
        return None;
    }
    let sought = if is_line {
        &code
    } else {
        code.rsplit("::").next()?
    };
    let found = read(&path).contains(sought);
    (!found).then(|| format!("{target} holds no `{sought}`"))
}

#[test]
fn every_link_leads_to_a_file_that_holds_what_it_names() {
    let mut faults = Vec::new();
    for page in pages() {
        let text = read(&page);
        let links = links(&text).into_iter();
        let found = links.filter_map(|(text, target)| fault(&page, text, target));
        faults.extend(found.map(|fault| format!("{}: {fault}", page.display())));
    }
    assert_eq!(faults, Vec::<String>::new());
}

#[test]
fn a_dead_link_and_a_name_that_is_gone_are_found() {
    let readme = root().join("README.md");
    assert_eq!(fault(&readme, "Fly", "#fly"), None);
    assert!(fault(&readme, "Fly", "#no-such-heading").is_some());
    let page =
        "[a](b.md) [`x`](tests/src/lib.rs)\n```\n[c](d.md)\n```\n[`golden`](tests/src/lib.rs)";
    let faults: Vec<_> = links(page)
        .into_iter()
        .map(|(text, target)| fault(&readme, text, target))
        .collect();
    assert_eq!(faults.len(), 3);
    assert_eq!(faults[0].as_deref(), Some("there is no b.md"));
    assert!(fault(&readme, "`no_such_name`", "tests/src/lib.rs").is_some());
    assert!(fault(&readme, "`let no = line();`", "tests/src/lib.rs").is_some());
    assert_eq!(faults[2], None);
}

#[test]
fn the_generated_table_is_that_of_the_code() {
    let page = read(&root().join(page_of_ranges::PAGE));
    let expected = page_of_ranges::text(root()).unwrap();
    // A whole page is no readable difference: name the first line that differs.
    let differ = page.lines().zip(expected.lines()).find(|(is, be)| is != be);
    assert_eq!(differ, None, "run `cargo xtask numbers --save`");
    assert_eq!(
        page.len(),
        expected.len(),
        "run `cargo xtask numbers --save`"
    );
}

/// The comment above each tuned number says where it comes from.
#[test]
fn each_tuned_number_has_a_source() {
    for path in files(&root().join("mpp-core/src/tuning"), "rs") {
        let (mut comment, mut found) = (String::new(), 0);
        for line in read(&path).lines().map(str::trim) {
            match line.strip_prefix("///") {
                Some(text) => comment += text,
                None => {
                    if line.starts_with("pub const ") {
                        let sourced = comment.contains("Source: ");
                        assert!(sourced, "{}: {line} has no source", path.display());
                        found += 1;
                    }
                    comment.clear();
                }
            }
        }
        assert!(found > 10, "{}", path.display());
    }
}

/// The pages give the elevator of level trim by airframe and cruise.
#[test]
fn the_elevator_of_level_trim_is_what_the_pages_say() {
    let elevator = |airframe| {
        Trim::at_speed(airframe, 12.0, 0.0)
            .unwrap()
            .control
            .elevator
    };
    let authors = Trim::of_authors(&Airframe::REFERENCE).control.elevator;
    let told = [
        elevator(&Airframe::REFERENCE),
        elevator(&Airframe::PAPER),
        authors,
    ];
    let [reference, paper, authors] = told.map(|elevator| format!("{elevator:.3}"));
    for page in [
        "docs/planner.md",
        "docs/notation.md",
        "docs/scenarios/example.toml",
        "mpp-data/src/airframe.rs",
    ] {
        assert!(
            read(&root().join(page)).contains(&reference),
            "{page}: {reference}"
        );
    }
    let notation = read(&root().join("docs/notation.md"));
    assert!(
        notation.contains(&paper) && notation.contains(&authors),
        "{paper}, {authors}"
    );
}
