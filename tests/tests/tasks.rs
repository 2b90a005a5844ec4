//! Tests step and planner as two tasks. Whatever the order in which they run, the flight is the
//! same. A planner that is late or lost does not hold the step.

use hil_protocol::{
    Decoder, MAX_FRAME, Message, PlanOutcome, RejectionCause, SetParameter, encode,
};
use mpp_node::parameters::PARAMETERS;
use mpp_node::{FlightNode, Pace, PlanReply, PlanRequest, PlanTask, Progress, StepTask};
use mpp_sim::flight::fly;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};
use proptest::prelude::*;

/// A link that keeps the harness's messages.
struct Recorder {
    pipe: PipeLink,
    sent: Vec<u8>,
}

impl Link for Recorder {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let mut buffer = [0; MAX_FRAME];
        self.sent.extend_from_slice(encode(message, &mut buffer)?);
        self.pipe.send(message)
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.pipe.receive(awaited)
    }
}

/// The bytes that a harness sends in a flight whose plans take 30 ticks.
fn flight(seconds: u32) -> Vec<u8> {
    let scenario = Scenario {
        latency_ticks: 30,
        slices_per_tick: 20,
        ticks: 100 * seconds,
        ..Scenario::new(Preset::Flight, 3)
    };
    let mut recorder = Recorder {
        pipe: PipeLink::new(),
        sent: Vec::new(),
    };
    assert!(fly(&scenario, &mut recorder, |_| {}).is_ok());
    recorder.sent
}

/// The answers of a core in one thread.
fn lockstep(input: &[u8]) -> Vec<u8> {
    let mut node = Box::new(FlightNode::new());
    let mut sent = Vec::new();
    node.receive(input, |frame| sent.extend_from_slice(frame));
    sent
}

/// Two tasks with a mailbox in each direction, as on a flight computer.
struct Tasks {
    step: StepTask,
    plan: Box<PlanTask>,
    request: Option<PlanRequest>,
    reply: Option<PlanReply>,
    sent: Vec<u8>,
}

impl Tasks {
    fn new(pace: Pace) -> Self {
        Self {
            step: StepTask::new(pace),
            plan: Box::new(PlanTask::new()),
            request: None,
            reply: None,
            sent: Vec::new(),
        }
    }

    fn post(&mut self) {
        if self.request.is_none() {
            self.request = self.step.request();
        }
    }

    /// Runs the step's interrupt: it takes the reply if there is one, then at most `count` bytes.
    fn step(&mut self, bytes: &mut &[u8], count: usize) {
        let sent = &mut self.sent;
        if let Some(reply) = self.reply.take() {
            self.step
                .take_reply(reply, |frame| sent.extend_from_slice(frame));
        }
        self.post();
        for _ in 0..count {
            let Some((byte, rest)) = bytes.split_first().filter(|_| !self.step.waits()) else {
                break;
            };
            *bytes = rest;
            let sent = &mut self.sent;
            self.step
                .receive(*byte, |frame| sent.extend_from_slice(frame));
            self.post();
        }
    }

    /// Runs the planner's thread for at most `count` slices.
    fn plan(&mut self, count: usize) {
        for _ in 0..count {
            if let Some(request) = self.request.take() {
                self.plan.take(&request);
            }
            match self.plan.advance(self.step.clock()) {
                Progress::Working => {}
                Progress::Replied if self.reply.is_none() => self.reply = self.plan.reply(),
                Progress::Waiting | Progress::Replied => return,
            }
        }
    }

    fn messages(&self) -> Vec<Message> {
        let mut decoder = Decoder::new();
        let found = self.sent.iter().filter_map(|byte| decoder.push(*byte));
        found.filter_map(Result::ok).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn any_interleaving_sends_the_same_bytes(
        turns in prop::collection::vec((0..200_usize, 0..60_usize), 50..200),
    ) {
        let input = flight(2);
        let expected = lockstep(&input);
        let mut tasks = Tasks::new(Pace::Lockstep);
        let mut bytes = &input[..];
        // A turn of both tasks follows, so that the end is reached whatever was drawn.
        for (step, plan) in turns.iter().chain([&(1, 1)]).cycle().take(100_000) {
            tasks.step(&mut bytes, *step);
            tasks.plan(*plan);
        }
        prop_assert!(bytes.is_empty(), "the flight was not flown to its end");
        prop_assert!(tasks.sent == expected);
    }
}

/// Flies by the clock: each tick's frames come at once, then as many slices run as `slices(tick)`
/// gives.
fn fly_by_the_clock(input: &[u8], slices: impl Fn(usize) -> usize) -> Vec<Message> {
    let mut tasks = Tasks::new(Pace::RealTime);
    let mut ticks = 0;
    let mut bytes = input;
    while !bytes.is_empty() {
        tasks.step(&mut bytes, 1);
        let stepped = tasks.step.last_tick().map_or(0, |tick| tick as usize + 1);
        if stepped > ticks || tasks.step.waits() {
            ticks = stepped;
            tasks.plan(slices(ticks));
        }
    }
    tasks.messages()
}

fn commands(messages: &[Message]) -> usize {
    let is_command = |message: &&Message| matches!(message, Message::ActuatorCommand(_));
    messages.iter().filter(is_command).count()
}

#[test]
fn in_time_the_real_pace_flies_as_in_lockstep() {
    let input = flight(3);
    let expected = lockstep(&input);
    let messages = fly_by_the_clock(&input, |_| 200);
    let mut decoder = Decoder::new();
    let decoded = expected.iter().filter_map(|byte| decoder.push(*byte));
    let decoded: Vec<Message> = decoded.filter_map(Result::ok).collect();
    assert!(messages == decoded);
}

#[test]
fn a_late_planner_ends_with_its_best_and_holds_no_step() {
    let input = flight(3);
    // One slice per tick is far less than a cycle takes.
    let messages = fly_by_the_clock(&input, |tick| if tick == 0 { 10 } else { 1 });
    assert_eq!(commands(&messages), 300);
    let plans = messages.iter().filter_map(|message| match message {
        Message::PlanReport(plan) => Some(plan),
        _ => None,
    });
    let plans: Vec<_> = plans.collect();
    assert_eq!(plans.len(), 3);
    for plan in plans {
        assert!(!plan.complete, "{plan:?}");
        assert_eq!(plan.used_from_tick, plan.scan_tick + 31);
    }
}

#[test]
fn a_planner_that_never_answers_is_busy_and_holds_no_step() {
    let input = flight(3);
    let messages = fly_by_the_clock(&input, |tick| if tick == 0 { 10 } else { 0 });
    assert_eq!(commands(&messages), 300);
    let busy = messages.iter().filter(|message| {
        matches!(message, Message::Rejection(r) if r.cause == RejectionCause::PlannerBusy)
    });
    assert_eq!(busy.count(), 2);
}

#[test]
fn a_lost_planner_is_reported_its_cycle_given_up_and_the_next_one_planned() {
    let input = flight(3);
    let mut tasks = Tasks::new(Pace::RealTime);
    let mut bytes = &input[..];
    let mut lost = false;
    while !bytes.is_empty() {
        tasks.step(&mut bytes, 1);
        if tasks.step.last_tick() == Some(10) && !lost {
            lost = true;
            *tasks.plan = PlanTask::new();
            tasks.reply = None;
            let sent = &mut tasks.sent;
            tasks
                .step
                .planner_lost(|frame| sent.extend_from_slice(frame));
            tasks.post();
        }
        // The planner hangs until it is lost.
        if lost || tasks.step.waits() {
            tasks.plan(200);
        }
    }
    let messages = tasks.messages();
    assert_eq!(commands(&messages), 300);
    let restarted = messages.iter().filter(|message| {
        matches!(message, Message::Rejection(r) if r.cause == RejectionCause::PlannerRestarted)
    });
    assert_eq!(restarted.count(), 1);
    let outcomes: Vec<_> = messages
        .iter()
        .filter_map(|message| match message {
            Message::PlanReport(plan) => Some((plan.scan_tick, plan.outcome, plan.candidates > 0)),
            _ => None,
        })
        .collect();
    assert_eq!(outcomes[0], (0, PlanOutcome::TrimHold, false));
    assert!(outcomes[1..].iter().all(|(_, _, planned)| *planned));
    assert_eq!(outcomes.len(), 3);
}

#[test]
fn without_its_planner_the_step_flies_on_and_later_sessions_are_accepted() {
    let input = flight(3);
    let mut tasks = Tasks::new(Pace::RealTime);
    let mut bytes = &input[..];
    while tasks.step.last_tick() != Some(150) {
        tasks.step(&mut bytes, 1);
        tasks.plan(200);
    }
    let sent = &mut tasks.sent;
    tasks
        .step
        .planner_off(|frame| sent.extend_from_slice(frame));
    // The planner never runs again.
    while !bytes.is_empty() {
        tasks.step(&mut bytes, 1);
        assert!(tasks.request.is_none());
    }
    let mut rest = &input[..];
    while !rest.is_empty() {
        tasks.step(&mut rest, 1);
        assert!(tasks.request.is_none());
    }
    let messages = tasks.messages();
    assert_eq!(commands(&messages), 600);
    let accepted = messages.iter().filter(|message| {
        matches!(message, Message::ConfigureReply(reply)
            if reply.verdict == hil_protocol::ConfigureVerdict::Accepted)
    });
    assert_eq!(accepted.count(), 2);
    let causes: Vec<_> = messages
        .iter()
        .filter_map(|message| match message {
            Message::Rejection(rejection) => Some(rejection.cause),
            _ => None,
        })
        .collect();
    // When it happens, and after the hello of the second session.
    assert_eq!(causes, [RejectionCause::PlannerOff; 2]);
    // The cycles of ticks 0 and 100, and nothing in the second session.
    let plans = messages
        .iter()
        .filter(|message| matches!(message, Message::PlanReport(_)));
    assert_eq!(plans.count(), 2);
}

#[test]
fn a_core_that_refuses_says_why_and_flies_nothing() {
    let mut step = StepTask::new(Pace::RealTime);
    step.refuse(hil_protocol::ConfigureVerdict::ImageDamaged);
    let (mut decoder, mut messages) = (Decoder::new(), Vec::new());
    for byte in flight(1) {
        step.receive(byte, |frame| {
            messages.extend(
                frame
                    .iter()
                    .filter_map(|byte| decoder.push(*byte))
                    .flatten(),
            );
        });
        assert!(step.request().is_none());
    }
    assert!(messages.iter().any(|message| {
        matches!(message, Message::ConfigureReply(reply)
            if reply.verdict == hil_protocol::ConfigureVerdict::ImageDamaged)
    }));
    assert_eq!(commands(&messages), 0);
}

#[test]
fn a_reply_to_an_earlier_set_up_does_not_accept_a_later_configuration() {
    let input = flight(1);
    let mut tasks = Tasks::new(Pace::RealTime);
    let mut bytes = &input[..];
    while tasks.step.last_tick() != Some(10) {
        tasks.step(&mut bytes, 1);
        tasks.plan(200);
    }
    // The planner is lost and set up again. Meanwhile a new session begins.
    *tasks.plan = PlanTask::new();
    tasks.reply = None;
    tasks.step.planner_lost(|_| {});
    tasks.post();
    tasks.plan(1);
    tasks.plan(1);
    let stale = tasks.reply.take();
    assert!(matches!(stale, Some(PlanReply::SetUp { .. })));
    let mut again = &input[..];
    tasks.step(&mut again, usize::MAX);
    assert!(tasks.step.waits());
    tasks.reply = stale;
    tasks.step(&mut again, usize::MAX);
    assert!(tasks.step.waits(), "accepted by a reply to another request");
    while !again.is_empty() {
        tasks.plan(200);
        tasks.step(&mut again, usize::MAX);
    }
    assert_eq!(commands(&tasks.messages()), 11 + 100);
}

/// The same input with a message after the sensor frame of a tick.
fn with_message_after(input: &[u8], tick: u32, message: &Message) -> Vec<u8> {
    let mut decoder = Decoder::new();
    let mut buffer = [0; MAX_FRAME];
    let frame = encode(message, &mut buffer).unwrap_or_default();
    let mut output = Vec::new();
    for byte in input {
        output.push(*byte);
        if let Some(Ok(Message::SensorFrame(sensors))) = decoder.push(*byte)
            && sensors.tick == tick
        {
            output.extend_from_slice(frame);
        }
    }
    output
}

#[test]
fn another_latency_is_for_the_cycles_to_come() {
    let name = |parameter: &mpp_node::parameters::Parameter| parameter.name == "MPP_LATENCY_S";
    let parameter = PARAMETERS.iter().position(name).unwrap() as u8;
    let input = flight(3);
    for (seconds, ticks) in [(0.1, 10), (0.5, 50)] {
        let set = Message::SetParameter(SetParameter {
            parameter,
            value: seconds,
        });
        let answer = lockstep(&with_message_after(&input, 5, &set));
        let mut decoder = Decoder::new();
        let decoded = answer.iter().filter_map(|byte| decoder.push(*byte));
        let messages: Vec<Message> = decoded.filter_map(Result::ok).collect();
        assert_eq!(commands(&messages), 300);
        let used = messages.iter().filter_map(|message| match message {
            Message::PlanReport(plan) => Some((plan.scan_tick, plan.used_from_tick)),
            _ => None,
        });
        let expected = [(0, 30), (100, 100 + ticks), (200, 200 + ticks)];
        assert!(
            used.clone().eq(expected),
            "{seconds} s: {:?}",
            used.collect::<Vec<_>>()
        );
    }
}
