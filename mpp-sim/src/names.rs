//! Names on the command line, in files and in logs.

/// A name that is not known.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {kind} `{name}`: give {}", .known.join(", "))]
pub struct UnknownName {
    /// Kind of thing that the name should denote.
    pub kind: &'static str,
    /// The name.
    pub name: String,
    /// The known names.
    pub known: Vec<&'static str>,
}

/// Finds the element of `all` with this name.
pub(crate) fn find<T: Copy>(
    kind: &'static str,
    all: &[T],
    name: fn(T) -> &'static str,
    text: &str,
) -> Result<T, UnknownName> {
    let found = all.iter().copied().find(|one| name(*one) == text);
    found.ok_or_else(|| UnknownName {
        kind,
        name: text.to_owned(),
        known: all.iter().copied().map(name).collect(),
    })
}
