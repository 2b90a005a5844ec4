//! The report of a campaign of faults.

use super::faults::{FaultCampaign, FaultJob};
use super::grid::Cell;
use super::report::quantile;
use super::stats::paired;
use mpp_sim::generator::GeneratorName;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// What a campaign of faults keeps of one flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Flown {
    /// Whether the flight is a success by the strict rule.
    pub strict: bool,
    /// Whether the aircraft survived, in the band or out of it.
    pub survived: bool,
    /// Whether it collided with an obstacle that it had known.
    pub known_collision: bool,
    /// Time from the onset of the fault until the core said so \[s\].
    pub flagged: Option<f64>,
    /// Names of the sensors and actuators that the core told as failed.
    pub told: BTreeSet<&'static str>,
}

/// Number of flights in which the core told a sensor or actuator as failed, by its name.
pub type Told = BTreeMap<&'static str, u32>;

/// The result of a campaign of faults, the same for any number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultReport {
    /// One entry for each fault and cell.
    pub faults: Vec<FaultRow>,
}

/// The pairs of one fault in one cell.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultRow {
    /// Name of the fault.
    pub name: &'static str,
    /// Name of the field file; not written without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// Generator of the random obstacles; not written if it is the paper's.
    #[serde(skip_serializing_if = "GeneratorName::is_papers")]
    pub generator: GeneratorName,
    /// Number of random obstacles in the field.
    pub obstacles: usize,
    /// Replanning rate \[Hz\].
    pub replan_hz: f64,
    /// The kind of the fields, for the table.
    #[serde(skip)]
    kind: String,
    /// Number of pairs.
    pub pairs: u32,
    /// Number of strict successes without the fault.
    pub clean: u32,
    /// Number of strict successes with it.
    pub faulty: u32,
    /// Number of pairs in which only the flight without the fault is a success.
    pub only_clean: u32,
    /// Number of pairs in which only the flight with the fault is a success.
    pub only_faulty: u32,
    /// Success rate without the fault less that with it [percentage points].
    pub lost_points: f64,
    /// Lower end of the 95 % interval of these points.
    pub lost_low: f64,
    /// Upper end of this interval.
    pub lost_high: f64,
    /// The most points that the fault may cost; null if nothing is asked.
    pub asked: Option<f64>,
    /// Number of strict successes of an oracle with the fault; null if no oracle flew.
    pub oracle: Option<u32>,
    /// Number of flights with the fault that collided with an obstacle that a beam had met more than 1 s
    /// before.
    pub known_collisions: u32,
    /// Number of flights with the fault that cost the aircraft: a collision or an extreme state.
    pub aircraft_lost: u32,
    /// Number of these in which the core said nothing after the onset.
    pub lost_untold: u32,
    /// Number of flights with the fault in which the core refused an input or excluded a sensor after the
    /// onset.
    pub flagged: u32,
    /// Median over these flights of the time from the onset to that tick \[s\]; null without such flights.
    pub flagged_s: Option<f64>,
    /// What the core told as failed in the flights with the fault.
    pub told: Told,
    /// What it told in the flights without the fault.
    pub told_clean: Told,
}

impl FaultReport {
    /// The report of a campaign whose jobs came to these ends, in the order of the jobs.
    #[must_use]
    pub fn new(campaign: &FaultCampaign, flown: &[(FaultJob, Flown)]) -> Self {
        let of = |fault: Option<usize>, cell: &Cell| -> Vec<&Flown> {
            let these = flown.iter();
            let these = these.filter(|(job, _)| job.fault == fault && job.cell == *cell);
            these.map(|(_, flown)| flown).collect()
        };
        let mut faults = Vec::new();
        for (number, variant) in campaign.faults.iter().enumerate() {
            for cell in &variant.cells {
                let (clean, faulty) = (of(None, cell), of(Some(number), cell));
                let kind = cell.kind(campaign.scene());
                let row = FaultRow::new(variant.fault.name, (cell, kind), &clean, &faulty);
                let oracle = campaign.oracle_beside(cell);
                let oracle = oracle.map(|cell| of(Some(number), &cell));
                faults.push(FaultRow {
                    asked: variant.fault.asked,
                    oracle: oracle
                        .map(|flown| flown.iter().filter(|one| one.strict).count() as u32),
                    ..row
                });
            }
        }
        Self { faults }
    }
}

impl FaultRow {
    /// The row of flights without and with a fault, seed for seed.
    fn new(
        name: &'static str,
        (cell, kind): (&Cell, String),
        clean: &[&Flown],
        faulty: &[&Flown],
    ) -> Self {
        let both = || clean.iter().zip(faulty);
        let count = |is: fn(bool, bool) -> bool| {
            both()
                .filter(|(clean, faulty)| is(clean.strict, faulty.strict))
                .count() as u32
        };
        let only_clean = count(|clean, faulty| clean && !faulty);
        let only_faulty = count(|clean, faulty| !clean && faulty);
        let pairs = count(|_, _| true);
        let (low, high) = paired(only_clean, only_faulty, pairs);
        let lost = f64::from(only_clean) - f64::from(only_faulty);
        let crashed = || faulty.iter().filter(|flown| !flown.survived);
        let flags = || faulty.iter().filter_map(|flown| flown.flagged);
        Self {
            name,
            field: cell.field.clone(),
            generator: cell.generator,
            obstacles: cell.obstacles,
            replan_hz: cell.replan_hz,
            kind,
            pairs,
            clean: count(|clean, _| clean),
            faulty: count(|_, faulty| faulty),
            only_clean,
            only_faulty,
            lost_points: 100.0 * lost / f64::from(pairs.max(1)),
            lost_low: 100.0 * low,
            lost_high: 100.0 * high,
            asked: None,
            oracle: None,
            known_collisions: faulty.iter().filter(|flown| flown.known_collision).count() as u32,
            aircraft_lost: crashed().count() as u32,
            lost_untold: crashed().filter(|flown| flown.flagged.is_none()).count() as u32,
            flagged: flags().count() as u32,
            flagged_s: quantile(flags(), 0.5),
            told: told(faulty),
            told_clean: told(clean),
        }
    }
}

fn told(flown: &[&Flown]) -> Told {
    let mut counts = Told::new();
    for name in flown.iter().flat_map(|flown| &flown.told) {
        *counts.entry(name).or_default() += 1;
    }
    counts
}

/// Names and counts as `motor 3, pitch 1`; `-` if there are none.
fn listed(told: &Told) -> String {
    let names: Vec<String> = told
        .iter()
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    match names.is_empty() {
        true => "-".to_owned(),
        false => names.join(", "),
    }
}

impl fmt::Display for FaultReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds: BTreeSet<&str> = self.faults.iter().map(|row| row.kind.as_str()).collect();
        let wide = kinds
            .iter()
            .map(|kind| kind.len())
            .max()
            .unwrap_or(0)
            .max(5);
        // Fields of one kind need no column.
        let column = |kind: &str| match kinds.len() {
            0 | 1 => String::new(),
            _ => format!("{kind:<wide$} "),
        };
        writeln!(
            f,
            "{:<18} {}{:>9} {:>4} {:>5} {:>6} {:>6} {:>10} {:>11}  {:<23} {:>5} {:>6} {:>5} {:>8} {:>6} {:>7} {:>9}  told / without fault",
            "fault",
            column("field"),
            "obstacles",
            "Hz",
            "pairs",
            "clean",
            "faulty",
            "only clean",
            "only faulty",
            "lost points [95 %]",
            "asked",
            "oracle",
            "known",
            "aircraft",
            "untold",
            "flagged",
            "after [s]",
        )?;
        for row in &self.faults {
            let lost = format!(
                "{:.1} [{:.1}, {:.1}]",
                row.lost_points, row.lost_low, row.lost_high
            );
            let number = |value: Option<f64>, digits| {
                value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
            };
            writeln!(
                f,
                "{:<18} {}{:>9} {:>4} {:>5} {:>6} {:>6} {:>10} {:>11}  {lost:<23} {:>5} {:>6} {:>5} {:>8} {:>6} {:>7} {:>9}  {} / {}",
                row.name,
                column(&row.kind),
                row.obstacles,
                row.replan_hz,
                row.pairs,
                row.clean,
                row.faulty,
                row.only_clean,
                row.only_faulty,
                number(row.asked, 0),
                number(row.oracle.map(f64::from), 0),
                row.known_collisions,
                row.aircraft_lost,
                row.lost_untold,
                row.flagged,
                number(row.flagged_s, 2),
                listed(&row.told),
                listed(&row.told_clean),
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::Lists;
    use super::super::{FaultCampaign, NamedFault};
    use super::*;
    use mpp_sim::scenario::ScenarioFile;

    /// The report of flights that all came to the same end.
    fn report(generators: &[GeneratorName]) -> FaultReport {
        let lists = Lists {
            generator: generators.to_vec(),
            obstacles: vec![20],
            ..Lists::default()
        };
        let faults = NamedFault::of(&["pitch-bias".to_owned()]).unwrap();
        let campaign = FaultCampaign::new(&ScenarioFile::default(), &lists, 2, Some(1), &faults);
        let campaign = campaign.unwrap();
        let end = Flown {
            strict: true,
            survived: true,
            known_collision: false,
            flagged: None,
            told: BTreeSet::new(),
        };
        let flown: Vec<_> = campaign
            .jobs()
            .into_iter()
            .map(|job| (job, end.clone()))
            .collect();
        FaultReport::new(&campaign, &flown)
    }

    #[test]
    fn rows_of_several_kinds_of_fields_say_which_they_are_of() {
        let both = report(&[GeneratorName::Paper, GeneratorName::Walls]);
        let json = serde_json::to_value(&both).unwrap();
        assert_eq!(json["faults"][0].get("generator"), None);
        assert_eq!(json["faults"][1]["generator"], "walls");
        assert_eq!(json["faults"][1].get("field"), None);
        let table = both.to_string();
        let lines: Vec<&str> = table.lines().collect();
        assert!(
            lines[0].starts_with("fault              field obstacles"),
            "{table}"
        );
        assert!(
            lines[2].starts_with("pitch-bias         walls        20"),
            "{table}"
        );
        // One kind needs no column.
        let one = report(&[GeneratorName::Walls]).to_string();
        assert!(
            one.starts_with("fault              obstacles   Hz"),
            "{one}"
        );
        assert!(
            one.lines()
                .nth(1)
                .unwrap()
                .starts_with("pitch-bias                20    1"),
            "{one}"
        );
    }

    /// A mission is lost without the aircraft if it leaves the band.
    #[test]
    fn a_lost_mission_is_no_lost_aircraft() {
        let flown = |survived, flagged| Flown {
            strict: false,
            survived,
            known_collision: false,
            flagged,
            told: BTreeSet::new(),
        };
        let faulty = [
            flown(true, None),
            flown(false, None),
            flown(false, Some(0.1)),
        ];
        let faulty: Vec<&Flown> = faulty.iter().collect();
        let faults = NamedFault::of(&["pitch-bias".to_owned()]).unwrap();
        let (file, lists) = (ScenarioFile::default(), Lists::default());
        let campaign = FaultCampaign::new(&file, &lists, 3, Some(1), &faults).unwrap();
        let cell = (&campaign.faults[0].cells[0], String::new());
        let row = FaultRow::new("pitch-bias", cell, &faulty, &faulty);
        assert_eq!((row.aircraft_lost, row.lost_untold), (2, 1));
    }
}
