//! What several tests share.

pub(crate) mod airframes;
pub(crate) mod cells;
pub(crate) mod clearance;
pub(crate) mod completed;
pub(crate) mod dense;
pub(crate) mod draw;
pub(crate) mod gaussian;
pub(crate) mod grids;
pub(crate) mod horizon;
pub(crate) mod lively;
pub(crate) mod planning;
pub(crate) mod pose;
pub(crate) mod presets;
pub(crate) mod rolling_grid;
pub(crate) mod scattered;
pub(crate) mod seeded;
pub(crate) mod sensors;
pub(crate) mod trajectories;
pub(crate) mod with_planner;
pub(crate) mod world;
