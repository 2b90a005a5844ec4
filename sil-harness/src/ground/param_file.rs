//! Parameter files, as ground stations read and write them: a name and a value in each line.

use mpp_node::parameters::{PARAMETERS, Tuning};
use std::fmt::Write;

/// An error in a parameter file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: `{text}` is not NAME,VALUE")]
pub struct ParamFileError {
    /// The line, counted from 1.
    pub line: usize,
    /// Text of the line, or its beginning.
    pub text: String,
}

/// Greatest length of a name, and of a line's part in a message \[letters\]. No parameter has a name of
/// more than 16.
const LONGEST: usize = 60;

/// Reads names and values from the text of a file. A comma, blanks or both separate a name from its
/// value; `#` begins a comment.
///
/// # Errors
/// [`ParamFileError`] for the first line that is neither empty nor a name with a value.
pub fn parse(text: &str) -> Result<Vec<(String, f64)>, ParamFileError> {
    let mut values = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        let mut words = content
            .split(|c: char| c == ',' || c.is_whitespace())
            .filter(|word| !word.is_empty());
        let error = || ParamFileError {
            line: number + 1,
            text: line.chars().take(LONGEST).collect(),
        };
        let (Some(name), Some(value), None) = (words.next(), words.next(), words.next()) else {
            return Err(error());
        };
        if name.len() > LONGEST {
            return Err(error());
        }
        values.push((name.to_owned(), value.parse().map_err(|_| error())?));
    }
    Ok(values)
}

/// Formats every parameter in force, one per line.
#[must_use]
pub fn format(tuning: &Tuning) -> String {
    let mut text = String::new();
    for (name, value) in values(tuning) {
        // A write to a string cannot fail.
        let _ = writeln!(text, "{name},{value}");
    }
    text
}

/// Names and values of every parameter in force, in the order of their numbers.
pub fn values(tuning: &Tuning) -> impl Iterator<Item = (&'static str, f64)> {
    PARAMETERS
        .iter()
        .zip(0..)
        .filter_map(|(parameter, number)| Some((parameter.name, tuning.value(number)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_sim::scenario::{Preset, Scenario};

    fn tuning(preset: Preset) -> Tuning {
        Tuning::new(&Scenario::new(preset, 1).configure()).unwrap()
    }

    #[test]
    fn what_is_written_is_read_bit_for_bit() {
        for preset in [Preset::Reference, Preset::Paper, Preset::Flight] {
            let tuning = tuning(preset);
            let read = parse(&format(&tuning)).unwrap();
            let written = values(&tuning).map(|(name, value)| (name.to_owned(), value));
            assert!(read.into_iter().eq(written));
        }
    }

    #[test]
    fn other_tools_files_are_read() {
        let text =
            "# a comment\nMPP_PATHS,12\r\n\nMPP_ALT_M        48.5 # m\n  LQR_R_ELEVATOR , 2e-1\n";
        let expected = [
            ("MPP_PATHS", 12.0),
            ("MPP_ALT_M", 48.5),
            ("LQR_R_ELEVATOR", 0.2),
        ];
        let expected = expected.map(|(name, value)| (name.to_owned(), value));
        assert_eq!(parse(text).unwrap(), expected);
    }

    #[test]
    fn a_line_that_is_neither_is_named() {
        for line in [
            "MPP_PATHS",
            "MPP_PATHS,twelve",
            "MPP_PATHS,1,2",
            "MPP_PATHS,",
        ] {
            let error = parse(&format!("MPP_ALT_M,50\n{line}\n")).unwrap_err();
            assert_eq!((error.line, error.text.as_str()), (2, line));
        }
    }
}
