//! What a planner can show: its plan, its candidates, its map.

use crate::errors::state;
use crate::output;
use mpp_core::config::KNOTS;
use mpp_core::map::RollingGrid;
use mpp_core::planner::Planner;
use mpp_core::planner::plane::PlanePlanner;
use mpp_core::trajectory::{Reference, Trajectory};
use mpp_core::tuning::grid::CELL;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A number of a knot: of the trajectory, the knot's number, and its reference.
type Pick = fn(&Trajectory, usize, &Reference) -> f64;

/// The plan of the last cycle as columns.
pub(crate) fn plan<'py>(py: Python<'py>, planner: &Planner) -> PyResult<Bound<'py, PyDict>> {
    if planner.summary().cost == f64::INFINITY {
        return Err(state(
            "there is no plan: give a scan, and wait until its plan is due",
        ));
    }
    output::knots(py, planner.best())
}

/// The candidates of the last cycle: prices, and one row of knots each.
pub(crate) fn candidates<'py>(py: Python<'py>, planner: &Planner) -> PyResult<Bound<'py, PyDict>> {
    let own = of_flight(planner)?;
    let mut offered = Trajectory::new();
    let (mut prices, mut plans) = (Vec::new(), Vec::new());
    while let Some(price) = own.offer(plans.len(), &mut offered) {
        prices.push(price);
        plans.push(offered.clone());
    }
    let dict = PyDict::new(py);
    dict.set_item("price", PyArray1::from_vec(py, prices))?;
    let columns: [(&str, Pick); 8] = [
        ("t", |plan, knot, _| {
            plan.start + plan.stage_period * knot as f64
        }),
        ("x", |_, _, it| it.state.x),
        ("z", |_, _, it| it.state.z),
        ("airspeed", |_, _, it| it.state.air.airspeed),
        ("pitch", |_, _, it| it.state.air.pitch),
        ("flight_path", |_, _, it| it.state.air.flight_path),
        ("thrust", |_, _, it| it.feedforward.thrust),
        ("elevator", |_, _, it| it.feedforward.elevator),
    ];
    for (name, value) in columns {
        let row = |plan: &Trajectory| {
            let knots = plan.knots.iter().enumerate();
            knots
                .map(|(knot, it)| value(plan, knot, it))
                .collect::<Vec<f64>>()
        };
        dict.set_item(name, matrix(py, plans.iter().map(row), KNOTS)?)?;
    }
    Ok(dict)
}

/// The map with memory as arrays. The first row is the lowest one, the first column the nearest.
pub(crate) fn map<'py>(py: Python<'py>, planner: &Planner) -> PyResult<Bound<'py, PyDict>> {
    let own = of_flight(planner)?;
    let (map, field) = (own.map(), own.clearance());
    let [rows, columns] = RollingGrid::SHAPE;
    let centre = |first: f64, cell: usize| first + CELL * (cell as f64 + 0.5);
    let (x, z) = (
        |col| centre(map.first_x(), col),
        |row| centre(map.floor(), row),
    );
    let bits = |mask: u128| (0..columns).map(move |col| mask >> col & 1 == 1).collect();
    let cells = |row: usize| (0..columns).map(move |col| (x(col), z(row)));
    let length = own.units().length;
    let dict = PyDict::new(py);
    dict.set_item(
        "x",
        PyArray1::from_iter(py, (0..columns).map(|col| x(col) * length)),
    )?;
    dict.set_item(
        "z",
        PyArray1::from_iter(py, (0..rows).map(|row| z(row) * length)),
    )?;
    let seen = (0..rows).map(|row| bits(map.row(row).0));
    dict.set_item("seen", matrix(py, seen, columns)?)?;
    let unknown = (0..rows).map(|row| bits(map.row(row).1));
    dict.set_item("unknown", matrix(py, unknown, columns)?)?;
    let occupied = |row| cells(row).map(|(x, z)| field.is_occupied(x, z)).collect();
    dict.set_item("occupied", matrix(py, (0..rows).map(occupied), columns)?)?;
    let distance = |row| {
        cells(row)
            .map(|(x, z)| field.distance(x, z) * length)
            .collect()
    };
    dict.set_item("distance", matrix(py, (0..rows).map(distance), columns)?)?;
    Ok(dict)
}

/// The flight planner. The paper's method has neither map nor candidates to look at.
fn of_flight(planner: &Planner) -> PyResult<&PlanePlanner> {
    let none = || state("only preset flight has candidates and a map: give preset=\"flight\"");
    planner.plane().ok_or_else(none)
}

/// A matrix of rows with this many columns; without rows an empty one.
fn matrix<'py, T: numpy::Element>(
    py: Python<'py>,
    rows: impl Iterator<Item = Vec<T>>,
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let rows: Vec<Vec<T>> = rows.collect();
    if rows.is_empty() {
        return Ok(PyArray2::zeros(py, [0, columns], false));
    }
    PyArray2::from_vec2(py, &rows).map_err(crate::errors::input)
}
