//! The report about a campaign's rows.

use super::causes::{CauseReport, causes};
use super::grid::{Campaign, Cell};
use super::pairs::{AgainstCeiling, AgainstOracle};
use super::row::Row;
use super::stats::wilson;
use crate::ceiling::Feasibility;
use mpp_sim::outcome::Class;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// The result of a campaign, the same for every order, number of threads and shards.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The campaign.
    pub campaign: Campaign,
    /// Number of flights in the campaign.
    pub flights: usize,
    /// Number of flights that have a row.
    pub flown: usize,
    /// One entry for each cell.
    pub cells: Vec<CellReport>,
}

/// The result of one cell.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CellReport {
    /// The cell.
    #[serde(flatten)]
    pub cell: Cell,
    /// Number of flights that have a row.
    pub trials: u32,
    /// Number of successes by the paper's rule.
    pub successes: u32,
    /// Share of these successes [-]; null without flights.
    pub success_rate: Option<f64>,
    /// Lower end of the share's 95 % interval.
    pub wilson_low: f64,
    /// Upper end of this interval.
    pub wilson_high: f64,
    /// Number of successes by the strict rule.
    pub strict_successes: u32,
    /// Share of these successes [-]; null without flights.
    pub strict_success_rate: Option<f64>,
    /// Lower end of the share's 95 % interval.
    pub strict_wilson_low: f64,
    /// Upper end of this interval.
    pub strict_wilson_high: f64,
    /// Number of collisions with an obstacle that a beam had met more than 1 s before.
    pub known_collisions: u32,
    /// Number of these that commands of the last two seconds could have avoided.
    pub avoidable_collisions: u32,
    /// Number of these that none could have avoided. The rest is undecided.
    pub unavoidable_collisions: u32,
    /// Number of flights in each class.
    pub outcomes: Outcomes,
    /// Failures by cause, the most frequent first.
    pub causes: Vec<CauseReport>,
    /// Comparison with the oracle on the same fields; only in campaigns with an oracle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_oracle: Option<AgainstOracle>,
    /// Comparison with what can be passed at all; only in campaigns that ask for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_ceiling: Option<AgainstCeiling>,
    /// Median over flights of the least distance to an obstacle's edge \[m\]; null without obstacles.
    pub clearance_median: Option<f64>,
    /// The 5th percentile of the same \[m\].
    pub clearance_p5: Option<f64>,
    /// Plans over all flights.
    pub replans: u64,
    /// Candidates over all flights.
    pub candidates: u64,
    /// Feasible candidates over all flights.
    pub feasible: u64,
    /// Slices of planning work over all flights.
    pub slices: u64,
    /// Mean wall time of the core's work for one plan, with the 100 Hz steps until the next plan
    /// \[ms\]; only in timed campaigns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub core_ms_per_replan: Option<f64>,
}

/// Number of flights in each class, in the order of [`Class::ALL`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcomes([u32; Class::ALL.len()]);

impl Outcomes {
    /// Number of flights in a class.
    #[must_use]
    pub fn of(&self, class: Class) -> u32 {
        self.0[class as usize]
    }
}

impl Serialize for Outcomes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for class in Class::ALL {
            map.serialize_entry(class.name(), &self.of(class))?;
        }
        map.end()
    }
}

impl Report {
    /// The report about a campaign's rows. The rows hold each flight once.
    #[must_use]
    pub fn new(campaign: &Campaign, rows: &[Row]) -> Self {
        let cells = campaign.cells();
        Self {
            flights: cells.len() * campaign.trials as usize,
            flown: rows.len(),
            cells: cells
                .iter()
                .map(|cell| CellReport::new(campaign, cell, rows))
                .collect(),
            campaign: campaign.clone(),
        }
    }
}

impl Report {
    /// Sets the flights of every cell with these fields beside the verdicts about the fields.
    pub fn set_beside(&mut self, fields: &Cell, rows: &[Row], verdicts: &[(u64, Feasibility)]) {
        for report in &mut self.cells {
            if report.cell.has_fields_of(fields) {
                let own: Vec<&Row> = rows.iter().filter(|row| row.cell == report.cell).collect();
                report.against_ceiling = Some(AgainstCeiling::new(&own, verdicts));
            }
        }
    }
}

impl CellReport {
    fn new(campaign: &Campaign, cell: &Cell, all: &[Row]) -> Self {
        let of =
            |cell: &Cell| -> Vec<&Row> { all.iter().filter(|row| row.cell == *cell).collect() };
        let rows = of(cell);
        let oracle = campaign.oracle_beside(cell).map(|cell| of(&cell));
        let trials = rows.len() as u32;
        let count = |is: fn(&Row) -> bool| rows.iter().filter(|row| is(row)).count() as u32;
        let (successes, strict_successes) =
            (count(|row| row.success), count(|row| row.summary.strict));
        let share = |part: u32| (trials > 0).then(|| f64::from(part) / f64::from(trials));
        let ((wilson_low, wilson_high), (strict_wilson_low, strict_wilson_high)) =
            (wilson(successes, trials), wilson(strict_successes, trials));
        let mut outcomes = Outcomes::default();
        for row in &rows {
            outcomes.0[row.summary.class as usize] += 1;
        }
        let clearances = || rows.iter().filter_map(|row| row.summary.min_clearance);
        let replans = rows.iter().map(|row| u64::from(row.summary.replans)).sum();
        let times: Option<f64> = rows.iter().map(|row| row.core_ms).sum();
        Self {
            cell: cell.clone(),
            trials,
            successes,
            success_rate: share(successes),
            wilson_low,
            wilson_high,
            strict_successes,
            strict_success_rate: share(strict_successes),
            strict_wilson_low,
            strict_wilson_high,
            known_collisions: count(|row| row.known_collision),
            avoidable_collisions: count(|row| row.avoidable == Some(true)),
            unavoidable_collisions: count(|row| row.avoidable == Some(false)),
            outcomes,
            causes: causes(&rows, oracle.as_deref()),
            against_oracle: oracle
                .as_deref()
                .map(|oracle| AgainstOracle::new(&rows, oracle)),
            against_ceiling: None,
            clearance_median: quantile(clearances(), 0.5),
            clearance_p5: quantile(clearances(), 0.05),
            replans,
            candidates: rows
                .iter()
                .map(|row| u64::from(row.summary.candidates))
                .sum(),
            feasible: rows.iter().map(|row| u64::from(row.summary.feasible)).sum(),
            slices: rows.iter().map(|row| row.summary.slices).sum(),
            core_ms_per_replan: times
                .filter(|_| replans > 0)
                .map(|time| time / replans as f64),
        }
    }
}

/// The value below which a share of the values lies, between two of them by their places; `None` without values.
pub(super) fn quantile(values: impl Iterator<Item = f64>, share: f64) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let place = share * values.len().saturating_sub(1) as f64;
    let (low, high) = (
        values.get(place as usize)?,
        values.get(place.ceil() as usize)?,
    );
    Some(low + place.fract() * (high - low))
}
