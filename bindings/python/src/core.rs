//! The flight core for a loop of the caller's own.

use crate::aside::aside;
use crate::errors::{self, FlightError, alone, input, state};
use crate::input::{argument, finite};
use crate::planner::scan;
use crate::{look, scenario};
use hil_protocol::{
    ActuatorCommand, AirData, ControlMode, GroundVelocity, Message, Position, SensorFrame,
    StepReport,
};
use mpp_sim::link::{Link, LinkError};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::Scenario;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::VecDeque;
use std::sync::Mutex;

/// The flight core, set up by the keys of a scenario: preset, aircraft, paths, replan_hz, latency_ms,
/// slices_per_tick, lidar, seed. It is the node that flies in the harness and on a flight computer, one step a tick.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Core {
    scenario: Scenario,
    guarded: Mutex<Stepped>,
}

/// A core and its last answer.
struct Stepped {
    link: PipeLink,
    tick: u32,
    answer: Option<(ActuatorCommand, StepReport)>,
    refused: VecDeque<(u32, String)>,
    refusals: u64,
}

/// Number of refused inputs that a core keeps.
const MOST_REFUSED: usize = 1000;

/// What a step gets.
type Inputs = (SensorFrame, Option<hil_protocol::LidarScan>);

#[pymethods]
impl Core {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(py: Python<'_>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let none = PyDict::new(py);
        let scenario = scenario::sensed(keys.unwrap_or(&none))?;
        let link = aside(py, |_| PipeLink::configured(&scenario.configure()))?
            .map_err(|error| errors::flight(error.into()))?;
        let guarded = Mutex::new(Stepped {
            link,
            tick: 0,
            answer: None,
            refused: VecDeque::new(),
            refusals: 0,
        });
        Ok(Self { scenario, guarded })
    }

    /// One step of 10 ms: takes what arrived in this tick, and gives thrust [N] and elevator [-]. Airspeed [m/s] and
    /// pitch [rad] belong together; so do `x` and `z` [m], with their standard deviation `sigma`, and perhaps
    /// the velocity over ground as x, z and its standard deviation [m/s]. Ages are ticks since the measurement. A scan
    /// holds the ranges [m], 0 where nothing came back; it starts a planning cycle.
    #[pyo3(signature = (
        airspeed = None, pitch = None, *, air_age = 0, x = None, z = None, sigma = 0.02, position_age = 0,
        velocity = None, scan = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are the sensors")]
    fn step(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = argument)] airspeed: Option<f64>,
        #[pyo3(from_py_with = argument)] pitch: Option<f64>,
        #[pyo3(from_py_with = argument)] air_age: u32,
        #[pyo3(from_py_with = argument)] x: Option<f64>,
        #[pyo3(from_py_with = argument)] z: Option<f64>,
        #[pyo3(from_py_with = argument)] sigma: f64,
        #[pyo3(from_py_with = argument)] position_age: u32,
        #[pyo3(from_py_with = argument)] velocity: Option<(f64, f64, f64)>,
        scan: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(f64, f64)> {
        let mut core = alone(&self.guarded, "core")?;
        let tick = core.tick;
        let air = pair(("airspeed", airspeed), ("pitch", pitch))?;
        let place = pair(("x", x), ("z", z))?;
        if !(0.0..=f64::from(f32::MAX)).contains(&sigma) {
            return Err(input(format!("sigma: give 0 or more, not {sigma}")));
        }
        let speeds = velocity.map(|(x, z, sigma)| [x, z, sigma]);
        for speed in speeds.iter().flatten() {
            finite("velocity", f64::from(*speed as f32))?;
        }
        if let Some((_, _, sigma)) = velocity.filter(|(_, _, sigma)| *sigma < 0.0) {
            return Err(input(format!(
                "velocity: give a sigma of 0 or more, not {sigma}"
            )));
        }
        let frame = SensorFrame {
            tick,
            air: air.map(|(airspeed, pitch)| AirData {
                tick: tick.wrapping_sub(air_age),
                airspeed,
                pitch,
            }),
            position: place.map(|(x, z)| Position {
                tick: tick.wrapping_sub(position_age),
                x,
                z,
                sigma: sigma as f32,
                velocity: speeds.map(|[x, z, sigma]| GroundVelocity {
                    x: x as f32,
                    z: z as f32,
                    sigma: sigma as f32,
                }),
            }),
        };
        let scan = scan.map(|ranges| self.wire(tick, ranges)).transpose()?;
        let core = &mut *core;
        let inputs = (frame, scan);
        let stepped = py.detach(|| core.step(&inputs));
        let command = stepped.map_err(|error| errors::flight(error.into()))?;
        let command = command.ok_or_else(|| FlightError::new_err("the core gave no command"))?;
        Ok((command.thrust, command.elevator))
    }

    /// Number of steps so far.
    #[getter]
    fn ticks(&self) -> PyResult<u32> {
        Ok(alone(&self.guarded, "core")?.tick)
    }

    /// The source of the reference in the last step: "tracking" or "trim-hold".
    #[getter]
    fn mode(&self) -> PyResult<&'static str> {
        let (command, _) = alone(&self.guarded, "core")?.answer()?;
        Ok(match command.mode {
            ControlMode::Tracking => "tracking",
            _ => "trim-hold",
        })
    }

    /// What the core takes for true after the last step: state, wind and lift; SI units.
    #[getter]
    fn estimate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (_, step) = alone(&self.guarded, "core")?.answer()?;
        let dict = motion(py, step.position, step.estimate)?;
        dict.set_item("wind_x", step.wind[0])?;
        dict.set_item("wind_z", step.wind[1])?;
        dict.set_item("lift", step.lift)?;
        Ok(dict)
    }

    /// The state that the last step tracked; SI units.
    #[getter]
    fn reference<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (_, step) = alone(&self.guarded, "core")?.answer()?;
        let [x, z, air @ ..] = step.reference;
        motion(py, [x, z], air)
    }

    /// The core's trust in each sensor after the last step.
    #[getter]
    fn sensors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (_, step) = alone(&self.guarded, "core")?.answer()?;
        let dict = PyDict::new(py);
        for (name, state) in step.sensors.named() {
            dict.set_item(name, state.to_string())?;
        }
        Ok(dict)
    }

    /// The last 1000 inputs that the core refused: tick and cause. `refusals` counts all of them.
    #[getter]
    fn refused(&self) -> PyResult<Vec<(u32, String)>> {
        Ok(alone(&self.guarded, "core")?
            .refused
            .iter()
            .cloned()
            .collect())
    }

    /// Number of inputs that the core refused so far.
    #[getter]
    fn refusals(&self) -> PyResult<u64> {
        Ok(alone(&self.guarded, "core")?.refusals)
    }

    /// The plan of the last cycle, one column a quantity, one row a knot; SI units.
    #[getter]
    fn plan<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        look::plan(py, alone(&self.guarded, "core")?.link.node().planner())
    }

    /// The candidates of the last cycle, as those of `Planner`.
    #[getter]
    fn candidates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        look::candidates(py, alone(&self.guarded, "core")?.link.node().planner())
    }

    /// The map, as that of `Planner`.
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        look::map(py, alone(&self.guarded, "core")?.link.node().planner())
    }
}

impl Core {
    /// A scan with these ranges as it goes over the link.
    fn wire(&self, tick: u32, ranges: &Bound<'_, PyAny>) -> PyResult<hil_protocol::LidarScan> {
        let checked = scan(&self.scenario.lidar, ranges)?;
        Ok(self.scenario.lidar.wire_scan(tick, &checked.ranges))
    }
}

impl Stepped {
    /// The answer to the last step.
    fn answer(&self) -> PyResult<(ActuatorCommand, StepReport)> {
        self.answer
            .ok_or_else(|| state("the core has made no step: call step first"))
    }

    /// Makes a step. Gives `None` if the core answers without a command.
    fn step(&mut self, (frame, scan): &Inputs) -> Result<Option<ActuatorCommand>, LinkError> {
        if let Some(scan) = scan {
            self.link.send(&Message::LidarScan(scan.clone()))?;
        }
        self.link.send(&Message::SensorFrame(*frame))?;
        let mut report = None;
        // The command ends the answer.
        loop {
            match self.link.receive("the actuator command")? {
                Message::StepReport(step) => report = Some(step),
                Message::Rejection(refused) => {
                    self.refusals += 1;
                    if self.refused.len() == MOST_REFUSED {
                        self.refused.pop_front();
                    }
                    let told = (refused.tick, refused.cause.to_string());
                    self.refused.push_back(told);
                }
                Message::ActuatorCommand(command) => {
                    self.tick += 1;
                    self.answer = report.map(|report| (command, report));
                    return Ok(Some(command));
                }
                Message::Hello(_) => return Ok(None),
                _ => {}
            }
        }
    }
}

/// Two values that come together or not at all.
fn pair(
    (one, a): (&str, Option<f64>),
    (other, b): (&str, Option<f64>),
) -> PyResult<Option<(f64, f64)>> {
    match (a, b) {
        (Some(a), Some(b)) => Ok(Some((finite(one, a)?, finite(other, b)?))),
        (None, None) => Ok(None),
        _ => Err(input(format!(
            "give {one} and {other} together, or neither"
        ))),
    }
}

fn motion<'py>(
    py: Python<'py>,
    [x, z]: [f64; 2],
    [airspeed, pitch, pitch_rate, flight_path]: [f64; 4],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let values = [
        ("x", x),
        ("z", z),
        ("airspeed", airspeed),
        ("pitch", pitch),
        ("pitch_rate", pitch_rate),
        ("flight_path", flight_path),
    ];
    for (name, value) in values {
        dict.set_item(name, value)?;
    }
    Ok(dict)
}
