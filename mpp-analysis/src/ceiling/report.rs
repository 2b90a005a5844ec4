//! Verdicts about many fields.

use super::Feasibility;
use crate::campaign::{Campaign, Cell, wilson};
use serde::Serialize;
use std::fmt;

/// Verdicts about the fields of one kind and margin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CeilingCell {
    /// Kind of the fields: generator, file, or both.
    pub field: String,
    /// Number of random obstacles.
    pub obstacles: usize,
    /// Margin beside the body's radius \[m\].
    pub margin: f64,
    /// Number of fields.
    pub fields: u32,
    /// Fields that are proven to be blocked.
    pub blocked: u32,
    /// Fields that a witness passes.
    pub passable: u32,
    /// The other fields.
    pub undecided: u32,
    /// 95 % interval of the share of passable fields, from the passable ones alone up to all that are not blocked [-].
    pub passable_interval: (f64, f64),
}

/// Verdicts of a command.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CeilingReport {
    /// One entry for each kind of field and margin.
    pub cells: Vec<CeilingCell>,
}

impl CeilingCell {
    /// The verdicts about the fields of a cell of a campaign.
    #[must_use]
    pub fn new(campaign: &Campaign, cell: &Cell, margin: f64, verdicts: &[Feasibility]) -> Self {
        let count =
            |is: fn(&Feasibility) -> bool| verdicts.iter().filter(|one| is(one)).count() as u32;
        let fields = verdicts.len() as u32;
        let blocked = count(|one| matches!(one, Feasibility::Blocked(_)));
        let passable = count(|one| *one == Feasibility::Passable);
        Self {
            field: cell.kind(campaign.scenario.scene),
            obstacles: cell.obstacles,
            margin,
            fields,
            blocked,
            passable,
            undecided: fields - blocked - passable,
            passable_interval: (
                wilson(passable, fields).0,
                wilson(fields - blocked, fields).1,
            ),
        }
    }
}

impl fmt::Display for CeilingReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<12} {:>9} {:>8} {:>7} {:>8} {:>9} {:>10}  passable [95 %]",
            "field", "obstacles", "margin", "fields", "blocked", "passable", "undecided"
        )?;
        for cell in &self.cells {
            let (low, high) = cell.passable_interval;
            writeln!(
                f,
                "{:<12} {:>9} {:>6} m {:>7} {:>8} {:>9} {:>10}  [{:.1}, {:.1}]",
                cell.field,
                cell.obstacles,
                cell.margin,
                cell.fields,
                cell.blocked,
                cell.passable,
                cell.undecided,
                100.0 * low,
                100.0 * high
            )?;
        }
        Ok(())
    }
}
