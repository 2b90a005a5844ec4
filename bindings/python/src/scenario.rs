//! The scenario of a flight from keyword arguments: the keys of a scenario file.

use crate::aircraft::Aircraft;
use crate::errors::{input, scenario};
use crate::field::Field;
use crate::input::text;
use crate::lidar::Lidar;
use crate::output;
use crate::typed::{plain, typed};
use mpp_sim::aircraft_file::AircraftFile;
use mpp_sim::scenario::{Scenario, ScenarioFile};
use mpp_sim::space::{SPACE, SpaceFile, SpaceScenario};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// The scenario that the keys describe.
pub(crate) fn build(keys: &Bound<'_, PyDict>) -> PyResult<Scenario> {
    // Drawing a field and checking an aircraft take a while.
    let file = file(keys)?;
    keys.py().detach(|| file.build()).map_err(scenario)
}

/// The flight in space that the keys describe, if they ask for that preset.
pub(crate) fn in_space(keys: &Bound<'_, PyDict>) -> PyResult<Option<SpaceScenario>> {
    let preset = keys.get_item("preset")?;
    if preset.is_none_or(|preset| !preset.eq(SPACE).unwrap_or(false)) {
        return Ok(None);
    }
    let all = PyDict::new(keys.py());
    for (key, value) in keys {
        let name = key.str()?.to_string();
        all.set_item(key, table_of(&name, &value)?)?;
    }
    let file: SpaceFile = typed("", &all)?;
    keys.py()
        .detach(|| file.build(None))
        .map(Some)
        .map_err(scenario)
}

/// The scenario that the keys describe, for something that gets no more than sensors tell.
pub(crate) fn sensed(keys: &Bound<'_, PyDict>) -> PyResult<Scenario> {
    of_sensors(build(keys)?)
}

/// A scenario without an oracle and without a known map.
pub(crate) fn of_sensors(scenario: Scenario) -> PyResult<Scenario> {
    if scenario.oracle {
        return Err(input("oracle: it needs the truth; fly(oracle=True) has it"));
    }
    if scenario.known_map {
        return Err(input(
            "known_map: it needs the field; fly(known_map=True) has it",
        ));
    }
    Ok(scenario)
}

/// The scenario file that the keys describe. `scenario` names a file; the other keys take precedence over it.
pub(crate) fn file(keys: &Bound<'_, PyDict>) -> PyResult<ScenarioFile> {
    let py = keys.py();
    let all = match keys.get_item("scenario")? {
        Some(path) if !path.is_none() => {
            let (path, text) = text("scenario", &path)?;
            let below = ScenarioFile::parse(&path, &text).map_err(scenario)?;
            output::plain(py, &below)?.cast_into::<PyDict>()?
        }
        _ => PyDict::new(py),
    };
    for (key, value) in keys {
        let name = key.str()?.to_string();
        if name != "scenario" && !(value.is_none() && all.contains(&key)?) {
            all.set_item(key, table_of(&name, &value)?)?;
        }
    }
    typed("", &all)
}

/// The value of a key as it stands in a scenario file.
fn table_of<'py>(key: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    match key {
        "aircraft" => {
            if let Ok(own) = value.cast::<Aircraft>() {
                return output::plain(py, &own.get().model.file);
            }
        }
        "field" => {
            if let Ok(own) = value.cast::<Field>() {
                return output::plain(py, &own.get().file);
            }
        }
        "lidar" => {
            if let Ok(own) = value.cast::<Lidar>() {
                return output::plain(py, &own.get().table);
            }
        }
        _ => {}
    }
    let named = |name: &str| {
        let table = PyDict::new(py);
        table.set_item(name, value)?;
        PyResult::Ok(table.into_any())
    };
    let is_text = value.is_instance_of::<PyString>() || value.hasattr("__fspath__")?;
    match key {
        "generator" if is_text => named("name"),
        "navigation" if is_text => named("source"),
        "aircraft" if is_text && AircraftFile::known(&value.str()?.to_string_lossy()).is_none() => {
            let aircraft = py.get_type::<Aircraft>().call1((value,))?;
            table_of(key, &aircraft)
        }
        "field" if is_text => table_of(key, &py.get_type::<Field>().call1((value,))?),
        "lidar" if is_text => table_of(key, &py.get_type::<Lidar>().call1((value,))?),
        _ => plain(value),
    }
}
