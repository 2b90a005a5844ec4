//! The bytes of every message and of every variant, as they were when they first went over a wire.
//!
//! A failure here means that a peer of the same version would read something else. Do not change
//! a line: raise `PROTOCOL_VERSION` (the third byte of all frames), or append.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

use hil_protocol::*;

/// Each line is one frame; its bytes in hexadecimal.
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
            "054d500101010c01c8904e8001125f9d741d00",
        ),
        (hello(Role::Core), "064d500101010c01c8904e8001121c890f0a00"),
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
    })
}

#[test]
fn configure_and_every_preset_and_airframe() {
    check(&[
        (
            configure(Preset::Reference, AirframeId::Paper),
            "054d50010201121932ac02f0a204ef9bafcdf8acd1910164010f48429a9999999999b9bf415cfa0b00",
        ),
        (
            configure(Preset::Paper, AirframeId::Reference),
            "184d50010201011932ac02f0a204ef9bafcdf8acd1910164010f48429a9999999999b9bf98577d3900",
        ),
        (
            configure(Preset::Flight, AirframeId::Paper),
            "064d50010202121932ac02f0a204ef9bafcdf8acd1910164010f48429a9999999999b9bfe38d351600",
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
        (reply(Accepted), "054d50010305b35da38700"),
        (reply(TooManyPaths { max: 25 }), "0b4d500103011967379dfd00"),
        (reply(ReplanPeriod), "0a4d500103029f3cad6900"),
        (reply(Latency), "0a4d50010303090caa1e00"),
        (reply(Beams { max: 128 }), "0c4d5001030480016f4566d000"),
        (reply(NonFinite), "0a4d500103053ca9c9f700"),
        (reply(NotTrimmable), "0a4d5001030686f8c06e00"),
        (reply(SlicesPerTick), "0a4d5001030710c8c71900"),
        (reply(RangeMax), "0a4d5001030881d5788900"),
        (reply(AlreadyConfigured), "0a4d5001030917e57ffe00"),
    ]);
}

#[test]
fn sensor_frame() {
    let message = SensorFrame {
        tick: 1000,
        airspeed: 9.1,
        pitch: -0.2,
        x: 123.456,
        z: 30.0,
    };
    check(&[(
        Message::SensorFrame(message),
        "1f4d500104e80733333333333322409a9999999999c9bf77be9f1a2fdd5e400101010101073e404782c66f00",
    )]);
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
        (scan(&[]), "0f4d500105e807333333bfcdcc4c3c056cf0b6b500"),
        (
            scan(&[49.9, 0.0, 12.3]),
            "144d500105e807333333bfcdcc4c3c039a99474201010109cdcc4441e4a273c200",
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
            "0f4d500106ac029a99999999991140010101010103d0bf051139fc7f00",
        ),
        (
            command(ControlMode::Tracking),
            "0f4d500106ac029a99999999991140010101010108d0bf018709fb0800",
        ),
    ]);
}

#[test]
fn step_report() {
    let message = StepReport {
        tick: 300,
        estimate: [9.1, 0.1, -0.01, 0.05],
        reference: [50.0, 30.5, 9.0, 0.2, 0.02, -0.3],
        plan_age_ticks: 40,
    };
    check(&[(
        Message::StepReport(message),
        "274d500107ac0233333333333322409a9999999999b93f7b14ae47e17a84bf9a9999999999a93f01010101010349400101010104803e4001010101012022409a9999999999c93f7b14ae47e17a943f333333333333d3bf28d5d45bde00",
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
            "094d500108c801fa01071903ac02a01f01010101118031409a9999999999b93f01f412c8a000",
        ),
        (
            plan(PlanOutcome::LeastViolating, false),
            "104d500108c801fa01011903ac02a01f010101010c8031409a9999999999b93f054547ea5600",
        ),
        (
            plan(PlanOutcome::KeptPrevious, true),
            "104d500108c801fa01021903ac02a01f01010101118031409a9999999999b93f01fbdef37900",
        ),
        (
            plan(PlanOutcome::TrimHold, false),
            "104d500108c801fa01031903ac02a01f010101010c8031409a9999999999b93f054a8bd18f00",
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
        (rejection(NonFiniteSensor), "074d500109ac02058c63021600"),
        (
            rejection(InnovationGate {
                airspeed: true,
                pitch: false,
            }),
            "094d500109ac020101052eb88d1a00",
        ),
        (
            rejection(ScanLength {
                expected: 100,
                found: 128,
            }),
            "0f4d500109ac02026480010261e31e00",
        ),
        (
            rejection(ScanNotFinite { beam: 7 }),
            "0d4d500109ac02030785e4538300",
        ),
        (
            rejection(ScanRange { beam: 99 }),
            "0d4d500109ac02046303d7cd8600",
        ),
        (
            rejection(TickOrder {
                expected: 301,
                found: 70_000,
            }),
            "114d500109ac0206ad02f0a204c98ac45e00",
        ),
        (rejection(NotConfigured), "0c4d500109ac02072ff6668800"),
        (
            rejection(UnexpectedMessage { id: 200 }),
            "0d4d500109ac0208c86fe27c6b00",
        ),
        (rejection(PlannerBusy), "0c4d500109ac020928dbde6f00"),
        (
            rejection(BytesLost { count: 70_000 }),
            "0f4d500109ac020af0a2046eeb95f600",
        ),
        (rejection(PlannerRestarted), "0c4d500109ac020b04bad08100"),
    ]);
}

#[test]
fn rejection_and_every_fault_of_a_frame() {
    use DecodeError::*;
    let frame = |fault| rejection(RejectionCause::Frame(fault));
    check(&[
        (frame(TooLong), "084d500109ac020505a0d66d4b00"),
        (frame(Cobs), "0d4d500109ac02050136e66a3c00"),
        (frame(TooShort), "0d4d500109ac0205028cb763a500"),
        (frame(Magic), "0d4d500109ac0205031a8764d200"),
        (frame(Crc), "0b4d500109ac020504b912024c00"),
        (frame(Version { peer: 2 }), "0e4d500109ac02050502dab4e69700"),
        (
            frame(UnknownId { id: 10 }),
            "0e4d500109ac0205060a2b6f10b200",
        ),
        (frame(Payload { id: 3 }), "0e4d500109ac02050703cee6d7d200"),
        (
            frame(TrailingBytes { id: 255 }),
            "0e4d500109ac020508ff364444e100",
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
        "064d50010a07010101010107d0bf99a485a100",
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
        (parameter_reply(Accepted), "064d50010b07059969bfc100"),
        (parameter_reply(Unknown), "0b4d50010b07010f59b8b600"),
        (parameter_reply(Range), "0b4d50010b0702b508b12f00"),
        (parameter_reply(NotWhole), "0b4d50010b07032338b65800"),
        (parameter_reply(InFlight), "0b4d50010b070480add2c600"),
        (parameter_reply(NotConfigured), "0b4d50010b0705169dd5b100"),
        (
            parameter_reply(SetUp(ConfigureVerdict::NotTrimmable)),
            "0c4d50010b070606b77929e400",
        ),
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
        "074d50010cc8010104803e020103c03f010720c0cdcccc3d0103c03f010b20c0cdcccc3d6437739500",
    )]);
}
