//! How much a text to a station matters.

/// The severity of a text, with the numbers of MAV_SEVERITY.
#[derive(Clone, Copy, Debug)]
pub(super) enum Severity {
    Critical = 2,
    Warning = 4,
    Notice = 5,
    Info = 6,
}
