//! The node in space, message by message.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    clippy::needless_pass_by_value,
    reason = "helpers of tests fail by panicking, and messages are made where they are asked"
)]

use hil_protocol::{
    ActuatorLimits, AirData, Aircraft, Configure, ConfigureLateral, ConfigureSpace,
    ConfigureVerdict, ControlMode, Decoder, Derivatives, InertialFrame, LateralAirframe, MAX_FRAME,
    Message, PlanOutcome, PointPacket, Preset, RejectionCause, SensorFrame, SpacePosition, encode,
};
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::{SpacePlanner, SpaceStage};
use mpp_node::{FlightNode, SpaceMemory, SpaceNode, SpaceSlice, SpaceTask};

/// Does something on a stack on which the node can be built.
fn aside(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(32 << 20);
    thread.spawn(work).unwrap().join().unwrap();
}

fn answers(node: &mut SpaceNode, message: &Message) -> Vec<Message> {
    let (mut buffer, mut sent) = ([0; MAX_FRAME], Vec::new());
    let frame = encode(message, &mut buffer).unwrap();
    node.receive(frame, |frame| sent.extend_from_slice(frame));
    decoded(&sent)
}

fn decoded(sent: &[u8]) -> Vec<Message> {
    let mut decoder = Decoder::new();
    let received = sent.iter().filter_map(|byte| decoder.push(*byte));
    received.map(Result::unwrap).collect()
}

fn verdict(node: &mut SpaceNode, message: Message) -> ConfigureVerdict {
    match answers(node, &message).as_slice() {
        [Message::ConfigureReply(reply)] => reply.verdict,
        other => panic!("{other:?}"),
    }
}

const CONFIGURE: Configure = Configure {
    preset: Preset::Space,
    aircraft: Aircraft::REFERENCE,
    paths: 3,
    seed: 0,
    replan_period_ticks: 25,
    latency_ticks: 10,
    slices_per_tick: 1000,
    beams: 1,
    range_max: 45.0,
    altitude: 7.5,
    actuators: ActuatorLimits::NONE,
};

const LIMITS: ConfigureSpace = ConfigureSpace {
    bank: [1.0, 1.5],
    margin: 0.6,
    half_span: 0.5,
    heights: [0.5, 14.5],
    half_width: 29.0,
    programs: true,
    open: false,
};

/// A wing that rolls, damps its yaw and holds its nose into the wind.
fn lateral() -> ConfigureLateral {
    let of = |sideslip, roll_rate, yaw_rate, aileron, rudder| Derivatives {
        sideslip,
        roll_rate,
        yaw_rate,
        aileron,
        rudder,
    };
    ConfigureLateral {
        airframe: LateralAirframe {
            span: 1.0,
            roll_inertia: 0.02,
            yaw_inertia: 0.04,
            product_inertia: 0.0,
            side: of(-0.4, 0.0, 0.0, 0.0, 0.1),
            roll: of(-0.05, -0.5, 0.1, 0.2, 0.0),
            yaw: of(0.1, -0.03, -0.15, 0.0, 0.06),
        },
        surfaces_max: [Some(0.5); 2],
        surface_rate: None,
        roll_loop: None,
    }
}

fn ready(configure: Configure) -> Box<SpaceNode> {
    let mut node = Box::new(SpaceNode::new());
    configured(&mut node, configure);
    node
}

fn configuration(configure: Configure) -> [Message; 3] {
    [
        Message::ConfigureLateral(lateral()),
        Message::ConfigureSpace(LIMITS),
        Message::Configure(configure),
    ]
}

fn configured(node: &mut SpaceNode, configure: Configure) {
    for message in configuration(configure) {
        assert_eq!(verdict(node, message), ConfigureVerdict::Accepted);
    }
}

/// What comes before the sensor frame of a tick of level flight at 12 m/s, and the frame. A sensor that repeats to the last bit
/// would count as frozen.
fn level(tick: u32, sees: bool) -> Vec<Message> {
    let noise = 1e-5 * (tick % 7) as f32;
    let mut messages = vec![
        Message::InertialFrame(InertialFrame {
            tick,
            attitude: [noise, 0.156 - noise, noise],
            sigma: 0.01,
            rates: [noise; 3],
            force: [1.52, noise, -9.69],
        }),
        Message::SpacePosition(SpacePosition {
            tick,
            position: [0.12 * f64::from(tick), 0.0, 7.5],
            sigma: 0.02,
            velocity: Some(([12.0, 0.0, 0.0], 0.1)),
        }),
    ];
    if sees {
        messages.push(Message::PointPacket(PointPacket {
            tick,
            sensor_time: 0,
            interval: 10,
            points: [[20.0, 1.0, 0.0], [20.0, 3.0, 0.0]].into_iter().collect(),
        }));
    }
    messages.push(frame(tick));
    messages
}

fn frame(tick: u32) -> Message {
    Message::SensorFrame(SensorFrame {
        tick,
        air: Some(AirData {
            tick,
            airspeed: 12.0 + 1e-5 * f64::from(tick % 7),
            pitch: 0.156,
        }),
        position: None,
    })
}

fn fly(node: &mut SpaceNode, tick: u32, sees: bool) -> Vec<Message> {
    let messages = level(tick, sees);
    let told = messages.iter().map(|message| answers(node, message));
    told.collect::<Vec<_>>().concat()
}

#[test]
fn each_part_of_a_configuration_gets_its_verdict() {
    aside(|| {
        use ConfigureVerdict::{
            Accepted, AlreadyConfigured, LateralAircraft, LateralMissing, NoSuchPlanner, PathsZero,
            SpaceLimits,
        };
        let mut node = Box::new(SpaceNode::new());
        let mut ask = |message| verdict(&mut node, message);
        assert_eq!(ask(Message::Configure(CONFIGURE)), LateralMissing);
        let mut odd = lateral();
        odd.airframe.roll_inertia = f64::NAN;
        assert_eq!(ask(Message::ConfigureLateral(odd)), LateralAircraft);
        odd = lateral();
        odd.airframe.product_inertia = 1.0;
        assert_eq!(ask(Message::ConfigureLateral(odd)), LateralAircraft);
        for dead_time in [f64::NAN, -0.1, 0.4] {
            let odd = ConfigureLateral {
                roll_loop: Some(dead_time),
                ..lateral()
            };
            assert_eq!(ask(Message::ConfigureLateral(odd)), LateralAircraft);
        }
        assert_eq!(ask(Message::ConfigureLateral(lateral())), Accepted);
        for limits in [
            ConfigureSpace {
                bank: [0.0, 1.0],
                ..LIMITS
            },
            ConfigureSpace {
                heights: [14.0, 1.0],
                ..LIMITS
            },
            ConfigureSpace {
                half_span: 28.5,
                ..LIMITS
            },
            ConfigureSpace {
                margin: f64::NAN,
                ..LIMITS
            },
        ] {
            assert_eq!(ask(Message::ConfigureSpace(limits)), SpaceLimits);
        }
        assert_eq!(ask(Message::ConfigureSpace(LIMITS)), Accepted);
        for (configure, expected) in [
            (
                Configure {
                    preset: Preset::Flight,
                    ..CONFIGURE
                },
                NoSuchPlanner,
            ),
            (
                Configure {
                    paths: 0,
                    ..CONFIGURE
                },
                PathsZero,
            ),
            (
                Configure {
                    altitude: 20.0,
                    ..CONFIGURE
                },
                SpaceLimits,
            ),
            (CONFIGURE, Accepted),
            (CONFIGURE, AlreadyConfigured),
        ] {
            assert_eq!(ask(Message::Configure(configure)), expected);
        }
    });
}

#[test]
fn the_node_in_the_plane_does_not_fly_in_space() {
    let mut node = Box::new(FlightNode::new());
    let (mut buffer, mut sent) = ([0; MAX_FRAME], Vec::new());
    let frame = encode(&Message::Configure(CONFIGURE), &mut buffer).unwrap();
    node.receive(frame, |frame| sent.extend_from_slice(frame));
    let mut decoder = Decoder::new();
    let told = sent.iter().find_map(|byte| decoder.push(*byte)).unwrap();
    let Ok(Message::ConfigureReply(reply)) = told else {
        panic!("{told:?}");
    };
    assert_eq!(reply.verdict, ConfigureVerdict::NoSuchPlanner);
}

#[test]
fn without_a_fix_the_surfaces_are_neutral_and_old_ticks_get_no_command() {
    aside(|| {
        let mut node = ready(CONFIGURE);
        let told = answers(&mut node, &frame(7));
        let [
            Message::SurfaceCommand(surfaces),
            Message::ActuatorCommand(command),
        ] = &told[..]
        else {
            panic!("{told:?}");
        };
        assert_eq!((surfaces.aileron, surfaces.rudder), (0.0, 0.0));
        assert_eq!((command.tick, command.mode), (7, ControlMode::TrimHold));
        let told = answers(&mut node, &frame(7));
        let [Message::Rejection(rejection)] = &told[..] else {
            panic!("{told:?}");
        };
        let order = RejectionCause::TickOrder {
            expected: 8,
            found: 7,
        };
        assert_eq!(rejection.cause, order);
        // A lost tick is told, and the next one flown.
        let told = answers(&mut node, &frame(9));
        assert!(matches!(told[0], Message::Rejection(_)) && told.len() == 3);
    });
}

#[test]
fn a_plan_is_due_after_its_latency_and_told_in_the_next_tick() {
    aside(|| {
        let mut node = ready(CONFIGURE);
        let (mut reports, mut shown, mut followed) = (Vec::new(), Vec::new(), Vec::new());
        for tick in 0..60 {
            for message in fly(&mut node, tick, tick % 25 == 3) {
                match message {
                    Message::StepReport(step) => followed.push((tick, step.reference[0])),
                    Message::PlanReport(report) => reports.push((tick, report)),
                    Message::SpaceTrajectory(it) => {
                        assert_eq!(it.knots.len(), 19);
                        shown.push((tick, it.scan_tick));
                    }
                    Message::ActuatorCommand(command) => {
                        let tracks = command.mode == ControlMode::Tracking;
                        assert_eq!(tracks, tick >= 13, "{tick}");
                    }
                    Message::Rejection(rejection) => panic!("{tick}: {rejection:?}"),
                    _ => {}
                }
            }
        }
        // The second plan is due at 38 and begins 12 ticks later: what is followed goes on through both.
        for pair in followed.windows(2).filter(|pair| pair[0].0 >= 14) {
            let moved = pair[1].1 - pair[0].1;
            assert!((0.10..0.14).contains(&moved), "{moved} at {}", pair[1].0);
        }
        let ticks: Vec<_> = reports
            .iter()
            .map(|(tick, it)| (*tick, it.scan_tick, it.used_from_tick))
            .collect();
        assert_eq!(ticks, [(14, 3, 13), (39, 28, 38)]);
        // A trajectory comes a tick after its report, because both in one would be the longest step.
        assert_eq!(shown, [(15, 3), (40, 28)]);
        assert!(
            reports
                .iter()
                .all(|(_, it)| it.complete && it.outcome.is_new())
        );
    });
}

/// Few slices give no plan, or a worse one; the tick never does more of them.
#[test]
fn a_cycle_gets_its_slices_and_no_more() {
    aside(|| {
        let mut node = ready(Configure {
            slices_per_tick: 1,
            ..CONFIGURE
        });
        let told: Vec<_> = (0..15)
            .flat_map(|tick| fly(&mut node, tick, tick == 3))
            .collect();
        let report = told.iter().find_map(|message| match message {
            Message::PlanReport(report) => Some(*report),
            _ => None,
        });
        let report = report.unwrap();
        assert_eq!((report.slices, report.complete), (10, false));
        assert_eq!(report.outcome, PlanOutcome::TrimHold);
    });
}

/// As an image does it, in memory that it has used before: byte by byte, and each slice on its own.
#[test]
fn a_task_that_is_reset_gives_the_nodes_answers_slice_by_slice() {
    use SpaceStage::{Candidate, Field, Lattice, Program, Refine, Solve};
    aside(|| {
        let mut node = ready(CONFIGURE);
        let sees = |tick: u32| tick % 10 == 3;
        let wanted: Vec<_> = (0..60)
            .flat_map(|tick| fly(&mut node, tick, sees(tick)))
            .collect();
        let mut task = Box::new(SpaceTask::new());
        let (mut map, mut planner) = (Box::new(VoxelGrid::new()), Box::new(SpacePlanner::new()));
        let mut memory = SpaceMemory {
            map: &mut map,
            planner: &mut planner,
        };
        let (mut sent, mut slices) = (Vec::new(), Vec::new());
        for _ in 0..2 {
            task.reset(&mut memory);
            assert_eq!(task.slice(memory.planner), None);
            assert!(!task.advance(&mut memory));
            sent.clear();
            slices.clear();
            let flight = (0..60).flat_map(|tick| level(tick, sees(tick)));
            for message in configuration(CONFIGURE).into_iter().chain(flight) {
                let mut buffer = [0; MAX_FRAME];
                for byte in encode(&message, &mut buffer).unwrap() {
                    let mut send = |frame: &[u8]| sent.extend_from_slice(frame);
                    task.take(*byte, &mut memory, &mut send);
                    while let Some(slice) = task.slice(memory.planner) {
                        assert!(task.advance(&mut memory));
                        slices.push(slice);
                    }
                }
            }
        }
        let [_, _, _, told @ ..] = &decoded(&sent)[..] else {
            panic!("three replies to the configuration come first");
        };
        assert!(told == wanted);
        let count = |wanted| slices.iter().filter(|slice| **slice == wanted).count();
        // The points of a sweep are few: one slice for their hits, and one for what they passed.
        assert_eq!(count(SpaceSlice::Sweep), 6);
        assert_eq!(count(SpaceSlice::Map), 12);
        // Cycles begin at ticks 3 and 33: with a sweep, or after twice the time.
        let begins = |pair: &&[SpaceSlice]| {
            let field = SpaceSlice::Planner(Field);
            pair[1] == field && pair[0] != field
        };
        let cycles = slices.windows(2).filter(begins).count();
        assert_eq!(cycles, 2);
        for stage in [Field, Lattice, Candidate, Program, Solve, Refine] {
            assert!(count(SpaceSlice::Planner(stage)) >= cycles, "{stage:?}");
        }
    });
}
