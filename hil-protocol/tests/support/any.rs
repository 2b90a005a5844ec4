//! Any message, including floats of every bit pattern.

use super::aircraft::{aircraft, limits};
use hil_protocol::*;
use proptest::array::{uniform3, uniform4, uniform5, uniform6};
use proptest::collection::vec;
use proptest::num::{f32, f64};
use proptest::prelude::*;
use proptest::sample::select;

pub(crate) fn message() -> impl Strategy<Value = Message> {
    prop_oneof![
        hello().prop_map(Message::Hello),
        configure().prop_map(Message::Configure),
        verdict().prop_map(|verdict| Message::ConfigureReply(ConfigureReply { verdict })),
        sensor_frame().prop_map(Message::SensorFrame),
        lidar_scan().prop_map(Message::LidarScan),
        actuator_command().prop_map(Message::ActuatorCommand),
        step_report().prop_map(Message::StepReport),
        plan_report().prop_map(Message::PlanReport),
        (any::<u32>(), cause())
            .prop_map(|(tick, cause)| Message::Rejection(Rejection { tick, cause })),
        (any::<u8>(), f64::ANY).prop_map(|(parameter, value)| Message::SetParameter(
            SetParameter { parameter, value }
        )),
        parameter_reply().prop_map(Message::ParameterReply),
        plan_trajectory().prop_map(Message::PlanTrajectory),
        plan_controls().prop_map(Message::PlanControls),
        health_report().prop_map(Message::HealthReport),
    ]
}

fn hello() -> impl Strategy<Value = Hello> {
    let roles = select(&[Role::Harness, Role::Core]);
    (
        roles,
        any::<[u8; 3]>(),
        any::<u32>(),
        any::<u16>(),
        any::<u16>(),
    )
        .prop_map(
            |(role, software, tick_period_us, beams_max, stages)| Hello {
                role,
                software,
                tick_period_us,
                beams_max,
                stages,
            },
        )
}

fn configure() -> impl Strategy<Value = Configure> {
    let presets = select(&[Preset::Reference, Preset::Paper, Preset::Flight]);
    let ticks = any::<[u32; 3]>();
    let rest = (any::<u64>(), any::<u16>(), f32::ANY, f64::ANY, limits());
    (presets, aircraft(), any::<u16>(), ticks, rest).prop_map(
        |(preset, aircraft, paths, ticks, (seed, beams, range_max, altitude, actuators))| {
            Configure {
                preset,
                aircraft,
                paths,
                replan_period_ticks: ticks[0],
                latency_ticks: ticks[1],
                slices_per_tick: ticks[2],
                seed,
                beams,
                range_max,
                altitude,
                actuators,
            }
        },
    )
}

fn verdict() -> impl Strategy<Value = ConfigureVerdict> {
    prop_oneof![
        any::<u16>().prop_map(|max| ConfigureVerdict::TooManyPaths { max }),
        any::<u16>().prop_map(|max| ConfigureVerdict::Beams { max }),
        select(&[
            ConfigureVerdict::Accepted,
            ConfigureVerdict::ReplanPeriod,
            ConfigureVerdict::Latency,
            ConfigureVerdict::NonFinite,
            ConfigureVerdict::NotTrimmable,
            ConfigureVerdict::SlicesPerTick,
            ConfigureVerdict::RangeMax,
            ConfigureVerdict::AlreadyConfigured,
            ConfigureVerdict::Actuators,
            ConfigureVerdict::PresetNotBuilt,
            ConfigureVerdict::PathsZero,
            ConfigureVerdict::ThrustTooLow,
            ConfigureVerdict::CruiseAirspeed,
            ConfigureVerdict::AirframeNotFinite,
            ConfigureVerdict::NotCarried,
            ConfigureVerdict::NoElevator,
            ConfigureVerdict::RegulatorNotFinite,
            ConfigureVerdict::RegulatorSingular,
            ConfigureVerdict::RegulatorNotConverged,
            ConfigureVerdict::RegulatorNotStabilising,
            ConfigureVerdict::PlanModel,
            ConfigureVerdict::PlanWeights,
            ConfigureVerdict::Penalty,
            ConfigureVerdict::Margin,
            ConfigureVerdict::Band,
            ConfigureVerdict::PlanThrust,
            ConfigureVerdict::WindChange,
            ConfigureVerdict::AngleOfAttackLimit,
            ConfigureVerdict::FlightPathLimit,
            ConfigureVerdict::OtherPreset,
            ConfigureVerdict::Unstable,
            ConfigureVerdict::OutOfRange(Setting::Mass),
            ConfigureVerdict::OutOfRange(Setting::PaddingFar),
            ConfigureVerdict::ImageDamaged,
        ]),
    ]
}

fn parameter_reply() -> impl Strategy<Value = ParameterReply> {
    use ParameterVerdict::*;
    let verdicts = prop_oneof![
        select(&[
            Accepted,
            Unknown,
            Range,
            NotWhole,
            InFlight,
            NotConfigured,
            NotInPreset,
            PathsInFlight,
            CruiseFixed,
        ]),
        verdict().prop_map(SetUp),
    ];
    (any::<u8>(), verdicts).prop_map(|(parameter, verdict)| ParameterReply { parameter, verdict })
}

fn plan_controls() -> impl Strategy<Value = PlanControls> {
    let knots = vec(proptest::array::uniform2(f32::ANY), 0..=MAX_KNOTS);
    (any::<u32>(), knots).prop_map(|(scan_tick, knots)| PlanControls {
        scan_tick,
        knots: knots.into_iter().collect(),
    })
}

fn plan_trajectory() -> impl Strategy<Value = PlanTrajectory> {
    let knots = vec(proptest::array::uniform3(f32::ANY), 0..=MAX_KNOTS);
    (any::<u32>(), f32::ANY, knots).prop_map(|(scan_tick, period, knots)| PlanTrajectory {
        scan_tick,
        period,
        knots: knots.into_iter().collect(),
    })
}

fn sensor_frame() -> impl Strategy<Value = SensorFrame> {
    (
        any::<u32>(),
        prop::option::of(air_data()),
        prop::option::of(position()),
    )
        .prop_map(|(tick, air, position)| SensorFrame {
            tick,
            air,
            position,
        })
}

fn air_data() -> impl Strategy<Value = AirData> {
    (any::<u32>(), f64::ANY, f64::ANY).prop_map(|(tick, airspeed, pitch)| AirData {
        tick,
        airspeed,
        pitch,
    })
}

fn position() -> impl Strategy<Value = Position> {
    let velocity = uniform3(f32::ANY).prop_map(|[x, z, sigma]| GroundVelocity { x, z, sigma });
    (
        any::<u32>(),
        (f64::ANY, f64::ANY),
        f32::ANY,
        prop::option::of(velocity),
    )
        .prop_map(|(tick, (x, z), sigma, velocity)| Position {
            tick,
            x,
            z,
            sigma,
            velocity,
        })
}

fn lidar_scan() -> impl Strategy<Value = LidarScan> {
    (
        any::<u32>(),
        f32::ANY,
        f32::ANY,
        vec(f32::ANY, 0..=MAX_BEAMS),
    )
        .prop_map(|(tick, angle_min, angle_increment, ranges)| LidarScan {
            tick,
            angle_min,
            angle_increment,
            ranges: ranges.into_iter().collect(),
        })
}

fn actuator_command() -> impl Strategy<Value = ActuatorCommand> {
    let modes = select(&[ControlMode::TrimHold, ControlMode::Tracking]);
    (any::<u32>(), f64::ANY, f64::ANY, modes).prop_map(|(tick, thrust, elevator, mode)| {
        ActuatorCommand {
            tick,
            thrust,
            elevator,
            mode,
        }
    })
}

fn step_report() -> impl Strategy<Value = StepReport> {
    (
        any::<u32>(),
        uniform4(f64::ANY),
        uniform5(f64::ANY),
        uniform6(f64::ANY),
        any::<u32>(),
        sensor_states(),
    )
        .prop_map(
            |(tick, estimate, [x, z, ahead, up, lift], reference, age, sensors)| StepReport {
                tick,
                estimate,
                position: [x, z],
                wind: [ahead, up],
                lift,
                reference,
                plan_age_ticks: age,
                sensors,
            },
        )
}

fn sensor_states() -> impl Strategy<Value = SensorStates> {
    let state = || {
        select(&[
            SensorState::Healthy,
            SensorState::Suspected,
            SensorState::Excluded,
            SensorState::Recovering,
        ])
    };
    let all = [state(), state(), state(), state(), state(), state()];
    all.prop_map(
        |[airspeed, pitch, position, lidar, elevator, motor]| SensorStates {
            airspeed,
            pitch,
            position,
            lidar,
            elevator,
            motor,
        },
    )
}

fn health_report() -> impl Strategy<Value = HealthReport> {
    any::<(u32, [u32; HealthReport::NAMES.len()])>()
        .prop_map(|(tick, counters)| HealthReport { tick, counters })
}

fn plan_report() -> impl Strategy<Value = PlanReport> {
    let outcomes = select(&[
        PlanOutcome::Adopted,
        PlanOutcome::LeastViolating,
        PlanOutcome::KeptPrevious,
        PlanOutcome::TrimHold,
    ]);
    let counts = (any::<[u32; 3]>(), any::<[u16; 3]>());
    (outcomes, counts, f64::ANY, f64::ANY, any::<bool>()).prop_map(
        |(outcome, (long, short), cost, violation, complete)| PlanReport {
            scan_tick: long[0],
            used_from_tick: long[1],
            outcome,
            candidates: short[0],
            feasible: short[1],
            tree_runs: short[2],
            slices: long[2],
            cost,
            violation,
            complete,
        },
    )
}

fn cause() -> impl Strategy<Value = RejectionCause> {
    prop_oneof![
        any::<(bool, bool)>()
            .prop_map(|(airspeed, pitch)| RejectionCause::InnovationGate { airspeed, pitch }),
        any::<(u16, u16)>()
            .prop_map(|(expected, found)| RejectionCause::ScanLength { expected, found }),
        any::<u16>().prop_map(|beam| RejectionCause::ScanNotFinite { beam }),
        any::<u16>().prop_map(|beam| RejectionCause::ScanRange { beam }),
        any::<(u32, u32)>()
            .prop_map(|(expected, found)| RejectionCause::TickOrder { expected, found }),
        any::<u8>().prop_map(|id| RejectionCause::UnexpectedMessage { id }),
        decode_error().prop_map(RejectionCause::Frame),
        select(&[
            RejectionCause::NonFiniteSensor,
            RejectionCause::NotConfigured,
            RejectionCause::PlannerBusy,
            RejectionCause::PlannerRestarted,
            RejectionCause::ScanAngle,
            RejectionCause::ScanRepeated,
            RejectionCause::ScanBlind,
            RejectionCause::PlannerOff,
        ]),
        (
            select(&[CoreTask::Step, CoreTask::Planner]),
            core_fault(),
            any::<u32>(),
            any::<u8>()
        )
            .prop_map(|(task, fault, address, count)| RejectionCause::Trapped {
                task,
                fault,
                address,
                count,
            }),
        any::<u32>().prop_map(|count| RejectionCause::BytesLost { count }),
    ]
}

fn core_fault() -> impl Strategy<Value = CoreFault> {
    select(&[
        CoreFault::Other,
        CoreFault::Stack,
        CoreFault::Memory,
        CoreFault::Bus,
        CoreFault::Instruction,
        CoreFault::Hang,
    ])
}

fn decode_error() -> impl Strategy<Value = DecodeError> {
    prop_oneof![
        any::<u8>().prop_map(|peer| DecodeError::Version { peer }),
        any::<u8>().prop_map(|id| DecodeError::UnknownId { id }),
        any::<u8>().prop_map(|id| DecodeError::Payload { id }),
        any::<u8>().prop_map(|id| DecodeError::TrailingBytes { id }),
        select(&[
            DecodeError::TooLong,
            DecodeError::Cobs,
            DecodeError::TooShort,
            DecodeError::Magic,
            DecodeError::Crc,
        ]),
    ]
}
