//! The flights of a campaign: a scenario, the lists that vary it, and the seeds.

use mpp_sim::scenario::{ORACLE_REPLAN_HZ, Preset, Scenario, ScenarioError, ScenarioFile};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// One combination of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The core's preset.
    pub preset: Preset,
    /// Number of random obstacles in the field.
    pub obstacles: usize,
    /// Number of candidate paths of a cycle.
    pub paths: u16,
    /// Replanning rate \[Hz\].
    pub replan_hz: f64,
    /// Whether an oracle flies.
    pub oracle: bool,
}

impl Cell {
    /// The cell of the oracle's flights past this number of random obstacles.
    fn oracle(obstacles: usize) -> Self {
        Self {
            preset: Preset::Flight,
            obstacles,
            // This is more than the oracle's candidates.
            paths: 25,
            replan_hz: ORACLE_REPLAN_HZ,
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

/// The flights of a campaign: a scenario, and the lists that vary it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// All parameters that the lists do not vary.
    pub scenario: ScenarioFile,
    /// Presets.
    pub preset: Vec<Preset>,
    /// Numbers of random obstacles.
    pub obstacles: Vec<usize>,
    /// Numbers of candidate paths.
    pub paths: Vec<u16>,
    /// Replanning rates \[Hz\].
    pub replan_hz: Vec<f64>,
    /// Number of flights in each cell.
    pub trials: u32,
    /// Seed of the first flight; the next flights take the next seeds.
    pub seed: u64,
    /// Whether an oracle flies the same fields too.
    pub oracle: bool,
}

/// The lists of a command line. An empty list takes the scenario's value.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// Presets.
    pub preset: Vec<Preset>,
    /// Numbers of random obstacles.
    pub obstacles: Vec<usize>,
    /// Numbers of candidate paths.
    pub paths: Vec<u16>,
    /// Replanning rates \[Hz\].
    pub replan_hz: Vec<f64>,
}

impl Campaign {
    /// A campaign with `trials` flights in each cell, from `seed` on or else from the scenario's
    /// seed on.
    ///
    /// # Errors
    /// [`ScenarioError`] when the scenario or a cell of it is invalid.
    pub fn new(
        mut scenario: ScenarioFile,
        lists: Lists,
        trials: u32,
        seed: Option<u64>,
    ) -> Result<Self, ScenarioError> {
        let oracle = scenario.oracle.take().unwrap_or(false);
        let base = scenario.build()?;
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

    /// Every cell, in the order of the table; the oracle's cells come last.
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

    /// The oracle's cell with the fields of this cell. Returns `None` if this cell is the oracle's
    /// own, or if the campaign has no oracle.
    pub(super) fn oracle_beside(&self, cell: &Cell) -> Option<Cell> {
        (self.oracle && !cell.oracle).then(|| Cell::oracle(cell.obstacles))
    }

    /// The scenario of one flight of a cell.
    ///
    /// # Errors
    /// [`ScenarioError`].
    pub fn scenario(&self, cell: &Cell, seed: u64) -> Result<Scenario, ScenarioError> {
        let file = ScenarioFile {
            preset: Some(cell.preset),
            obstacles: Some(cell.obstacles),
            paths: Some(cell.paths),
            replan_hz: Some(cell.replan_hz),
            seed: Some(seed),
            oracle: Some(cell.oracle),
            ..self.scenario.clone()
        };
        file.build()
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

    /// The place of a flight in the campaign, by cell and trial. Returns `None` if the campaign has
    /// no such flight.
    #[must_use]
    pub fn place(&self, cell: &Cell, seed: u64) -> Option<(usize, u64)> {
        let trial = seed.wrapping_sub(self.seed);
        let cell = self.cells().iter().position(|own| own == cell)?;
        (trial < u64::from(self.trials)).then_some((cell, trial))
    }
}

/// The values without repetitions, in their order. Without values, the list holds the default.
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

/// A text that names no part of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoShard;

impl fmt::Display for NoShard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("give i/n with i from 1 to n, such as 2/8")
    }
}

impl std::error::Error for NoShard {}

impl FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        let numbers = text.split_once('/').and_then(|(index, of)| {
            let shard = Self {
                index: index.parse().ok()?,
                of: of.parse().ok()?,
            };
            (1..=shard.of).contains(&shard.index).then_some(shard)
        });
        numbers.ok_or(NoShard)
    }
}
