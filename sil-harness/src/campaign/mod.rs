//! Campaigns: many flights over a grid of presets, obstacles, paths and replanning rates.
//!
//! Every cell of the grid flies the same seeds, so that cells can be compared flight by flight. A
//! row depends on its cell and seed alone: neither the number of threads nor the split into shards
//! changes it, and `fly` with the same flags and seed flies it again, to the same log hash.

mod pairs;
mod report;
mod row;
mod stats;
mod store;
mod table;
mod taxonomy;

pub use pairs::AgainstOracle;
pub use report::{CellReport, Outcomes, Report};
pub use row::Row;
pub use stats::wilson;
pub use store::{Header, RowFile, merge, read};
pub use taxonomy::{CauseReport, Taxonomy};

use crate::link::{Link, LinkError, PipeLink};
use crate::oracle::REPLAN_HZ;
use crate::run::{FlyError, fly};
use crate::scenario::{Preset, Scenario, ScenarioError, ScenarioFile};
use hil_protocol::Message;
use mpp_core::vehicle::{VehicleState, Wind};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use std::time::{Duration, Instant};

/// Stack of a thread [bytes]: the core is built on it before it moves to its box.
const STACK: usize = 8 << 20;

/// One combination of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The core's preset.
    pub preset: Preset,
    /// Random obstacles in the field.
    pub obstacles: usize,
    /// Candidate paths of a cycle.
    pub paths: u16,
    /// Replanning rate [Hz].
    pub replan_hz: f64,
    /// Whether an oracle flies.
    pub oracle: bool,
}

impl Cell {
    /// The oracle's flights past so many random obstacles.
    fn oracle(obstacles: usize) -> Self {
        Self {
            preset: Preset::Flight,
            obstacles,
            // More than its candidates.
            paths: 25,
            replan_hz: REPLAN_HZ,
            oracle: true,
        }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "--preset {} --obstacles {} --paths {} --replan-hz {}",
            self.preset.name(),
            self.obstacles,
            self.paths,
            self.replan_hz
        )?;
        f.write_str(if self.oracle { " --oracle" } else { "" })
    }
}

/// What is flown: a scenario, and the lists that vary it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Everything that the lists do not say.
    pub scenario: ScenarioFile,
    /// Presets.
    pub preset: Vec<Preset>,
    /// Numbers of random obstacles.
    pub obstacles: Vec<usize>,
    /// Numbers of candidate paths.
    pub paths: Vec<u16>,
    /// Replanning rates [Hz].
    pub replan_hz: Vec<f64>,
    /// Flights of each cell.
    pub trials: u32,
    /// Seed of the first flight; the others follow.
    pub seed: u64,
    /// Whether an oracle flies the same fields too.
    pub oracle: bool,
}

/// The lists of a command line; an empty one takes the scenario's value.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// Presets.
    pub preset: Vec<Preset>,
    /// Numbers of random obstacles.
    pub obstacles: Vec<usize>,
    /// Numbers of candidate paths.
    pub paths: Vec<u16>,
    /// Replanning rates [Hz].
    pub replan_hz: Vec<f64>,
}

impl Campaign {
    /// A campaign of `trials` flights a cell from `seed` on, or from the scenario's seed on.
    ///
    /// # Errors
    /// [`CampaignError::Scenario`] when the scenario or a cell of it makes no sense.
    pub fn new(
        mut scenario: ScenarioFile,
        lists: Lists,
        trials: u32,
        seed: Option<u64>,
    ) -> Result<Self, CampaignError> {
        let oracle = scenario.oracle.take().unwrap_or(false);
        let base = scenario.build().map_err(CampaignError::Scenario)?;
        let campaign = Self {
            preset: listed(lists.preset, base.preset),
            obstacles: listed(lists.obstacles, base.obstacles),
            paths: listed(lists.paths, base.paths),
            replan_hz: listed(lists.replan_hz, base.replan_hz()),
            trials,
            seed: seed.unwrap_or(base.seed),
            oracle,
            scenario,
        };
        for cell in campaign.cells() {
            campaign.scenario(&cell, campaign.seed)?;
        }
        Ok(campaign)
    }

    /// Every cell, in the order of the table, the oracle's last.
    #[must_use]
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = Vec::new();
        for &preset in &self.preset {
            for &replan_hz in &self.replan_hz {
                for &paths in &self.paths {
                    for &obstacles in &self.obstacles {
                        cells.push(Cell {
                            preset,
                            obstacles,
                            paths,
                            replan_hz,
                            oracle: false,
                        });
                    }
                }
            }
        }
        if self.oracle {
            cells.extend(self.obstacles.iter().copied().map(Cell::oracle));
        }
        cells
    }

    /// The oracle's cell with the fields of this one; none if it is itself the oracle's, or there is
    /// none.
    fn oracle_beside(&self, cell: &Cell) -> Option<Cell> {
        (self.oracle && !cell.oracle).then(|| Cell::oracle(cell.obstacles))
    }

    /// One flight of a cell.
    ///
    /// # Errors
    /// [`CampaignError::Scenario`].
    pub fn scenario(&self, cell: &Cell, seed: u64) -> Result<Scenario, CampaignError> {
        let file = ScenarioFile {
            preset: Some(cell.preset),
            obstacles: Some(cell.obstacles),
            paths: Some(cell.paths),
            replan_hz: Some(cell.replan_hz),
            seed: Some(seed),
            oracle: Some(cell.oracle),
            ..self.scenario.clone()
        };
        file.build().map_err(CampaignError::Scenario)
    }

    /// Every flight of a shard.
    #[must_use]
    pub fn jobs(&self, shard: Shard) -> Vec<(Cell, u64)> {
        let seeds = (0..u64::from(self.trials)).map(|trial| self.seed.wrapping_add(trial));
        let cells = self.cells();
        let all = cells
            .iter()
            .flat_map(|cell| seeds.clone().map(|seed| (*cell, seed)));
        all.skip(shard.index - 1).step_by(shard.of).collect()
    }

    /// What this program makes of the campaign's first seconds, for each planner: another program's
    /// rows are not to be mixed with its own.
    ///
    /// # Errors
    /// [`CampaignError::Flight`].
    pub fn fingerprint(&self) -> Result<String, CampaignError> {
        const SECONDS: u32 = 2;
        let mut start = self.clone();
        start.scenario.duration = Some(SECONDS);
        let mut cells = self.cells();
        cells.dedup_by_key(|cell| (cell.preset, cell.oracle));
        let hashes = cells
            .iter()
            .map(|cell| Ok(flown(&start, *cell, self.seed, false)?.log_hash));
        Ok(hashes
            .collect::<Result<Vec<String>, CampaignError>>()?
            .join("-"))
    }

    /// The place of a flight in the campaign, by cell and trial; none if it is not one of its
    /// flights.
    #[must_use]
    pub fn place(&self, cell: &Cell, seed: u64) -> Option<(usize, u64)> {
        let trial = seed.wrapping_sub(self.seed);
        let cell = self.cells().iter().position(|own| own == cell)?;
        (trial < u64::from(self.trials)).then_some((cell, trial))
    }
}

/// The values without repetitions, in their order; the default if there are none.
fn listed<T: PartialEq>(values: Vec<T>, default: T) -> Vec<T> {
    let mut list = Vec::new();
    for value in values {
        if !list.contains(&value) {
            list.push(value);
        }
    }
    if list.is_empty() {
        list.push(default);
    }
    list
}

/// A part of a campaign: every `of`-th flight, counted from `index`, which begins at 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    index: usize,
    of: usize,
}

impl Shard {
    /// The whole campaign.
    pub const WHOLE: Self = Self { index: 1, of: 1 };
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, of)| {
            let shard = Self {
                index: index.parse().ok()?,
                of: of.parse().ok()?,
            };
            (1..=shard.of).contains(&shard.index).then_some(shard)
        });
        numbers.ok_or_else(|| "give i/n with i from 1 to n, such as 2/8".to_owned())
    }
}

/// Flies these flights on so many threads (0: as many as there are cores), and hands each row to `keep` as soon as it is flown, from whichever thread flew it. With `timed` rows also
/// hold the core's wall time.
///
/// # Errors
/// [`CampaignError`] of the first flight or row that fails; the rows kept so far are good.
pub fn run(
    campaign: &Campaign,
    jobs: &[(Cell, u64)],
    threads: usize,
    timed: bool,
    keep: impl Fn(Row) -> Result<(), CampaignError> + Sync,
) -> Result<(), CampaignError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK)
        .build()
        .map_err(CampaignError::Threads)?;
    pool.install(|| {
        // Bridged, flights start in order, and no flight stands on a stack of half-split lists.
        jobs.iter()
            .par_bridge()
            .try_for_each(|&(cell, seed)| keep(flown(campaign, cell, seed, timed)?))
    })
}

/// Flies one row.
fn flown(campaign: &Campaign, cell: Cell, seed: u64, timed: bool) -> Result<Row, CampaignError> {
    let failed = |error: FlyError| CampaignError::Flight(cell, seed, error.to_string());
    let scenario = campaign.scenario(&cell, seed)?;
    let mut link = Stopwatch {
        link: PipeLink::of(&scenario),
        elapsed: Duration::ZERO,
    };
    let log = fly(&scenario, &mut link, |_| {}).map_err(failed)?;
    let hash = log
        .hash()
        .map_err(|error| CampaignError::Flight(cell, seed, error.to_string()))?;
    let core_ms = timed.then_some(link.elapsed.as_secs_f64() * 1e3);
    Ok(Row::new(cell, &log, hash, core_ms))
}

/// A link that knows how long the core worked: in process, it works while it is sent to.
struct Stopwatch {
    link: PipeLink,
    elapsed: Duration,
}

impl Link for Stopwatch {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let begin = Instant::now();
        let sent = self.link.send(message);
        self.elapsed += begin.elapsed();
        sent
    }

    fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        self.link.reveal(truth, wind)
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.link.receive(awaited)
    }
}

/// Why a campaign did not come to its end.
#[derive(Debug)]
#[non_exhaustive]
pub enum CampaignError {
    /// The scenario makes no sense.
    Scenario(ScenarioError),
    /// A flight has no outcome: its cell, its seed, why.
    Flight(Cell, u64, String),
    /// A row file cannot be read or written.
    File(String, std::io::Error),
    /// A row file's line is not one of this campaign's: file, line, why.
    Line(String, usize, String),
    /// A row file holds another campaign's rows: file, what differs.
    Differs(String, String),
    /// Another process writes this row file.
    Busy(String),
    /// Two row files disagree about a flight: cell and seed.
    Disagree(Cell, u64),
    /// No threads are to be had.
    Threads(rayon::ThreadPoolBuildError),
}

impl fmt::Display for CampaignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scenario(error) => write!(f, "{error}"),
            Self::Flight(cell, seed, why) => {
                write!(f, "{why}; fly it again with: fly --seed {seed} {cell}")
            }
            Self::File(path, error) => write!(f, "{path}: {error}"),
            Self::Line(path, line, why) => write!(f, "{path}, line {line}: {why}"),
            Self::Differs(path, what) => write!(
                f,
                "{path} holds another campaign: {what}; give another file, or the same flags"
            ),
            Self::Busy(path) => write!(f, "{path} is being written by another process"),
            Self::Disagree(cell, seed) => write!(
                f,
                "the files disagree about --seed {seed} {cell}: they come from different programs"
            ),
            Self::Threads(error) => write!(f, "--threads: {error}"),
        }
    }
}

impl std::error::Error for CampaignError {}

#[cfg(test)]
mod tests;
