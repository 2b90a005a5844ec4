//! When what was asked for.

/// When what was asked for \[us\], and what the user was told of the answers.
#[derive(Default)]
pub(super) struct Asked {
    pub(super) second: Option<u64>,
    pub(super) sync: Option<u64>,
    /// Whether the user was told what was verified.
    pub(super) told: bool,
    pub(super) flaw: Option<String>,
}
