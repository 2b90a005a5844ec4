//! A table: columns as the schema has them, and rows of JSON values.

use crate::error::ExportError;
use crate::schema::{Column, Schema};
use serde_json::{Map, Value};

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name and columns.
    pub schema: &'static Schema,
    /// One value for each column and row; null where there is none.
    pub rows: Vec<Vec<Value>>,
}

impl Table {
    /// A table of objects. A key that an object lacks is null.
    ///
    /// # Errors
    /// [`ExportError::NoColumn`] for a key that no column has, so that nothing is lost.
    pub fn of_objects(
        schema: &'static Schema,
        objects: impl IntoIterator<Item = Map<String, Value>>,
    ) -> Result<Self, ExportError> {
        let row = |mut object: Map<String, Value>| {
            let values = schema.columns.iter().map(|column| {
                let value = object.remove(column.name);
                value.unwrap_or(Value::Null)
            });
            let values = values.collect();
            match object.keys().next() {
                Some(key) => Err(ExportError::NoColumn(key.clone(), schema.name)),
                None => Ok(values),
            }
        };
        let rows = objects.into_iter().map(row).collect::<Result<_, _>>()?;
        Ok(Self { schema, rows })
    }

    /// Each column with its values.
    pub fn columns(&self) -> impl Iterator<Item = (&'static Column, Vec<&Value>)> {
        let columns = self.schema.columns.iter().enumerate();
        columns.map(|(place, column)| {
            let values = self.rows.iter().filter_map(|row| row.get(place));
            (column, values.collect())
        })
    }
}
