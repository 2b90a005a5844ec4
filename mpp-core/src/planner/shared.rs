//! What both planners share: the size of a slice.

/// Number of solver steps in one slice.
pub(crate) const STEPS_PER_SLICE: usize = 8;
