//! Tests the bytes of every message and of every variant, as they were when they first went over a
//! wire.
//!
//! A failure here means that a peer of the same version would read something else. After the
//! release of a version no line may change: raise `PROTOCOL_VERSION` (the third byte of all frames)
//! and write all lines anew. Before the release, changes go into the table of versions in the
//! crate's documentation, and the lines of the changed message are changed here.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

use hil_protocol::*;

/// Checks lines that each hold one frame, with its bytes in hexadecimal.
fn check(frozen: &[(Message, &str)]) {
    for (message, expected) in frozen {
        let mut buffer = [0; MAX_FRAME];
        let frame = encode(message, &mut buffer).unwrap();
        let hex: String = frame.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(hex, *expected, "{message:?}");

        let mut decoder = Decoder::new();
        let received = frame.iter().find_map(|&byte| decoder.push(byte));
        assert_eq!(received, Some(Ok(message.clone())));
    }
}

/// A frame of version 1 with a good checksum is told from noise, and its version is named.
#[test]
fn the_version_before_is_refused_by_its_number() {
    let hello_1 = "054d500101010c01c8904e8001125f9d741d00";
    let bytes =
        (0..hello_1.len() / 2).map(|at| u8::from_str_radix(&hello_1[2 * at..][..2], 16).unwrap());
    let mut decoder = Decoder::new();
    let received = bytes.into_iter().find_map(|byte| decoder.push(byte));
    assert_eq!(received, Some(Err(DecodeError::Version { peer: 1 })));
    assert_eq!(PROTOCOL_VERSION, 2);
}

fn hello(role: Role) -> Message {
    Message::Hello(Hello {
        role,
        software: [0, 1, 200],
        tick_period_us: 10_000,
        beams_max: 128,
        stages: 18,
    })
}

#[test]
fn hello_and_every_role() {
    check(&[
        (
            hello(Role::Harness),
            "054d500201010c01c8904e8001125efb968400",
        ),
        (hello(Role::Core), "064d500201010c01c8904e8001121defed9300"),
    ]);
}

fn configure(preset: Preset, airframe: AirframeId) -> Message {
    Message::Configure(Configure {
        preset,
        airframe,
        paths: 25,
        replan_period_ticks: 50,
        latency_ticks: 300,
        slices_per_tick: 70_000,
        seed: 0x0123_4567_89AB_CDEF,
        beams: 100,
        range_max: 50.0,
        altitude: -0.1,
        actuators: ActuatorLimits {
            thrust_max: Some(15.0),
            thrust_lag: None,
            elevator_range: Some(2.0),
            elevator_rate: None,
        },
    })
}

#[test]
fn configure_and_every_preset_and_airframe() {
    check(&[
        (
            configure(Preset::Reference, AirframeId::Paper),
            "054d50020201121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010103704102010101024005625f53ad00",
        ),
        (
            configure(Preset::Paper, AirframeId::Reference),
            "184d50020201011932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010103704102010101024005772d794b00",
        ),
        (
            configure(Preset::Flight, AirframeId::Paper),
            "064d50020202121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf01010370410201010102400594b2742300",
        ),
    ]);
}

fn reply(verdict: ConfigureVerdict) -> Message {
    Message::ConfigureReply(ConfigureReply { verdict })
}

#[test]
fn configure_reply_and_every_verdict() {
    use ConfigureVerdict::*;
    check(&[
        (reply(Accepted), "054d50020305eae3e58500"),
        (reply(TooManyPaths { max: 25 }), "0b4d5002030119899828ef00"),
        (reply(ReplanPeriod), "0a4d50020302c682eb6b00"),
        (reply(Latency), "0a4d5002030350b2ec1c00"),
        (reply(Beams { max: 128 }), "0c4d500203048001bf3fc69700"),
        (reply(NonFinite), "0a4d5002030565178ff500"),
        (reply(NotTrimmable), "0a4d50020306df46866c00"),
        (reply(SlicesPerTick), "0a4d500203074976811b00"),
        (reply(RangeMax), "0a4d50020308d86b3e8b00"),
        (reply(AlreadyConfigured), "0a4d500203094e5b39fc00"),
        (reply(Actuators), "0a4d5002030af40a306500"),
        (reply(PresetNotBuilt), "0a4d5002030b623a371200"),
        (reply(PathsZero), "0a4d5002030cc1af538c00"),
        (reply(ThrustTooLow), "0a4d5002030d579f54fb00"),
        (reply(CruiseAirspeed), "0a4d5002030eedce5d6200"),
        (reply(AirframeNotFinite), "0a4d5002030f7bfe5a1500"),
        (reply(NotCarried), "0a4d500203108ef3529800"),
        (reply(NoElevator), "0a4d5002031118c355ef00"),
        (reply(RegulatorNotFinite), "0a4d50020312a2925c7600"),
        (reply(RegulatorSingular), "0a4d5002031334a25b0100"),
        (reply(RegulatorNotConverged), "0a4d5002031497373f9f00"),
        (reply(RegulatorNotStabilising), "0a4d50020315010738e800"),
        (reply(PlanModel), "0a4d50020316bb56317100"),
        (reply(PlanWeights), "0a4d500203172d66360600"),
        (reply(Penalty), "0a4d50020318bc7b899600"),
        (reply(Margin), "0a4d500203192a4b8ee100"),
        (reply(Band), "0a4d5002031a901a877800"),
        (reply(PlanThrust), "0a4d5002031b062a800f00"),
        (reply(WindChange), "0a4d5002031ca5bfe49100"),
        (reply(AngleOfAttackLimit), "0a4d5002031d338fe3e600"),
        (reply(FlightPathLimit), "0a4d5002031e89deea7f00"),
        (reply(OtherPreset), "0a4d5002031f1feeed0800"),
    ]);
}

#[test]
fn sensor_frame() {
    let air = AirData {
        tick: 998,
        airspeed: 9.1,
        pitch: -0.2,
    };
    let position = Position {
        tick: 990,
        x: 123.456,
        z: 30.0,
        sigma: 0.02,
        velocity: Some(GroundVelocity {
            x: 8.5,
            z: -0.25,
            sigma: 0.1,
        }),
    };
    let frame = |air, position| {
        Message::SensorFrame(SensorFrame {
            tick: 1000,
            air,
            position,
        })
    };
    check(&[
        (
            frame(Some(air), Some(position)),
            "254d500204e80701e60733333333333322409a9999999999c9bf01de0777be9f1a2fdd5e400101010101083e400ad7a33c0101030841010b80becdcccc3d470482d800",
        ),
        (
            frame(
                None,
                Some(Position {
                    velocity: None,
                    ..position
                }),
            ),
            "074d500204e8070c01de0777be9f1a2fdd5e400101010101073e400ad7a33c05c888a8d600",
        ),
        (frame(None, None), "074d500204e80701057b99a35a00"),
    ]);
}

fn scan(ranges: &[f32]) -> Message {
    Message::LidarScan(LidarScan {
        tick: 1000,
        angle_min: -0.7,
        angle_increment: 0.0125,
        ranges: ranges.iter().copied().collect(),
    })
}

#[test]
fn lidar_scan() {
    check(&[
        (scan(&[]), "0f4d500205e807333333bfcdcc4c3c05a29c7c0800"),
        (
            scan(&[49.9, 0.0, 12.3]),
            "144d500205e807333333bfcdcc4c3c039a99474201010109cdcc4441b7149ef700",
        ),
    ]);
}

fn command(mode: ControlMode) -> Message {
    Message::ActuatorCommand(ActuatorCommand {
        tick: 300,
        thrust: 4.4,
        elevator: -0.25,
        mode,
    })
}

#[test]
fn actuator_command_and_every_mode() {
    check(&[
        (
            command(ControlMode::TrimHold),
            "0f4d500206ac029a99999999991140010101010103d0bf05f2bbe20400",
        ),
        (
            command(ControlMode::Tracking),
            "0f4d500206ac029a99999999991140010101010108d0bf01648be57300",
        ),
    ]);
}

#[test]
fn step_report() {
    let message = StepReport {
        tick: 300,
        estimate: [9.1, 0.1, -0.01, 0.05],
        position: [49.5, 30.25],
        wind: [-1.5, 0.25],
        lift: 0.03,
        reference: [50.0, 30.5, 9.0, 0.2, 0.02, -0.3],
        plan_age_ticks: 40,
        sensors: SensorStates {
            airspeed: SensorState::Healthy,
            pitch: SensorState::Suspected,
            position: SensorState::Excluded,
            lidar: SensorState::Recovering,
        },
    };
    check(&[(
        Message::StepReport(message),
        "274d500207ac0233333333333322409a9999999999b93f7b14ae47e17a84bf9a9999999999a93f0101010104c048400101010104403e40010101010103f8bf01010101010bd03fb81e85eb51b89e3f01010101010349400101010104803e4001010101011c22409a9999999999c93f7b14ae47e17a943f333333333333d3bf28080102034ba62cd000",
    )]);
}

fn plan(outcome: PlanOutcome, complete: bool) -> Message {
    Message::PlanReport(PlanReport {
        scan_tick: 200,
        used_from_tick: 250,
        outcome,
        candidates: 25,
        feasible: 3,
        tree_runs: 300,
        slices: 4000,
        cost: 17.5,
        violation: 0.1,
        complete,
    })
}

#[test]
fn plan_report_and_every_outcome() {
    check(&[
        (
            plan(PlanOutcome::Adopted, true),
            "094d500208c801fa01071903ac02a01f01010101118031409a9999999999b93f01ec3769e400",
        ),
        (
            plan(PlanOutcome::LeastViolating, false),
            "104d500208c801fa01011903ac02a01f010101010c8031409a9999999999b93f055d624b1200",
        ),
        (
            plan(PlanOutcome::KeptPrevious, true),
            "104d500208c801fa01021903ac02a01f01010101118031409a9999999999b93f01e3fb523d00",
        ),
        (
            plan(PlanOutcome::TrimHold, false),
            "104d500208c801fa01031903ac02a01f010101010c8031409a9999999999b93f0552ae70cb00",
        ),
    ]);
}

fn rejection(cause: RejectionCause) -> Message {
    Message::Rejection(Rejection { tick: 300, cause })
}

#[test]
fn rejection_and_every_cause() {
    use RejectionCause::*;
    check(&[
        (rejection(NonFiniteSensor), "074d500209ac02055c19a25100"),
        (
            rejection(InnovationGate {
                airspeed: true,
                pitch: false,
            }),
            "094d500209ac02010105b3a2652b00",
        ),
        (
            rejection(ScanLength {
                expected: 100,
                found: 128,
            }),
            "0f4d500209ac0202648001e1666c9000",
        ),
        (
            rejection(ScanNotFinite { beam: 7 }),
            "0d4d500209ac0203072b96c70500",
        ),
        (
            rejection(ScanRange { beam: 99 }),
            "0c4d500209ac020463ada5590100",
        ),
        (
            rejection(TickOrder {
                expected: 301,
                found: 70_000,
            }),
            "114d500209ac0206ad02f0a204ca31f3b500",
        ),
        (rejection(NotConfigured), "0c4d500209ac0207ff8cc6cf00"),
        (
            rejection(UnexpectedMessage { id: 200 }),
            "0d4d500209ac0208c8c190e8ed00",
        ),
        (rejection(PlannerBusy), "0c4d500209ac0209f8a17e2800"),
        (
            rejection(BytesLost { count: 70_000 }),
            "0f4d500209ac020af0a2048dec1a7800",
        ),
        (rejection(PlannerRestarted), "0c4d500209ac020bd4c070c600"),
        (rejection(ScanAngle), "0c4d500209ac020c7755145800"),
        (rejection(ScanRepeated), "0c4d500209ac020de165132f00"),
        (rejection(ScanBlind), "0c4d500209ac020e5b341ab600"),
    ]);
}

#[test]
fn rejection_and_every_fault_of_a_frame() {
    use DecodeError::*;
    let frame = |fault| rejection(RejectionCause::Frame(fault));
    check(&[
        (frame(TooLong), "084d500209ac0205050ea4f9cd00"),
        (frame(Cobs), "0d4d500209ac0205019894feba00"),
        (frame(TooShort), "0d4d500209ac02050222c5f72300"),
        (frame(Magic), "0d4d500209ac020503b4f5f05400"),
        (frame(Crc), "0d4d500209ac020504176094ca00"),
        (frame(Version { peer: 2 }), "0e4d500209ac0205050247ae0ea600"),
        (
            frame(UnknownId { id: 10 }),
            "0e4d500209ac0205060ab675f88300",
        ),
        (frame(Payload { id: 3 }), "0e4d500209ac0205070353fc3fe300"),
        (
            frame(TrailingBytes { id: 255 }),
            "0e4d500209ac020508ffab5eacd000",
        ),
    ]);
}

#[test]
fn set_parameter() {
    let message = SetParameter {
        parameter: 7,
        value: -0.25,
    };
    check(&[(
        Message::SetParameter(message),
        "064d50020a07010101010107d0bf98c2673800",
    )]);
}

fn parameter_reply(verdict: ParameterVerdict) -> Message {
    Message::ParameterReply(ParameterReply {
        parameter: 7,
        verdict,
    })
}

#[test]
fn parameter_reply_and_every_verdict() {
    use ParameterVerdict::*;
    check(&[
        (parameter_reply(Accepted), "064d50020b070577c60ad300"),
        (parameter_reply(Unknown), "0b4d50020b0701e1f60da400"),
        (parameter_reply(Range), "0b4d50020b07025ba7043d00"),
        (parameter_reply(NotWhole), "0b4d50020b0703cd97034a00"),
        (parameter_reply(InFlight), "0b4d50020b07046e0267d400"),
        (parameter_reply(NotConfigured), "0b4d50020b0705f83260a300"),
        (
            parameter_reply(SetUp(ConfigureVerdict::NotTrimmable)),
            "0c4d50020b070606670389a300",
        ),
        (parameter_reply(NotInPreset), "0b4d50020b0707d4536e4d00"),
        (parameter_reply(PathsInFlight), "0b4d50020b0708454ed1dd00"),
        (parameter_reply(CruiseFixed), "0b4d50020b0709d37ed6aa00"),
    ]);
}

#[test]
fn plan_trajectory() {
    let message = PlanTrajectory {
        scan_tick: 200,
        period: 0.25,
        knots: [[1.5, -2.5, 0.1]; 2].into_iter().collect(),
    };
    check(&[(
        Message::PlanTrajectory(message),
        "074d50020cc8010104803e020103c03f010720c0cdcccc3d0103c03f010b20c0cdcccc3d718664ce00",
    )]);
}

#[test]
fn health_report() {
    let mut counters = [0; HealthReport::NAMES.len()];
    counters[1] = 300;
    counters[18] = 7;
    let report = HealthReport {
        tick: 1263,
        counters,
    };
    check(&[(
        Message::HealthReport(report),
        "074d50020def0903ac0201010101010101010101010101010106077d9e63fe00",
    )]);
}
