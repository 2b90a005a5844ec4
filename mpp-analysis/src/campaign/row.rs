//! One flight of a campaign.

use super::grid::Cell;
use crate::ceiling::avoidable;
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::log::{FlightLog, Summary};
use mpp_sim::outcome::Outcome;
use mpp_sim::scenario::Scenario;
use serde::{Deserialize, Serialize};

/// One flight: its cell, its seed and its summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Cell of the flight.
    #[serde(flatten)]
    pub cell: Cell,
    /// Seed of the flight.
    pub seed: u64,
    /// Whether the flight is a success by the paper's rule.
    pub success: bool,
    /// Summary of the flight, as in its log.
    #[serde(flatten)]
    pub summary: Summary,
    /// Whether it collided with an obstacle that a beam had met more than 1 s before; not written if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub known_collision: bool,
    /// Whether commands of its last two seconds could have avoided such a collision; not written if that is undecided, or
    /// nobody asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub avoidable: Option<bool>,
    /// The flight log's hash; empty in a campaign that keeps no rows.
    pub log_hash: String,
    /// Wall time of the core's work \[ms\], if it was measured. A seed does not determine it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub core_ms: Option<f64>,
}

impl Row {
    /// The row of a flight, with nothing that costs time: neither hash nor judgement.
    #[must_use]
    pub fn new(cell: Cell, log: &FlightLog, observer: &FlightObserver) -> Self {
        Self {
            cell,
            seed: log.header.seed,
            success: log.summary.outcome == Outcome::Survived,
            summary: log.summary,
            known_collision: observer.known_collision(log),
            avoidable: None,
            log_hash: String::new(),
            core_ms: None,
        }
    }

    /// The row with its collision judged, if it is one with a known obstacle.
    #[must_use]
    pub fn judged(self, scenario: &Scenario, observer: &FlightObserver) -> Self {
        // Of a field that cannot be judged nothing is proven.
        let verdict = || avoidable(scenario, observer).ok().flatten();
        let avoidable = self.known_collision.then(verdict).flatten();
        Self { avoidable, ..self }
    }

    /// Whether two rows agree about a flight. The wall time does not count.
    #[must_use]
    pub fn agrees(&self, other: &Self) -> bool {
        let timeless = |row: &Self| Self {
            core_ms: None,
            ..row.clone()
        };
        timeless(self) == timeless(other)
    }
}
