//! Many flights side by side, for learning: the agent is the regulator.

use crate::episode::{Episode, Shaping, controls, pair, scales, seen};
use crate::errors::{self, alone, input, state};
use crate::field::Field;
use crate::input::{argument, rows};
use crate::output::flat;
use crate::scenario;
use mpp_core::vehicle::Control;
use mpp_sim::field::FieldFile;
use mpp_sim::scenario::{Scenario, ScenarioFile, TICKS_PER_SECOND};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::{Arc, Mutex};

/// Greatest number of flights side by side. Each takes some 10 kB, and 16 bytes a tick.
const MOST_FLIGHTS: usize = 100_000;

/// Flights of one scenario with different seeds. `python/mppflight/environments.py` makes environments of them.
#[pyclass(frozen, module = "mppflight._native")]
pub(crate) struct Batch {
    plan: Arc<Flights>,
    guarded: Mutex<Vec<Option<Run>>>,
}

/// What the flights have in common.
struct Flights {
    file: ScenarioFile,
    base: Scenario,
    scan_ticks: u32,
    shaping: Shaping,
    /// Elevator and thrust for the actions -1 and 1.
    ranges: [[f64; 2]; 2],
}

/// A flight and what its agent knows.
#[derive(Clone)]
struct Run {
    episode: Episode,
    seed: u64,
    /// Every action so far.
    actions: Vec<[f64; 2]>,
    scan: Vec<f32>,
    /// Airspeed [m/s], pitch [rad]; place [m]; ticks of position and scan.
    air: [f64; 2],
    place: [f64; 2],
    ticks: [u32; 2],
}

/// A copy of one flight. It goes on as the original would, bit for bit, also after pickling.
#[pyclass(frozen, module = "mppflight._native", name = "Moment")]
pub(crate) struct SavedFlight {
    plan: Arc<Flights>,
    run: Run,
}

#[pymethods]
impl Batch {
    /// `count` flights of the scenario with these keys, each with a scan `lidar_hz` times a second. `shaping` holds what missing
    /// clearance costs a second, the margin [m], and what effort costs.
    #[new]
    #[pyo3(signature = (keys, count, lidar_hz = 10.0, shaping = [0.0, 1.0, 0.0]))]
    fn new(
        keys: &Bound<'_, PyDict>,
        count: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = argument)] lidar_hz: f64,
        shaping: [f64; 3],
    ) -> PyResult<Self> {
        let some = argument(count).ok();
        let some = some.filter(|count| (1..=MOST_FLIGHTS).contains(count));
        let wrong = || format!("num_envs: give 1 to {MOST_FLIGHTS} flights, not {count}");
        let count = some.ok_or_else(|| input(wrong()))?;
        let plan = Arc::new(Flights::new(scenario::file(keys)?, lidar_hz, shaping)?);
        let runs = (0..count).map(|_| None).collect();
        let guarded = Mutex::new(runs);
        Ok(Self { plan, guarded })
    }

    /// Number of beams, their greatest range [m], and the field of view [rad].
    #[getter]
    fn lidar(&self) -> (usize, f64, f64) {
        let lidar = &self.plan.base.lidar;
        (lidar.beams, lidar.range_max, lidar.field_of_view)
    }

    /// The obstacles of a flight, where they are at its start.
    fn field(&self, index: usize) -> PyResult<Field> {
        let runs = alone(&self.guarded, "environment")?;
        let run = runs.get(index).and_then(Option::as_ref).ok_or_else(unset)?;
        Field::checked(FieldFile::of(&run.episode.scenario.field().obstacles))
    }

    /// Elevator for the actions -1 and 1, and thrust likewise [N].
    #[getter]
    fn controls(&self) -> [[f64; 2]; 2] {
        self.plan.ranges
    }

    /// Cruise [m/s], the way of a flight, its altitude and its band [m].
    #[getter]
    fn scales(&self) -> [f64; 4] {
        scales(&self.plan.base)
    }

    /// Starts the flights anew that have a seed in the list.
    fn reset(&self, seeds: Vec<Option<u64>>) -> PyResult<()> {
        let mut runs = alone(&self.guarded, "environment")?;
        if seeds.len() != runs.len() {
            return Err(input("seeds: give one for each flight, or None"));
        }
        for (run, seed) in runs.iter_mut().zip(seeds) {
            if let Some(seed) = seed {
                *run = Some(Run::new(&self.plan, seed)?);
            }
        }
        Ok(())
    }

    /// Flies one tick of each flight by its action, a row of elevator and thrust, each from -1 to 1. Gives the rewards
    /// and which flights failed and which came to their end. Flights that start anew have a seed in `seeds`; they
    /// fly no tick.
    #[pyo3(signature = (actions, seeds = None))]
    fn step<'py>(
        &self,
        actions: &Bound<'py, PyAny>,
        seeds: Option<Vec<Option<u64>>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let py = actions.py();
        let actions = match actions.extract::<PyReadonlyArray2<'_, f64>>() {
            Ok(array) if array.as_array().ncols() == 2 => (array.as_array().rows().into_iter())
                .map(|row| [row[0], row[1]])
                .collect(),
            _ => rows::<2>("actions", actions)?,
        };
        let seeds = seeds.unwrap_or_default();
        let mut runs = alone(&self.guarded, "environment")?;
        if actions.len() != runs.len() {
            let advice = format!("actions: give a row for each of the {} flights", runs.len());
            return Err(input(advice));
        }
        // All are checked before one is flown: after an error every flight is where it was.
        for (index, (run, action)) in runs.iter().zip(&actions).enumerate() {
            if !matches!(seeds.get(index), Some(Some(_))) {
                check(run.as_ref(), *action)?;
            }
        }
        let (runs, plan) = (&mut **runs, &self.plan);
        let stepped = py.detach(|| {
            let flights = runs.iter_mut().zip(&actions).enumerate();
            let each = flights.map(|(index, (run, action))| match seeds.get(index) {
                Some(Some(seed)) => {
                    *run = Some(Run::new(plan, *seed)?);
                    Ok((0.0, false, false))
                }
                _ => fly(run, plan, *action),
            });
            each.collect::<PyResult<Vec<_>>>()
        })?;
        let rewards = PyArray1::from_iter(py, stepped.iter().map(|it| it.0));
        let failed = PyArray1::from_iter(py, stepped.iter().map(|it| it.1));
        let ended = PyArray1::from_iter(py, stepped.iter().map(|it| it.2));
        (rewards, failed, ended).into_pyobject(py)
    }

    /// Flies one tick of a single flight by its action, elevator and thrust. Gives what a step of an environment gives:
    /// what the agent knows, the reward, whether the flight failed, whether it came to its end, and the truth.
    fn step_one<'py>(&self, action: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, action) = (action.py(), pair(action)?);
        let mut runs = alone(&self.guarded, "environment")?;
        let place = runs.first_mut().ok_or_else(unset)?;
        let (reward, failed, ended) = fly(place, &self.plan, action)?;
        let run = place.as_ref().ok_or_else(unset)?;
        (run.known(py)?, reward, failed, ended, run.truth(py)?).into_pyobject(py)
    }

    /// What the agent of a single flight knows: a row of `observe`.
    fn observe_one<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let runs = alone(&self.guarded, "environment")?;
        let run = runs.first().and_then(Option::as_ref).ok_or_else(unset)?;
        run.known(py)
    }

    /// What the agents know, a row a flight: ranges of the last scan [m], the greatest where nothing came back; airspeed
    /// [m/s] and pitch [rad]; place [m]; ages of place and scan [s].
    fn observe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let runs = alone(&self.guarded, "environment")?;
        let runs = runs.iter().map(|run| run.as_ref().ok_or_else(unset));
        let runs = runs.collect::<PyResult<Vec<&Run>>>()?;
        let (rows, dict) = (runs.len(), PyDict::new(py));
        let scans = runs.iter().flat_map(|run| run.scan.iter().copied());
        dict.set_item(
            "lidar",
            flat(py, scans, [rows, self.plan.base.lidar.beams])?,
        )?;
        let air = runs.iter().flat_map(|run| single(run.air));
        dict.set_item("air", flat(py, air, [rows, 2])?)?;
        let places = runs.iter().flat_map(|run| single(run.place));
        dict.set_item("position", flat(py, places, [rows, 2])?)?;
        let ages = runs.iter().flat_map(|run| single(run.ages()));
        dict.set_item("age", flat(py, ages, [rows, 2])?)?;
        Ok(dict)
    }

    /// The flight's true place, its time and its end, for the field `info` of an environment.
    fn truth<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyDict>> {
        let runs = alone(&self.guarded, "environment")?;
        let run = runs.get(index).and_then(Option::as_ref).ok_or_else(unset)?;
        run.truth(py)
    }

    /// A copy of a flight as it is now.
    fn save(&self, index: usize) -> PyResult<SavedFlight> {
        let runs = alone(&self.guarded, "environment")?;
        let run = runs.get(index).and_then(Option::as_ref).ok_or_else(unset)?;
        Ok(SavedFlight {
            plan: Arc::clone(&self.plan),
            run: run.clone(),
        })
    }

    /// A copy of all flights, for `copy.deepcopy`.
    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let runs = alone(&self.guarded, "environment")?.clone();
        Ok(Self {
            plan: Arc::clone(&self.plan),
            guarded: Mutex::new(runs),
        })
    }

    /// Goes on from a copy.
    fn restore(&self, index: usize, moment: &SavedFlight) -> PyResult<()> {
        let mut runs = alone(&self.guarded, "environment")?;
        if moment.plan.file != self.plan.file || moment.plan.scan_ticks != self.plan.scan_ticks {
            return Err(input("moment: it is of an environment with other keys"));
        }
        let place = runs
            .get_mut(index)
            .ok_or_else(|| input("index: there is no such flight"))?;
        *place = Some(moment.run.clone());
        Ok(())
    }
}

#[pymethods]
impl SavedFlight {
    /// The moment to which these actions lead.
    #[staticmethod]
    fn replayed(file: &str, scan_ticks: u32, seed: u64, actions: Vec<[f64; 2]>) -> PyResult<Self> {
        let file = serde_json::from_str(file).map_err(input)?;
        let hz = f64::from(TICKS_PER_SECOND) / f64::from(scan_ticks.max(1));
        let plan = Arc::new(Flights::new(file, hz, [0.0, 1.0, 0.0])?);
        let mut run = Some(Run::new(&plan, seed)?);
        for action in actions {
            fly(&mut run, &plan, action)?;
        }
        let run = run.ok_or_else(unset)?;
        Ok(Self { plan, run })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let make = slf.get_type().getattr("replayed")?;
        let Self { plan, run } = slf.get();
        let file = serde_json::to_string(&plan.file).map_err(input)?;
        let arguments = (file, plan.scan_ticks, run.seed, run.actions.clone());
        (make, arguments).into_pyobject(slf.py())
    }
}

fn single(values: [f64; 2]) -> [f32; 2] {
    values.map(|value| value as f32)
}

fn unset() -> PyErr {
    state("the environment was not reset: call reset first")
}

impl Flights {
    fn new(file: ScenarioFile, lidar_hz: f64, shaping: [f64; 3]) -> PyResult<Self> {
        let base = scenario::of_sensors(file.build().map_err(errors::scenario)?)?;
        let scan_ticks = f64::from(TICKS_PER_SECOND) / lidar_hz;
        let whole =
            (1.0..=1e6).contains(&scan_ticks) && (scan_ticks - scan_ticks.round()).abs() < 1e-9;
        if !whole {
            return Err(input(
                "lidar_hz: give a rate of which 100 Hz is a whole multiple, such as 10",
            ));
        }
        Ok(Self {
            scan_ticks: scan_ticks.round() as u32,
            shaping: Shaping::new(shaping)?,
            ranges: controls(&base)?,
            file,
            base,
        })
    }
}

impl Run {
    fn new(plan: &Flights, seed: u64) -> PyResult<Self> {
        let greatest = plan.base.lidar.range_max as f32;
        let scenario = Scenario {
            seed,
            ..plan.base.clone()
        };
        let mut run = Self {
            scan: vec![greatest; scenario.lidar.beams],
            episode: Episode::new(scenario, plan.scan_ticks)?,
            seed,
            actions: Vec::new(),
            air: [0.0; 2],
            place: [0.0; 2],
            ticks: [0; 2],
        };
        let (start, trim) = (*run.episode.state(), run.episode.state().air);
        run.air = [trim.airspeed, trim.pitch];
        run.place = [start.x, start.z];
        run.look();
        Ok(run)
    }

    /// Takes in what the sensors say.
    fn look(&mut self) {
        let readings = self.episode.measure();
        if let Some(air) = readings.frame.air {
            self.air = [air.airspeed, air.pitch];
        }
        if let Some(position) = readings.frame.position {
            self.place = [position.x, position.z];
            self.ticks[0] = position.tick;
        }
        if let Some(scan) = readings.scan {
            let greatest = self.episode.scenario.lidar.range_max;
            self.scan = seen(&scan.ranges, greatest).collect();
            self.ticks[1] = scan.tick;
        }
    }

    /// What the agent knows; see [`Batch::observe`].
    fn known<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let pair = |values| PyArray1::from_slice(py, &single(values));
        dict.set_item(intern!(py, "lidar"), PyArray1::from_slice(py, &self.scan))?;
        dict.set_item(intern!(py, "air"), pair(self.air))?;
        dict.set_item(intern!(py, "position"), pair(self.place))?;
        dict.set_item(intern!(py, "age"), pair(self.ages()))?;
        Ok(dict)
    }

    /// The flight's true place, its time, its end and its seed.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = self.episode.truth(py)?;
        dict.set_item(intern!(py, "seed"), self.seed)?;
        Ok(dict)
    }

    /// Ages of position and scan [s].
    fn ages(&self) -> [f64; 2] {
        self.ticks
            .map(|tick| Scenario::time(self.episode.tick.saturating_sub(tick)))
    }
}

/// Whether a flight is under way and can take an action.
fn check(run: Option<&Run>, action: [f64; 2]) -> PyResult<()> {
    if run.ok_or_else(unset)?.episode.outcome().is_some() {
        return Err(state("the flight has ended: call reset"));
    }
    if action.iter().all(|share| (-1.0..=1.0).contains(share)) {
        return Ok(());
    }
    let [elevator, thrust] = action;
    let advice = format!("actions: give -1 to 1, not {elevator} and {thrust}");
    Err(input(advice))
}

/// Flies one tick. Gives the reward, and whether the flight failed or came to its end. The reward of a flight to the
/// end is about 1: the share of the way at cruise, less what the shaping costs. A failure costs 1.
fn fly(run: &mut Option<Run>, plan: &Flights, action: [f64; 2]) -> PyResult<(f64, bool, bool)> {
    check(run.as_ref(), action)?;
    let run = run.as_mut().ok_or_else(unset)?;
    let between =
        |[least, most]: [f64; 2], share: f64| least + (most - least) * 0.5 * (share + 1.0);
    let command = Control {
        elevator: between(plan.ranges[0], action[0]),
        thrust: between(plan.ranges[1], action[1]),
    };
    let before = run.episode.state().x;
    run.episode.step(command)?;
    run.actions.push(action);
    let way = plan.base.aircraft.trim.state.airspeed * plan.base.duration();
    let advance = (run.episode.state().x - before) / way;
    let advance = advance - plan.shaping.cost(&run.episode, command, &plan.ranges);
    let failed = run.episode.failed();
    let ended = !failed && run.episode.is_through();
    run.look();
    Ok((if failed { advance - 1.0 } else { advance }, failed, ended))
}
