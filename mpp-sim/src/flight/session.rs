//! The session with the core. Every question gets an answer from a configured core.
//!
//! A core that restarts says hello without a request. The session then configures it anew, sends
//! every value that it had accepted, and repeats the open question.

use crate::entries::RejectionEntry;
use crate::link::{Link, LinkError};
use crate::scenario::{Scenario, TICK_US};
use hil_protocol::{
    ActuatorCommand, Configure, ConfigureReply, ConfigureVerdict, HealthReport, Hello, LidarScan,
    Message, ParameterReply, ParameterVerdict, PlanControls, PlanReport, PlanTrajectory, Rejection,
    RejectionCause, Role, SensorFrame, SetParameter, StepReport,
};
use mpp_core::config::STAGES;
use mpp_core::vehicle::{VehicleState, Wind};
use mpp_node::parameters::PARAMETERS;

/// The number of restarts that a core may make before one answer.
const RESTARTS: usize = 3;

/// The core's reply to one tick.
pub(super) struct StepReply {
    pub(super) command: ActuatorCommand,
    pub(super) step: Option<StepReport>,
    pub(super) plan: Option<PlanReport>,
    pub(super) trajectory: Option<PlanTrajectory>,
    pub(super) controls: Option<PlanControls>,
    pub(super) health: Option<HealthReport>,
}

/// The parts of an answer that came before the command. The command ends the answer.
#[derive(Default)]
struct Draft {
    step: Option<StepReport>,
    plan: Option<PlanReport>,
    trajectory: Option<PlanTrajectory>,
    controls: Option<PlanControls>,
    health: Option<HealthReport>,
}

/// The role of a message for a question that awaits its answer.
enum Part<T> {
    /// The message is a part before the end of the answer, or it is of no interest.
    More,
    /// The message ends the answer.
    Last(T),
    /// The message must not come here.
    None,
}

/// What a core was told, from tick to tick.
pub(super) struct Told {
    configure: Configure,
    /// Whether a core was configured before. A hello before that is no restart.
    open: bool,
    /// Whether the core that is connected now accepted the configuration.
    configured: bool,
    /// Every value that the core accepted, in the order of acceptance.
    values: Vec<SetParameter>,
    /// The tick that is flown next.
    pub(super) tick: u32,
    /// Every input that the core refused, and its restarts.
    pub(super) rejections: Vec<RejectionEntry>,
}

impl Told {
    /// Nothing yet. A core will get the configuration of this scenario.
    pub(super) fn nothing(scenario: &Scenario) -> Self {
        Self {
            configure: scenario.configure(),
            open: false,
            configured: false,
            values: Vec::new(),
            tick: 0,
            rejections: Vec::new(),
        }
    }
}

/// A core at its link, and what it was told.
pub(super) struct Session<'a> {
    pub(super) told: &'a mut Told,
    pub(super) link: &'a mut dyn Link,
}

impl Session<'_> {
    /// Shows the truth to a core that is an oracle.
    pub(super) fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        self.link.reveal(truth, wind)
    }

    /// Exchanges hellos with the core and configures it.
    pub(super) fn open(&mut self) -> Result<(), LinkError> {
        let hello = [Message::Hello(own_hello())];
        let nothing_else = |(): &mut (), _: &Message| Part::<()>::None;
        self.once("hello", &hello, &nothing_else)?;
        self.ready()?;
        self.told.open = true;
        Ok(())
    }

    /// Asks the core to take another value for a parameter.
    pub(super) fn set(&mut self, set: SetParameter) -> Result<ParameterVerdict, LinkError> {
        let question = [Message::SetParameter(set)];
        let verdict = self.ask("the reply to a parameter", &question, verdict_on(set))?;
        if verdict == ParameterVerdict::Accepted {
            self.told.values.push(set);
        }
        Ok(verdict)
    }

    /// Sends a tick's measurements and gets the answer. Returns `None` if the core takes the tick for an old
    /// one: it then refuses the measurements and sends no command.
    pub(super) fn fly(
        &mut self,
        scan: Option<&LidarScan>,
        frame: SensorFrame,
    ) -> Result<Option<StepReply>, LinkError> {
        let alone = [Message::SensorFrame(frame)];
        let with_scan = scan.map(|scan| {
            let scan = Message::LidarScan(scan.clone());
            [scan, Message::SensorFrame(frame)]
        });
        let questions = with_scan.as_ref().map_or(&alone[..], |both| both);
        let awaited = format!("the actuator command of tick {}", frame.tick);
        self.ask(&awaited, questions, |draft: &mut Draft, message| {
            match message {
                Message::ActuatorCommand(command) if command.tick == frame.tick => {
                    let Draft {
                        step,
                        plan,
                        trajectory,
                        controls,
                        health,
                    } = std::mem::take(draft);
                    return Part::Last(Some(StepReply {
                        command: *command,
                        step,
                        plan,
                        trajectory,
                        controls,
                        health,
                    }));
                }
                Message::Rejection(rejection) if is_old(frame.tick, rejection) => {
                    return Part::Last(None);
                }
                Message::StepReport(report) => draft.step = Some(*report),
                Message::PlanReport(report) => draft.plan = Some(*report),
                Message::HealthReport(report) => draft.health = Some(*report),
                Message::PlanTrajectory(knots) => draft.trajectory = Some(knots.clone()),
                Message::PlanControls(controls) => draft.controls = Some(controls.clone()),
                _ => return Part::None,
            }
            Part::More
        })
    }

    /// Sends the questions and gives each reply to `take` until `take` has a complete answer.
    /// Starts over each time a core starts.
    fn ask<D: Default, T>(
        &mut self,
        awaited: &str,
        questions: &[Message],
        take: impl Fn(&mut D, &Message) -> Part<T>,
    ) -> Result<T, LinkError> {
        for _ in 0..=RESTARTS {
            self.ready()?;
            if let Some(answer) = self.once(awaited, questions, &take)? {
                return Ok(answer);
            }
        }
        Err(self.restless())
    }

    /// Asks the core that is connected now. Returns `None` if another core says hello meanwhile.
    fn once<D: Default, T>(
        &mut self,
        awaited: &str,
        questions: &[Message],
        take: &impl Fn(&mut D, &Message) -> Part<T>,
    ) -> Result<Option<T>, LinkError> {
        for question in questions {
            self.link.send(question)?;
        }
        let mut draft = D::default();
        loop {
            match self.link.receive(awaited)? {
                Message::Hello(peer) => {
                    self.greeted(&peer)?;
                    return Ok(None);
                }
                Message::Rejection(rejection) => {
                    self.told.rejections.push(entry(&rejection));
                    // A refused tick gets no other answer.
                    if let Part::Last(answer) = take(&mut draft, &Message::Rejection(rejection)) {
                        return Ok(Some(answer));
                    }
                }
                // The core started after a configuration was sent and still got it. It then also
                // got the configuration that was sent after its hello.
                Message::ConfigureReply(ConfigureReply {
                    verdict: ConfigureVerdict::AlreadyConfigured,
                }) if self.told.configured => {}
                message => match take(&mut draft, &message) {
                    Part::More => {}
                    Part::Last(answer) => return Ok(Some(answer)),
                    Part::None => {
                        return Err(LinkError::Unexpected {
                            awaited: awaited.to_owned(),
                            id: message.id(),
                        });
                    }
                },
            }
        }
    }

    /// Handles the hello of a core that knows nothing yet.
    fn greeted(&mut self, peer: &Hello) -> Result<(), LinkError> {
        self.told.configured = false;
        if self.told.open {
            self.told.rejections.push(RejectionEntry {
                tick: u64::from(self.told.tick),
                cause: "CoreRestarted".to_owned(),
            });
        }
        check(peer, self.told.configure.beams)
    }

    /// Ensures that the core is configured and has every value.
    fn ready(&mut self) -> Result<(), LinkError> {
        for _ in 0..=RESTARTS {
            if self.told.configured || self.configure()? {
                return Ok(());
            }
        }
        Err(self.restless())
    }

    /// Configures the core. Returns `false` if another core says hello meanwhile.
    fn configure(&mut self) -> Result<bool, LinkError> {
        let question = [Message::Configure(self.told.configure)];
        let awaited = "the reply to the configuration";
        let verdict = self.once(awaited, &question, &|(): &mut (), message| match message {
            Message::ConfigureReply(reply) => Part::Last(reply.verdict),
            // This parameter reached the core before its configuration did.
            Message::ParameterReply(ParameterReply {
                verdict: ParameterVerdict::NotConfigured,
                ..
            }) => Part::More,
            _ => Part::None,
        })?;
        match verdict {
            Some(ConfigureVerdict::Accepted) => self.told.configured = true,
            Some(refused) => return Err(LinkError::Refused(refused)),
            None => return Ok(false),
        }
        for set in self.told.values.clone() {
            let question = [Message::SetParameter(set)];
            match self.once("the reply to a parameter", &question, &verdict_on(set))? {
                Some(ParameterVerdict::Accepted) => {}
                Some(refused) => return Err(relapsed(set, refused)),
                None => return Ok(false),
            }
        }
        Ok(true)
    }

    fn restless(&self) -> LinkError {
        LinkError::Restless(self.told.tick)
    }
}

/// Takes the verdict on a value.
fn verdict_on(set: SetParameter) -> impl Fn(&mut (), &Message) -> Part<ParameterVerdict> {
    move |(), message| match message {
        Message::ParameterReply(reply) if reply.parameter == set.parameter => {
            Part::Last(reply.verdict)
        }
        _ => Part::None,
    }
}

fn relapsed(set: SetParameter, verdict: ParameterVerdict) -> LinkError {
    let SetParameter { parameter, value } = set;
    let name = PARAMETERS
        .get(usize::from(parameter))
        .map_or("?", |parameter| parameter.name);
    LinkError::Relapsed(name, value, verdict)
}

pub(crate) fn entry(rejection: &Rejection) -> RejectionEntry {
    RejectionEntry {
        tick: u64::from(rejection.tick),
        cause: format!("{:?}", rejection.cause),
    }
}

/// Whether a core refuses this tick because it has done a later one.
fn is_old(tick: u32, rejection: &Rejection) -> bool {
    match rejection.cause {
        RejectionCause::TickOrder { expected, found } => {
            found == tick && found.wrapping_sub(expected).cast_signed() < 0
        }
        _ => false,
    }
}

pub(crate) fn own_hello() -> Hello {
    Hello {
        role: Role::Harness,
        software: software(),
        tick_period_us: TICK_US,
        beams_max: hil_protocol::MAX_BEAMS as u16,
        stages: STAGES as u16,
    }
}

/// Checks that the core that said hello suits a flight with this number of beams.
pub(crate) fn check(peer: &Hello, beams: u16) -> Result<(), LinkError> {
    if peer.role != Role::Core {
        return Err(LinkError::NoCore);
    }
    if peer.tick_period_us != TICK_US || peer.beams_max < beams {
        return Err(LinkError::Unfit {
            tick_us: peer.tick_period_us,
            beams_max: peer.beams_max,
            beams: usize::from(beams),
        });
    }
    Ok(())
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
