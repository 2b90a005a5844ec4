//! Aircraft.

use crate::errors::{flight, input, scenario as refused, set_up};
use crate::input::text;
use crate::output::{flat, plain};
use crate::typed::{typed, unlike};
use mpp_analysis::recording;
use mpp_core::control::Lqr;
use mpp_core::vehicle::{JacobianForm, linearize};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::scenario::{Preset, Scenario, ScenarioError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// An aircraft: one that comes with the project, by its name; a file as docs/aircraft.md describes; or a dict with
/// the keys of such a file.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Aircraft {
    pub(crate) model: AircraftModel,
}

#[pymethods]
impl Aircraft {
    #[new]
    #[pyo3(signature = (source = None))]
    fn new(py: Python<'_>, source: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Some(source) = source else {
            let model = AircraftModel::reference();
            return Ok(Self { model });
        };
        let (name, file) = if let Ok(keys) = source.cast::<PyDict>() {
            (None, typed("aircraft", keys)?)
        } else {
            let name = source.str()?.to_string_lossy().into_owned();
            match AircraftFile::known(&name) {
                Some(known) => (None, known),
                None if is_name(source) => return Err(unknown(&name)),
                None => {
                    let (path, text) = text("aircraft", source)?;
                    let file = AircraftFile::parse(&path, &text).map_err(refused)?;
                    (Some(path), file)
                }
            }
        };
        // The design of the regulator takes a while.
        let model = py.detach(|| AircraftModel::new(file));
        let in_file = |error| match name {
            Some(name) => refused(ScenarioError::File(name, Box::new(error))),
            None => refused(error),
        };
        Ok(Self {
            model: model.map_err(in_file)?,
        })
    }

    /// The names of the aircraft that come with the project.
    #[staticmethod]
    fn known() -> Vec<&'static str> {
        AircraftFile::KNOWN.map(|(name, _)| name).to_vec()
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.model.file.name
    }

    /// Its numbers: a dict with the keys of an aircraft file.
    #[getter]
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.model.file)
    }

    /// Level flight: airspeed [m/s], pitch [rad], thrust [N], elevator [-].
    #[getter]
    fn trim<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let trim = &self.model.trim;
        let dict = PyDict::new(py);
        dict.set_item("airspeed", trim.state.airspeed)?;
        dict.set_item("pitch", trim.state.pitch)?;
        dict.set_item("thrust", trim.control.thrust)?;
        dict.set_item("elevator", trim.control.elevator)?;
        Ok(dict)
    }

    /// The motion about level flight to first order, dx/dt = A x + B u, without actuators: a dict of A and B, and of
    /// the names and units of states and inputs, which are deviations from `trim`. The elevator's unit is that of its file. K is
    /// the gain of the core's regulator: elevator = -K x.
    fn linearize<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (model, trim) = (&self.model, &self.model.trim);
        let exact = JacobianForm::Exact;
        let linear = linearize(&model.known.airframe, &trim.state, trim.control, exact);
        let dict = PyDict::new(py);
        let (a, b) = (linear.a.transpose(), linear.b.transpose());
        dict.set_item("A", flat(py, a.iter().copied(), [4, 4])?)?;
        dict.set_item("B", flat(py, b.iter().copied(), [4, 2])?)?;
        dict.set_item("states", ["airspeed", "pitch", "pitch_rate", "flight_path"])?;
        dict.set_item("state_units", ["m/s", "rad", "rad/s", "rad"])?;
        dict.set_item("inputs", ["thrust", "elevator"])?;
        let elevator = plain(py, &model.file.elevator.unit)?;
        dict.set_item("input_units", ("N", elevator))?;
        let aircraft = model.clone();
        let scenario = Scenario {
            aircraft,
            ..Scenario::new(Preset::Flight, 1)
        };
        let settings = recording::settings(&scenario).map_err(flight)?;
        let lqr = Lqr::design(&linear, &settings.regulator).map_err(set_up)?;
        dict.set_item("K", flat(py, lqr.gain.iter().copied(), [1, 4])?)?;
        Ok(dict)
    }

    /// Gain, phase and delay margin of the regulator at the elevator, in level flight at 100 Hz with commands that come a
    /// tick late. Needs python-control.
    fn margins<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let linear = slf.get().linearize(slf.py())?;
        let analysis = slf.py().import("mppflight.analysis")?;
        analysis.call_method1("margins", (linear,))
    }

    /// The factor on the lengths of fields, lidar and band that makes them as hard as those of the paper's aircraft.
    #[getter]
    fn world_scale(&self) -> f64 {
        self.model.units().length
    }

    fn __repr__(&self) -> String {
        format!("Aircraft({:?})", self.model.file.name)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let numbers = slf.get().numbers(slf.py())?;
        Ok((slf.get_type().into_any(), (numbers,)))
    }
}

/// Whether a text can only be meant as a name: a file's has an ending or a folder.
fn is_name(source: &Bound<'_, PyAny>) -> bool {
    let text = source.cast::<PyString>().map(|text| text.to_string());
    text.is_ok_and(|text| !text.contains(['.', '/', '\\']))
}

fn unknown(name: &str) -> PyErr {
    let known = AircraftFile::KNOWN.map(|(known, _)| known);
    let advice = unlike(&format!("`{name}`"), name, &known);
    input(format!("aircraft: {advice}, a file, or a dict of its keys"))
}
