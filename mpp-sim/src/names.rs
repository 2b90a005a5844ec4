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

/// Writes and reads a type by the names of its elements, `ALL` and `name`.
macro_rules! by_name {
    ($type:ident, $kind:literal) => {
        impl core::fmt::Display for $type {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl core::str::FromStr for $type {
            type Err = $crate::names::UnknownName;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                $crate::names::find($kind, &Self::ALL, Self::name, text)
            }
        }
    };
}
pub(crate) use by_name;
