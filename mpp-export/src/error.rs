//! The reason why a log cannot be exported.

/// The reason why a log cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// This program was built without the format of this name.
    #[error(
        "this program was built without {0}: build it with `--features formats`, or take `--format csv`"
    )]
    NotBuilt(&'static str),
    /// A value cannot be written; holds what the library of the format said.
    #[error("{0}: {1}")]
    Write(&'static str, String),
    /// A value of the log has no column: the key, and the table.
    #[error("`{0}` has no column in table {1}: add it to the schema")]
    NoColumn(String, &'static str),
}
