//! Any message, including floats of every bit pattern. Each is read from its fields, which stand here in the order
//! of the wire.

use hil_protocol::*;
use proptest::array::{uniform, uniform2, uniform3, uniform4, uniform5, uniform6};
use proptest::collection::vec;
use proptest::num::{f32, f64};
use proptest::option;
use proptest::prelude::*;
use proptest::sample::{Select, select};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

pub(crate) fn message() -> impl Strategy<Value = Message> {
    prop_oneof![
        of(hello()).prop_map(Message::Hello),
        of(configure()).prop_map(Message::Configure),
        verdict().prop_map(|verdict| Message::ConfigureReply(ConfigureReply { verdict })),
        of(sensor_frame()).prop_map(Message::SensorFrame),
        of(lidar_scan()).prop_map(Message::LidarScan),
        of(actuator_command()).prop_map(Message::ActuatorCommand),
        of(step_report()).prop_map(Message::StepReport),
        of(plan_report()).prop_map(Message::PlanReport),
        of((any::<u32>(), cause())).prop_map(Message::Rejection),
        of((any::<u8>(), f64::ANY)).prop_map(Message::SetParameter),
        of((any::<u8>(), parameter_verdict())).prop_map(Message::ParameterReply),
        of(plan_trajectory()).prop_map(Message::PlanTrajectory),
        of(plan_controls()).prop_map(Message::PlanControls),
        of(any::<(u32, [u32; HealthReport::NAMES.len()])>()).prop_map(Message::HealthReport),
        space(),
    ]
}

/// A message of an aircraft in space.
fn space() -> impl Strategy<Value = Message> {
    let lateral = uniform::<_, { LateralAirframe::COUNT }>(f64::ANY);
    let lateral = (lateral, uniform3(option::of(f64::ANY)));
    let limits = (uniform2(f64::ANY), uniform5(f64::ANY), any::<[bool; 2]>());
    let inertial = (any::<u32>(), uniform::<_, 10>(f32::ANY));
    let velocity = option::of(uniform4(f32::ANY));
    let position = (any::<u32>(), uniform3(f64::ANY), f32::ANY, velocity);
    let points = list::<_, MAX_POINTS>(uniform3(f32::ANY));
    let packet = (any::<(u32, u32, u16)>(), points);
    let report = (any::<u32>(), uniform::<_, 10>(f64::ANY), f32::ANY);
    let knots = list::<_, MAX_KNOTS>(uniform5(f32::ANY));
    prop_oneof![
        of(lateral).prop_map(Message::ConfigureLateral),
        of(limits).prop_map(Message::ConfigureSpace),
        of(inertial).prop_map(Message::InertialFrame),
        of(position).prop_map(Message::SpacePosition),
        of(packet).prop_map(Message::PointPacket),
        of((any::<u32>(), f64::ANY, f64::ANY)).prop_map(Message::SurfaceCommand),
        of(report).prop_map(Message::SpaceReport),
        of((any::<u32>(), f32::ANY, knots)).prop_map(Message::SpaceTrajectory),
    ]
}

/// The value with these fields.
fn of<T: DeserializeOwned + Debug>(
    fields: impl Strategy<Value: Serialize>,
) -> impl Strategy<Value = T> {
    fields.prop_map(|fields| {
        let mut bytes = [0; MAX_FRAME];
        postcard::from_bytes(postcard::to_slice(&fields, &mut bytes).unwrap()).unwrap()
    })
}

/// A list of at most so many elements.
fn list<T: Debug, const MOST: usize>(
    element: impl Strategy<Value = T>,
) -> impl Strategy<Value = heapless::Vec<T, MOST>> {
    vec(element, 0..=MOST).prop_map(|list| list.into_iter().collect())
}

/// Any variant without fields.
fn plain<T: DeserializeOwned + Clone + Debug + 'static>() -> Select<T> {
    let all = (0..=u8::MAX).filter_map(|number| postcard::from_bytes(&[number]).ok());
    select(all.collect::<Vec<T>>())
}

fn hello() -> impl Strategy<Value: Serialize> {
    let numbers = any::<([u8; 3], u32, u16, u16)>();
    (plain::<Role>(), numbers)
}

fn configure() -> impl Strategy<Value: Serialize> {
    let aircraft = (
        uniform::<_, { Airframe::COUNT + 2 }>(f64::ANY),
        option::of(f64::ANY),
    );
    let numbers = any::<(u16, [u32; 3], u64, u16)>();
    let limits = uniform5(option::of(f64::ANY));
    let rest = (f32::ANY, f64::ANY, limits);
    (plain::<Preset>(), aircraft, numbers, rest)
}

fn verdict() -> impl Strategy<Value = ConfigureVerdict> {
    prop_oneof![
        1 => any::<u16>().prop_map(|max| ConfigureVerdict::TooManyPaths { max }),
        1 => any::<u16>().prop_map(|max| ConfigureVerdict::Beams { max }),
        1 => plain().prop_map(ConfigureVerdict::OutOfRange),
        3 => plain(),
    ]
}

fn parameter_verdict() -> impl Strategy<Value = ParameterVerdict> {
    prop_oneof![plain(), verdict().prop_map(ParameterVerdict::SetUp)]
}

fn plan_controls() -> impl Strategy<Value: Serialize> {
    (any::<u32>(), list::<_, MAX_KNOTS>(uniform2(f32::ANY)))
}

fn plan_trajectory() -> impl Strategy<Value: Serialize> {
    let knots = list::<_, MAX_KNOTS>(uniform3(f32::ANY));
    (any::<u32>(), f32::ANY, knots)
}

fn sensor_frame() -> impl Strategy<Value: Serialize> {
    let air = (any::<u32>(), f64::ANY, f64::ANY);
    let velocity = option::of(uniform3(f32::ANY));
    let position = (any::<u32>(), uniform2(f64::ANY), f32::ANY, velocity);
    (any::<u32>(), option::of(air), option::of(position))
}

fn lidar_scan() -> impl Strategy<Value: Serialize> {
    let ranges = list::<_, MAX_BEAMS>(f32::ANY);
    (any::<u32>(), f32::ANY, f32::ANY, ranges)
}

fn actuator_command() -> impl Strategy<Value: Serialize> {
    (any::<u32>(), f64::ANY, f64::ANY, plain::<ControlMode>())
}

fn step_report() -> impl Strategy<Value: Serialize> {
    let estimate = (uniform4(f64::ANY), uniform5(f64::ANY));
    let rest = (uniform6(f64::ANY), any::<u32>());
    (
        any::<u32>(),
        estimate,
        rest,
        uniform6(plain::<SensorState>()),
    )
}

fn plan_report() -> impl Strategy<Value: Serialize> {
    let ticks = any::<(u32, u32)>();
    let counts = any::<([u16; 3], u32)>();
    let costs = (f64::ANY, f64::ANY, any::<bool>());
    (ticks, plain::<PlanOutcome>(), counts, costs)
}

fn cause() -> impl Strategy<Value = RejectionCause> {
    use RejectionCause::*;
    let task = (plain(), plain(), any::<u32>(), any::<u8>());
    prop_oneof![
        any::<(bool, bool)>().prop_map(|(airspeed, pitch)| InnovationGate { airspeed, pitch }),
        any::<(u16, u16)>().prop_map(|(expected, found)| ScanLength { expected, found }),
        any::<u16>().prop_map(|beam| ScanNotFinite { beam }),
        any::<u16>().prop_map(|beam| ScanRange { beam }),
        any::<(u32, u32)>().prop_map(|(expected, found)| TickOrder { expected, found }),
        any::<u8>().prop_map(|id| UnexpectedMessage { id }),
        decode_error().prop_map(Frame),
        plain(),
        task.prop_map(|(task, fault, address, count)| Trapped {
            task,
            fault,
            address,
            count
        }),
        any::<u32>().prop_map(|count| BytesLost { count }),
    ]
}

fn decode_error() -> impl Strategy<Value = DecodeError> {
    prop_oneof![
        any::<u8>().prop_map(|peer| DecodeError::Version { peer }),
        any::<u8>().prop_map(|id| DecodeError::UnknownId { id }),
        any::<u8>().prop_map(|id| DecodeError::Payload { id }),
        any::<u8>().prop_map(|id| DecodeError::TrailingBytes { id }),
        plain(),
    ]
}
