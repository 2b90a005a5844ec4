//! An aircraft in a scenario file: the name of a known one, or a table.

use super::AircraftFile;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use std::fmt;

impl AircraftFile {
    /// Reads a name or a table.
    ///
    /// # Errors
    /// The deserializer's error.
    pub fn named_or_table<'a, D: Deserializer<'a>>(input: D) -> Result<Option<Self>, D::Error> {
        struct NameOrTable;
        impl<'a> Visitor<'a> for NameOrTable {
            type Value = AircraftFile;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of an aircraft or a table of its numbers")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<AircraftFile, E> {
                AircraftFile::known(name).ok_or_else(|| {
                    let known = AircraftFile::KNOWN.map(|(known, _)| known).join(", ");
                    E::custom(format!(
                        "there is no aircraft `{name}`: give {known} or a table"
                    ))
                })
            }

            fn visit_map<A: MapAccess<'a>>(self, map: A) -> Result<AircraftFile, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(map))
            }
        }
        input.deserialize_any(NameOrTable).map(Some)
    }
}
