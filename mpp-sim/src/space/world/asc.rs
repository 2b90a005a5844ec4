//! Height maps as ESRI ASCII grids, as surveys give them.

use super::terrain::Terrain;
use std::ops::RangeBounds;

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
    let mut header = Header {
        name,
        values: [None; KEYS.len()],
    };
    let mut heights: Vec<f64> = Vec::new();
    let (mut last, mut shape) = (1, None);
    for (line, text) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let Some(first) = text.split_whitespace().next() else {
            continue;
        };
        last = line;
        if shape.is_none() && first.starts_with(|it: char| it.is_ascii_alphabetic()) {
            header.take(line, text)?;
            continue;
        }
        let [columns, rows] = match shape {
            Some(shape) => shape,
            None => *shape.insert(header.shape()?),
        };
        for word in text.split_whitespace() {
            heights.push(header.height(line, word)?);
        }
        header.count(line, heights.len(), ..=columns * rows)?;
    }
    let [columns, rows] = header.shape()?;
    header.count(last, heights.len(), columns * rows..=columns * rows)?;
    let (cell, north) = (header.value(4)?, header.value(3)?);
    Ok(Terrain {
        corner: [
            header.value(2)? + 0.5 * cell,
            -(north + (rows as f64 - 0.5) * cell),
        ],
        cell,
        rows: heights.chunks(columns).map(<[f64]>::to_vec).collect(),
    })
}

/// What stands before the heights: for each key its line and its value.
struct Header<'a> {
    name: &'a str,
    values: [Option<(usize, f64)>; KEYS.len()],
}

impl Header<'_> {
    /// Takes a line with a key.
    fn take(&mut self, line: usize, text: &str) -> Result<(), GridError> {
        let mut words = text.split_whitespace();
        let (key, value) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
        let place = KEYS.iter().position(|it| *it == key.to_lowercase());
        let advice = "give one of the keys of an ESRI ASCII grid with corners";
        let place = place.ok_or_else(|| self.wrong(line, key, advice))?;
        self.values[place] = Some((line, self.number(line, value)?));
        Ok(())
    }

    fn value(&self, key: usize) -> Result<f64, GridError> {
        let missing = || GridError::Key {
            name: self.name.to_owned(),
            key: KEYS[key],
        };
        self.values[key].map(|(_, value)| value).ok_or_else(missing)
    }

    /// Numbers of columns and rows, once no key is missing.
    fn shape(&self) -> Result<[usize; 2], GridError> {
        for key in 0..5 {
            self.value(key)?;
        }
        let count = |key: usize| {
            let (line, value) = self.values[key].unwrap_or_default();
            let whole = value.fract() == 0.0 && (2.0..=1e6).contains(&value);
            let advice = "give a whole number from 2 to 1,000,000";
            whole
                .then_some(value as usize)
                .ok_or_else(|| self.wrong(line, KEYS[key], advice))
        };
        Ok([count(0)?, count(1)?])
    }

    fn height(&self, line: usize, word: &str) -> Result<f64, GridError> {
        let height = self.number(line, word)?;
        if self.values[5].is_some_and(|(_, none)| none.total_cmp(&height).is_eq()) {
            let advice = "fill the gaps of the map: a flight needs the ground everywhere";
            return Err(self.wrong(line, word, advice));
        }
        Ok(height)
    }

    /// Whether so many heights are right at a line.
    fn count(
        &self,
        line: usize,
        found: usize,
        right: impl RangeBounds<usize>,
    ) -> Result<(), GridError> {
        if right.contains(&found) {
            return Ok(());
        }
        let [columns, rows] = self.shape()?;
        Err(GridError::Count {
            name: self.name.to_owned(),
            line,
            found,
            expected: columns * rows,
        })
    }

    fn number(&self, line: usize, word: &str) -> Result<f64, GridError> {
        let value = word.parse::<f64>().ok().filter(|it| it.is_finite());
        let advice = "give a number, with a point before its decimals";
        value.ok_or_else(|| self.wrong(line, word, advice))
    }

    fn wrong(&self, line: usize, word: &str, advice: &str) -> GridError {
        GridError::Word {
            name: self.name.to_owned(),
            line,
            word: word.chars().take(SHOWN).collect(),
            advice: advice.to_owned(),
        }
    }
}
