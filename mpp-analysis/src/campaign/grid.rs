//! The flights of a campaign: a scenario, the lists that vary it, and the seeds.

use mpp_sim::field::FieldFile;
use mpp_sim::generator::GeneratorName;
use mpp_sim::scenario::{
    GeneratorTable, ORACLE_REPLAN_HZ, Preset, Scenario, ScenarioError, ScenarioFile,
};
use mpp_sim::scene::Scene;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// One combination of the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The core's preset.
    pub preset: Preset,
    /// Name of the field file; not written without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// Generator of the random obstacles; not written if it is the paper's.
    #[serde(default, skip_serializing_if = "GeneratorName::is_papers")]
    pub generator: GeneratorName,
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
    /// The cell of the oracle's flights through the fields of a cell, at its rate \[Hz\].
    fn oracle(fields: &Self, replan_hz: f64) -> Self {
        Self {
            preset: Preset::Flight,
            field: fields.field.clone(),
            generator: fields.generator,
            obstacles: fields.obstacles,
            // This is more than the oracle's candidates.
            paths: 25,
            replan_hz,
            oracle: true,
        }
    }

    /// Whether another cell flies through the same fields.
    #[must_use]
    pub fn has_fields_of(&self, other: &Self) -> bool {
        (&self.field, self.generator, self.obstacles)
            == (&other.field, other.generator, other.obstacles)
    }

    /// The kind of its fields, for a table: file, the scene of its campaign, and generator, as far as they are there.
    #[must_use]
    pub fn kind(&self, scene: Option<Scene>) -> String {
        let mut parts: Vec<String> = self.field.iter().cloned().collect();
        parts.extend(scene.map(|scene| scene.to_string()));
        if parts.is_empty() || self.obstacles > 0 {
            parts.push(self.generator.to_string());
        }
        parts.join(", ")
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.field {
            write!(f, "--field {file} ")?;
        }
        if !self.generator.is_papers() {
            write!(f, "--generator {} ", self.generator)?;
        }
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

/// A field and the name of its file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedField {
    /// Name of the file.
    pub name: String,
    /// Its content.
    pub content: FieldFile,
}

/// The flights of a campaign: a scenario, and the lists that vary it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// All parameters that the lists do not vary.
    pub scenario: ScenarioFile,
    /// Presets.
    pub preset: Vec<Preset>,
    /// Fields of files; without one, the scenario's.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub field: Vec<NamedField>,
    /// Generators of random obstacles.
    #[serde(default)]
    pub generator: Vec<GeneratorName>,
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
    /// Fields of files.
    pub field: Vec<NamedField>,
    /// Generators of random obstacles.
    pub generator: Vec<GeneratorName>,
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
        // Fields of files stand alone, as the field of a scenario does.
        let first = lists.field.first().map(|field| field.content.clone());
        let base = ScenarioFile {
            field: first.unwrap_or_else(|| scenario.field.clone()),
            ..scenario.clone()
        };
        let name = lists.field.first().map(|field| field.name.as_str());
        let base = base.build().map_err(|error| error.of_field(name))?;
        let campaign = Self {
            preset: listed_or(lists.preset, base.preset),
            field: listed(lists.field),
            generator: listed_or(lists.generator, base.generator.name),
            obstacles: listed_or(lists.obstacles, base.obstacles),
            paths: listed_or(lists.paths, scenario.paths.unwrap_or(base.paths)),
            replan_hz: listed_or(lists.replan_hz, base.replan_hz()),
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
                    let fields = self.fields().into_iter();
                    cells.extend(fields.map(|(field, generator, obstacles)| Cell {
                        preset,
                        field,
                        generator,
                        obstacles,
                        paths,
                        replan_hz,
                        oracle: false,
                    }));
                }
            }
        }
        if self.oracle {
            let mut oracles: Vec<Cell> = Vec::new();
            let rate = self.oracle_hz();
            for oracle in cells.iter().map(|cell| Cell::oracle(cell, rate)) {
                if !oracles.contains(&oracle) {
                    oracles.push(oracle);
                }
            }
            cells.extend(oracles);
        }
        cells
    }

    /// Every kind of field: file, generator and number of random obstacles.
    fn fields(&self) -> Vec<(Option<String>, GeneratorName, usize)> {
        let mut files: Vec<_> = self.field.iter().map(|field| Some(&field.name)).collect();
        if files.is_empty() {
            files.push(None);
        }
        let mut fields = Vec::new();
        for file in files {
            for &generator in &self.generator {
                for &count in &self.obstacles {
                    fields.push((file.cloned(), generator, count));
                }
            }
        }
        fields
    }

    /// The oracle's cell with the fields of this cell. Returns `None` if this cell is the oracle's
    /// own, or if the campaign has no oracle.
    pub(super) fn oracle_beside(&self, cell: &Cell) -> Option<Cell> {
        (self.oracle && !cell.oracle).then(|| Cell::oracle(cell, self.oracle_hz()))
    }

    /// Replanning rate of an oracle that flies the campaign's aircraft \[Hz\].
    fn oracle_hz(&self) -> f64 {
        let scenario = self.scenario.build();
        scenario.map_or(ORACLE_REPLAN_HZ, |scenario| scenario.informed().replan_hz())
    }

    /// The scenario of one flight of a cell.
    ///
    /// # Errors
    /// [`ScenarioError`].
    pub fn scenario(&self, cell: &Cell, seed: u64) -> Result<Scenario, ScenarioError> {
        let of_file = self
            .field
            .iter()
            .find(|field| Some(&field.name) == cell.field.as_ref());
        let content = of_file.map(|field| field.content.clone());
        let file = ScenarioFile {
            field: content.unwrap_or_else(|| self.scenario.field.clone()),
            generator: GeneratorTable {
                name: Some(cell.generator),
                ..self.scenario.generator
            },
            preset: Some(cell.preset),
            obstacles: Some(cell.obstacles),
            paths: Some(cell.paths),
            replan_hz: Some(cell.replan_hz),
            seed: Some(seed),
            oracle: Some(cell.oracle),
            ..self.scenario.clone()
        };
        file.build()
            .map_err(|error| error.of_field(cell.field.as_deref()))
    }

    /// The seeds of each cell.
    pub fn seeds(&self) -> impl Iterator<Item = u64> + Clone {
        let first = self.seed;
        (0..u64::from(self.trials)).map(move |trial| first.wrapping_add(trial))
    }

    /// Every flight of a shard.
    #[must_use]
    pub fn jobs(&self, shard: Shard) -> Vec<(Cell, u64)> {
        let seeds = self.seeds();
        let cells = self.cells();
        let all = cells
            .iter()
            .flat_map(|cell| seeds.clone().map(|seed| (cell.clone(), seed)));
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

/// The values without repetitions, in their order.
fn listed<T: PartialEq>(values: Vec<T>) -> Vec<T> {
    let mut list = Vec::new();
    for value in values {
        if !list.contains(&value) {
            list.push(value);
        }
    }
    list
}

/// The same; without values, the list holds the default.
fn listed_or<T: PartialEq>(values: Vec<T>, default: T) -> Vec<T> {
    let mut list = listed(values);
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("give i/n with i from 1 to n, such as 2/8")]
pub struct NoShard;

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
