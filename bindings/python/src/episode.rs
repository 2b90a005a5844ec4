//! A flight without a core: plant, field and sensors of a scenario, one tick at a time. It is the world of
//! `mpp_sim::flight::fly`, and the loop is the caller's.

use crate::errors::{self, FlightError, input};
use crate::input::vector;
use mpp_analysis::recording;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{Control, VehicleState, Wind};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::faults::FaultyLidar;
use mpp_sim::field::{Field as _, ObstacleField};
use mpp_sim::flight::Sensing;
use mpp_sim::lidar::Lidar as _;
use mpp_sim::outcome::{Outcome, Score};
use mpp_sim::plant::Plant as _;
use mpp_sim::scenario::{ALTITUDE, Scenario};
use numpy::PyReadonlyArray1;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A flight under way. A copy goes on as the original would, bit for bit.
#[derive(Clone, Debug)]
pub(crate) struct Episode {
    pub(crate) scenario: Arc<Scenario>,
    plant: Aircraft,
    field: ObstacleField,
    lidar: FaultyLidar,
    sensing: Sensing,
    score: Score,
    /// Ticks between two scans.
    scan_ticks: u32,
    pub(crate) tick: u32,
    pub(crate) end: Option<Outcome>,
    /// Distance from the nearest obstacle in the last tick [m].
    clearance: f64,
}

/// What the actions -1 and 1 of an agent mean: elevator, and thrust [N].
pub(crate) fn controls(base: &Scenario) -> PyResult<[[f64; 2]; 2]> {
    let settings = recording::settings(base).map_err(errors::flight)?;
    let own = settings.planner.plane();
    let most = own.map_or(f64::INFINITY, |own| own.thrust_max);
    let (limits, trim) = (base.limits(), base.trim().map_err(errors::set_up)?.control);
    // The deflection that holds the greatest angle of attack of a plan, and as much again to get there.
    let airframe = &base.aircraft.known.airframe;
    let held = airframe.moment_alpha / airframe.moment_elevator;
    let reach = 2.0 * held.abs() * own.map_or(0.2, |own| own.attitude.angle_of_attack);
    let side = |limit: Option<f64>| limit.map_or(reach, |limit| limit.min(reach));
    Ok([
        [
            trim.elevator - side(limits.elevator_below),
            trim.elevator + side(limits.elevator_above),
        ],
        [0.0, limits.thrust_max.map_or(most, |limit| limit.min(most))],
    ])
}

/// What a second costs an agent besides, taken from its reward.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shaping {
    /// For what is missing of the margin, as a share of it.
    pub(crate) clearance: f64,
    /// Distance from obstacles that costs nothing [m].
    pub(crate) margin: f64,
    /// For the squares of the elevator's share of its range and of the thrust's.
    pub(crate) effort: f64,
}

impl Shaping {
    pub(crate) fn new([clearance, margin, effort]: [f64; 3]) -> PyResult<Self> {
        if margin > 0.0
            && [clearance, margin, effort]
                .iter()
                .all(|it| (0.0..=1e6).contains(it))
        {
            return Ok(Self {
                clearance,
                margin,
                effort,
            });
        }
        Err(input(
            "reward: give clearance and effort from 0, and margin more than 0 m",
        ))
    }

    /// What the last tick cost.
    pub(crate) fn cost(&self, episode: &Episode, command: Control, ranges: &[[f64; 2]; 2]) -> f64 {
        let missing = (1.0 - episode.clearance / self.margin).clamp(0.0, 1.0);
        let share = |value: f64, [least, most]: [f64; 2]| (value - least) / (most - least);
        let elevator = (2.0 * share(command.elevator, ranges[0]) - 1.0).clamp(-1.0, 1.0);
        let thrust = share(command.thrust, ranges[1]).clamp(0.0, 1.0);
        let effort = elevator * elevator + thrust * thrust;
        TICK_PERIOD * (self.clearance * missing + self.effort * effort)
    }
}

/// Cruise [m/s], the way of a flight, its altitude and its band [m]: what an agent may measure in.
pub(crate) fn scales(base: &Scenario) -> [f64; 4] {
    let cruise = base.aircraft.trim.state.airspeed;
    [cruise, cruise * base.duration(), ALTITUDE, base.band()]
}

/// Elevator and thrust of one action.
pub(crate) fn pair(action: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    let wrong = |_| input("actions: give elevator and thrust");
    match action.extract::<PyReadonlyArray1<'_, f64>>() {
        Ok(array) => <[f64; 2]>::try_from(array.as_array().to_vec()).map_err(wrong),
        Err(_) => <[f64; 2]>::try_from(vector("actions", action)?).map_err(wrong),
    }
}

/// Ranges of a scan as an agent gets them: where nothing came back they are the greatest range, which is next to what
/// stands far away, and not 0, which is next to what stands before the nose.
pub(crate) fn seen(ranges: &[f32], greatest: f64) -> impl Iterator<Item = f32> {
    let greatest = greatest as f32;
    (ranges.iter()).map(move |range| if *range > 0.0 { *range } else { greatest })
}

/// What arrives from the sensors in a tick.
pub(crate) struct Readings {
    pub(crate) frame: hil_protocol::SensorFrame,
    pub(crate) scan: Option<hil_protocol::LidarScan>,
}

impl Episode {
    /// The start of a flight. A scan comes every `scan_ticks` ticks.
    pub(crate) fn new(scenario: Scenario, scan_ticks: u32) -> PyResult<Self> {
        let faults = &scenario.faults;
        let none = mpp_sim::faults::Faults::default();
        if faults.link != none.link || faults.clock != none.clock {
            let advice = "faults.link, faults.clock: leave them out, there is no link here";
            return Err(input(advice));
        }
        Ok(Self {
            plant: Aircraft::new(&scenario).map_err(errors::set_up)?,
            field: scenario.field(),
            lidar: FaultyLidar::new(scenario.seed, scenario.lidar, faults.lidar),
            sensing: Sensing::new(&scenario),
            score: Score::new(ALTITUDE, scenario.band(), scenario.body_radius),
            scan_ticks,
            tick: 0,
            end: None,
            clearance: f64::INFINITY,
            scenario: Arc::new(scenario),
        })
    }

    /// The true state.
    pub(crate) fn state(&self) -> &VehicleState {
        self.plant.state()
    }

    /// Motion of the air.
    pub(crate) fn wind(&self) -> Wind {
        let (x, z) = self.plant.wind();
        Wind { x, z }
    }

    /// Whether the flight failed. By the strict rule, one that leaves its band fails too.
    pub(crate) fn failed(&self) -> bool {
        self.end.is_some() || !self.score.in_band()
    }

    /// How the flight ended; `None` while it goes on.
    pub(crate) fn outcome(&self) -> Option<String> {
        match self.end {
            Some(end) => Some(end.to_string()),
            None if self.failed() => Some("left band".to_owned()),
            None if self.is_through() => Some("survived".to_owned()),
            None => None,
        }
    }

    /// Time [s], true place and distance from the nearest obstacle [m], and the outcome.
    pub(crate) fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (dict, at) = (PyDict::new(py), self.state());
        dict.set_item(intern!(py, "t"), Scenario::time(self.tick))?;
        dict.set_item(intern!(py, "x"), at.x)?;
        dict.set_item(intern!(py, "z"), at.z)?;
        dict.set_item(intern!(py, "clearance"), self.clearance)?;
        dict.set_item(intern!(py, "outcome"), self.outcome())?;
        Ok(dict)
    }

    /// Whether the flight has reached its planned end.
    pub(crate) fn is_through(&self) -> bool {
        self.tick >= self.scenario.ticks
    }

    /// Measures the present tick. The order of the draws is that of `fly`; call it once before each step.
    pub(crate) fn measure(&mut self) -> Readings {
        let tick = self.tick;
        self.field.move_to(Scenario::time(tick));
        let state = *self.plant.state();
        let wind = self.wind();
        let (_, frame) = self.sensing.measure(tick, &state, wind);
        let shown = tick.is_multiple_of(self.scan_ticks).then(|| {
            let turned = self.sensing.lidar_state(tick, &state);
            self.lidar.scan(&turned, &self.field)
        });
        let shown = shown.and_then(|ranges| self.sensing.show(tick, &ranges));
        let scan = self.sensing.scan(tick, shown);
        Readings { frame, scan }
    }

    /// Flies one tick under a command.
    pub(crate) fn step(&mut self, command: Control) -> PyResult<()> {
        let before = *self.plant.state();
        let flown = self.plant.step(command);
        flown.map_err(|error| FlightError::new_err(error.to_string()))?;
        let least = std::mem::replace(&mut self.score.min_clearance, f64::INFINITY);
        self.end = (self.score).update(&self.field, &before, self.plant.state());
        self.clearance = self.score.min_clearance;
        self.score.min_clearance = self.clearance.min(least);
        self.tick += 1;
        Ok(())
    }
}
