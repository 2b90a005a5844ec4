//! Height maps as ESRI ASCII grids, as surveys give them.

use super::terrain::Terrain;

/// Most characters of a word that an error repeats.
const SHOWN: usize = 40;
/// The keys of the header. Of the last one a grid may do without.
const KEYS: [&str; 6] = [
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "cellsize",
    "nodata_value",
];

/// The reason why a text is no height map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// A key is missing before the heights.
    #[error(
        "height map {name}: there is no `{key}`: begin with a line for each of ncols, nrows, xllcorner, yllcorner and cellsize"
    )]
    Key {
        /// Name of the text.
        name: String,
        /// The key.
        key: &'static str,
    },
    /// A word is unsound.
    #[error("height map {name}, line {line}, `{word}`: {advice}")]
    Word {
        /// Name of the text.
        name: String,
        /// Line, from 1.
        line: usize,
        /// What stands there.
        word: String,
        /// What to do.
        advice: String,
    },
    /// There are more or less heights than the header says.
    #[error(
        "height map {name}, line {line}: {found} heights where the header says {expected}: give nrows lines of ncols heights"
    )]
    Count {
        /// Name of the text.
        name: String,
        /// The last line that was read, from 1.
        line: usize,
        /// Heights up to there.
        found: usize,
        /// Heights of the map.
        expected: usize,
    },
}

/// Reads an ESRI ASCII grid. Its east is ahead, its north to the left; coordinates count from the start of the flight, and
/// heights stand in the middle of cells \[m\]. An error shows `name` as the name of the text.
///
/// # Errors
/// [`GridError`] for the first thing that is wrong.
pub fn ascii_grid(name: &str, text: &str) -> Result<Terrain, GridError> {
    let wrong = |line: usize, word: &str, advice: &str| GridError::Word {
        name: name.to_owned(),
        line,
        word: word.chars().take(SHOWN).collect(),
        advice: advice.to_owned(),
    };
    let number = |line: usize, word: &str| {
        let value = word.parse::<f64>().ok().filter(|it| it.is_finite());
        value.ok_or_else(|| {
            wrong(
                line,
                word,
                "give a number, with a point before its decimals",
            )
        })
    };
    let mut header = [None; KEYS.len()];
    let mut heights: Vec<f64> = Vec::new();
    let (mut last, mut shape) = (1, None);
    for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let mut words = text.split_whitespace().peekable();
        let Some(first) = words.peek() else {
            continue;
        };
        last = line;
        if shape.is_none() && first.starts_with(|it: char| it.is_ascii_alphabetic()) {
            let key = first.to_lowercase();
            let place = KEYS.iter().position(|it| *it == key);
            let place = place.ok_or_else(|| {
                wrong(
                    line,
                    first,
                    "give one of the keys of an ESRI ASCII grid with corners",
                )
            })?;
            header[place] = Some((line, number(line, words.nth(1).unwrap_or(""))?));
            continue;
        }
        let of = |key: usize| {
            header[key].ok_or_else(|| GridError::Key {
                name: name.to_owned(),
                key: KEYS[key],
            })
        };
        let count = |key: usize| {
            let (line, value) = of(key)?;
            let whole = value.fract() == 0.0 && (2.0..=1e6).contains(&value);
            let advice = "give a whole number from 2 to 1,000,000";
            whole
                .then_some(value as usize)
                .ok_or_else(|| wrong(line, KEYS[key], advice))
        };
        let (columns, rows) = match shape {
            Some(shape) => shape,
            None => {
                for key in 2..5 {
                    of(key)?;
                }
                *shape.insert((count(0)?, count(1)?))
            }
        };
        for word in words {
            let height = number(line, word)?;
            if header[5].is_some_and(|(_, none)| none.total_cmp(&height).is_eq()) {
                return Err(wrong(
                    line,
                    word,
                    "fill the gaps of the map: a flight needs the ground everywhere",
                ));
            }
            heights.push(height);
        }
        let expected = columns * rows;
        if heights.len() > expected {
            return Err(GridError::Count {
                name: name.to_owned(),
                line,
                found: heights.len(),
                expected,
            });
        }
    }
    let value = |key: usize| {
        let missing = || GridError::Key {
            name: name.to_owned(),
            key: KEYS[key],
        };
        header[key].map(|(_, value)| value).ok_or_else(missing)
    };
    let [columns, rows, east, north, cell] =
        [value(0)?, value(1)?, value(2)?, value(3)?, value(4)?];
    let expected = columns as usize * rows as usize;
    if heights.len() != expected || heights.is_empty() {
        return Err(GridError::Count {
            name: name.to_owned(),
            line: last,
            found: heights.len(),
            expected,
        });
    }
    Ok(Terrain {
        corner: [east + 0.5 * cell, -(north + (rows - 0.5) * cell)],
        cell,
        rows: heights
            .chunks(columns as usize)
            .map(<[f64]>::to_vec)
            .collect(),
    })
}
