//! Stands in for the faults of tests in every image that is built without the feature `faults`.

/// Does nothing: this image has no faults.
pub fn planner(_: u32) {}

/// Does nothing: this image has no faults.
pub fn slice() {}

/// Does nothing: this image has no faults.
pub fn set_up(_: impl Fn()) {}

/// Does nothing: this image has no faults.
pub fn step(_: u32) {}
