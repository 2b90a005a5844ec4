//! Rows of one campaign from several sources.

use super::grid::{Campaign, Cell};
use super::row::Row;
use std::collections::BTreeMap;

/// Two rows differ about one flight, so they come from different programs.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the files disagree about --seed {seed} {cell}: they come from different programs")]
pub struct Disagreement {
    /// Cell of the flight.
    pub cell: Cell,
    /// Seed of the flight.
    pub seed: u64,
}

/// The rows of a campaign from several files, each flight once, in the order of cells and seeds.
///
/// # Errors
/// [`Disagreement`] when two rows differ about a flight.
pub fn merge(
    campaign: &Campaign,
    rows: impl IntoIterator<Item = Row>,
) -> Result<Vec<Row>, Disagreement> {
    let mut merged: BTreeMap<(usize, u64), Row> = BTreeMap::new();
    for row in rows {
        let Some(place) = campaign.place(&row.cell, row.seed) else {
            continue;
        };
        match merged.get(&place) {
            Some(known) if known.agrees(&row) => {}
            Some(_) => {
                return Err(Disagreement {
                    cell: row.cell,
                    seed: row.seed,
                });
            }
            None => {
                merged.insert(place, row);
            }
        }
    }
    Ok(merged.into_values().collect())
}
