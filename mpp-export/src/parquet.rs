//! Parquet, through the crate of the same name.

use crate::error::ExportError;
use crate::table::Table;

/// The bytes of the file: one row group, without compression. Units, frames and meanings stand in the metadata
/// under `mpp.columns`, as JSON.
///
/// # Errors
/// [`ExportError::NotBuilt`] without the cargo feature `formats`; [`ExportError::Write`] if the library refuses.
pub fn parquet(table: &Table) -> Result<Vec<u8>, ExportError> {
    #[cfg(feature = "formats")]
    return write::parquet(table).map_err(|why| ExportError::Write("Parquet", why.to_string()));
    #[cfg(not(feature = "formats"))]
    {
        let _ = table;
        Err(ExportError::NotBuilt("Parquet"))
    }
}

#[cfg(feature = "formats")]
mod write {
    use crate::schema::{Column, Kind, VERSION};
    use crate::table::Table;
    use parquet::basic::{ConvertedType, Repetition, Type as Physical};
    use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
    use parquet::errors::Result;
    use parquet::file::metadata::KeyValue;
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
    use parquet::schema::types::Type;
    use serde_json::{Value, json};
    use std::sync::Arc;

    pub(super) fn parquet(table: &Table) -> Result<Vec<u8>> {
        let fields = table.schema.columns.iter().map(field);
        let schema = Type::group_type_builder(table.schema.name)
            .with_fields(fields.collect::<Result<Vec<_>>>()?)
            .build()?;
        let properties = WriterProperties::builder()
            .set_key_value_metadata(Some(metadata(table)))
            .build();
        let mut file =
            SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
        let mut group = file.next_row_group()?;
        for (column, values) in table.columns() {
            if let Some(mut writer) = group.next_column()? {
                write(&mut writer, column.kind, &values)?;
                writer.close()?;
            }
        }
        group.close()?;
        file.into_inner()
    }

    fn field(column: &Column) -> Result<Arc<Type>> {
        let (physical, converted) = match column.kind {
            Kind::Real => (Physical::DOUBLE, ConvertedType::NONE),
            Kind::Whole => (Physical::INT64, ConvertedType::UINT_64),
            Kind::Truth => (Physical::BOOLEAN, ConvertedType::NONE),
            Kind::Text => (Physical::BYTE_ARRAY, ConvertedType::UTF8),
        };
        let builder = Type::primitive_type_builder(column.name, physical);
        let field = builder
            .with_repetition(Repetition::OPTIONAL)
            .with_converted_type(converted);
        Ok(Arc::new(field.build()?))
    }

    fn metadata(table: &Table) -> Vec<KeyValue> {
        let column = |column: &Column| {
            let about =
                json!({ "unit": column.unit, "frame": column.frame, "about": column.about });
            (column.name.to_owned(), about)
        };
        let columns: serde_json::Map<String, Value> =
            table.schema.columns.iter().map(column).collect();
        vec![
            KeyValue::new("mpp.schema_version".to_owned(), VERSION.to_string()),
            KeyValue::new("mpp.table".to_owned(), table.schema.name.to_owned()),
            KeyValue::new("mpp.columns".to_owned(), Value::from(columns).to_string()),
        ]
    }

    fn write(writer: &mut SerializedColumnWriter<'_>, kind: Kind, values: &[&Value]) -> Result<()> {
        match kind {
            Kind::Real => batch::<DoubleType>(writer, values, Value::as_f64),
            // Parquet keeps whole numbers without a sign in the bits of those with one.
            Kind::Whole => {
                batch::<Int64Type>(writer, values, |value| Some(value.as_u64()?.cast_signed()))
            }
            Kind::Truth => batch::<BoolType>(writer, values, Value::as_bool),
            Kind::Text => batch::<ByteArrayType>(writer, values, |value| {
                Some(ByteArray::from(value.as_str()?))
            }),
        }
    }

    fn batch<T: DataType>(
        writer: &mut SerializedColumnWriter<'_>,
        values: &[&Value],
        read: impl Fn(&Value) -> Option<T::T>,
    ) -> Result<()> {
        let read: Vec<Option<T::T>> = values.iter().map(|value| read(value)).collect();
        let levels: Vec<i16> = read
            .iter()
            .map(|value| i16::from(value.is_some()))
            .collect();
        let there: Vec<T::T> = read.into_iter().flatten().collect();
        writer
            .typed::<T>()
            .write_batch(&there, Some(&levels), None)?;
        Ok(())
    }
}
