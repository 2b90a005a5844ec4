//! The table of budgets in docs/validation/firmware.md.

use crate::folders::root;
use crate::limits::{budget, worst};
use anyhow::{Context, Result, ensure};
use toml_edit::DocumentMut;

/// The page that holds the table.
const PAGE: &str = "docs/validation/firmware.md";
const BEGIN: &str = "<!-- budgets: written by `cargo xtask budget --save` -->\n";
const END: &str = "<!-- end of budgets -->\n";

/// Rows of the table: label, table, name. Without a name it is the greatest figure of the table.
const ROWS: [(&str, &str, &str); 10] = [
    ("flash", "bytes", "flash"),
    ("static RAM", "bytes", "static_ram"),
    ("stack, bound over all paths", "bytes", "stack_bound"),
    ("static RAM and stack together", "bytes", "ram"),
    ("100 Hz step with its link, mean", "step", "mean"),
    ("100 Hz step with its link, worst", "step", "worst"),
    ("slice of preset `flight`, worst", "slice_worst_flight", ""),
    (
        "cycle, `flight`, 20 obstacles, median",
        "cycle",
        "flight_20_median",
    ),
    (
        "cycle, `reference`, 20 obstacles, median",
        "cycle",
        "reference_20_median",
    ),
    (
        "cycle, `flight`, 40 obstacles, worst",
        "cycle",
        "flight_40_worst",
    ),
];

fn table(document: &DocumentMut) -> Result<String> {
    let mut text = "| on a Cortex-M7, 25 candidates | budget |\n|---|---|\n".to_owned();
    for (label, table, name) in ROWS {
        let value = if name.is_empty() {
            worst(document, table)?
        } else {
            budget(document, table, name)?
        };
        let value = match (table, value) {
            ("bytes", bytes) => format!("{} kB", bytes.div_ceil(1000)),
            (_, count) if count >= 1_000_000 => {
                let tenths = count.div_ceil(100_000);
                format!("{}.{} million instructions", tenths / 10, tenths % 10)
            }
            (_, count) => format!("{} instructions", grouped(count)),
        };
        text += &format!("| {label} | {value} |\n");
    }
    Ok(text)
}

/// Formats a number with commas between thousands.
fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The page's parts before, within and after the table.
fn parts(text: &str) -> Result<(&str, &str, &str)> {
    let (before, rest) = text
        .split_once(BEGIN)
        .with_context(|| format!("{PAGE} has no place for budgets"))?;
    let (within, after) = rest
        .split_once(END)
        .with_context(|| format!("{PAGE}: the budgets have no end"))?;
    Ok((before, within, after))
}

/// Writes the table to the page.
pub(crate) fn write(document: &DocumentMut) -> Result<()> {
    let path = root().join(PAGE);
    let text = std::fs::read_to_string(&path)?;
    let (before, _, after) = parts(&text)?;
    let table = table(document)?;
    std::fs::write(&path, format!("{before}{BEGIN}{table}{END}{after}"))?;
    Ok(())
}

/// Checks that the page's table shows the budgets of docs/budgets.toml.
pub(crate) fn check(document: &DocumentMut) -> Result<()> {
    let text = std::fs::read_to_string(root().join(PAGE))?;
    let (_, within, _) = parts(&text)?;
    ensure!(
        within == table(document)?,
        "the budgets of {PAGE} are not those of docs/budgets.toml: cargo xtask budget --save"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{check, grouped, parts};

    #[test]
    fn thousands_are_grouped() {
        assert_eq!(
            [7, 1000, 123_456, 1_234_567].map(grouped),
            ["7", "1,000", "123,456", "1,234,567"]
        );
    }

    #[test]
    fn a_page_without_a_place_is_an_error() {
        assert!(parts("no table").is_err());
    }

    #[test]
    fn the_page_shows_the_budgets_of_the_file() -> anyhow::Result<()> {
        let mut document = crate::limits::read()?;
        check(&document)?;
        document["firmware"]["bytes"]["flash"] = toml_edit::value(1_000_000);
        assert!(check(&document).is_err());
        Ok(())
    }
}
