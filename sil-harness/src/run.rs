//! One flight in lockstep: sensors out, command back, plant on.

use crate::aircraft::Aircraft;
use crate::faults::LidarFaults;
use crate::lidar::Lidar;
use crate::link::{Link, LinkError};
use crate::log::{FlightLog, Header, ObstacleEntry, PlanEntry, RejectionEntry, Tick, finite};
use crate::outcome::{Outcome, Score};
use crate::plant::PlantError;
use crate::scenario::{ALTITUDE, Scenario};
use crate::sensors::AirDataSensors;
use crate::world::ObstacleField;
use hil_protocol::{
    ActuatorCommand, ConfigureVerdict, ControlMode, Hello, LidarScan, Message, PlanReport,
    Rejection, Role, SensorFrame, StepReport,
};
use mpp_core::config::{STAGES, TICK_PERIOD};
use mpp_core::vehicle::{AirState, Control, TrimError, VehicleState};
use nalgebra::Vector4;
use std::fmt;

/// Why a flight could not be flown to an outcome.
#[derive(Debug)]
pub enum FlyError {
    /// The link failed.
    Link(LinkError),
    /// The core told the plant something that it cannot fly.
    Plant(PlantError),
    /// The airframe has no level flight to start from.
    Trim(TrimError),
}

impl fmt::Display for FlyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Link(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Trim(error) => write!(f, "the airframe has no level flight: {error:?}"),
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
    /// The plan taken over at this tick, if one was.
    pub plan: Option<&'a PlanEntry>,
}

/// The core's answer to one tick.
struct Answer {
    command: ActuatorCommand,
    step: Option<StepReport>,
    plan: Option<PlanEntry>,
}

/// Flies a scenario over a link; `watch` sees every tick.
///
/// # Errors
/// [`FlyError`]: there is no outcome.
pub fn fly(
    scenario: &Scenario,
    link: &mut dyn Link,
    mut watch: impl FnMut(&Moment<'_>),
) -> Result<FlightLog, FlyError> {
    let mut aircraft = Aircraft::new(scenario).map_err(FlyError::Trim)?;
    let field = scenario.field();
    let mut log = FlightLog::begin(header(scenario, &field));
    greet(scenario, link, &mut log.rejections)?;
    let mut sensors = AirDataSensors::new(scenario.seed, scenario.air_data);
    let mut eyes = Eyes::new(scenario);
    let mut score = Score::new(ALTITUDE);
    let mut end = None;
    let mut holds_trim = true;
    let mut flown = 0;
    while flown < scenario.ticks && end.is_none() {
        let before = *aircraft.state();
        let measured = sensors.measure(&before);
        let scan = (flown % scenario.replan_ticks == 0)
            .then(|| wire_scan(scenario, flown, &eyes.scan(&before, &field)));
        let frame = SensorFrame {
            tick: flown,
            airspeed: measured.airspeed,
            pitch: measured.pitch,
            x: before.x,
            z: before.z,
        };
        let answer = exchange(scenario, link, scan, frame, &mut log.rejections)?;
        let wind = aircraft.wind();
        let applied = aircraft.step(control(&answer)).map_err(FlyError::Plant)?;
        let tick = Tick {
            applied,
            wind,
            ..logged(flown, &before, measured, &answer)
        };
        watch(&Moment {
            tick: &tick,
            plan: answer.plan.as_ref(),
        });
        log.ticks.push(&tick);
        log.plans.extend(answer.plan);
        holds_trim = answer.command.mode == ControlMode::TrimHold;
        end = score.update(&field, &before, aircraft.state());
        flown += 1;
    }
    let outcome = end.unwrap_or(Outcome::Survived);
    log.conclude(outcome, &score, holds_trim);
    log.summary.t_end = Scenario::time(flown);
    log.summary.x_end = aircraft.state().x;
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

/// Hello both ways, and the configuration.
fn greet(
    scenario: &Scenario,
    link: &mut dyn Link,
    rejections: &mut Vec<RejectionEntry>,
) -> Result<(), LinkError> {
    link.send(&Message::Hello(own_hello()))?;
    let peer = loop {
        match link.receive("hello")? {
            Message::Hello(peer) => break peer,
            Message::Rejection(rejection) => rejections.push(rejection_entry(&rejection)),
            other => return Err(unexpected("hello", &other)),
        }
    };
    configure(scenario, link, &peer, rejections)
}

fn own_hello() -> Hello {
    Hello {
        role: Role::Harness,
        software: software(),
        tick_period_us: (TICK_PERIOD * 1e6) as u32,
        beams_max: hil_protocol::MAX_BEAMS as u16,
        stages: STAGES as u16,
    }
}

/// Checks the core that said hello and configures it.
fn configure(
    scenario: &Scenario,
    link: &mut dyn Link,
    peer: &Hello,
    rejections: &mut Vec<RejectionEntry>,
) -> Result<(), LinkError> {
    if peer.role != Role::Core {
        let why = "the other side is a harness too: give the address of a core";
        return Err(LinkError::Peer(why.to_owned()));
    }
    let own = own_hello();
    if peer.tick_period_us != own.tick_period_us
        || usize::from(peer.beams_max) < scenario.lidar.beams
    {
        return Err(LinkError::Peer(format!(
            "the core ticks every {} us and takes {} beams; this harness needs {} us and {} beams",
            peer.tick_period_us, peer.beams_max, own.tick_period_us, scenario.lidar.beams
        )));
    }
    link.send(&Message::Configure(scenario.configure()))?;
    let awaited = "the reply to the configuration";
    loop {
        match link.receive(awaited)? {
            Message::ConfigureReply(reply) if reply.verdict == ConfigureVerdict::Accepted => {
                return Ok(());
            }
            Message::ConfigureReply(reply) => return Err(LinkError::Refused(reply.verdict)),
            // A core that starts says hello unasked, and once more when it is greeted.
            Message::Hello(_) => {}
            // Of frames that came before the configuration.
            Message::Rejection(rejection) => rejections.push(rejection_entry(&rejection)),
            other => return Err(unexpected(awaited, &other)),
        }
    }
}

/// Sends a tick's measurements and gets the answer. A core that restarts meanwhile, which its
/// unasked hello tells, is configured anew and gets them once more.
fn exchange(
    scenario: &Scenario,
    link: &mut dyn Link,
    scan: Option<LidarScan>,
    frame: SensorFrame,
    rejections: &mut Vec<RejectionEntry>,
) -> Result<Answer, LinkError> {
    const RESTARTS: usize = 3;
    let scan = scan.map(Message::LidarScan);
    for _ in 0..=RESTARTS {
        if let Some(scan) = &scan {
            link.send(scan)?;
        }
        link.send(&Message::SensorFrame(frame))?;
        match receive_answer(link, frame.tick, rejections)? {
            Received::Answer(answer) => return Ok(*answer),
            Received::Hello(peer) => {
                rejections.push(RejectionEntry {
                    tick: u64::from(frame.tick),
                    cause: "CoreRestarted".to_owned(),
                });
                configure(scenario, link, &peer, rejections)?;
            }
        }
    }
    Err(LinkError::Peer(format!(
        "the core restarts again and again at tick {}",
        frame.tick
    )))
}

/// What came instead of an answer, or the answer.
enum Received {
    Answer(Box<Answer>),
    Hello(Hello),
}

fn unexpected(awaited: &str, message: &Message) -> LinkError {
    LinkError::Unexpected {
        awaited: awaited.to_owned(),
        id: message.id(),
    }
}

/// Collects what the core sends until its command for this tick.
fn receive_answer(
    link: &mut dyn Link,
    tick: u32,
    rejections: &mut Vec<RejectionEntry>,
) -> Result<Received, LinkError> {
    let awaited = format!("the actuator command of tick {tick}");
    let mut step = None;
    let mut plan = None;
    loop {
        match link.receive(&awaited)? {
            Message::ActuatorCommand(command) if command.tick == tick => {
                return Ok(Received::Answer(Box::new(Answer {
                    command,
                    step,
                    plan,
                })));
            }
            Message::StepReport(report) => step = Some(report),
            Message::PlanReport(report) => plan = Some(plan_entry(&report)),
            Message::Rejection(rejection) => rejections.push(rejection_entry(&rejection)),
            Message::Hello(peer) => return Ok(Received::Hello(peer)),
            other => return Err(unexpected(&awaited, &other)),
        }
    }
}

fn rejection_entry(rejection: &Rejection) -> RejectionEntry {
    RejectionEntry {
        tick: u64::from(rejection.tick),
        cause: format!("{:?}", rejection.cause),
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

fn header(scenario: &Scenario, field: &ObstacleField) -> Header {
    Header {
        package_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: scenario.seed,
        obstacles: scenario.obstacles,
        paths: usize::from(scenario.paths),
        preset: scenario.preset.name().to_owned(),
        airframe: scenario.airframe.name().to_owned(),
        replan_hz: scenario.replan_hz(),
        latency: Scenario::time(scenario.latency_ticks),
        duration: Scenario::time(scenario.ticks),
        lidar: scenario.lidar,
        air_data: scenario.air_data,
        faults: scenario.faults,
        scene: scenario.scene,
        field: field.obstacles.iter().map(ObstacleEntry::from).collect(),
    }
}

/// This crate's version.
fn software() -> [u8; 3] {
    let part = |text: &str| text.parse().unwrap_or(0);
    [
        part(env!("CARGO_PKG_VERSION_MAJOR")),
        part(env!("CARGO_PKG_VERSION_MINOR")),
        part(env!("CARGO_PKG_VERSION_PATCH")),
    ]
}
