//! The session with the core: greeting, configuration, ticks; and again after it restarts.

use super::steering::Steering;
use crate::link::{Link, LinkError};
use crate::log::RejectionEntry;
use crate::scenario::Scenario;
use hil_protocol::{
    ActuatorCommand, ConfigureVerdict, Hello, LidarScan, Message, PlanReport, PlanTrajectory,
    Rejection, Role, SensorFrame, StepReport,
};
use mpp_core::config::{STAGES, TICK_PERIOD};

/// The core's answer to one tick.
pub(super) struct Answer {
    pub(super) command: ActuatorCommand,
    pub(super) step: Option<StepReport>,
    pub(super) plan: Option<PlanReport>,
    pub(super) trajectory: Option<PlanTrajectory>,
}

/// Hello both ways, and the configuration.
pub(super) fn greet(
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
pub(super) fn exchange(
    scenario: &Scenario,
    steering: &Steering,
    link: &mut dyn Link,
    scan: Option<&LidarScan>,
    frame: SensorFrame,
    rejections: &mut Vec<RejectionEntry>,
) -> Result<Answer, LinkError> {
    const RESTARTS: usize = 3;
    let scan = scan.map(|scan| Message::LidarScan(scan.clone()));
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
                steering.restore(link, rejections)?;
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

pub(super) fn unexpected(awaited: &str, message: &Message) -> LinkError {
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
    let mut trajectory = None;
    loop {
        match link.receive(&awaited)? {
            Message::ActuatorCommand(command) if command.tick == tick => {
                return Ok(Received::Answer(Box::new(Answer {
                    command,
                    step,
                    plan,
                    trajectory,
                })));
            }
            Message::StepReport(report) => step = Some(report),
            Message::PlanReport(report) => plan = Some(report),
            Message::PlanTrajectory(knots) => trajectory = Some(knots),
            Message::Rejection(rejection) => rejections.push(rejection_entry(&rejection)),
            Message::Hello(peer) => return Ok(Received::Hello(peer)),
            other => return Err(unexpected(&awaited, &other)),
        }
    }
}

pub(super) fn rejection_entry(rejection: &Rejection) -> RejectionEntry {
    RejectionEntry {
        tick: u64::from(rejection.tick),
        cause: format!("{:?}", rejection.cause),
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
