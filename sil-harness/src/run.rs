//! One flight in lockstep: sensors out, command back, plant on.

mod session;
mod steering;

use crate::aircraft::Aircraft;
use crate::faults::LidarFaults;
use crate::ground::Ground;
use crate::inquest::Inquest;
use crate::lidar::Lidar;
use crate::link::{Link, LinkError};
use crate::log::{FlightLog, Header, ObstacleEntry, PlanEntry, Summary, Tick, finite};
use crate::outcome::{Outcome, Score};
use crate::plant::PlantError;
use crate::scenario::{ALTITUDE, Scenario};
use crate::sensors::AirDataSensors;
use crate::world::ObstacleField;
use hil_protocol::{ControlMode, LidarScan, PlanReport, PlanTrajectory, SensorFrame};
use mpp_core::planner::SetupError;
use mpp_core::vehicle::{AirState, Control, TrimError, VehicleState, Wind};
use nalgebra::Vector4;
use session::{Answer, Session};
use std::fmt;
use steering::Steering;

/// Why a flight could not be flown to an outcome.
#[derive(Debug)]
pub enum FlyError {
    /// The link failed.
    Link(LinkError),
    /// The core told the plant something that it cannot fly.
    Plant(PlantError),
    /// The airframe has no level flight to start from.
    Trim(TrimError),
    /// The planner cannot be set up.
    SetUp(SetupError),
}

impl fmt::Display for FlyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Link(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Trim(error) => write!(f, "the airframe has no level flight: {error:?}"),
            Self::SetUp(error) => write!(f, "the planner cannot be set up: {error:?}"),
        }
    }
}

impl std::error::Error for FlyError {}

impl From<LinkError> for FlyError {
    fn from(error: LinkError) -> Self {
        Self::Link(error)
    }
}

/// What one tick brought, for whoever watches the flight.
pub struct Moment<'a> {
    /// The tick as logged.
    pub tick: &'a Tick,
    /// The scan taken at this tick, if one was.
    pub scan: Option<&'a LidarScan>,
    /// The plan taken over at this tick, if one was.
    pub plan: Option<&'a PlanEntry>,
    /// What the core says about it.
    pub report: Option<&'a PlanReport>,
    /// Its trajectory.
    pub trajectory: Option<&'a PlanTrajectory>,
    /// Inputs refused so far.
    pub rejections: usize,
}

/// A flight with nobody but an onlooker.
struct Onlooker<F>(F);

impl<F: FnMut(&Moment<'_>)> Ground for Onlooker<F> {
    fn watch(&mut self, moment: &Moment<'_>) {
        (self.0)(moment);
    }
}

/// Flies a scenario over a link; `watch` sees every tick.
///
/// # Errors
/// [`FlyError`]: there is no outcome.
pub fn fly(
    scenario: &Scenario,
    link: &mut dyn Link,
    watch: impl FnMut(&Moment<'_>),
) -> Result<FlightLog, FlyError> {
    fly_with(scenario, link, &mut Onlooker(watch))
}

/// Flies a scenario over a link, with people on the ground.
///
/// # Errors
/// [`FlyError`]: there is no outcome.
pub fn fly_with(
    scenario: &Scenario,
    link: &mut dyn Link,
    ground: &mut dyn Ground,
) -> Result<FlightLog, FlyError> {
    let mut aircraft = Aircraft::new(scenario).map_err(FlyError::Trim)?;
    let field = scenario.field();
    let mut log = FlightLog::begin(header(scenario, &field));
    let mut session = Session::open(scenario, link)?;
    let mut sensors = AirDataSensors::new(scenario.seed, scenario.air_data);
    let mut eyes = Eyes::new(scenario);
    let mut score = Score::new(ALTITUDE);
    let mut end = None;
    let mut holds_trim = true;
    let mut flown = 0;
    let mut inquest = Inquest::default();
    let mut last = ((0.0, 0.0), (0.0, 0.0));
    let mut steering = Steering::new(scenario)?;
    ground.begin(&steering.tuning, aircraft.state());
    steering.wait(&mut session, ground)?;
    while flown < scenario.ticks && end.is_none() {
        session.tick = flown;
        steering.obey(&mut session, ground)?;
        if steering.terminated {
            end = Some(Outcome::Terminated);
            break;
        }
        let before = *aircraft.state();
        if scenario.oracle {
            let (x, z) = aircraft.wind();
            session.reveal(&before, Wind { x, z })?;
        }
        let measured = sensors.measure(&before);
        let scan = steering
            .scans(flown)
            .then(|| wire_scan(scenario, flown, &eyes.scan(&before, &field)));
        let frame = SensorFrame {
            tick: flown,
            airspeed: measured.airspeed,
            pitch: measured.pitch,
            x: before.x,
            z: before.z,
        };
        let mut answer = session.fly(scan.as_ref(), frame)?;
        steering.limit(&mut answer.command);
        let wind = aircraft.wind();
        let applied = aircraft.step(control(&answer)).map_err(FlyError::Plant)?;
        let tick = Tick {
            applied,
            wind,
            ..logged(flown, &before, measured, &answer)
        };
        let plan = answer.plan.as_ref().map(plan_entry);
        let moment = Moment {
            tick: &tick,
            scan: scan.as_ref(),
            plan: plan.as_ref(),
            report: answer.plan.as_ref(),
            trajectory: answer.trajectory.as_ref(),
            rejections: session.rejections.len(),
        };
        inquest.watch(&moment);
        ground.watch(&moment);
        log.ticks.push(&tick);
        log.plans.extend(plan);
        holds_trim = answer.command.mode == ControlMode::TrimHold;
        let after = aircraft.state();
        end = score.update(&field, &before, after);
        last = ((before.x, before.z), (after.x, after.z));
        flown += 1;
    }
    log.rejections = session.rejections;
    log.orders = std::mem::take(&mut steering.orders);
    let outcome = end.unwrap_or(Outcome::Survived);
    let (t_end, x_end) = (Scenario::time(flown), aircraft.state().x);
    let summary = Summary::new(&log.plans, outcome, &score, holds_trim);
    log.summary = Summary {
        failure: inquest.conclude(summary.class, &field, last, t_end),
        t_end,
        x_end,
        ..summary
    };
    Ok(log)
}

/// The lidar with its faults.
struct Eyes {
    lidar: Lidar,
    faults: LidarFaults,
}

impl Eyes {
    fn new(scenario: &Scenario) -> Self {
        let (seed, config) = (scenario.seed, scenario.lidar);
        Self {
            lidar: Lidar::new(seed, config),
            faults: LidarFaults::new(seed, scenario.faults.lidar, config.range_max),
        }
    }

    fn scan(&mut self, state: &VehicleState, field: &ObstacleField) -> Vec<f32> {
        let mut ranges = self.lidar.scan(state, field);
        self.faults.spoil(&mut ranges);
        ranges
    }
}

fn plan_entry(report: &PlanReport) -> PlanEntry {
    PlanEntry {
        tick: u64::from(report.scan_tick),
        used_from_tick: Some(u64::from(report.used_from_tick)),
        outcome: format!("{:?}", report.outcome),
        candidates: u32::from(report.candidates),
        feasible: u32::from(report.feasible),
        tree_runs: u32::from(report.tree_runs),
        slices: report.slices,
        cost: finite(Some(report.cost)),
        violation: finite(Some(report.violation)),
    }
}

/// A scan as it goes over the link.
pub(crate) fn wire_scan(scenario: &Scenario, tick: u32, ranges: &[f32]) -> LidarScan {
    let lidar = &scenario.lidar;
    let gaps = lidar.beams.saturating_sub(1).max(1);
    LidarScan {
        tick,
        angle_min: (-0.5 * lidar.field_of_view) as f32,
        angle_increment: (lidar.field_of_view / gaps as f64) as f32,
        ranges: ranges
            .iter()
            .copied()
            .take(hil_protocol::MAX_BEAMS)
            .collect(),
    }
}

fn logged(
    number: u32,
    state: &VehicleState,
    measured: crate::sensors::Measurement,
    answer: &Answer,
) -> Tick {
    let air = |values: [f64; 4]| AirState::from_vector(&Vector4::from(values));
    let tracking = answer.command.mode == ControlMode::Tracking;
    let reference = answer.step.filter(|_| tracking).map(|step| {
        let [x, z, rest @ ..] = step.reference;
        VehicleState {
            x,
            z,
            air: air(rest),
        }
    });
    Tick {
        t: Scenario::time(number),
        state: *state,
        measured,
        estimate: answer.step.map_or(state.air, |step| air(step.estimate)),
        reference,
        control: control(answer),
        applied: control(answer),
        wind: (0.0, 0.0),
    }
}

/// What the core commands.
fn control(answer: &Answer) -> Control {
    Control {
        thrust: answer.command.thrust,
        elevator: answer.command.elevator,
    }
}

/// What a flight's log begins with.
pub(crate) fn header(scenario: &Scenario, field: &ObstacleField) -> Header {
    Header {
        package_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: scenario.seed,
        obstacles: scenario.obstacles,
        paths: usize::from(scenario.paths),
        preset: scenario.preset.name().to_owned(),
        airframe: scenario.airframe.name().to_owned(),
        replan_hz: scenario.replan_hz(),
        latency: Scenario::time(scenario.latency_ticks),
        slices_per_tick: Some(scenario.slices_per_tick).filter(|slices| *slices != u32::MAX),
        duration: Scenario::time(scenario.ticks),
        lidar: scenario.lidar,
        air_data: scenario.air_data,
        faults: scenario.faults,
        scene: scenario.scene,
        oracle: scenario.oracle,
        field: field.obstacles.iter().map(ObstacleEntry::from).collect(),
    }
}
