//! Campaigns: many flights over a grid of presets, obstacles, paths and replanning rates.
//!
//! Neither the number of threads nor the split into shards changes a row.
//! [`mpp_analysis::campaign`] defines the flights and evaluates the rows.

mod engine;
mod error;
mod store;

pub(crate) use engine::pool;
pub use engine::{Extras, decide_all, header, run, run_faults, run_pairs};
pub use error::CampaignError;
pub use store::{RowFile, Sheet, parse_rows, read};

#[cfg(test)]
mod tests;
