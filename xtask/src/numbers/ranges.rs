//! The ranges of aircraft files at the end of their page, from the lists of the code. The test `documents` includes this
//! file and compares.

use std::fs::read_to_string;
use std::io::{Error, Result};
use std::path::Path;

pub(crate) const PAGE: &str = "docs/aircraft.md";

/// What stands above this line is written by hand.
const MARK: &str =
    "<!-- Below: written by `cargo xtask numbers --save` from the lists of the code. -->\n";

const HEAD: &str = "## Ranges\n\n|key|least|most|unit|\n|---|---|---|---|\n";

/// Keys with units; those of the lateral table have their ranges here too.
const KEYS: &str = "mpp-sim/src/aircraft_file/ranges.rs";

/// The core's ranges.
const SETTINGS: &str = "mpp-data/src/setting.rs";

/// The page as it should be.
///
/// # Errors
/// A file that cannot be read, or a list that is not as it was.
pub(crate) fn text(root: &Path) -> Result<String> {
    let read = |file: &str| read_to_string(root.join(file));
    let (page, keys, settings) = (read(PAGE)?, read(KEYS)?, read(SETTINGS)?);
    let (own, _) = page
        .split_once(MARK)
        .ok_or_else(|| Error::other(format!("{PAGE} lacks the line {MARK}")))?;
    let settings = rows(&settings, "settings! {")?;
    let mut told: Vec<(String, String)> = Vec::new();
    let core = rows(&keys, "of_core! {")?.into_iter().map(|row| {
        let (setting, row) = row.split_once(", ")?;
        let of = settings
            .iter()
            .find(|it| it.starts_with(&format!("{setting}, ")))?;
        Some((row.trim_end_matches(';'), range(of)?))
    });
    let turns = rows(&keys, "of_turns! {")?.into_iter();
    let turns = turns.map(|row| Some((row.split_once(", [")?.0, range(row)?)));
    for row in core.chain(turns) {
        let (key, rest) = row
            .and_then(|(row, [least, most])| {
                let (key, unit) = row.split_once(", ")?;
                Some((key, format!("{least}|{most}|{}", unit.trim_matches('"'))))
            })
            .ok_or_else(|| Error::other(format!("{KEYS}: write a key in one line")))?;
        let key = format!("`{}`", key.trim_matches('"'));
        // Neighbours of one range share a row.
        match told.last_mut() {
            Some((keys, last)) if *last == rest => *keys += &format!(", {key}"),
            _ => told.push((key, rest)),
        }
    }
    let told: String = told
        .iter()
        .map(|(keys, rest)| format!("|{keys}|{rest}|\n"))
        .collect();
    Ok(format!("{own}{MARK}\n{HEAD}{told}"))
}

/// The rows of a list, which is a call of a macro.
fn rows<'a>(source: &'a str, start: &str) -> Result<Vec<&'a str>> {
    let list = source
        .split_once(&format!("\n{start}\n"))
        .and_then(|(_, rest)| rest.split_once("\n}"))
        .ok_or_else(|| Error::other(format!("there is no {start}")))?;
    Ok(list.0.lines().map(str::trim).collect())
}

/// The two numbers between the first brackets of a row, as the code writes them.
fn range(row: &str) -> Option<[&str; 2]> {
    let (_, rest) = row.split_once('[')?;
    let (least, most) = rest.split_once(']')?.0.split_once(", ")?;
    Some([least, most].map(|end| end.trim_end_matches(".0")))
}
