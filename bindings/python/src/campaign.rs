//! Campaigns: a grid of flights, and a row for each.

use crate::aside::aside;
use crate::errors::{self, input};
use crate::field::Field;
use crate::input::argument;
use crate::scenario;
use crate::typed::typed;
use mpp_analysis::campaign::{self, Campaign as Grid, Cell, Lists, NamedField, Row, Shard};
use mpp_analysis::rows::Header;
use mpp_sim::flight::fly;
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::pipe::DirectLink;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// The flights of a campaign, in their order. `python/mppflight/campaigns.py` flies them.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Campaign {
    campaign: Grid,
    cells: Vec<Cell>,
}

impl Campaign {
    fn of(campaign: Grid) -> Self {
        let cells = campaign.cells();
        Self { campaign, cells }
    }
}

#[pymethods]
impl Campaign {
    /// A campaign over lists of values, with `trials` flights in each cell from `seed` on. `keys` are those of a
    /// scenario, `fields` are fields by name.
    #[new]
    #[pyo3(signature = (
        keys, *, trials, seed = None, preset = vec![], generator = vec![], obstacles = vec![], paths = vec![],
        replan_hz = vec![], fields = None
    ), text_signature = "(keys, *, trials, seed=None, preset=(), generator=(), obstacles=(), paths=(), \
        replan_hz=(), fields=None)")]
    #[expect(
        clippy::too_many_arguments,
        clippy::needless_pass_by_value,
        reason = "they are the lists of the command line, and Python hands them over"
    )]
    fn new(
        py: Python<'_>,
        keys: &Bound<'_, PyAny>,
        trials: &Bound<'_, PyAny>,
        seed: Option<&Bound<'_, PyAny>>,
        preset: Vec<Bound<'_, PyAny>>,
        generator: Vec<Bound<'_, PyAny>>,
        obstacles: Vec<Bound<'_, PyAny>>,
        paths: Vec<Bound<'_, PyAny>>,
        replan_hz: Vec<Bound<'_, PyAny>>,
        fields: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let keys = keys.cast::<PyDict>();
        let keys = keys.map_err(|_| input("keys: give a dict of the keys of a scenario"))?;
        let scenario = scenario::file(keys)?;
        let fields = fields.map(|it| it.extract::<BTreeMap<String, Py<Field>>>());
        let fields = fields.transpose();
        let field = fields
            .map_err(|_| input("fields: give a dict of Fields by name"))?
            .unwrap_or_default()
            .into_iter()
            .map(|(name, field)| NamedField {
                name,
                content: field.get().file.clone(),
            });
        let lists = Lists {
            preset: all("preset", &preset)?,
            field: field.collect(),
            generator: all("generator", &generator)?,
            obstacles: all("obstacles", &obstacles)?,
            paths: all("paths", &paths)?,
            replan_hz: all("replan_hz", &replan_hz)?,
        };
        let trials = typed("trials", trials)?;
        if trials == 0 {
            return Err(input("trials: give 1 or more, not 0"));
        }
        let seed = seed.map(|seed| typed("seed", seed)).transpose()?;
        let campaign = py.detach(|| Grid::new(scenario, lists, trials, seed));
        campaign.map(Self::of).map_err(errors::scenario)
    }

    /// The campaign of a text that `to_json` gave.
    #[staticmethod]
    fn from_json(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        serde_json::from_str(&typed::<String>("text", text)?)
            .map(Self::of)
            .map_err(input)
    }

    /// The campaign as it stands in the header of a row file.
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.campaign).map_err(input)
    }

    /// Number of flights.
    fn __len__(&self) -> usize {
        self.cells
            .len()
            .saturating_mul(self.campaign.trials as usize)
    }

    /// Flies one flight: cells one after the other, each seed by seed. Gives its row: the line that
    /// `sil-harness campaign --out` writes, without its end.
    fn fly(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = argument)] index: usize,
    ) -> PyResult<String> {
        let trials = (self.campaign.trials as usize).max(1);
        let Some(cell) = self.cells.get(index / trials) else {
            let last = self.__len__().saturating_sub(1);
            return Err(input(format!("index: give 0 to {last}")));
        };
        let seed = self.campaign.seed.wrapping_add((index % trials) as u64);
        let row = aside(py, |_| flown(&self.campaign, cell, seed))??;
        serde_json::to_string(&row).map_err(input)
    }

    /// The first line of the row file that `sil-harness campaign --out` writes, without its end.
    fn header(&self, py: Python<'_>) -> PyResult<String> {
        let hash = |start: &_, cell: &_, seed| Ok::<_, PyErr>(flown(start, cell, seed)?.log_hash);
        let campaign = self.campaign.clone();
        let header = aside(py, |_| Header::new(campaign, Shard::WHOLE, hash))??;
        serde_json::to_string(&header).map_err(input)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let make = slf.get_type().getattr("from_json")?;
        Ok((make, (slf.get().to_json()?,)))
    }
}

/// Flies a flight, for its row.
fn flown(campaign: &Grid, cell: &Cell, seed: u64) -> PyResult<Row> {
    let scenario = campaign.scenario(cell, seed).map_err(errors::scenario)?;
    let mut observer = FlightObserver::of(&scenario);
    let mut link = DirectLink::of(&scenario);
    let log = fly(&scenario, &mut link, |record| observer.watch(record)).map_err(errors::flight)?;
    let row = Row {
        log_hash: log.hash().map_err(input)?,
        ..Row::new(cell.clone(), &log, &observer)
    };
    Ok(row.judged(&scenario, &observer))
}

/// Each of these values of one name.
fn all<T: DeserializeOwned>(name: &str, values: &[Bound<'_, PyAny>]) -> PyResult<Vec<T>> {
    values.iter().map(|value| typed(name, value)).collect()
}

/// The Wilson interval of a share of successes, 95 %.
#[pyfunction]
pub(crate) fn wilson(
    #[pyo3(from_py_with = argument)] successes: u32,
    #[pyo3(from_py_with = argument)] trials: u32,
) -> PyResult<(f64, f64)> {
    if successes > trials {
        return Err(input(format!(
            "successes: give at most {trials}, the trials"
        )));
    }
    Ok(campaign::wilson(successes, trials))
}
