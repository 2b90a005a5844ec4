//! The world of a flight for a loop of the caller's own.

use crate::episode::Episode;
use crate::errors::{alone, state};
use crate::input::{argument, finite};
use crate::scenario;
use mpp_core::vehicle::Control;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::pythonize;
use std::sync::Mutex;

/// Plant, field and sensors of a scenario, one tick of 10 ms at a time. With `Core` in the loop it flies what `fly`
/// flies, bit for bit.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct World {
    guarded: Mutex<Stage>,
}

/// The flight, and whether the present tick has been measured.
struct Stage {
    episode: Episode,
    measured: bool,
}

#[pymethods]
impl World {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let none = PyDict::new(py);
        let scenario = scenario::sensed(keys.unwrap_or(&none))?;
        let scan_ticks = scenario.replan_ticks;
        let guarded = Mutex::new(Stage {
            episode: Episode::new(scenario, scan_ticks)?,
            measured: false,
        });
        Ok(Self { guarded })
    }

    /// What the sensors deliver in this tick: the arguments of `Core.step`. Once a tick.
    fn measure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let mut stage = alone(&self.guarded, "world")?;
        stage.open()?;
        if stage.measured {
            return Err(state("this tick is measured: call step"));
        }
        stage.measured = true;
        let readings = stage.episode.measure();
        let (tick, dict) = (stage.episode.tick, PyDict::new(py));
        if let Some(air) = readings.frame.air {
            dict.set_item("airspeed", air.airspeed)?;
            dict.set_item("pitch", air.pitch)?;
            dict.set_item("air_age", tick - air.tick)?;
        }
        if let Some(position) = readings.frame.position {
            dict.set_item("x", position.x)?;
            dict.set_item("z", position.z)?;
            dict.set_item("sigma", position.sigma)?;
            dict.set_item("position_age", tick - position.tick)?;
            if let Some(velocity) = position.velocity {
                dict.set_item("velocity", (velocity.x, velocity.z, velocity.sigma))?;
            }
        }
        if let Some(scan) = readings.scan {
            dict.set_item("scan", PyArray1::from_slice(py, &scan.ranges))?;
        }
        Ok(dict)
    }

    /// Flies one tick with this thrust [N] and elevator [-]. Gives true while the flight goes on.
    fn step(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = argument)] thrust: f64,
        #[pyo3(from_py_with = argument)] elevator: f64,
    ) -> PyResult<bool> {
        let mut stage = alone(&self.guarded, "world")?;
        stage.open()?;
        let command = Control {
            thrust: finite("thrust", thrust)?,
            elevator: finite("elevator", elevator)?,
        };
        if !stage.measured {
            return Err(state("this tick is not measured: call measure first"));
        }
        stage.measured = false;
        let episode = &mut stage.episode;
        py.detach(|| episode.step(command))?;
        Ok(stage.is_open())
    }

    /// The true state: time [s], position [m], airspeed [m/s], angles [rad], and the wind [m/s].
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let stage = alone(&self.guarded, "world")?;
        let (at, wind) = (stage.episode.state(), stage.episode.wind());
        let dict = PyDict::new(py);
        let time = mpp_sim::scenario::Scenario::time(stage.episode.tick);
        let values = [
            ("t", time),
            ("x", at.x),
            ("z", at.z),
            ("airspeed", at.air.airspeed),
            ("pitch", at.air.pitch),
            ("pitch_rate", at.air.pitch_rate),
            ("flight_path", at.air.flight_path),
            ("wind_x", wind.x),
            ("wind_z", wind.z),
        ];
        for (name, value) in values {
            dict.set_item(name, value)?;
        }
        Ok(dict)
    }

    /// How the flight ended, as in a flight's summary; `None` while it goes on.
    #[getter]
    fn outcome<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let stage = alone(&self.guarded, "world")?;
        if stage.is_open() {
            return Ok(None);
        }
        let outcome = stage
            .episode
            .end
            .unwrap_or(mpp_sim::outcome::Outcome::Survived);
        Ok(Some(pythonize(py, &outcome)?))
    }
}

impl Stage {
    fn is_open(&self) -> bool {
        self.episode.end.is_none() && !self.episode.is_through()
    }

    fn open(&self) -> PyResult<()> {
        if self.is_open() {
            return Ok(());
        }
        Err(state("the flight has ended: make another world"))
    }
}
