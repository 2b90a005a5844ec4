//! The first line of a row file: which campaign its rows are of, and which program flew them.

use crate::campaign::{Campaign, Cell, Shard};
use mpp_sim::scenario::TICKS_PER_SECOND;
use serde::{Deserialize, Serialize};

/// Version of the rows' layout.
const ROWS: u32 = 3;

/// A row file's first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Version of the rows' layout.
    rows: u32,
    /// Version of the program.
    package_version: String,
    /// Log hashes of the campaign's first seconds, one for each planner. They show which program flew the rows,
    /// because rows of different programs must not be mixed.
    pub fingerprint: String,
    /// The campaign.
    pub campaign: Campaign,
    /// The part of the campaign that this file holds.
    pub shard: Shard,
}

impl Header {
    /// The header of a file that this program writes. `hash` flies a cell's seed and gives the log's hash.
    ///
    /// # Errors
    /// The error of `hash`.
    pub fn new<E>(
        campaign: Campaign,
        shard: Shard,
        hash: impl Fn(&Campaign, &Cell, u64) -> Result<String, E>,
    ) -> Result<Self, E> {
        const SECONDS: u32 = 2;
        let mut start = campaign.clone();
        start.scenario.duration = Some(f64::from(SECONDS));
        // A fault that begins later is none of this start, and would be refused in so short a flight.
        start.scenario.faults = campaign.scenario.faults.within(SECONDS * TICKS_PER_SECOND);
        let mut cells = campaign.cells();
        cells.dedup_by_key(|cell| (cell.preset, cell.oracle));
        let hashes = cells.iter().map(|cell| hash(&start, cell, campaign.seed));
        Ok(Self {
            rows: ROWS,
            package_version: env!("CARGO_PKG_VERSION").to_owned(),
            fingerprint: hashes.collect::<Result<Vec<String>, E>>()?.join("-"),
            campaign,
            shard,
        })
    }

    /// The first key in which another header differs, with both values.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let flat = |header: &Self| {
            let mut keys = serde_json::to_value(header).unwrap_or_default();
            let campaign = keys["campaign"].take();
            (keys, campaign)
        };
        let ((outer, inner), (other_outer, other_inner)) = (flat(self), flat(other));
        [(inner, other_inner), (outer, other_outer)]
            .iter()
            .find_map(|(own, others)| {
                let keys = own.as_object()?;
                let (key, value) = keys
                    .iter()
                    .find(|(key, value)| others[key.as_str()] != **value)?;
                Some(format!(
                    "its {key} is {}, not {value}",
                    others[key.as_str()]
                ))
            })
    }
}
