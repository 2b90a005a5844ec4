//! A campaign of two faults at once. Each flight has a pair of named faults, each with a start of its own, drawn by a seed.

use super::fault_report::Flown;
use super::faults::NamedFault;
use super::grid::{Campaign, Cell, Lists};
use super::single_fault::Single;
use super::stats::wilson;
use mpp_sim::random::{Draws, Stream, generator, uniform};
use mpp_sim::scenario::{Scenario, ScenarioError, ScenarioFile};
use serde::Serialize;
use std::fmt;
use toml::Table;

/// First and last start of a fault \[s\], and the step between starts. Starts fall on all phases of a cycle.
const STARTS: (f64, f64) = (1.0, 12.0);
const STEP: f64 = 0.01;
/// Share of the faults that come and go, of those that can [-].
const TOGGLING: f64 = 0.25;
/// Slowest and fastest rate at which they do \[Hz\].
const TOGGLE_HZ: (f64, f64) = (0.5, 10.0);

/// The flights of a campaign of pairs.
#[derive(Clone, Debug)]
pub struct FaultPairs {
    clean: Campaign,
    cells: Vec<Cell>,
    faults: Vec<Single>,
}

/// One flight with two faults.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultPair {
    /// Names of the faults.
    pub faults: [&'static str; 2],
    /// Start of each \[s\]; 0 for one that acts from the beginning.
    pub starts: [f64; 2],
    /// Rate at which each comes and goes \[Hz\]; null for one that stays.
    pub toggle_hz: [Option<f64>; 2],
    /// Number of random obstacles.
    pub obstacles: usize,
    /// Replanning rate \[Hz\].
    pub replan_hz: f64,
    /// Seed of the flight.
    pub seed: u64,
    /// What fails, by the names that the core has; null when the link or the clock fails, because then anything can seem to.
    pub culprits: Option<Vec<&'static str>>,
    #[serde(skip)]
    cell: usize,
}

/// How a flight with two faults ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairRow {
    /// The flight.
    #[serde(flatten)]
    pub pair: FaultPair,
    /// Whether the flight is no success by the strict rule.
    pub lost: bool,
    /// Whether the aircraft itself is lost, and not its mission alone.
    pub aircraft_lost: bool,
    /// Names of the sensors and actuators that the core told as failed.
    pub told: Vec<&'static str>,
    /// Those of them that did not fail.
    pub wrongly: Vec<&'static str>,
    /// Time from the first fault until the core said that something is wrong \[s\]. A flight ends with its loss, so it said
    /// so before.
    pub flagged: Option<f64>,
}

/// The rows of a campaign of pairs, and their sums.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairReport {
    /// Number of flights.
    pub flights: u32,
    /// Flights that are no success by the strict rule.
    pub lost: u32,
    /// Flights that lost the aircraft.
    pub aircraft_lost: u32,
    /// Lost flights in which the core said nothing.
    pub lost_untold: u32,
    /// Flights in which the core told a sensor or actuator as failed that did not fail.
    pub wrongly_told: u32,
    /// Lower end of the 95 % interval of their share of all flights (Wilson).
    pub untold_low: f64,
    /// Upper end of this interval.
    pub untold_high: f64,
    /// One for each flight.
    pub rows: Vec<PairRow>,
}

impl FaultPairs {
    /// A campaign of `trials` flights. The cells are those of lists and scenario, or 20 obstacles at 1 Hz and 40 at 4 Hz.
    ///
    /// # Errors
    /// [`ScenarioError`] when the scenario or a cell is invalid.
    pub fn new(
        scenario: &ScenarioFile,
        lists: &Lists,
        trials: u32,
        seed: Option<u64>,
        faults: &[NamedFault],
    ) -> Result<Self, ScenarioError> {
        let (clean, cells) = super::faults::cells_of(scenario, lists, trials, seed)?;
        let single = |fault: &NamedFault| Single::of(fault).transpose();
        let faults = faults.iter().filter_map(single).collect::<Result<_, _>>()?;
        Ok(Self {
            clean,
            cells,
            faults,
        })
    }

    /// The flights. Empty if no two of the faults touch different tables.
    #[must_use]
    pub fn pairs(&self) -> Vec<FaultPair> {
        let seeds = (0..u64::from(self.clean.trials)).map(|it| self.clean.seed.wrapping_add(it));
        seeds.filter_map(|seed| self.draw(seed)).collect()
    }

    /// Draws the pair of a seed.
    fn draw(&self, seed: u64) -> Option<FaultPair> {
        let mut draws = generator(seed, Stream::FaultPairs);
        let index = |draws: &mut Draws, of: usize| (uniform(draws) * of as f64) as usize;
        let cell = index(&mut draws, self.cells.len());
        let found = self.cells.get(cell)?;
        // Nearly every draw fits: two faults of one table are one fault.
        let (first, second) = (0..1000).find_map(|_| {
            let mut one = || self.faults.get(index(&mut draws, self.faults.len()));
            let (first, second) = (one()?, one()?);
            (!first.overlaps(second)).then_some((first, second))
        })?;
        let span = ((STARTS.1 - STARTS.0) / STEP) as usize;
        let starts = [first, second].map(|fault| {
            let start = STARTS.0 + STEP * index(&mut draws, span) as f64;
            if fault.is_timed() { start } else { 0.0 }
        });
        let toggle_hz = [first, second].map(|fault| {
            let (drawn, along) = (uniform(&mut draws), uniform(&mut draws));
            let rate = TOGGLE_HZ.0 * libm::pow(TOGGLE_HZ.1 / TOGGLE_HZ.0, along);
            (drawn < TOGGLING && fault.toggles()).then_some((10.0 * rate).round() / 10.0)
        });
        Some(FaultPair {
            faults: [first.name, second.name],
            starts,
            toggle_hz,
            obstacles: found.obstacles,
            replan_hz: found.replan_hz,
            seed,
            culprits: [first, second]
                .iter()
                .all(|fault| fault.is_of_a_part())
                .then(|| first.culprits().chain(second.culprits()).collect()),
            cell,
        })
    }

    /// The scenario of a flight.
    ///
    /// # Errors
    /// [`ScenarioError`].
    pub fn scenario(&self, pair: &FaultPair) -> Result<Scenario, ScenarioError> {
        let mut campaign = self.clean.clone();
        for ((name, start), toggle) in pair.faults.iter().zip(pair.starts).zip(pair.toggle_hz) {
            let fault = self.faults.iter().find(|fault| fault.name == *name);
            let file = fault.map_or_else(Table::new, |fault| fault.begun(start, toggle));
            campaign.scenario = campaign.scenario.under(name, &file.to_string())?;
        }
        let cell = self.cells.get(pair.cell).cloned();
        let mut cell = cell.unwrap_or_else(|| self.clean.cells().swap_remove(0));
        cell.replan_hz = campaign.scenario.replan_hz.unwrap_or(cell.replan_hz);
        campaign.scenario(&cell, pair.seed)
    }
}

/// What was told as failed and did not fail.
fn innocent(pair: &FaultPair, flown: &Flown) -> Vec<&'static str> {
    let culprits = pair.culprits.as_ref();
    let told = flown.told.iter().copied();
    told.filter(|name| culprits.is_some_and(|culprits| !culprits.contains(name)))
        .collect()
}

impl PairReport {
    /// The report of flights that ended so, in their order.
    #[must_use]
    pub fn new(flown: Vec<(FaultPair, Flown)>) -> Self {
        let rows: Vec<PairRow> = flown
            .into_iter()
            .map(|(pair, flown)| PairRow {
                lost: !flown.strict,
                aircraft_lost: !flown.survived,
                wrongly: innocent(&pair, &flown),
                told: flown.told.into_iter().collect(),
                flagged: flown.flagged,
                pair,
            })
            .collect();
        let count = |is: &dyn Fn(&&PairRow) -> bool| rows.iter().filter(is).count() as u32;
        let flights = rows.len() as u32;
        let untold = count(&|row| row.lost && row.flagged.is_none());
        let (untold_low, untold_high) = wilson(untold, flights);
        Self {
            flights,
            lost: count(&|row| row.lost),
            aircraft_lost: count(&|row| row.aircraft_lost),
            lost_untold: untold,
            wrongly_told: count(&|row| !row.wrongly.is_empty()),
            untold_low,
            untold_high,
            rows,
        }
    }
}

impl fmt::Display for PairReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:>9} {:>4}  {:<44} {:>11}  {:>20} told",
            "obstacles", "Hz", "lost: faults", "from [s]", "seed"
        )?;
        for row in self.rows.iter().filter(|row| row.lost) {
            let FaultPair {
                faults,
                starts,
                toggle_hz,
                obstacles,
                replan_hz,
                seed,
                ..
            } = &row.pair;
            let told = match row.flagged {
                Some(after) => format!("after {after:.2} s {}", row.told.join(", ")),
                None => "nothing".to_owned(),
            };
            let named = |(name, rate): (&&str, &Option<f64>)| match rate {
                Some(rate) => format!("{name} at {rate} Hz"),
                None => (*name).to_owned(),
            };
            let names = faults
                .iter()
                .zip(toggle_hz)
                .map(named)
                .collect::<Vec<_>>()
                .join(" + ");
            let from = format!("{:.2}, {:.2}", starts[0], starts[1]);
            writeln!(
                f,
                "{obstacles:>9} {replan_hz:>4}  {names:<44} {from:>11}  {seed:>20} {told}"
            )?;
        }
        let percent = |share: f64| 100.0 * share;
        let of = f64::from(self.flights.max(1));
        writeln!(
            f,
            "{} of {} flights lost, {} with the aircraft; lost untold: {}, {:.2} % [{:.2}, {:.2}]; wrongly told in {}",
            self.lost,
            self.flights,
            self.aircraft_lost,
            self.lost_untold,
            percent(f64::from(self.lost_untold) / of),
            percent(self.untold_low),
            percent(self.untold_high),
            self.wrongly_told,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(trials: u32) -> FaultPairs {
        let all = NamedFault::of(&["all".to_owned()]).unwrap();
        FaultPairs::new(
            &ScenarioFile::default(),
            &Lists::default(),
            trials,
            Some(5),
            &all,
        )
        .unwrap()
    }

    #[test]
    fn every_drawn_pair_can_be_flown_and_comes_again() {
        let campaign = pairs(400);
        let drawn = campaign.pairs();
        assert_eq!(drawn.len(), 400);
        assert_eq!(drawn, campaign.pairs());
        let mut names = std::collections::BTreeSet::new();
        for pair in &drawn {
            campaign.scenario(pair).unwrap();
            assert_ne!(pair.faults[0], pair.faults[1]);
            names.extend(pair.faults);
        }
        assert_eq!(names.len(), campaign.faults.len());
        assert!(
            drawn
                .iter()
                .any(|pair| pair.obstacles == 20 && pair.replan_hz < 2.0)
        );
        assert!(drawn.iter().any(|pair| pair.obstacles == 40));
    }

    #[test]
    fn what_did_not_fail_and_was_told_is_counted() {
        let mut pair = pairs(1).pairs().remove(0);
        pair.culprits = Some(vec!["pitch"]);
        let flown = Flown {
            strict: true,
            survived: true,
            known_collision: false,
            flagged: Some(0.1),
            told: ["motor", "pitch"].into(),
        };
        assert_eq!(innocent(&pair, &flown), ["motor"]);
        pair.culprits = None;
        assert!(innocent(&pair, &flown).is_empty());
    }

    #[test]
    fn a_loss_is_untold_if_the_core_said_nothing() {
        let pair = pairs(1).pairs().remove(0);
        let flown = |strict, flagged| {
            let flown = Flown {
                strict,
                survived: strict,
                known_collision: false,
                flagged,
                told: std::collections::BTreeSet::new(),
            };
            (pair.clone(), flown)
        };
        let report = PairReport::new(vec![
            flown(true, None),
            flown(false, Some(0.5)),
            flown(false, None),
            flown(true, Some(0.1)),
        ]);
        assert_eq!((report.flights, report.lost, report.lost_untold), (4, 2, 1));
        assert!(
            report.to_string().contains("lost untold: 1, 25.00 %"),
            "{report}"
        );
    }
}
