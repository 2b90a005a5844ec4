//! What the parser of TOML says of a text.

/// Greatest length of a message that repeats a line of the file \[bytes\].
const LONGEST_MESSAGE: usize = 1000;

/// The place and the cause of an error, to stand after the name of the text.
pub(crate) fn place_and_cause(error: &toml::de::Error) -> String {
    let text = error.to_string();
    // A key that is missing has no line: the parser shows that of its table, or the first one.
    if error.message().starts_with("missing field") {
        let line = text.lines().nth(2).and_then(|line| line.split_once("| "));
        let table = line.filter(|(_, shown)| shown.starts_with('['));
        let table = table.map_or(String::new(), |(_, shown)| {
            format!("table {}: ", shown.trim())
        });
        return format!(": {table}{}", error.message());
    }
    // The parser repeats the line, however long it is.
    if text.len() <= LONGEST_MESSAGE {
        return format!(": {}", text.trim_end());
    }
    let place = error.span().map_or(0, |span| span.start);
    format!(", byte {place}: {}", error.message())
}
