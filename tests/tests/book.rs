//! Whether the book has every page of `docs`.

use mpp_tests::project::{files, root};
use std::collections::BTreeSet;
use std::path::PathBuf;

#[test]
fn the_summary_lists_every_page_once() {
    let docs = root().join("docs");
    let name = |path: &PathBuf| path.strip_prefix(&docs).unwrap().display().to_string();
    let mut pages: BTreeSet<String> = files(&docs, "md").iter().map(name).collect();
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
