//! The bytes of the core's reports, rejections and parameters.

use super::check;
use hil_protocol::*;

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
            elevator: SensorState::Suspected,
            motor: SensorState::Excluded,
        },
    };
    check(&[(
        Message::StepReport(message),
        "274d500207ac0233333333333322409a9999999999b93f7b14ae47e17a84bf9a9999999999a93f0101010104c048400101010104403e40010101010103f8bf01010101010bd03fb81e85eb51b89e3f01010101010349400101010104803e4001010101011c22409a9999999999c93f7b14ae47e17a943f333333333333d3bf280a0102030102ad02f49a00",
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
        (
            plan(PlanOutcome::Pursuit, true),
            "104d500208c801fa01041903ac02a01f01010101118031409a9999999999b93f01b3a96f8d00",
        ),
        (
            plan(PlanOutcome::Reserve, true),
            "104d500208c801fa01051903ac02a01f01010101118031409a9999999999b93f0194cc4a0c00",
        ),
        (
            plan(PlanOutcome::Latest, true),
            "104d500208c801fa01061903ac02a01f01010101118031409a9999999999b93f01bc65545400",
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
        (
            rejection(Trapped {
                task: CoreTask::Planner,
                fault: CoreFault::Stack,
                address: 70_000,
                count: 2,
            }),
            "124d500209ac020f0101f0a20402a8b8eefb00",
        ),
        (rejection(PlannerOff), "0c4d500209ac02103809154c00"),
        (rejection(ScanSilentBelow), "0c4d500209ac0211ae39123b00"),
        (rejection(ScanAged), "0c4d500209ac021214681ba200"),
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
fn plan_controls() {
    let message = PlanControls {
        scan_tick: 200,
        knots: [[8.0, 3.75]; 2].into_iter().collect(),
    };
    check(&[(
        Message::PlanControls(message),
        "084d50020ec80102010102410103704001010241010770407c9e1fe300",
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
        "074d50020def0903ac0201010101010101010101010101010102070101010105befc515a00",
    )]);
}
