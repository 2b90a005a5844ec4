//! CSV as RFC 4180 describes it: one line of names, then a line for each row. A null is empty.

use crate::table::Table;
use serde_json::Value;

/// The bytes of the file.
#[must_use]
pub fn csv(table: &Table) -> Vec<u8> {
    let names = table
        .schema
        .columns
        .iter()
        .map(|column| column.name.to_owned());
    let mut text = names.collect::<Vec<_>>().join(",") + "\n";
    for row in &table.rows {
        let cells: Vec<String> = row.iter().map(cell).collect();
        text += &cells.join(",");
        text.push('\n');
    }
    text.into_bytes()
}

/// A value as text. JSON's numbers are CSV's, and read back to the same bits.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) if text.contains([',', '"', '\n', '\r']) => {
            format!("\"{}\"", text.replace('"', "\"\""))
        }
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::SENSORS;
    use serde_json::json;

    #[test]
    fn marks_in_a_text_are_quoted_and_a_null_is_empty() {
        let rows = vec![vec![json!(7), json!("a \"b\", c"), Value::Null]];
        let table = Table {
            schema: &SENSORS,
            rows,
        };
        let text = String::from_utf8(csv(&table)).unwrap();
        assert_eq!(text, "tick,sensor,state\n7,\"a \"\"b\"\", c\",\n");
    }
}
