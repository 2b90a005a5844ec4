//! Python values to numbers.

use crate::errors::input;
use crate::typed::typed;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::de::DeserializeOwned;

/// What a dict with the keys of a file says. An error names the key.
pub(crate) fn table<T: DeserializeOwned>(what: &str, keys: &Bound<'_, PyDict>) -> PyResult<T> {
    let own = PyDict::new(keys.py());
    for (key, value) in keys {
        if !value.is_none() {
            own.set_item(key, value)?;
        }
    }
    typed(what, &own)
}

/// The text of a file.
pub(crate) fn text(path: &Bound<'_, PyAny>) -> PyResult<String> {
    let paths = path.py().import("pathlib")?;
    let path = paths.call_method1("Path", (path,))?;
    path.call_method1("read_text", ("utf-8-sig",))?.extract()
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

/// A whole number that is not negative and fits.
pub(crate) fn whole<T: TryFrom<i128>>(name: &str, value: i128) -> PyResult<T> {
    T::try_from(value).map_err(|_| {
        let bits = 8 * size_of::<T>();
        let advice = format!("{name}: give a whole number from 0 to 2**{bits} - 1, not {value}");
        input(advice)
    })
}

/// A finite number.
pub(crate) fn finite(name: &str, value: f64) -> PyResult<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(input(format!("{name}: give a finite number, not {value}")))
    }
}
