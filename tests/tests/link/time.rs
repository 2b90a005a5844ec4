//! Ticks that wrap around, jump or go back, and measurements that come late.

use super::input::level_flight;
use super::short;
use hil_protocol::{Hello, LidarScan, Message, RejectionCause, Role, SensorFrame};
use mpp_sim::flight::fly;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::log::FlightLog;
use mpp_sim::navigation::NavigationConfig;
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::PipeLink;
use std::collections::VecDeque;

/// A link whose core counts ticks from another number than the harness.
struct Shifted {
    pipe: PipeLink,
    offset: u32,
}

impl Link for Shifted {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let mut message = message.clone();
        let offset = self.offset;
        let shift = |tick: &mut u32| *tick = tick.wrapping_add(offset);
        match &mut message {
            Message::SensorFrame(frame) => {
                shift(&mut frame.tick);
                if let Some(air) = &mut frame.air {
                    shift(&mut air.tick);
                }
                if let Some(position) = &mut frame.position {
                    shift(&mut position.tick);
                }
            }
            Message::LidarScan(scan) => shift(&mut scan.tick),
            _ => {}
        }
        self.pipe.send(&message)
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        let mut message = self.pipe.receive(awaited)?;
        let offset = self.offset;
        let shift = |tick: &mut u32| *tick = tick.wrapping_sub(offset);
        match &mut message {
            Message::ActuatorCommand(command) => shift(&mut command.tick),
            Message::StepReport(report) => shift(&mut report.tick),
            Message::PlanReport(report) => {
                shift(&mut report.scan_tick);
                shift(&mut report.used_from_tick);
            }
            Message::PlanTrajectory(trajectory) => shift(&mut trajectory.scan_tick),
            Message::PlanControls(controls) => shift(&mut controls.scan_tick),
            Message::HealthReport(report) => shift(&mut report.tick),
            Message::Rejection(rejection) => shift(&mut rejection.tick),
            _ => {}
        }
        Ok(message)
    }
}

/// The number from which ticks are counted does not matter, nor that they pass the greatest number.
#[test]
fn a_flight_is_the_same_wherever_its_ticks_start() {
    let flown = |offset| {
        let pipe = PipeLink::new();
        fly(&short(2), &mut Shifted { pipe, offset }, |_| {}).unwrap()
    };
    let usual = flown(0);
    for offset in [7, 1 << 31, u32::MAX - 249, u32::MAX] {
        let other = flown(offset);
        assert_eq!(other.ticks, usual.ticks, "{offset}");
        assert_eq!(other.plans, usual.plans, "{offset}");
        assert!(other.rejections.is_empty());
    }
}

/// The answers to one message.
fn answers(pipe: &mut PipeLink, message: &Message) -> Vec<Message> {
    pipe.send(message).unwrap();
    std::iter::from_fn(|| pipe.receive("anything").ok()).collect()
}

/// A clock that was set back is followed after 0.2 s; until then its frames count as old. The commands go on
/// as if nothing had happened.
#[test]
fn a_clock_that_was_set_back_is_followed() {
    let mut pipe = PipeLink::new();
    let configure = Message::Configure(short(1).configure());
    assert_eq!(answers(&mut pipe, &configure).len(), 1);
    let mut refused = 0;
    let mut last_elevator = f64::NAN;
    for index in 0..300_u32 {
        let tick = if index < 150 { 1000 + index } else { index };
        let Message::SensorFrame(mut frame) = level_flight(index) else {
            unreachable!("it is a sensor frame");
        };
        frame.tick = tick;
        frame.air.as_mut().unwrap().tick = tick;
        frame.position.as_mut().unwrap().tick = tick;
        let answers = answers(&mut pipe, &Message::SensorFrame(frame));
        let command = answers.iter().find_map(|answer| match answer {
            Message::ActuatorCommand(command) => Some(*command),
            _ => None,
        });
        match command {
            Some(command) => {
                assert_eq!(command.tick, tick);
                if index > 50 {
                    assert!((command.elevator - last_elevator).abs() < 0.1, "{index}");
                }
                last_elevator = command.elevator;
            }
            None => refused += 1,
        }
    }
    assert_eq!(refused, 19);
}

/// A clock that was set back is followed on a line that loses every second frame, too.
#[test]
fn a_clock_that_was_set_back_on_a_lossy_line_is_followed() {
    let mut pipe = PipeLink::new();
    let configure = Message::Configure(short(1).configure());
    assert_eq!(answers(&mut pipe, &configure).len(), 1);
    let mut random = 1_u32;
    let mut commanded = Vec::new();
    for index in 0..300_u32 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if random >> 31 == 1 {
            continue;
        }
        let Message::SensorFrame(mut frame) = level_flight(index) else {
            unreachable!("it is a sensor frame");
        };
        frame.tick = if index < 150 { 100_000 + index } else { index };
        frame.air = None;
        frame.position = None;
        let answers = answers(&mut pipe, &Message::SensorFrame(frame));
        let is_command = |answer: &Message| matches!(answer, Message::ActuatorCommand(_));
        if answers.iter().any(is_command) {
            commanded.push(index);
        }
    }
    let again = commanded.iter().find(|index| **index >= 150);
    assert!(again.is_some_and(|index| *index < 215), "{again:?}");
}

/// An echo of the core's own hello does not end the session in flight.
#[test]
fn an_echo_of_hello_is_refused() {
    let mut pipe = PipeLink::new();
    let configure = Message::Configure(short(1).configure());
    assert_eq!(answers(&mut pipe, &configure).len(), 1);
    let hello = |role| {
        Message::Hello(Hello {
            role,
            software: [0, 2, 0],
            tick_period_us: 10_000,
            beams_max: 128,
            stages: 18,
        })
    };
    let told = answers(&mut pipe, &hello(Role::Core));
    assert!(matches!(told[..], [Message::Rejection(_)]), "{told:?}");
    let is_command = |answer: &Message| matches!(answer, Message::ActuatorCommand(_));
    assert!(answers(&mut pipe, &level_flight(0)).iter().any(is_command));
}

/// A link that delivers each frame twice is no clock that was set back: the second copies are refused, and
/// the flight's time stays that of the ticks.
#[test]
fn frames_that_come_twice_are_refused_once_each() {
    let mut pipe = PipeLink::new();
    answers(&mut pipe, &Message::Configure(short(1).configure()));
    let count = |answers: &[Message], is: fn(&Message) -> bool| {
        answers.iter().filter(|answer| is(answer)).count()
    };
    for tick in 0..200 {
        let first = answers(&mut pipe, &level_flight(tick));
        assert_eq!(
            count(&first, |it| matches!(it, Message::ActuatorCommand(_))),
            1
        );
        let again = answers(&mut pipe, &level_flight(tick));
        assert!(matches!(again[..], [Message::Rejection(_)]), "{again:?}");
    }
}

/// A sender repeats a scan until a command answers it. The core takes it once, as old as it is, and says nothing of its
/// copies.
#[test]
fn a_scan_that_comes_again_and_again_is_taken_once() {
    let usual = fly(&short(2), &mut PipeLink::new(), |_| {}).unwrap();
    let mut held = None;
    let mut link = super::Spoilt {
        pipe: PipeLink::new(),
        spoil: move |pipe: &mut PipeLink, message: &Message| match message {
            // The scan of tick 100 comes with tick 180 for the first time.
            Message::LidarScan(scan) if scan.tick == 100 => {
                held = Some(message.clone());
                true
            }
            Message::SensorFrame(frame) if (180..190).contains(&frame.tick) => {
                held.as_ref().is_some_and(|scan| pipe.send(scan).is_ok())
                    && pipe.send(message).is_ok()
            }
            _ => false,
        },
    };
    let late = fly(&short(2), &mut link, |_| {}).unwrap();
    assert!(late.rejections.is_empty(), "{:?}", late.rejections);
    let plans = |log: &FlightLog| {
        let plans = log.plans.iter();
        plans
            .map(|plan| (plan.tick, plan.used_from_tick))
            .collect::<Vec<_>>()
    };
    let mut expected = plans(&usual);
    expected[1].1 = expected[1].1.map(|tick| tick + 80);
    assert_eq!(plans(&late), expected);
}

/// When the origin of the positions jumps, the plan under way is dropped: it counts from the old origin.
#[test]
fn a_plan_under_way_is_dropped_when_the_origin_jumps() {
    let mut link = super::Spoilt {
        pipe: PipeLink::new(),
        spoil: |pipe: &mut PipeLink, message: &Message| {
            let Message::SensorFrame(mut frame) = *message else {
                return false;
            };
            // The positions are refused for a second; then the filter starts anew from them.
            if frame.tick >= 110
                && let Some(position) = &mut frame.position
            {
                position.x += 30.0;
            }
            pipe.send(&Message::SensorFrame(frame)).is_ok()
        },
    };
    let mut scenario = short(2);
    scenario.navigation = NavigationConfig::IDEAL;
    scenario.replan_ticks = 25;
    scenario.latency_ticks = 20;
    let log = fly(&scenario, &mut link, |_| {}).unwrap();
    let scans: Vec<_> = log.plans.iter().map(|plan| plan.tick).collect();
    let expected: Vec<_> = (0..20)
        .map(|k| 25 * k)
        .filter(|tick| *tick != 200)
        .collect();
    assert_eq!(scans, expected);
}

/// Sends everything later by some ticks, each with the time at which it was measured.
struct Late {
    pipe: PipeLink,
    ticks: usize,
    frames: VecDeque<SensorFrame>,
    scans: VecDeque<LidarScan>,
}

impl Link for Late {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        match message {
            Message::LidarScan(scan) => {
                self.scans.push_back(scan.clone());
                Ok(())
            }
            Message::SensorFrame(frame) => {
                self.frames.push_back(*frame);
                let due = |tick: u32| tick as usize + self.ticks <= frame.tick as usize;
                if self.scans.front().is_some_and(|scan| due(scan.tick))
                    && let Some(scan) = self.scans.pop_front()
                {
                    self.pipe.send(&Message::LidarScan(scan))?;
                }
                let mut late = SensorFrame {
                    tick: frame.tick,
                    air: None,
                    position: None,
                };
                if self.frames.len() > self.ticks
                    && let Some(old) = self.frames.pop_front()
                {
                    (late.air, late.position) = (old.air, old.position);
                }
                self.pipe.send(&Message::SensorFrame(late))
            }
            _ => self.pipe.send(message),
        }
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.pipe.receive(awaited)
    }
}

/// Air data, positions and scans that are 0.2 s late, with honest times, cost no flight.
#[test]
fn measurements_that_are_late_are_used_as_late() {
    for seed in 1..=6 {
        let mut link = Late {
            pipe: PipeLink::new(),
            ticks: 20,
            frames: VecDeque::new(),
            scans: VecDeque::new(),
        };
        let mut scenario = short(seed);
        scenario.ticks = 1500;
        let log = fly(&scenario, &mut link, |_| {}).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Survived, "seed {seed}");
        assert!(log.summary.strict, "seed {seed}");
        assert!(log.plans.len() >= 14, "{} plans", log.plans.len());
        assert!(log.rejections.is_empty(), "{:?}", log.rejections);
    }
}

/// A frame far in the future is answered, and so is the clock that goes on as before.
#[test]
fn a_forged_tick_does_not_end_the_session() {
    let mut pipe = PipeLink::new();
    let configure = Message::Configure(short(1).configure());
    answers(&mut pipe, &configure);
    for tick in 0..10 {
        answers(&mut pipe, &level_flight(tick));
    }
    let forged = answers(&mut pipe, &level_flight(3_000_000));
    assert!(forged.iter().any(|it| matches!(it, Message::Rejection(r)
        if matches!(r.cause, RejectionCause::TickOrder { .. }))));
    let mut commands = 0;
    for tick in 10..60 {
        let answers = answers(&mut pipe, &level_flight(tick));
        commands += answers
            .iter()
            .filter(|it| matches!(it, Message::ActuatorCommand(_)))
            .count();
    }
    assert_eq!(commands, 31);
}
