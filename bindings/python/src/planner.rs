//! The planner for scans of the caller's own.

use crate::aside::aside;
use crate::errors::{self, alone, input};
use crate::input::{argument, finite, vector};
use crate::{look, scenario};
use mpp_analysis::recording;
use mpp_core::planner::Verdict;
use mpp_core::sense::LidarScan;
use mpp_core::vehicle::{AirState, Conditions, VehicleState, Wind};
use mpp_sim::inspector::core_scan;
use mpp_sim::lidar::LidarConfig;
use mpp_sim::scenario::ALTITUDE;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Mutex;

/// A planner, set up by the keys of a scenario: preset, aircraft, paths, lidar, seed. Its map remembers the scans of
/// earlier cycles.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Planner {
    lidar: LidarConfig,
    guarded: Mutex<Box<mpp_core::planner::Planner>>,
}

#[pymethods]
impl Planner {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let none = PyDict::new(py);
        let scenario = scenario::sensed(keys.unwrap_or(&none))?;
        let planner = aside(py, |_| {
            recording::settings(&scenario).and_then(|settings| recording::planner(&settings))
        })?;
        Ok(Self {
            lidar: scenario.lidar,
            guarded: Mutex::new(planner.map_err(errors::flight)?),
        })
    }

    /// One cycle at a time [s] on the ranges of a scan [m], 0 where nothing came back, from a state: position
    /// [m], airspeed [m/s] and angles [rad], by default those of level flight; in a wind [m/s]. `pitch` must
    /// be that at which the scan was taken. Gives the verdict, "feasible", "least-violating" or "nothing", or what is
    /// flown because the gate refuses the plan, "kept", "pursuit", "reserve" or "latest"; and the totals of the cycle.
    #[pyo3(signature = (
        ranges, *, time = 0.0, x = 0.0, z = ALTITUDE, airspeed = None, pitch = None, pitch_rate = 0.0,
        flight_path = 0.0, wind = (0.0, 0.0)
    ), text_signature = "($self, ranges, *, time=0.0, x=0.0, z=50.0, airspeed=None, pitch=None, pitch_rate=0.0, \
        flight_path=0.0, wind=(0.0, 0.0))")]
    #[expect(clippy::too_many_arguments, reason = "they are the state")]
    fn plan<'py>(
        &self,
        ranges: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = argument)] time: f64,
        #[pyo3(from_py_with = argument)] x: f64,
        #[pyo3(from_py_with = argument)] z: f64,
        #[pyo3(from_py_with = argument)] airspeed: Option<f64>,
        #[pyo3(from_py_with = argument)] pitch: Option<f64>,
        #[pyo3(from_py_with = argument)] pitch_rate: f64,
        #[pyo3(from_py_with = argument)] flight_path: f64,
        #[pyo3(from_py_with = argument)] wind: (f64, f64),
    ) -> PyResult<Bound<'py, PyDict>> {
        let py = ranges.py();
        let mut planner = alone(&self.guarded, "planner")?;
        let scan = scan(&self.lidar, ranges)?;
        let level = planner.trim().state;
        let speed = planner.plane().map_or(1.0, |own| own.units().speed());
        let air = AirState {
            airspeed: airspeed.unwrap_or(level.airspeed * speed),
            pitch: pitch.unwrap_or(level.pitch),
            pitch_rate,
            flight_path,
        };
        let given = [
            ("time", time),
            ("x", x),
            ("z", z),
            ("airspeed", air.airspeed),
            ("pitch", air.pitch),
            ("pitch_rate", air.pitch_rate),
            ("flight_path", air.flight_path),
            ("wind", wind.0),
            ("wind", wind.1),
        ];
        for (name, value) in given {
            finite(name, value)?;
        }
        if air.airspeed <= 0.0 {
            let advice = format!("airspeed: give more than 0 m/s, not {}", air.airspeed);
            return Err(input(advice));
        }
        let conditions = Conditions {
            wind: Wind {
                x: wind.0,
                z: wind.1,
            },
            ..Conditions::STILL
        };
        let state = VehicleState { x, z, air };
        let planner = &mut **planner;
        let verdict = py.detach(|| {
            planner.begin(time, &state, &conditions, &scan);
            while planner.advance() {}
            planner.finish()
        });
        let summary = planner.summary();
        let dict = PyDict::new(py);
        dict.set_item("verdict", name(verdict))?;
        dict.set_item("candidates", summary.candidates)?;
        dict.set_item("feasible", summary.feasible)?;
        dict.set_item("slices", summary.slices)?;
        dict.set_item("cost", summary.cost)?;
        dict.set_item("violation", summary.violation)?;
        Ok(dict)
    }

    /// The best plan of the last cycle, one column a quantity, one row a knot; SI units.
    #[getter]
    fn best<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        look::plan(py, &**alone(&self.guarded, "planner")?)
    }

    /// The candidates of the last cycle: `price`, and matrices with a row for each candidate and a column for each
    /// knot.
    #[getter]
    fn candidates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        look::candidates(py, &**alone(&self.guarded, "planner")?)
    }

    /// The map as matrices, the lowest row first: what beams met, what is unknown, what counts as occupied, and the
    /// distance to it [m]; `x` and `z` are the centres of the cells [m].
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        look::map(py, &**alone(&self.guarded, "planner")?)
    }

    /// Forgets map and last plan.
    fn forget(&self) -> PyResult<()> {
        alone(&self.guarded, "planner")?.forget();
        Ok(())
    }
}

/// A scan of a lidar with these ranges, as the core takes it.
pub(crate) fn scan(lidar: &LidarConfig, ranges: &Bound<'_, PyAny>) -> PyResult<LidarScan> {
    let ranges: Vec<f32> = (vector("ranges", ranges)?.into_iter())
        .map(|range| range as f32)
        .collect();
    if ranges.len() != lidar.beams {
        let (beams, found) = (lidar.beams, ranges.len());
        return Err(input(format!(
            "ranges: give one for each of the {beams} beams, not {found}"
        )));
    }
    let scan = core_scan(&lidar.wire_scan(0, &ranges));
    scan.check(lidar.beams).map_err(input)?;
    Ok(scan)
}

fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Feasible => "feasible",
        Verdict::LeastViolating => "least-violating",
        Verdict::Nothing => "nothing",
        Verdict::Kept => "kept",
        Verdict::Pursuit => "pursuit",
        Verdict::Reserve => "reserve",
        Verdict::Latest => "latest",
    }
}
