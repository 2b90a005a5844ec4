//! The table of a campaign's rows.

use crate::error::ExportError;
use crate::schema::ROWS;
use crate::table::Table;
use mpp_analysis::campaign::Row;
use serde_json::{Map, Value};

/// The table of these rows.
///
/// # Errors
/// [`ExportError::NoColumn`] when a row has a value that the schema does not know.
pub fn table(rows: &[Row]) -> Result<Table, ExportError> {
    let objects = rows.iter().map(object).collect::<Result<Vec<_>, _>>()?;
    Table::of_objects(&ROWS, objects)
}

/// A row as a flat object. What a row file leaves out because it is usual is written.
fn object(row: &Row) -> Result<Map<String, Value>, ExportError> {
    let failed = |error: serde_json::Error| ExportError::Write(ROWS.name, error.to_string());
    let Value::Object(mut object) = serde_json::to_value(row).map_err(failed)? else {
        return Ok(Map::new());
    };
    object.insert(
        "generator".to_owned(),
        row.cell.generator.to_string().into(),
    );
    object.insert("known_collision".to_owned(), row.known_collision.into());
    if let Some(Value::Object(failure)) = object.remove("failure") {
        let flat = failure
            .into_iter()
            .map(|(key, value)| (format!("failure_{key}"), value));
        object.extend(flat);
    }
    Ok(object)
}
