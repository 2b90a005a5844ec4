//! Why there is no world.

/// Greatest coordinate of a body \[m\]: that of field files.
pub const FARTHEST: f64 = 1e5;

/// The reason why there is no world.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A body is unsound.
    #[error("body {number}, {key}: {advice}")]
    Body {
        /// Its number, from 1.
        number: usize,
        /// The value at fault.
        key: &'static str,
        /// What to do.
        advice: String,
    },
    /// A parameter of a generator or of the extent is unsound.
    #[error("{key}: {advice}")]
    Value {
        /// The parameter.
        key: &'static str,
        /// What to do.
        advice: String,
    },
    /// The aircraft would start in a body.
    #[error("the aircraft touches a body or the ground at its start: move the bodies or the start")]
    Start,
}
