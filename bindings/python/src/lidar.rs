//! Lidars.

use crate::errors::{input, scenario};
use crate::field::Field;
use crate::input::{argument, finite, text};
use crate::output::plain;
use crate::typed::typed;
use mpp_core::vehicle::VehicleState;
use mpp_sim::lidar::{FanLidar, Lidar as _, LidarConfig};
use mpp_sim::scenario::{LidarTable, ScenarioFile};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A lidar: a fan of beams in the vertical plane. Give a file as docs/lidars/example.toml, or its keys. What is
/// absent is that of the paper's lidar here, and that of the preset in a flight.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Lidar {
    pub(crate) table: LidarTable,
    pub(crate) config: LidarConfig,
}

#[pymethods]
impl Lidar {
    #[new]
    #[pyo3(signature = (path = None, **keys))]
    fn new(path: Option<&Bound<'_, PyAny>>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let below = match path {
            Some(path) => {
                let (path, text) = text("lidar", path)?;
                LidarTable::parse(&path, &text).map_err(scenario)?
            }
            None => LidarTable::default(),
        };
        let keys: Option<LidarTable> = keys.map(|keys| typed("lidar", keys)).transpose()?;
        let lidar = keys.unwrap_or_default().before(&below);
        // A scenario checks its lidar.
        let file = ScenarioFile {
            lidar,
            ..ScenarioFile::default()
        };
        let config = file.build().map_err(scenario)?.lidar;
        Ok(Self {
            table: lidar,
            config,
        })
    }

    /// Its keys, as in a lidar's file.
    #[getter]
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.table)
    }

    /// Angles of the beams against the body axis, nose-up positive [rad].
    #[getter]
    fn angles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let (beams, view) = (self.config.beams, self.config.field_of_view);
        let gaps = beams.saturating_sub(1).max(1) as f64;
        let angle = |beam: usize| view * (beam as f64 / gaps - 0.5);
        PyArray1::from_iter(py, (0..beams).map(angle))
    }

    /// Ranges of the beams at a place and pitch in a field [m], 0 where nothing came back. With a seed they have the
    /// error of this lidar, without one they are exact.
    #[pyo3(signature = (field, x, z, pitch = 0.0, seed = None))]
    fn scan<'py>(
        &self,
        field: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = argument)] x: f64,
        #[pyo3(from_py_with = argument)] z: f64,
        #[pyo3(from_py_with = argument)] pitch: f64,
        #[pyo3(from_py_with = argument)] seed: Option<u64>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        for (name, value) in [("x", x), ("z", z), ("pitch", pitch)] {
            finite(name, value)?;
        }
        let py = field.py();
        let field = field.cast::<Field>();
        let field = field.map_err(|_| input("field: give a Field"))?.get();
        let mut state = VehicleState {
            x,
            z,
            ..VehicleState::default()
        };
        state.air.pitch = pitch;
        let config = LidarConfig {
            range_error: seed.map_or(0.0, |_| self.config.range_error),
            ..self.config
        };
        let mut lidar = FanLidar::new(seed.unwrap_or(0), config);
        let ranges = py.detach(|| lidar.scan(&state, &field.field));
        Ok(PyArray1::from_vec(py, ranges))
    }

    /// For pickle and copy: no arguments, and the keys.
    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyAny>)> {
        Ok(((), self.numbers(py)?))
    }

    fn __repr__(&self) -> String {
        let LidarConfig {
            beams, range_max, ..
        } = self.config;
        format!("Lidar(beams={beams}, range_max={range_max})")
    }
}
