//! Stem maps: trunks as a CSV table, as foresters write them.

use super::FARTHEST;
use super::body::Body;

/// Most characters of a cell that an error repeats.
const SHOWN: usize = 40;

/// The reason why a text is no stem map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StemError {
    /// The first line does not name a column.
    #[error(
        "stem map {name}, line 1: there is no column `{column}`: name the columns `x`, `y`, `diameter` and, if known, `height`"
    )]
    Column {
        /// Name of the text.
        name: String,
        /// The column.
        column: &'static str,
    },
    /// A cell is unsound.
    #[error("stem map {name}, line {line}, {column} `{cell}`: {advice}")]
    Cell {
        /// Name of the text.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Its column.
        column: &'static str,
        /// Its content.
        cell: String,
        /// What to do.
        advice: String,
    },
    /// There is no trunk.
    #[error("stem map {0} holds no trunk: give one line for each, below the names of the columns")]
    Empty(String),
}

/// Reads the trunks of a stem map: `x` ahead, `y` to the right, `diameter`, and `height` if there is such a column \[m\]. The
/// first line names the columns, in any order and among others. A trunk without a height has no end. An error shows `name` as
/// the name of the text.
///
/// # Errors
/// [`StemError`] for the first thing that is wrong.
pub fn stems(name: &str, text: &str) -> Result<Vec<Body>, StemError> {
    let mut lines = (1..).zip(text.trim_start_matches('\u{feff}').lines());
    let header: Vec<String> = lines.next().map_or(Vec::new(), |(_, line)| {
        cells(line).map(str::to_lowercase).collect()
    });
    let place = |column: &str| header.iter().position(|it| it == column);
    let needed = |column: &'static str| {
        place(column).ok_or_else(|| StemError::Column {
            name: name.to_owned(),
            column,
        })
    };
    let (x, y, diameter) = (needed("x")?, needed("y")?, needed("diameter")?);
    let height = place("height");
    let mut bodies = Vec::new();
    for (line, text) in lines.filter(|(_, text)| !text.trim().is_empty()) {
        let row: Vec<&str> = cells(text).collect();
        let value = |column: &'static str, at: usize, least: f64| {
            let cell = row.get(at).copied().unwrap_or("");
            number(cell, least).map_err(|advice| StemError::Cell {
                name: name.to_owned(),
                line,
                column,
                cell: cell.chars().take(SHOWN).collect(),
                advice,
            })
        };
        let least = f64::MIN_POSITIVE;
        bodies.push(Body::Cylinder {
            x: value("x", x, -FARTHEST)?,
            y: value("y", y, -FARTHEST)?,
            radius: 0.5 * value("diameter", diameter, least)?,
            height: height.map_or(Ok(f64::INFINITY), |at| value("height", at, least))?,
        });
    }
    if bodies.is_empty() {
        return Err(StemError::Empty(name.to_owned()));
    }
    Ok(bodies)
}

fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| cell.trim().trim_matches('"'))
}

/// Reads a number of at least `least`; else says what to do.
fn number(cell: &str, least: f64) -> Result<f64, String> {
    let value: f64 = cell
        .parse()
        .map_err(|_| "give a number, with a point before its decimals".to_owned())?;
    if value.is_nan() {
        return Err("give a number, or leave the line out".to_owned());
    }
    if value.abs() > FARTHEST {
        return Err(format!(
            "give at most {FARTHEST} m: subtract the place of the start from x and y"
        ));
    }
    if value < least {
        return Err("give more than 0 m, or leave the line out".to_owned());
    }
    Ok(value)
}
