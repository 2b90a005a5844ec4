//! What several tests share.

pub(crate) mod cells;
pub(crate) mod dense;
pub(crate) mod draw;
pub(crate) mod grids;
pub(crate) mod motion;
pub(crate) mod planning;
pub(crate) mod rolling_grid;
pub(crate) mod seeded;
pub(crate) mod sensors;
pub(crate) mod trajectories;
pub(crate) mod world;
