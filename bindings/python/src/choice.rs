//! A flight for learning in which the agent chooses among the planner's candidates, once each cycle.

use crate::aside::aside;
use crate::episode::{Episode, Shaping, controls, scales, seen};
use crate::errors::{self, FlightError, alone, input, state};
use crate::field::Field;
use crate::output::flat;
use crate::scenario;
use mpp_analysis::recording;
use mpp_core::config::KNOTS;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::plane::MAX_CANDIDATES;
use mpp_core::planner::{Planner, Verdict};
use mpp_core::settings::Settings;
use mpp_core::trajectory::Trajectory;
use mpp_sim::field::FieldFile;
use mpp_sim::inspector::core_scan;
use mpp_sim::scenario::{ALTITUDE, Scenario, ScenarioFile, TICKS_PER_SECOND};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::{Arc, Mutex};

/// A flight of preset `flight`. `python/mppflight/environments.py` makes an environment of it.
#[pyclass(frozen, module = "mppflight._native")]
pub(crate) struct Choice {
    plan: Arc<Plan>,
    guarded: Mutex<Option<Box<Run>>>,
}

/// What every flight of an environment has in common.
struct Plan {
    file: ScenarioFile,
    base: Scenario,
    shaping: Shaping,
    /// Elevator and thrust that an agent would have.
    ranges: [[f64; 2]; 2],
}

/// A flight between a scan and the choice of its plan. It is large: it is made, copied and flown on a stack of our own
/// (`aside`), and stays in its box.
#[derive(Clone)]
struct Run {
    episode: Episode,
    flight: FlightLoop,
    planner: Box<Planner>,
    /// The planner's verdict on its own best plan.
    verdict: Verdict,
    /// Indices of the candidates by price.
    order: Vec<(usize, f64)>,
    scan: Vec<f32>,
    /// The choice that waits until its plan is due.
    chosen: Option<(Verdict, Trajectory)>,
    seed: u64,
    actions: Vec<usize>,
}

/// A copy of the flight. It goes on as the original would, bit for bit, also after pickling.
#[pyclass(frozen, module = "mppflight._native")]
pub(crate) struct Fork {
    plan: Arc<Plan>,
    run: Box<Run>,
}

#[pymethods]
impl Choice {
    /// A flight of the scenario with these keys. `shaping` is that of a [`Batch`](crate::batch::Batch).
    #[new]
    #[pyo3(signature = (keys, shaping = [0.0, 1.0, 0.0]))]
    fn new(keys: &Bound<'_, PyDict>, shaping: [f64; 3]) -> PyResult<Self> {
        let plan = Arc::new(Plan::new(scenario::file(keys)?, shaping)?);
        let guarded = Mutex::new(None);
        Ok(Self { plan, guarded })
    }

    /// Greatest number of candidates, and knots of each.
    #[classattr]
    const SHAPE: (usize, usize) = (MAX_CANDIDATES, KNOTS);

    /// Number of beams, their greatest range [m], and the field of view [rad].
    #[getter]
    fn lidar(&self) -> (usize, f64, f64) {
        let lidar = &self.plan.base.lidar;
        (lidar.beams, lidar.range_max, lidar.field_of_view)
    }

    /// As those of a [`Batch`](crate::batch::Batch).
    #[getter]
    fn scales(&self) -> [f64; 4] {
        scales(&self.plan.base)
    }

    /// Cycles a second.
    #[getter]
    fn rate(&self) -> f64 {
        f64::from(TICKS_PER_SECOND) / f64::from(self.plan.base.replan_ticks)
    }

    /// The obstacles of the flight, where they are at its start.
    fn field(&self) -> PyResult<Field> {
        let run = alone(&self.guarded, "environment")?;
        let run = run.as_ref().ok_or_else(unset)?;
        Field::checked(FieldFile::of(&run.episode.scenario.field().obstacles))
    }

    /// Starts a flight, and plans its first cycle.
    fn reset(&self, py: Python<'_>, seed: u64) -> PyResult<()> {
        let mut run = alone(&self.guarded, "environment")?;
        let plan = &self.plan;
        *run = Some(aside(py, |_| Run::new(plan, seed))??);
        Ok(())
    }

    /// Flies a candidate until the next cycle is planned: 0 is the planner's own best plan, 1 the candidate with the
    /// lowest price, and so on; a number beyond the candidates keeps the last plan. Gives the reward, whether the
    /// flight failed, and whether it came to its end.
    fn step(&self, py: Python<'_>, action: usize) -> PyResult<(f64, bool, bool)> {
        let mut run = alone(&self.guarded, "environment")?;
        let run = run.as_mut().ok_or_else(unset)?;
        aside(py, |_| run.fly(&self.plan, action))?
    }

    /// What the agent knows: the scan [m], the greatest range where nothing came back; airspeed [m/s], pitch and flight path angle [rad] and height above the
    /// altitude [m] as estimated; the candidates by price, as places from the aircraft [m]; their prices; and which
    /// actions there are: the planner's own plan always, and the candidates.
    fn observe_one<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let run = alone(&self.guarded, "environment")?;
        let run = run.as_ref().ok_or_else(unset)?;
        let at = run.flight.state();
        let mut knots = vec![0.0_f32; MAX_CANDIDATES * KNOTS * 2];
        let (mut prices, mut mask) = ([MOST; MAX_CANDIDATES], [0_i8; MAX_CANDIDATES + 1]);
        mask[0] = 1;
        let mut offered = Trajectory::new();
        let planner = run.planner.plane();
        for (place, (index, price)) in run.order.iter().enumerate() {
            prices[place] = (*price as f32).min(MOST);
            mask[place + 1] = 1;
            planner.and_then(|own| own.offer(*index, &mut offered));
            let places = knots[place * KNOTS * 2..].chunks_exact_mut(2);
            for (cell, knot) in places.zip(&offered.knots) {
                cell[0] = (knot.state.x - at.x) as f32;
                cell[1] = (knot.state.z - at.z) as f32;
            }
        }
        let dict = PyDict::new(py);
        dict.set_item("lidar", PyArray1::from_slice(py, &run.scan))?;
        let air = [
            at.air.airspeed,
            at.air.pitch,
            at.air.flight_path,
            at.z - ALTITUDE,
        ];
        let air = air.map(|value| value as f32);
        dict.set_item("state", PyArray1::from_slice(py, &air))?;
        let knots = flat(py, knots.into_iter(), [MAX_CANDIDATES * KNOTS, 2])?;
        dict.set_item("candidates", knots.reshape([MAX_CANDIDATES, KNOTS, 2])?)?;
        dict.set_item("price", PyArray1::from_slice(py, &prices))?;
        dict.set_item("mask", PyArray1::from_slice(py, &mask))?;
        Ok(dict)
    }

    /// The flight's true place, its time and its end, for the field `info` of an environment.
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let run = alone(&self.guarded, "environment")?;
        let run = run.as_ref().ok_or_else(unset)?;
        let dict = run.episode.truth(py)?;
        dict.set_item("seed", run.seed)?;
        Ok(dict)
    }

    /// A copy of the flight as it is now.
    fn save(&self, py: Python<'_>) -> PyResult<Fork> {
        let run = alone(&self.guarded, "environment")?;
        let run = run.as_ref().ok_or_else(unset)?;
        let run = aside(py, |_| run.clone())?;
        let plan = Arc::clone(&self.plan);
        Ok(Fork { plan, run })
    }

    /// A copy of the flight, for `copy.deepcopy`.
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        let run = alone(&self.guarded, "environment")?;
        let run = aside(py, |_| run.clone())?;
        Ok(Self {
            plan: Arc::clone(&self.plan),
            guarded: Mutex::new(run),
        })
    }

    /// Goes on from a copy.
    fn restore(&self, py: Python<'_>, fork: &Fork) -> PyResult<()> {
        if fork.plan.file != self.plan.file {
            return Err(input("fork: it is of an environment with other keys"));
        }
        let mut run = alone(&self.guarded, "environment")?;
        *run = Some(aside(py, |_| fork.run.clone())?);
        Ok(())
    }
}

#[pymethods]
impl Fork {
    /// The flight to which these actions lead.
    #[staticmethod]
    fn replayed(py: Python<'_>, file: &str, seed: u64, actions: Vec<usize>) -> PyResult<Self> {
        let file = serde_json::from_str(file).map_err(input)?;
        let plan = Arc::new(Plan::new(file, [0.0, 1.0, 0.0])?);
        let run = aside(py, |_| {
            let mut run = Run::new(&plan, seed)?;
            for action in actions {
                run.fly(&plan, action)?;
            }
            PyResult::Ok(run)
        })??;
        Ok(Self { plan, run })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let make = slf.get_type().getattr("replayed")?;
        let Self { plan, run } = slf.get();
        let file = serde_json::to_string(&plan.file).map_err(input)?;
        (make, (file, run.seed, run.actions.clone())).into_pyobject(slf.py())
    }
}

/// Price in observations of what has none [-].
const MOST: f32 = 1e6;

fn unset() -> PyErr {
    state("the environment was not reset: call reset first")
}

impl Plan {
    fn new(file: ScenarioFile, shaping: [f64; 3]) -> PyResult<Self> {
        let base = scenario::of_sensors(file.build().map_err(errors::scenario)?)?;
        if base.preset != mpp_sim::scenario::Preset::Flight {
            return Err(input("preset: only flight has candidates"));
        }
        // A cycle here starts from the scan of its tick and ends at once. The core plans without a scan, too.
        let scan = &base.faults.scan;
        let odd = [
            (file.slices_per_tick.is_some(), "slices_per_tick"),
            (scan.delay_ms.is_some(), "faults.scan.delay_ms"),
            (scan.missing, "faults.scan.missing"),
            (scan.one_late, "faults.scan.one_late"),
            (scan.show.is_some(), "faults.scan.show"),
        ];
        if let Some((_, key)) = odd.iter().find(|(given, _)| *given) {
            return Err(input(format!(
                "{key}: leave it out, choices cannot fly it as fly does"
            )));
        }
        Ok(Self {
            shaping: Shaping::new(shaping)?,
            ranges: controls(&base)?,
            file,
            base,
        })
    }
}

impl Run {
    fn new(plan: &Plan, seed: u64) -> PyResult<Box<Self>> {
        let scenario = Scenario {
            seed,
            ..plan.base.clone()
        };
        let settings: Settings = recording::settings(&scenario).map_err(errors::flight)?;
        let mut run = Box::new(Self {
            scan: vec![scenario.lidar.range_max as f32; scenario.lidar.beams],
            flight: FlightLoop::new(&settings).map_err(errors::set_up)?,
            planner: recording::planner(&settings).map_err(errors::flight)?,
            episode: Episode::new(scenario, plan.base.replan_ticks)?,
            verdict: Verdict::Nothing,
            order: Vec::new(),
            chosen: None,
            seed,
            actions: Vec::new(),
        });
        run.tick(plan)?;
        Ok(run)
    }

    /// Adopts a plan that is due, steps, and plans if there is a scan. Then flies one tick. Gives what it costs.
    fn tick(&mut self, plan: &Plan) -> PyResult<f64> {
        let readings = self.episode.measure();
        let now = self.episode.tick;
        let time = Scenario::time(now);
        let since = now % plan.base.replan_ticks;
        if since == plan.base.latency_ticks % plan.base.replan_ticks
            && let Some((verdict, chosen)) = self.chosen.take()
        {
            self.flight.adopt(time, verdict, &chosen);
        }
        let output = self
            .flight
            .step(time, &mpp_node::sensor_frame(&readings.frame));
        if output.moved {
            // A choice that waits, and the map, count from estimates that are no more.
            self.chosen = None;
            self.planner.forget();
        }
        if let Some(scan) = readings.scan {
            self.scan = seen(&scan.ranges, plan.base.lidar.range_max).collect();
            self.plan(time, &scan)?;
        }
        self.episode.step(output.control)?;
        Ok((plan.shaping).cost(&self.episode, output.control, &plan.ranges))
    }

    fn plan(&mut self, time: f64, scan: &hil_protocol::LidarScan) -> PyResult<()> {
        let poses = self
            .flight
            .poses_at(self.episode.tick.saturating_sub(scan.tick));
        let poses =
            poses.ok_or_else(|| FlightError::new_err("the scan is too old for the core"))?;
        let (state, conditions) = (self.flight.planned_from(), self.flight.conditions());
        let planner = &mut self.planner;
        planner.begin_from(time, &poses, &state, &conditions, Some(&core_scan(scan)));
        while planner.advance() {}
        self.verdict = planner.finish();
        let mut offered = Trajectory::new();
        self.order.clear();
        if let Some(own) = planner.plane() {
            let prices = (0..own.offers())
                .filter_map(|it| own.offer(it, &mut offered).map(|price| (it, price)));
            self.order.extend(prices);
        }
        self.order.sort_by(|one, other| one.1.total_cmp(&other.1));
        Ok(())
    }

    /// Flies a choice until the next cycle is planned.
    fn fly(&mut self, plan: &Plan, action: usize) -> PyResult<(f64, bool, bool)> {
        if self.episode.outcome().is_some() {
            return Err(state("the flight has ended: call reset"));
        }
        self.actions.push(action);
        let candidate = action.checked_sub(1).map(|place| self.order.get(place));
        let taken = match candidate {
            None => self.verdict,
            Some(None) => Verdict::Nothing,
            Some(Some((index, _))) => {
                let own = self.planner.plane_mut();
                own.and_then(|own| own.choose(*index));
                Verdict::Feasible
            }
        };
        self.chosen = Some((taken, self.planner.best().clone()));
        let (before, mut cost) = (self.episode.state().x, 0.0);
        while self.episode.outcome().is_none() {
            let next = self.episode.tick.is_multiple_of(plan.base.replan_ticks);
            cost += self.tick(plan)?;
            if next {
                break;
            }
        }
        let way = plan.base.aircraft.trim.state.airspeed * plan.base.duration();
        let advance = (self.episode.state().x - before) / way - cost;
        let failed = self.episode.failed();
        let reward = if failed { advance - 1.0 } else { advance };
        Ok((reward, failed, !failed && self.episode.is_through()))
    }
}
