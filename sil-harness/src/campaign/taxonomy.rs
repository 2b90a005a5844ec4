//! The failures of a cell by their causes.

use super::{CellReport, Report, Row};
use crate::inquest::Cause;
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt;

/// The failures of one cause.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CauseReport {
    /// Why.
    pub cause: Cause,
    /// Flights that failed so.
    pub flights: u32,
    /// Those of them whose fields the oracle flies; only of campaigns that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub oracle_flies: Option<u32>,
    /// Seed of the first, to look at.
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

/// A report's failures by cause, as a table for people.
pub struct Taxonomy<'a>(pub &'a Report);

impl fmt::Display for Taxonomy<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for cell in &self.0.cells {
            write_cell(f, cell)?;
        }
        Ok(())
    }
}

fn write_cell(f: &mut fmt::Formatter<'_>, cell: &CellReport) -> fmt::Result {
    let failed = cell.trials - cell.strict_successes;
    writeln!(
        f,
        "{}: {failed} of {} flights failed",
        cell.cell, cell.trials
    )?;
    for report in &cell.causes {
        let name = report.cause.name();
        write!(f, "  {name:<12} {:>5}", report.flights)?;
        if let Some(flies) = report.oracle_flies {
            write!(f, ", the oracle flies {flies:>5}")?;
        }
        writeln!(f, ", such as --seed {}", report.seed)?;
    }
    Ok(())
}
