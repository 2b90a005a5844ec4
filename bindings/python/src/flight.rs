//! Whole flights.

use crate::aside::aside;
use crate::errors::{self, input};
use crate::field::Field;
use crate::output::{columns, flat, plain};
use crate::scenario;
use mpp_sim::entries::{Columns, LateralColumns};
use mpp_sim::flight::fly_with;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::Ground;
use mpp_sim::pipe::PipeLink;
use mpp_sim::space::{Look, SpaceCycle, SpacePipe, fly_space_with};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::sync::atomic::{AtomicBool, Ordering};

/// A ground that ends the flight when Python has a signal.
struct Signalled<'a>(&'a AtomicBool);

impl Ground for Signalled<'_> {
    fn interrupts(&mut self, _: u32) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Flies a scenario with the core in this process. The arguments are the keys of a scenario file, as
/// docs/scenarios/example.toml; `scenario` names such a file. With `preset="space"` they are those of a flight in space.
#[pyfunction]
#[pyo3(signature = (**keys))]
pub(crate) fn fly(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Flight> {
    let none = PyDict::new(py);
    let keys = keys.unwrap_or(&none);
    if let Some(scenario) = scenario::in_space(keys)? {
        let flown = aside(py, |stop| {
            let stops = || stop.load(Ordering::Relaxed);
            fly_space_with(&scenario, &mut SpacePipe::of(&scenario), stops)
        })?;
        return Flight::new(flown.map_err(errors::flight)?);
    }
    let scenario = scenario::build(keys)?;
    let flown = aside(py, |stop| {
        fly_with(
            &scenario,
            &mut PipeLink::of(&scenario),
            &mut Signalled(stop),
        )
    })?;
    Flight::new(flown.map_err(errors::flight)?)
}

/// A flight from its parameters to its outcome.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Flight {
    log: FlightLog,
    bytes: Vec<u8>,
    hash: String,
}

impl Flight {
    fn new(log: FlightLog) -> PyResult<Self> {
        let bytes = log.to_json().map_err(input)?;
        let hash = log.hash().map_err(input)?;
        Ok(Self { log, bytes, hash })
    }
}

#[pymethods]
impl Flight {
    /// The flight of a log's bytes, as `to_json` gives them and `sil-harness fly` writes them.
    #[staticmethod]
    fn from_json(log: &Bound<'_, PyAny>) -> PyResult<Self> {
        let log = log.cast::<PyBytes>();
        let log = log.map_err(|_| input("log: give the bytes of a log"))?;
        Self::new(FlightLog::from_json(log.as_bytes()).map_err(input)?)
    }

    /// The log as JSON, byte for byte what `sil-harness fly` writes.
    fn to_json<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.bytes)
    }

    /// First 16 hexadecimal digits of the SHA-256 of the log: the same for a seed on every machine.
    #[getter]
    fn log_hash(&self) -> &str {
        &self.hash
    }

    /// The ticks of the flight, one column a quantity; SI units. References are NaN without a plan.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut all = ticks(&self.log.ticks);
        if !self.log.lateral.is_empty() {
            all.extend(lateral(&self.log.lateral));
        }
        columns(py, all)
    }

    /// What there was to see of a flight in space, which is flown again for it: `bodies`, what stood there; `at`, `attitude` (a
    /// quaternion w, x, y, z that turns ahead, right, down of the body into those of the world) and `clearance`, at the start and after each tick; `cycles`,
    /// each with its `tick`, `hits` and `paths`. Places are ahead, right and up [m].
    fn look<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        if self.log.header.space.is_none() {
            return Err(input(
                "look: this flight is in the vertical plane: its field and columns have all",
            ));
        }
        let again = "look: flown again, the flight does not come out the same: its log is of another version";
        let look = py
            .detach(|| Look::again(&self.log))
            .ok_or_else(|| input(again))?;
        let (dict, count) = (PyDict::new(py), look.moments.len());
        let at = look.moments.iter().flat_map(|it| it.0);
        let attitude = look.moments.iter().flat_map(|it| it.1);
        dict.set_item("bodies", plain(py, &look.bodies)?)?;
        dict.set_item("span", look.span)?;
        dict.set_item("at", flat(py, at, [count, 3])?)?;
        dict.set_item("attitude", flat(py, attitude, [count, 4])?)?;
        let clearance = look.moments.iter().map(|it| it.3);
        dict.set_item("clearance", PyArray1::from_iter(py, clearance))?;
        let cycles = look.cycles.iter().map(|cycle| seen(py, cycle));
        dict.set_item("cycles", cycles.collect::<PyResult<Vec<_>>>()?)?;
        Ok(dict)
    }

    /// Draws field, way and tracked plan with matplotlib, into `axes` if they are given. Gives the axes.
    #[pyo3(signature = (axes = None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        axes: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let plots = slf.py().import("mppflight.plots")?;
        plots.call_method1("flight", (slf, axes))
    }

    /// What a notebook shows.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let plots = slf.py().import("mppflight.plots")?;
        plots.call_method1("flight_html", (slf,))
    }

    /// The columns as a `pandas.DataFrame`.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let pandas = py.import("pandas")?;
        pandas.call_method1("DataFrame", (self.columns(py)?,))
    }

    /// The end of the flight and its totals.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.log.summary)
    }

    /// The parameters of the flight.
    #[getter]
    fn header<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.log.header)
    }

    /// Every plan that the core delivered.
    #[getter]
    fn plans<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.log.plans)
    }

    /// Every input that the core refused.
    #[getter]
    fn rejections<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.log.rejections)
    }

    /// The obstacles.
    #[getter]
    fn field(&self) -> PyResult<Field> {
        Field::checked(self.log.header.field.clone())
    }

    fn __len__(&self) -> usize {
        self.log.ticks.t.len()
    }

    fn __repr__(&self) -> String {
        let summary = &self.log.summary;
        format!(
            "Flight(seed={}, {}, {:.2} s, log {})",
            self.log.header.seed, summary.outcome, summary.t_end, self.hash
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let make = slf.get_type().getattr("from_json")?;
        Ok((make, (slf.get().to_json(slf.py()),)))
    }
}

/// A planning cycle in space.
fn seen<'py>(py: Python<'py>, cycle: &SpaceCycle) -> PyResult<Bound<'py, PyDict>> {
    let metres = |part: &i32| 0.01 * f64::from(*part);
    let path =
        |knots: &Vec<[i32; 4]>| flat(py, knots.iter().flatten().map(metres), [knots.len(), 4]);
    let dict = PyDict::new(py);
    dict.set_item("tick", cycle.tick)?;
    dict.set_item(
        "hits",
        flat(py, cycle.hits.iter().map(metres), [cycle.hits.len() / 3, 3])?,
    )?;
    let paths = cycle.paths.iter().map(path);
    dict.set_item("paths", paths.collect::<PyResult<Vec<_>>>()?)?;
    Ok(dict)
}

/// These columns by name.
macro_rules! named {
    ($log:ident; $($column:ident),* ; $($reference:ident),*) => {
        vec![
            $((stringify!($column), $log.$column.clone()),)*
            $((stringify!($reference), with_nan(&$log.$reference)),)*
        ]
    };
}

/// The columns of a log by name.
fn ticks(log: &Columns) -> Vec<(&'static str, Vec<f64>)> {
    named!(
        log;
        t, x, z, airspeed, pitch, pitch_rate, flight_path, measured_airspeed, measured_pitch,
        est_airspeed, est_pitch, est_pitch_rate, est_flight_path, est_x, est_z, est_wind_x,
        est_wind_z, est_lift, thrust, elevator, applied_thrust, applied_elevator, wind_x, wind_z;
        ref_x, ref_z, ref_airspeed, ref_pitch, ref_pitch_rate, ref_flight_path
    )
}

/// The lateral columns of a flight in space.
fn lateral(log: &LateralColumns) -> Vec<(&'static str, Vec<f64>)> {
    named!(
        log;
        y, bank, course, sideslip, roll_rate, yaw_rate, est_y, est_bank, est_course, est_wind_y,
        aileron, rudder, applied_aileron, applied_rudder, wind_y;
        ref_y, ref_bank, ref_course
    )
}

fn with_nan(column: &[Option<f64>]) -> Vec<f64> {
    column
        .iter()
        .map(|value| value.unwrap_or(f64::NAN))
        .collect()
}
