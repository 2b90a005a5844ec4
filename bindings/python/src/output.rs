//! Numbers to Python values.

use crate::errors::input;
use mpp_core::trajectory::{Reference, Trajectory};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::pythonize;
use serde::Serialize;

/// Numbers, texts, lists and dicts, as in the JSON of the value.
pub(crate) fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    pythonize(py, value).map_err(input)
}

/// A dict of columns. Each column is handed over to NumPy without a copy.
pub(crate) fn columns<'py>(
    py: Python<'py>,
    columns: impl IntoIterator<Item = (&'static str, Vec<f64>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, column) in columns {
        dict.set_item(name, PyArray1::from_vec(py, column))?;
    }
    Ok(dict)
}

/// The knots of a trajectory as columns: time [s], state, and the controls from each knot on.
pub(crate) fn knots<'py>(py: Python<'py>, plan: &Trajectory) -> PyResult<Bound<'py, PyDict>> {
    let column = |pick: fn(&Reference) -> f64| plan.knots.iter().map(pick).collect::<Vec<f64>>();
    let times = (0..plan.knots.len()).map(|knot| plan.start + plan.stage_period * knot as f64);
    columns(
        py,
        [
            ("t", times.collect()),
            ("x", column(|it| it.state.x)),
            ("z", column(|it| it.state.z)),
            ("airspeed", column(|it| it.state.air.airspeed)),
            ("pitch", column(|it| it.state.air.pitch)),
            ("pitch_rate", column(|it| it.state.air.pitch_rate)),
            ("flight_path", column(|it| it.state.air.flight_path)),
            ("thrust", column(|it| it.feedforward.thrust)),
            ("elevator", column(|it| it.feedforward.elevator)),
        ],
    )
}

/// A matrix of this shape from its numbers, row by row.
pub(crate) fn flat<'py, T: numpy::Element>(
    py: Python<'py>,
    numbers: impl Iterator<Item = T>,
    shape: [usize; 2],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    PyArray1::from_vec(py, numbers.collect()).reshape(shape)
}
