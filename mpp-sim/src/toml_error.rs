//! What the parser of TOML says of a text.

/// Greatest length of a message that repeats a line of the file \[bytes\].
const LONGEST_MESSAGE: usize = 1000;

/// The form of a text of another program, by its first line, in which the parser found an error.
fn foreign(first: &str) -> Option<&'static str> {
    let word = first.split(['(', ' ']).next().unwrap_or_default();
    match first.trim_start().chars().next()? {
        '<' => Some("XML"),
        '{' => Some("JSON"),
        _ if word.len() > 4 && word.chars().all(|it| it.is_ascii_uppercase()) => Some("WKT"),
        _ if first.contains(',') && !first.contains(['=', '[', '#']) => Some("CSV"),
        _ => None,
    }
}

/// The place and the cause of an error, to stand after the name of the text.
pub(crate) fn place_and_cause(error: &toml::de::Error) -> String {
    let text = error.to_string();
    let first = text
        .lines()
        .nth(2)
        .and_then(|line| line.strip_prefix("1 | "));
    if let Some(form) = first.and_then(foreign) {
        return format!(": it is {form}, and this file has to be TOML: see docs/ for its keys");
    }
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
