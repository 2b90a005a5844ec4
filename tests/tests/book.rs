//! Whether the book has every page of `docs`.

use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn the_summary_lists_every_page_once() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let mut pages = BTreeSet::new();
    let mut folders = vec![docs.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                let name = path.strip_prefix(&docs).unwrap();
                pages.insert(name.display().to_string());
            }
        }
    }
    pages.remove("SUMMARY.md");
    let summary = include_str!("../../docs/SUMMARY.md");
    let links = summary
        .lines()
        .filter_map(|line| line.rsplit_once("](")?.1.strip_suffix(')'));
    let links: Vec<String> = links.map(str::to_owned).collect();
    assert_eq!(
        links.len(),
        pages.len(),
        "SUMMARY.md lists a page twice, or lacks one"
    );
    assert_eq!(links.into_iter().collect::<BTreeSet<_>>(), pages);
}
