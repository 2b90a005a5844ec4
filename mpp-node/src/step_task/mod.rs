//! The task of the step: the link, the 100 Hz step, and the hand-over of plans.

mod asker;
mod input;
mod loss;
mod set_up;
#[cfg(test)]
mod tests;
mod tick;
mod tune;

use crate::convert;
use crate::greeting;
use crate::mail::{Plan, PlanReply, PlanRequest};
use crate::out::{Frames, Out};
use crate::parameters::Tuning;
use asker::Asker;
use hil_protocol::{
    Body, ConfigureVerdict, DecodeError, Decoder, Hello, MAX_FRAME, Message, PlanReport, Rejection,
    RejectionCause, Role, SensorFrame as WireFrame, id,
};
use mpp_core::estimate::SensorMonitor;
use mpp_core::flight::FlightLoop;
use mpp_core::gate::Cause;
use mpp_core::health::Health;
use mpp_core::planner::Verdict;
use mpp_core::sense::LidarScan;

/// The behaviour at the tick at which a plan is due but the planner has not replied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// The tick waits until the planner has done all its slices. The harness sets the time, so the time
    /// stands still meanwhile.
    Lockstep,
    /// The step continues with the present trajectory. The planner ends its cycle at its next slice, and the
    /// step takes over the plan at the following tick.
    RealTime,
}

/// The cycle that the planner works on.
#[derive(Clone, Copy)]
struct Cycle {
    /// The tick at which the cycle started.
    begun: u32,
    /// The tick at which the scan was taken.
    scan: u32,
    /// The tick at which the plan is due.
    due: u32,
    /// Whether the cycle plans from the map alone, because the lidar has fallen silent. `scan` is then the tick of its start.
    without_scan: bool,
}

/// A session after its configuration: the flight under way.
struct Session {
    tuning: Tuning,
    /// The cause of the last set-up of the planner.
    asker: Asker,
    /// Whether the planner is set up with the present values.
    ready: bool,
    control: FlightLoop,
    /// The tick of the first step. The flight's time counts from it.
    first_tick: Option<u32>,
    last_tick: Option<u32>,
    cycle: Option<Cycle>,
    /// The tick at which the last cycle started.
    last_cycle: Option<u32>,
    /// The tick of the last scan that started a cycle.
    last_scan: Option<u32>,
    /// Ticks between the last two scans that started cycles. A lidar may be slower than the planner.
    scan_interval: Option<u32>,
    /// The tick from which the planner does without a scan, if none comes before. It follows from the values above when a
    /// cycle starts, because each tick asks for it.
    blind_from: Option<u32>,
    /// The tick of the scan from which the present trajectory was planned. If its cycle had no scan, this is the tick
    /// at which the cycle started.
    plan_tick: Option<u32>,
    /// The report of a plan that the last tick has taken over.
    untold: Option<PlanReport>,
    /// `plan_tick` of the plan that was told, and whose commands are not told yet.
    unsteered: Option<u32>,
    /// The tick of a checked scan that waits for its sensor frame.
    scan_tick: Option<u32>,
    /// The tick of the last scan that came. A sender repeats a scan until a command answers it.
    heard_scan: Option<u32>,
    /// Whether the map of the planner no longer fits the estimates.
    forget: bool,
    /// The tick that follows the last old one, and the number of old ticks in a row.
    old_ticks: Option<(u32, u32)>,
    /// The trust in the lidar, and whether a scan that was refused or planned from since the last tick was
    /// good.
    lidar: SensorMonitor,
    lidar_good: Option<bool>,
    /// Whether many beams of the last scan were bad.
    spoilt: bool,
}

/// The link and the 100 Hz step. It shares no data with the planner: the caller passes requests from
/// [`StepTask::request`] to the [`crate::PlanTask`], and replies back to [`StepTask::take_reply`].
///
/// # Example
///
/// A hello, a configuration, and one sensor frame, which an actuator command answers.
///
/// ```
/// use hil_protocol::{
///     ActuatorLimits, AirData, Aircraft, Configure, Decoder, EncodeError, Hello, MAX_FRAME, Message, Preset,
///     Role, SensorFrame, encode,
/// };
/// use mpp_node::{Pace, PlanTask, Progress, StepTask};
///
/// let mut step = StepTask::new(Pace::Lockstep);
/// let mut plan = Box::new(PlanTask::new());
/// let mut decoder = Decoder::new();
/// // Gives the last message of the answer.
/// let mut ask = |question: Message| -> Result<Option<Message>, EncodeError> {
///     let (mut buffer, mut sent) = ([0; MAX_FRAME], Vec::new());
///     for byte in encode(&question, &mut buffer)? {
///         step.receive(*byte, |frame| sent.extend_from_slice(frame));
///     }
///     if let Some(request) = step.request() {
///         plan.take(&request);
///     }
///     while plan.advance(step.clock()) == Progress::Working {}
///     if let Some(reply) = plan.reply() {
///         step.take_reply(reply, |frame| sent.extend_from_slice(frame));
///     }
///     Ok(sent.iter().filter_map(|byte| decoder.push(*byte)).flatten().last())
/// };
///
/// let (role, software) = (Role::Harness, [0, 1, 0]);
/// ask(Message::Hello(Hello { role, software, tick_period_us: 10_000, beams_max: 128, stages: 0 }))?;
/// ask(Message::Configure(Configure {
///     preset: Preset::Flight, aircraft: Aircraft::REFERENCE, paths: 25, seed: 0,
///     replan_period_ticks: 100, latency_ticks: 50, slices_per_tick: 100,
///     beams: 100, range_max: 45.0, altitude: 50.0, actuators: ActuatorLimits::default(),
/// }))?;
/// let air = AirData { tick: 0, airspeed: 12.0, pitch: 0.156 };
/// let frame = SensorFrame { tick: 0, air: Some(air), position: None };
/// let Some(Message::ActuatorCommand(command)) = ask(Message::SensorFrame(frame))? else {
///     panic!("a sensor frame is answered by an actuator command");
/// };
/// // Level trim of the reference airframe.
/// assert!(command.tick == 0 && (command.elevator - 3.749).abs() < 0.1);
/// # Ok::<(), EncodeError>(())
/// ```
pub struct StepTask {
    pace: Pace,
    decoder: Decoder,
    buffer: [u8; MAX_FRAME],
    scan: LidarScan,
    session: Option<Session>,
    request: Option<PlanRequest>,
    /// Number of the last set-up that the step requested.
    set_ups: u32,
    /// A plan that is not due yet.
    plan: Option<Plan>,
    /// The sensor frame that waits for a plan.
    held: Option<WireFrame>,
    /// Whether the core flies without the planner.
    planner_off: bool,
    /// The reason why the core accepts no configuration, if there is one.
    refusal: Option<ConfigureVerdict>,
    clock: u32,
}

impl StepTask {
    /// A task that waits for a hello.
    #[must_use]
    pub const fn new(pace: Pace) -> Self {
        Self {
            pace,
            decoder: Decoder::new(),
            buffer: [0; MAX_FRAME],
            scan: LidarScan::new(),
            session: None,
            request: None,
            set_ups: 0,
            plan: None,
            held: None,
            planner_off: false,
            refusal: None,
            clock: 0,
        }
    }

    /// Sends a hello without being asked. By this hello a harness notices that a core has started during a
    /// flight.
    pub fn announce(&mut self, send: impl FnMut(&[u8])) {
        self.greet(&mut Frames(send));
    }

    /// Refuses every configuration from now on, so that the core does not fly.
    pub fn refuse(&mut self, reason: ConfigureVerdict) {
        self.refusal = Some(reason);
    }

    /// Takes a byte from the link. `send` gets each frame of the answer as a whole. The caller must not give
    /// bytes to a task that [waits](StepTask::waits).
    pub fn receive(&mut self, byte: u8, send: impl FnMut(&[u8])) {
        self.take_byte(byte, &mut Frames(send));
    }

    pub(crate) fn take_byte(&mut self, byte: u8, send: &mut impl Out) {
        let Some(taken) = self.decoder.take(byte) else {
            return;
        };
        if let Err(fault) = taken.and_then(|id| self.handle(id, send)) {
            self.reject(RejectionCause::Frame(fault), send);
        }
    }

    /// Whether the next byte of the link has to wait for a reply of the planner.
    #[must_use]
    pub fn waits(&self) -> bool {
        self.held.is_some() || self.session.as_ref().is_some_and(|session| !session.ready)
    }

    /// Whether there is a request for the planner.
    #[must_use]
    pub fn has_request(&self) -> bool {
        self.request.is_some()
    }

    /// Takes the request for the planner, if there is one.
    pub fn request(&mut self) -> Option<PlanRequest> {
        self.request.take()
    }

    /// Takes a reply of the planner.
    pub fn take_reply(&mut self, reply: PlanReply, send: impl FnMut(&[u8])) {
        self.settle(reply, &mut Frames(send));
    }

    pub(crate) fn settle(&mut self, reply: PlanReply, send: &mut impl Out) {
        match reply {
            PlanReply::Plan(mut plan) => {
                if plan.seal != plan.trajectory.seal() {
                    plan.verdict = Verdict::Nothing;
                    plan.summary.refused = Some(Cause::Altered);
                }
                // The step drops a plan that does not belong to the present cycle, for example one from a
                // session that has ended.
                let cycle = self.session.as_ref().and_then(|session| session.cycle);
                if cycle.is_some_and(|cycle| cycle.begun == plan.tick) {
                    self.plan = Some(plan);
                }
            }
            PlanReply::SetUp { number, result } if number == self.set_ups => {
                self.set_up_done(result.map_err(convert::setup_verdict), send);
            }
            // The step drops a reply to an earlier set-up.
            PlanReply::SetUp { .. } => {}
        }
        if let Some(frame) = self.held.take() {
            self.tick(&frame, send);
        }
    }

    /// Reports a cause that the owner of the task knows, such as lost bytes of the link.
    pub fn report(&mut self, cause: RejectionCause, send: impl FnMut(&[u8])) {
        self.reject(cause, &mut Frames(send));
    }

    /// The tick of the last step of this flight, if there was one.
    #[must_use]
    pub fn last_tick(&self) -> Option<u32> {
        self.session.as_ref().and_then(|session| session.last_tick)
    }

    /// The tick up to which the planner may use its slices: the clock of [`crate::PlanTask::advance`].
    #[must_use]
    pub fn clock(&self) -> u32 {
        self.clock
    }

    /// The counters of this flight; `None` before the configuration.
    #[must_use]
    pub fn health(&self) -> Option<&Health> {
        self.session
            .as_ref()
            .map(|session| session.control.health())
    }

    /// Acts on the message that the decoder has found. Only what comes to a core is read.
    fn handle(&mut self, id: u8, send: &mut impl Out) -> Result<(), DecodeError> {
        match id {
            id::SENSOR_FRAME => self.sensor_frame(&self.decoder.body()?, send),
            id::LIDAR_SCAN => self.take_scan(send)?,
            id::HELLO => {
                let peer = self.decoder.body::<Hello>()?;
                self.greeted_by(peer.role, send);
            }
            id::CONFIGURE => self.read_configure(send)?,
            id::SET_PARAMETER => self.set_parameter(&self.decoder.body()?, send),
            id if (id::HELLO..=id::LAST).contains(&id) => {
                self.reject(RejectionCause::UnexpectedMessage { id }, send);
            }
            _ => return Err(DecodeError::UnknownId { id }),
        }
        if self.planner_off {
            self.fly_without_planner(send);
        }
        Ok(())
    }

    /// Does the work of [`StepTask::handle`] for a message that comes as it is.
    pub(crate) fn take_message(&mut self, message: &Message, send: &mut impl Out) {
        match message {
            Message::SensorFrame(frame) => self.sensor_frame(frame, send),
            Message::LidarScan(scan) => self.check_scan(scan, send),
            Message::Hello(peer) => self.greeted_by(peer.role, send),
            Message::Configure(configure) => self.configure(configure, send),
            Message::SetParameter(set) => self.set_parameter(set, send),
            other => {
                let id = other.id();
                self.reject(RejectionCause::UnexpectedMessage { id }, send);
            }
        }
        if self.planner_off {
            self.fly_without_planner(send);
        }
    }

    fn emit<T: Body>(&mut self, message: &T, send: &mut impl Out) {
        send.put(message, &mut self.buffer);
    }

    fn reject(&mut self, cause: RejectionCause, send: &mut impl Out) {
        let tick = self.last_tick().unwrap_or(0);
        self.emit(&Rejection { tick, cause }, send);
    }

    /// Acts on a hello. An echo of the core's own one opens no session.
    fn greeted_by(&mut self, role: Role, send: &mut impl Out) {
        match role {
            Role::Harness => self.greet(send),
            Role::Core => {
                let id = id::HELLO;
                self.reject(RejectionCause::UnexpectedMessage { id }, send);
            }
        }
    }

    /// Answers a hello. It starts a new session, whatever the state of the last one.
    fn greet(&mut self, send: &mut impl Out) {
        self.session = None;
        self.plan = None;
        self.emit(&greeting(), send);
        if self.planner_off {
            self.reject(RejectionCause::PlannerOff, send);
        }
    }
}
