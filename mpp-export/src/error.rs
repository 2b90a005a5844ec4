//! The reason why a log cannot be exported.

use std::fmt;

/// The reason why a log cannot be exported.
#[derive(Debug)]
pub enum ExportError {
    /// This program was built without the format of this name.
    NotBuilt(&'static str),
    /// A value cannot be written; holds what the library of the format said.
    Write(&'static str, String),
    /// A value of the log has no column: the key, and the table.
    NoColumn(String, &'static str),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotBuilt(format) => write!(
                f,
                "this program was built without {format}: build it with `--features formats`, or take `--format csv`"
            ),
            Self::Write(format, why) => write!(f, "{format}: {why}"),
            Self::NoColumn(key, table) => {
                write!(
                    f,
                    "`{key}` has no column in table {table}: add it to the schema"
                )
            }
        }
    }
}

impl std::error::Error for ExportError {}
