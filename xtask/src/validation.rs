//! `validation`: how old the figures of docs/validation are, and the commands that print them again.
//!
//! A page names the commit whose code gave its figures, and the paths of that code:
//! `<!-- figures: 6ccb475: mpp-core/src mpp-sim/src -->`, once for the page and once more where a table differs.
//! The block after `<!-- regenerate -->` holds the page's commands.

use crate::folders::root;
use crate::toolchain::succeed;
use anyhow::{Context, Result, bail, ensure};
use std::path::PathBuf;
use std::process::Command;

const FIGURES: &str = "<!-- figures: ";
const REGENERATE: &str = "<!-- regenerate -->\n```console\n";

/// The shell function that the commands of pages call; docs/validation/README.md has the same.
const HARNESS: &str =
    r#"sil-harness() { cargo run --release --locked --quiet -p sil-harness -- "$@"; }"#;

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct ValidationArgs {
    /// Run the commands of this page, such as `faults`, and write what they print to out/validation/PAGE
    #[arg(long)]
    page: Option<String>,
}

/// The figures of a page: where they come from, and the commands that print them.
#[derive(Debug, PartialEq)]
struct Page {
    /// Commit, and the paths of the code that its figures depend on.
    figures: Vec<(String, Vec<String>)>,
    commands: Vec<String>,
}

impl Page {
    fn parse(text: &str) -> Result<Self> {
        let marks = text.lines().filter_map(|line| line.strip_prefix(FIGURES));
        let figures: Vec<_> = marks
            .map(|mark| {
                let parts = mark
                    .strip_suffix(" -->")
                    .and_then(|mark| mark.split_once(": "));
                let (commit, paths) =
                    parts.with_context(|| format!("not COMMIT: PATHS --> but {mark}"))?;
                let paths = paths.split_whitespace().map(str::to_owned).collect();
                Ok((commit.to_owned(), paths))
            })
            .collect::<Result<_>>()?;
        ensure!(!figures.is_empty(), "no line {FIGURES}COMMIT: PATHS -->");
        let block = text
            .split_once(REGENERATE)
            .and_then(|(_, rest)| rest.split_once("\n```"));
        let (block, _) = block.context("no block of commands after <!-- regenerate -->")?;
        let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
        let commands = commands.map(str::to_owned).collect();
        Ok(Self { figures, commands })
    }
}

pub(crate) fn run(args: &ValidationArgs) -> Result<()> {
    let pages = pages()?;
    let Some(name) = &args.page else {
        return list(&pages);
    };
    let Some((_, page)) = pages.iter().find(|(page, _)| page == name) else {
        let names: Vec<_> = pages.iter().map(|(page, _)| page.as_str()).collect();
        bail!("there is no page {name}; pages: {}", names.join(", "));
    };
    let folder = root().canonicalize()?.join("out/validation").join(name);
    std::fs::create_dir_all(&folder)?;
    for (number, command) in page.commands.iter().enumerate() {
        println!("$ {command}");
        let file = folder.join(format!("{}.txt", number + 1));
        let script = format!("set -o pipefail\n{HARNESS}\n{{ {command}\n}} | tee \"$OUT_FILE\"");
        let mut shell = Command::new("bash");
        shell.current_dir(root()).args(["-c", &script]);
        shell.env("OUT", &folder).env("OUT_FILE", &file);
        succeed(&mut shell).with_context(|| format!("{name}.md: {command}"))?;
    }
    println!("printed to {}", folder.display());
    Ok(())
}

/// Each page with its name; README has no figures.
fn pages() -> Result<Vec<(String, Page)>> {
    let mut pages = Vec::new();
    for entry in std::fs::read_dir(root().join("docs/validation"))? {
        let path: PathBuf = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if path.extension().is_some_and(|extension| extension == "md") && name != "README" {
            let page = Page::parse(&std::fs::read_to_string(&path)?);
            let page = page.with_context(|| path.display().to_string())?;
            pages.push((name.into_owned(), page));
        }
    }
    pages.sort_by(|(a, _), (b, _)| a.cmp(b));
    Ok(pages)
}

fn list(pages: &[(String, Page)]) -> Result<()> {
    println!("page          figures of           commits to their code since");
    for (name, page) in pages {
        for (commit, paths) in &page.figures {
            let (date, since) = age(commit, paths).with_context(|| format!("{name}.md"))?;
            println!(
                "{name:<13} {commit} {date}  {since:>4}  cargo xtask validation --page {name}"
            );
        }
    }
    Ok(())
}

/// Date of a commit, and how many commits have touched the paths since.
fn age(commit: &str, paths: &[String]) -> Result<(String, u32)> {
    for path in paths {
        ensure!(root().join(path).exists(), "there is no {path}");
    }
    let git = |arguments: &[&str]| -> Result<String> {
        let mut git = Command::new("git");
        let output = git.current_dir(root()).args(arguments).output();
        let output = output.context("git does not run")?;
        ensure!(
            output.status.success(),
            "git does not know commit {commit}: fetch the whole history"
        );
        Ok(String::from_utf8(output.stdout)?.trim().to_owned())
    };
    let range = format!("{commit}..HEAD");
    let mut count = vec!["rev-list", "--count", &range, "--"];
    count.extend(paths.iter().map(String::as_str));
    let date = git(&["show", "--no-patch", "--format=%cs", commit])?;
    Ok((date, git(&count)?.parse()?))
}

#[cfg(test)]
mod tests {
    use super::{Page, age, pages};
    use crate::folders::root;

    const PAGE: &str = "# A\n<!-- figures: 712c49b: a/src b -->\n<!-- regenerate -->\n```console\n$ one 'x'\n1\n$ two\n```\n";

    #[test]
    fn a_page_names_its_commit_and_its_commands() -> anyhow::Result<()> {
        let page = Page::parse(PAGE)?;
        let paths = ["a/src", "b"].map(str::to_owned).to_vec();
        assert_eq!(page.figures, [("712c49b".to_owned(), paths)]);
        assert_eq!(page.commands, ["one 'x'", "two"]);
        Ok(())
    }

    #[test]
    fn a_page_without_commit_or_commands_is_an_error() {
        for wrong in ["figures: ", "712c49b: ", "<!-- regenerate -->", "```\n"] {
            assert!(Page::parse(&PAGE.replace(wrong, "")).is_err(), "{wrong}");
        }
    }

    #[test]
    fn an_unknown_commit_is_an_error() {
        assert!(age("0000000", &[]).is_err());
    }

    /// The sentence for people says the commit that the comment says, and the paths are there.
    #[test]
    fn each_page_says_the_commit_of_its_figures() -> anyhow::Result<()> {
        for (name, page) in pages()? {
            let text = std::fs::read_to_string(root().join(format!("docs/validation/{name}.md")))?;
            assert!(!page.commands.is_empty(), "{name}");
            for (commit, paths) in page.figures {
                assert!(text.contains(&format!("`{commit}`")), "{name}: {commit}");
                assert!(
                    paths.iter().all(|path| root().join(path).exists()),
                    "{name}"
                );
            }
        }
        Ok(())
    }
}
