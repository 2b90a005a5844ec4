//! The failures of a cell by their causes.

use super::row::Row;
use mpp_sim::inquest::Cause;
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The failures with one cause.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CauseReport {
    /// The cause.
    pub cause: Cause,
    /// Number of flights that failed with this cause.
    pub flights: u32,
    /// Number of these flights whose fields the oracle flies; only in campaigns with an oracle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub oracle_flies: Option<u32>,
    /// Seed of the first of these flights, for a closer look.
    pub seed: u64,
}

/// Failures by cause, the most frequent first.
pub(super) fn causes(rows: &[&Row], oracle: Option<&[&Row]>) -> Vec<CauseReport> {
    let flown = |row: &&&Row| row.summary.strict;
    let oracle: Option<Vec<u64>> =
        oracle.map(|rows| rows.iter().filter(flown).map(|row| row.seed).collect());
    let mut causes: BTreeMap<Cause, CauseReport> = BTreeMap::new();
    for row in rows {
        let Some(failure) = row.summary.failure else {
            continue;
        };
        let entry = causes.entry(failure.cause).or_insert(CauseReport {
            cause: failure.cause,
            flights: 0,
            oracle_flies: oracle.as_ref().map(|_| 0),
            seed: row.seed,
        });
        entry.flights += 1;
        if let (Some(flies), Some(seeds)) = (&mut entry.oracle_flies, &oracle) {
            *flies += u32::from(seeds.contains(&row.seed));
        }
    }
    let mut causes: Vec<CauseReport> = causes.into_values().collect();
    causes.sort_by_key(|report| Reverse(report.flights));
    causes
}
