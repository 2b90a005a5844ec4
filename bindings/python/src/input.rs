//! Python values to numbers.

use crate::errors::input;
use crate::typed::typed;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

/// What an argument says. `InputError` puts its name in front of an error.
pub(crate) fn argument<T: DeserializeOwned>(value: &Bound<'_, PyAny>) -> PyResult<T> {
    typed("", value)
}

/// The path of the file of an aircraft, a field, a lidar or a scenario, and its text.
pub(crate) fn text(name: &str, path: &Bound<'_, PyAny>) -> PyResult<(String, String)> {
    let path = (path.py().import("pathlib")?).call_method1("Path", (path,));
    let path = path.map_err(|error| input(format!("{name}: give a file: {error}")))?;
    let shown = path.str()?.to_string_lossy().into_owned();
    if shown.contains('\0') {
        return Err(input(format!("{name}: give a file, not {}", path.repr()?)));
    }
    let text = path.call_method1("read_text", ("utf-8-sig",))?;
    Ok((shown, text.extract()?))
}

/// An array of numbers with this many axes, as `f64`.
fn numbers<'py>(name: &str, value: &Bound<'py, PyAny>, axes: usize) -> PyResult<Bound<'py, PyAny>> {
    let array = value
        .py()
        .import("numpy")?
        .call_method1("asarray", (value,))?;
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        let advice = format!("{name}: give real numbers, not an array of dtype {dtype}");
        return Err(input(advice));
    }
    let shape = array.getattr("shape")?;
    if shape.len()? != axes {
        let advice = format!("{name}: give an array with {axes} axes, not one of shape {shape}");
        return Err(input(advice));
    }
    array.call_method1("astype", ("float64",))
}

/// A vector of numbers.
pub(crate) fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = numbers(name, value, 1)?;
    Ok(array
        .cast::<PyArray1<f64>>()?
        .readonly()
        .as_array()
        .to_vec())
}

/// A matrix of numbers with this many columns, row by row.
pub(crate) fn rows<const COLUMNS: usize>(
    name: &str,
    value: &Bound<'_, PyAny>,
) -> PyResult<Vec<[f64; COLUMNS]>> {
    let array = numbers(name, value, 2)?;
    let array = array.cast::<PyArray2<f64>>()?.readonly();
    let array = array.as_array();
    if array.ncols() != COLUMNS {
        let (rows, found) = array.dim();
        let advice = format!("{name}: give {COLUMNS} columns, not shape ({rows}, {found})");
        return Err(input(advice));
    }
    Ok((array.rows().into_iter())
        .map(|row| std::array::from_fn(|column| row[column]))
        .collect())
}

/// A finite number.
pub(crate) fn finite(name: &str, value: f64) -> PyResult<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(input(format!("{name}: give a finite number, not {value}")))
    }
}
