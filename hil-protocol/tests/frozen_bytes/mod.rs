//! Tests the bytes of every message and of every variant, as they were when they first went over a
//! wire.
//!
//! A failure here means that a peer of the same version would read something else. After the
//! release of a version no line may change: raise `PROTOCOL_VERSION` (the third byte of all frames)
//! and write all lines anew. Before the release, changes go into the table of versions in the
//! crate's documentation, and the lines of the changed message are changed here.

mod reports;
mod space;

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

fn configure(preset: Preset, aircraft: Aircraft) -> Message {
    Message::Configure(Configure {
        preset,
        aircraft,
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
            elevator_below: Some(2.0),
            elevator_above: None,
            elevator_rate: None,
            elevator_delay: None,
            thrust_delay: None,
        },
    })
}

#[test]
fn configure_and_every_preset() {
    check(&[
        (
            configure(Preset::Reference, Aircraft::REFERENCE),
            "054d500202119a99999999990940a6e2ecc367d8c53f010101010103d03f01010101010bf03f9a9999999999f33f01010101010be03f9301837b16eb16400101010101010101010101010101010101010101010101119a9999999999b93f9a9999999999a93f010101010113e03fb41a4223f60a20c0743f6a56df55ddbf01010101010101099a9999999999c93f01010101010328400101010101010101121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010101010101032e40020101010101010102400105bb4d0c4700",
        ),
        (
            configure(
                Preset::Paper,
                Aircraft {
                    stall: Some(0.25),
                    ..Aircraft::REFERENCE
                },
            ),
            "164d500202019a99999999990940a6e2ecc367d8c53f010101010103d03f01010101010bf03f9a9999999999f33f01010101010be03f9301837b16eb16400101010101010101010101010101010101010101010101119a9999999999b93f9a9999999999a93f010101010113e03fb41a4223f60a20c0743f6a56df55ddbf01010101010101099a9999999999c93f0101010101032840010101010101010201010101010114d03f1932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010101010101032e400201010101010101024001059f6194f800",
        ),
        (
            configure(Preset::Flight, Aircraft::REFERENCE),
            "164d500202029a99999999990940a6e2ecc367d8c53f010101010103d03f01010101010bf03f9a9999999999f33f01010101010be03f9301837b16eb16400101010101010101010101010101010101010101010101119a9999999999b93f9a9999999999a93f010101010113e03fb41a4223f60a20c0743f6a56df55ddbf01010101010101099a9999999999c93f01010101010328400101010101010101121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010101010101032e4002010101010101010240010533dc76e300",
        ),
    ]);
}

/// The dead times are a tail, without which all frames above end.
#[test]
fn configure_with_dead_times() {
    let told = |elevator_delay, thrust_delay| {
        let Message::Configure(known) = configure(Preset::Flight, Aircraft::REFERENCE) else {
            unreachable!("it is a configuration");
        };
        Message::Configure(Configure {
            actuators: ActuatorLimits {
                elevator_delay,
                thrust_delay,
                ..known.actuators
            },
            ..known
        })
    };
    check(&[
        (
            told(Some(0.1), None),
            "164d500202029a99999999990940a6e2ecc367d8c53f010101010103d03f01010101010bf03f9a9999999999f33f01010101010be03f9301837b16eb16400101010101010101010101010101010101010101010101119a9999999999b93f9a9999999999a93f010101010113e03fb41a4223f60a20c0743f6a56df55ddbf01010101010101099a9999999999c93f01010101010328400101010101010101121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010101010101032e4002010101010101010240010d9a9999999999b93fb43d882300",
        ),
        (
            told(None, Some(0.05)),
            "164d500202029a99999999990940a6e2ecc367d8c53f010101010103d03f01010101010bf03f9a9999999999f33f01010101010be03f9301837b16eb16400101010101010101010101010101010101010101010101119a9999999999b93f9a9999999999a93f010101010113e03fb41a4223f60a20c0743f6a56df55ddbf01010101010101099a9999999999c93f01010101010328400101010101010101121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010101010101032e40020101010101010102400101010101010101010d9a9999999999a93fadf2386900",
        ),
        (
            told(Some(0.1), Some(0.05)),
            "164d500202029a99999999990940a6e2ecc367d8c53f010101010103d03f01010101010bf03f9a9999999999f33f01010101010be03f9301837b16eb16400101010101010101010101010101010101010101010101119a9999999999b93f9a9999999999a93f010101010113e03fb41a4223f60a20c0743f6a56df55ddbf01010101010101099a9999999999c93f01010101010328400101010101010101121932ac02f0a204ef9bafcdf8acd1910164010c48429a9999999999b9bf010101010101032e400201010101010101024001159a9999999999b93f9a9999999999a93f379eee5300",
        ),
    ]);
}

/// A tail that ends within a number is refused, at each of its bytes.
#[test]
fn a_broken_tail_of_dead_times_is_refused() {
    let Message::Configure(mut known) = configure(Preset::Flight, Aircraft::REFERENCE) else {
        unreachable!("it is a configuration");
    };
    let mut buffer = [0; MAX_PAYLOAD];
    let without = postcard::to_slice(&known, &mut buffer).unwrap().len();
    known.actuators.elevator_delay = Some(0.1);
    known.actuators.thrust_delay = Some(0.2);
    let payload = postcard::to_slice(&known, &mut buffer).unwrap();
    for end in without..=payload.len() {
        let read = postcard::take_from_bytes::<Configure>(&payload[..end]);
        let whole = read.is_ok_and(|(_, rest)| rest.is_empty());
        assert_eq!(whole, (end - without) % 8 == 0, "{end}");
    }
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
        (reply(Unstable), "0a4d50020321b4f38cc900"),
        (reply(ImageDamaged), "0a4d500203220ea2855000"),
        (reply(NoSuchPlanner), "0a4d500203239892822700"),
        (reply(LateralMissing), "0a4d500203243b07e6b900"),
        (reply(LateralAircraft), "0a4d50020325ad37e1ce00"),
        (reply(LateralGain), "0a4d500203261766e85700"),
        (reply(SpaceLimits), "0a4d500203278156ef2000"),
    ]);
}

/// The number of a setting is its place in this list.
#[test]
fn every_setting_out_of_range() {
    use Setting::*;
    let out_of_range = |setting| reply(ConfigureVerdict::OutOfRange(setting));
    check(&[
        (out_of_range(Mass), "064d5002032005aa25dc0700"),
        (out_of_range(PaddingFar), "0b4d5002032029c6bd6e4500"),
    ]);
    #[rustfmt::skip]
    let places = [
        Mass, PitchInertia, WingArea, MomentLength, AirDensity, LiftZero, LiftAlpha, DragZero,
        DragInduced, MomentZero, MomentAlpha, MomentAlphaRate, MomentElevator, MotorThrust, ThrustLag,
        ElevatorBelow, ElevatorRate, DesignThrust, SpeedNoise, PitchNoise, RateNoise, PathNoise,
        AirspeedVariance, PitchVariance, InitialVariance, Gate, SpeedWeight, PitchWeight, RateWeight,
        PathWeight, ElevatorWeight, CrossTrack, AirspeedHold, PlanElevatorWeight, PlanThrustWeight,
        PlanTerminalWeight, Latency, PenaltyQuadratic, SqpIterations, RefinedCandidates, PaddingNear, PaddingFar,
        ElevatorAbove, LiftElevator, MomentPitchRate, BodyRadius, Stall, LengthUnit, TimeUnit, MassUnit,
        LiftAlphaRate, LiftPitchRate, CruiseAirspeed, WindChange, Altitude, Sight, PenaltyLinear,
        AngleOfAttackLimit, FlightPathLimit, Margin, Band, PlanThrust, ElevatorDelay, ThrustDelay,
    ];
    assert_eq!(places, Setting::ALL);
    for (place, setting) in places.into_iter().enumerate() {
        let mut bytes = [0; 2];
        assert_eq!(
            postcard::to_slice(&setting, &mut bytes).unwrap(),
            [place as u8]
        );
    }
    assert!(postcard::from_bytes::<Setting>(&[places.len() as u8]).is_err());
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
