//! Tables of a flight's log.

use crate::error::ExportError;
use crate::schema::{LATERAL, PLANS, REJECTIONS, SENSORS, Schema, TICKS};
use crate::table::Table;
use mpp_sim::log::FlightLog;
use serde_json::{Map, Value};

/// The tables of a flight, in the order of the log.
pub const TABLES: [&Schema; 4] = [&TICKS, &PLANS, &REJECTIONS, &SENSORS];

/// One of the tables of a flight.
///
/// # Errors
/// [`ExportError::NoColumn`] when the log has a value that the schema does not know.
pub fn table(log: &FlightLog, schema: &'static Schema) -> Result<Table, ExportError> {
    let failed = |error: serde_json::Error| ExportError::Write(schema.name, error.to_string());
    let value = match schema.name {
        "ticks" => return ticks(log),
        "lateral" => return lateral(log),
        "plans" => serde_json::to_value(&log.plans),
        "rejections" => serde_json::to_value(&log.rejections),
        "sensors" => serde_json::to_value(&log.sensors),
        _ => Ok(Value::Null),
    };
    Table::of_objects(schema, objects(value.map_err(failed)?))
}

fn objects(value: Value) -> Vec<Map<String, Value>> {
    let Value::Array(entries) = value else {
        return Vec::new();
    };
    let object = |entry| match entry {
        Value::Object(object) => Some(object),
        _ => None,
    };
    entries.into_iter().filter_map(object).collect()
}

/// The ticks: a log has a list for each column.
fn ticks(log: &FlightLog) -> Result<Table, ExportError> {
    let value = serde_json::to_value(&log.ticks);
    of_columns(&TICKS, value, log.ticks.t.len())
}

/// The lateral part, with the time beside.
fn lateral(log: &FlightLog) -> Result<Table, ExportError> {
    let value = serde_json::to_value(&log.lateral).map(|mut value| {
        if let Value::Object(columns) = &mut value {
            columns.insert("t".to_owned(), log.ticks.t.clone().into());
        }
        value
    });
    of_columns(&LATERAL, value, log.lateral.y.len())
}

fn of_columns(
    schema: &'static Schema,
    value: serde_json::Result<Value>,
    rows: usize,
) -> Result<Table, ExportError> {
    let failed = |error: serde_json::Error| ExportError::Write(schema.name, error.to_string());
    let Value::Object(columns) = value.map_err(failed)? else {
        return Table::of_objects(schema, []);
    };
    let row = |tick: usize| -> Map<String, Value> {
        let value = |(name, list): (&String, &Value)| (name.clone(), list[tick].clone());
        columns.iter().map(value).collect()
    };
    Table::of_objects(schema, (0..rows).map(row))
}
