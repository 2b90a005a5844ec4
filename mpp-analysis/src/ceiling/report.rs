//! Verdicts about many fields.

use super::Feasibility;
use crate::campaign::{Campaign, Cell, wilson};
use mpp_sim::space::SpaceScenario;
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
    /// The verdicts.
    #[serde(flatten)]
    pub counts: Counts,
}

/// How many fields got which verdict.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counts {
    /// Number of fields.
    pub fields: u32,
    /// Fields that are proven to be blocked.
    pub blocked: u32,
    /// Fields that a witness passes, or an oracle.
    pub passable: u32,
    /// The other fields.
    pub undecided: u32,
    /// 95 % interval of the share of passable fields, from the passable ones alone up to all that are not blocked [-].
    pub passable_interval: (f64, f64),
}

/// Verdicts about the worlds of one density.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpaceCeilingCell {
    /// Generator of the worlds.
    pub world: String,
    /// Density in the unit of the generator.
    pub density: f64,
    /// Sight of the oracle that flies \[m\]; null for witnesses, which know everything.
    pub sight: Option<f64>,
    /// The verdicts.
    #[serde(flatten)]
    pub counts: Counts,
}

/// Verdicts of a command in space.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SpaceCeilingReport {
    /// One entry for each density and sight.
    pub cells: Vec<SpaceCeilingCell>,
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
        Self {
            field: cell.kind(campaign.scenario.scene),
            obstacles: cell.obstacles,
            margin,
            counts: Counts::of(verdicts),
        }
    }
}

impl SpaceCeilingCell {
    /// The verdicts about worlds that differ from that of a scenario in their seeds.
    #[must_use]
    pub fn new(scenario: &SpaceScenario, sight: Option<f64>, verdicts: &[Feasibility]) -> Self {
        let space = scenario.header().space;
        let (world, density) = space
            .map(|space| (space.world, space.density))
            .unwrap_or_default();
        let mut counts = Counts::of(verdicts);
        if sight.is_some() {
            // What an oracle does not pass it loses.
            counts.passable_interval = wilson(counts.passable, counts.fields);
        }
        Self {
            world: world.unwrap_or_default(),
            density: density.unwrap_or_default(),
            sight,
            counts,
        }
    }
}

impl Counts {
    fn of(verdicts: &[Feasibility]) -> Self {
        let count =
            |is: fn(&Feasibility) -> bool| verdicts.iter().filter(|one| is(one)).count() as u32;
        let fields = verdicts.len() as u32;
        let blocked = count(|one| matches!(one, Feasibility::Blocked(_)));
        let passable = count(|one| *one == Feasibility::Passable);
        Self {
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

/// Heads of the columns of [`Counts`].
const HEADS: &str = " fields  blocked  passable  undecided  passable [95 %]";

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = self.passable_interval;
        write!(
            f,
            "{:>7} {:>8} {:>9} {:>10}  [{:.1}, {:.1}]",
            self.fields,
            self.blocked,
            self.passable,
            self.undecided,
            100.0 * low,
            100.0 * high
        )
    }
}

impl fmt::Display for SpaceCeilingReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<8} {:>8} {:>7} {HEADS}", "world", "density", "sight")?;
        (self.cells.iter()).try_for_each(|cell| {
            let sight = cell.sight.map_or("all".to_owned(), |it| format!("{it} m"));
            let SpaceCeilingCell {
                world,
                density,
                counts,
                ..
            } = cell;
            writeln!(f, "{world:<8} {density:>8} {sight:>7} {counts}")
        })
    }
}

impl fmt::Display for CeilingReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<12} {:>9} {:>8} {HEADS}",
            "field", "obstacles", "margin"
        )?;
        self.cells.iter().try_for_each(|cell| {
            writeln!(
                f,
                "{:<12} {:>9} {:>6} m {}",
                cell.field, cell.obstacles, cell.margin, cell.counts
            )
        })
    }
}
