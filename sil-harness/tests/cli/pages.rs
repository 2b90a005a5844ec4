//! The commands that the pages show: those in a block that a comment `<!-- runnable -->` stands before are run.

use crate::common::{harness, scratch};
use std::path::{Path, PathBuf};

const MARK: &str = "<!-- runnable -->\n```console\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// README and the pages of `docs` with what stands below it.
fn pages() -> Vec<(PathBuf, String)> {
    let mut paths = vec![root().join("README.md")];
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        (path, text)
    };
    paths.into_iter().map(read).collect()
}

/// The commands of a page's marked blocks, without `$` and comments.
fn marked(page: &str) -> Vec<String> {
    let blocks = page
        .split(MARK)
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap_or_default());
    let commands =
        blocks.flat_map(|block| block.lines().filter_map(|line| line.strip_prefix("$ ")));
    commands
        .map(|line| {
            line.split(" #")
                .next()
                .unwrap_or_default()
                .trim()
                .to_owned()
        })
        .collect()
}

#[test]
fn the_commands_that_pages_mark_as_runnable_run() {
    let mut ran = 0;
    for (number, (page, text)) in pages().into_iter().enumerate() {
        let commands = marked(&text);
        if commands.is_empty() {
            continue;
        }
        let place = scratch(&format!("page{number}"));
        for folder in ["docs", "aircraft"] {
            let target = root().join(folder).canonicalize().unwrap();
            std::os::unix::fs::symlink(target, place.join(folder)).unwrap();
        }
        for command in commands {
            let mut words = command.split_whitespace();
            let told = format!("{}: {command}", page.display());
            assert_eq!(words.next(), Some("sil-harness"), "{told}");
            let output = harness().args(words).current_dir(&place).output().unwrap();
            // A flight that ends in an obstacle was flown, too.
            let flown = matches!(output.status.code(), Some(0 | 3 | 4));
            assert!(flown, "{told}: {}", String::from_utf8_lossy(&output.stderr));
            ran += 1;
        }
        std::fs::remove_dir_all(place).unwrap();
    }
    assert!(ran >= 15, "only {ran} commands are marked");
}

#[test]
fn a_marked_block_is_read_without_its_comments() {
    let page = format!(
        "text\n{MARK}$ sil-harness fly   # once\nresult\n$ sil-harness params\n```\n$ sil-harness no\n"
    );
    assert_eq!(marked(&page), ["sil-harness fly", "sil-harness params"]);
}
