//! One flight of a campaign.

use super::Cell;
use crate::log::{FlightLog, Summary};
use crate::outcome::Outcome;
use serde::{Deserialize, Serialize};

/// One flight: what was flown and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What was flown.
    #[serde(flatten)]
    pub cell: Cell,
    /// Its seed.
    pub seed: u64,
    /// Success by the paper's rule.
    pub success: bool,
    /// What came of it, as in the flight's log.
    #[serde(flatten)]
    pub summary: Summary,
    /// The flight log's hash.
    pub log_hash: String,
    /// Wall time that the core worked [ms], if asked for: no part of what a seed determines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub core_ms: Option<f64>,
}

impl Row {
    /// The row of a flight.
    #[must_use]
    pub fn new(cell: Cell, log: &FlightLog, log_hash: String, core_ms: Option<f64>) -> Self {
        Self {
            cell,
            seed: log.header.seed,
            success: log.summary.outcome == Outcome::Survived,
            summary: log.summary,
            log_hash,
            core_ms,
        }
    }

    /// Whether two rows tell the same of a flight; the wall time is left aside.
    #[must_use]
    pub fn agrees(&self, other: &Self) -> bool {
        let timeless = |row: &Self| Self {
            core_ms: None,
            ..row.clone()
        };
        timeless(self) == timeless(other)
    }
}
