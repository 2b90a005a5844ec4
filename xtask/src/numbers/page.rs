//! The page of the planner's numbers: its own text, and below a mark a row for each constant, from its comment. The test
//! `documents` includes this file and compares.

use std::fs::read_to_string;
use std::io::{Error, Result};
use std::path::Path;

pub(crate) const PAGE: &str = "docs/planner-numbers.md";

/// What stands above this line is written by hand.
const MARK: &str =
    "<!-- Below: written by `cargo xtask numbers --save` from the comments of the code. -->\n";

const HEAD: &str = "|name|value|unit|what it is|\n|---|---|---|---|\n";

const CORE: &str = "mpp-core/src";

/// Every constant of these files has a row, and its comment has a source.
const TUNED: [&str; 3] = ["tuning/mod.rs", "tuning/watches.rs", "tuning/space.rs"];

/// The sizes and rates that shape a flight, by file.
const SIZES: [(&str, &str); 11] = [
    (
        "config.rs",
        "TICK_PERIOD STAGES STAGE_PERIOD DIRECTIONS MAX_BEAMS MAX_PATHS",
    ),
    ("map/rolling_grid.rs", "COLS ROWS"),
    ("map/distance_field.rs", "REACH"),
    ("lattice/mod.rs", "STATIONS MAX_LATTICE_PATHS"),
    ("lattice/edges.rs", "HEIGHTS SLOPES VIA"),
    ("planner/shared.rs", "STEPS_PER_SLICE"),
    ("planner/plane/candidate.rs", "ANGLE_SCALE"),
    ("planner/summary.rs", "FEASIBLE"),
    ("qp/kernel/solve/mod.rs", "MAX_ITERATIONS"),
    ("trajectory.rs", "STEPS"),
    ("vehicle/point_mass.rs", "LEAST_AIRSPEED"),
];

/// A constant of the code.
struct Constant {
    /// Its name, behind that of its module in the file.
    name: String,
    value: String,
    comment: String,
}

impl Constant {
    fn row(&self, file: &str) -> String {
        let Self { name, value, .. } = self;
        let (unit, sentence) = told(&self.comment);
        format!("|[`{name}`](../{CORE}/{file})|{value}|{unit}|{sentence}|\n")
    }
}

/// The page as it should be.
///
/// # Errors
/// A file that cannot be read, a constant that is not there, or a tuned one without a source.
pub(crate) fn text(root: &Path) -> Result<String> {
    let page = read_to_string(root.join(PAGE))?;
    let (own, _) = page
        .split_once(MARK)
        .ok_or_else(|| Error::other(format!("{PAGE} lacks the line {MARK}")))?;
    let mut text = format!("{own}{MARK}\n## Tuned numbers\n\n{HEAD}");
    for file in TUNED {
        let source = read_to_string(root.join(CORE).join(file))?;
        let constants = constants(&source);
        if constants.len() != source.matches("pub const ").count() {
            return Err(Error::other(format!(
                "{file}: write a constant in one line"
            )));
        }
        for constant in constants {
            if !constant.comment.contains("Source: ") {
                let bare = constant.name;
                return Err(Error::other(format!("{file}: {bare} has no source")));
            }
            text += &constant.row(file);
        }
    }
    text += &format!("\n## Sizes and rates\n\n{HEAD}");
    for (file, names) in SIZES {
        let found = constants(&read_to_string(root.join(CORE).join(file))?);
        for name in names.split(' ') {
            let constant = found.iter().find(|constant| constant.name == name);
            let constant = constant.ok_or_else(|| Error::other(format!("{file} has no {name}")))?;
            text += &constant.row(file);
        }
    }
    Ok(text)
}

/// The constants of a file. A declaration is one line, and a file has no modules within modules.
fn constants(source: &str) -> Vec<Constant> {
    let (mut module, mut comment, mut found) = (String::new(), String::new(), Vec::new());
    for line in source.lines() {
        let code = line.trim();
        if let Some(text) = code.strip_prefix("/// ") {
            comment = format!("{comment}{text} ");
            continue;
        }
        if let Some((name, value)) = declared(code) {
            found.push(Constant {
                name: format!("{module}{name}"),
                value: value.to_owned(),
                comment: comment.replace('\\', ""),
            });
        } else if let Some(name) = code.strip_prefix("pub mod ") {
            module = format!("{}::", name.trim_end_matches(" {"));
        } else if line == "}" {
            module.clear();
        }
        comment.clear();
    }
    found
}

/// Name and value of a constant.
fn declared(code: &str) -> Option<(&str, &str)> {
    let (_, declaration) = code.strip_suffix(';')?.split_once("const ")?;
    let (kind, value) = declaration.split_once(" = ")?;
    Some((kind.split_once(": ")?.0, value))
}

/// The unit in a comment, and its first sentence without it.
fn told(comment: &str) -> (&str, String) {
    let start = comment
        .match_indices(" [")
        .find(|(at, _)| !comment[at + 2..].starts_with('`'));
    let (before, unit, after) = start
        .and_then(|(at, _)| {
            let (unit, after) = comment[at + 2..].split_once(']')?;
            Some((&comment[..at], unit, after))
        })
        .unwrap_or((comment, "", ""));
    let text = format!("{before}{after}");
    let ends = [". ", ": ", "; ", " ("]
        .iter()
        .filter_map(|end| text.find(end));
    let sentence = &text[..ends.min().unwrap_or(text.len())];
    (
        unit,
        sentence
            .replace("[`", "`")
            .replace("`]", "`")
            .replace("super::", ""),
    )
}
