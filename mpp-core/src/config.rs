//! All compile-time sizes and rates, but those of the paper's method (`paper::config`).

/// Period of the flight loop \[s\].
pub const TICK_PERIOD: f64 = 0.01;

/// Stages of the planning horizon (paper, section III-D: 4.5 s at 0.25 s).
pub const STAGES: usize = 18;
/// Number of stage boundaries, the start included.
pub const KNOTS: usize = STAGES + 1;
/// Length of a stage \[s\].
pub const STAGE_PERIOD: f64 = 0.25;

/// Number of rays around each collocation point; each ray gives one half-plane (paper, section III-B).
pub const DIRECTIONS: usize = 8;

/// Greatest number of candidate paths in one cycle.
pub const MAX_PATHS: usize = 50;

/// Greatest number of beams in a lidar scan.
pub const MAX_BEAMS: usize = 128;
