//! How far a trajectory reaches.

use mpp_core::config::{STAGE_PERIOD, STAGES};

/// Length of a trajectory \[s\].
pub(crate) const HORIZON: f64 = STAGES as f64 * STAGE_PERIOD;
