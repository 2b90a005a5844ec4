//! One flight of a campaign.

use super::Cell;
use crate::log::FlightLog;
use crate::outcome::{Class, Outcome};
use serde::{Deserialize, Serialize};

/// One flight: what was flown and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What was flown.
    #[serde(flatten)]
    pub cell: Cell,
    /// Its seed.
    pub seed: u64,
    /// What it is counted as.
    pub class: Class,
    /// What ended it, by the paper's rule.
    pub outcome: Outcome,
    /// Success by the paper's rule.
    pub success: bool,
    /// Success by the strict rule.
    pub strict: bool,
    /// Time at the end [s].
    pub t_end: f64,
    /// Downrange distance at the end [m].
    pub x_end: f64,
    /// Least distance to an obstacle's edge [m]; null without obstacles.
    pub min_clearance: Option<f64>,
    /// Greatest distance from the initial altitude [m].
    pub max_altitude_deviation: f64,
    /// Plans delivered.
    pub replans: u32,
    /// Candidates over all plans.
    pub candidates: u32,
    /// Feasible candidates over all plans.
    pub feasible: u32,
    /// Slices of planning work over all plans.
    pub slices: u64,
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
        let summary = &log.summary;
        Self {
            cell,
            seed: log.header.seed,
            class: summary.class,
            outcome: summary.outcome,
            success: summary.outcome == Outcome::Survived,
            strict: summary.strict,
            t_end: summary.t_end,
            x_end: summary.x_end,
            min_clearance: summary.min_clearance,
            max_altitude_deviation: summary.max_altitude_deviation,
            replans: summary.replans,
            candidates: summary.candidates,
            feasible: summary.feasible,
            slices: summary.slices,
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
