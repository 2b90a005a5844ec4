//! Tests that the longest payload of each message is as long as its `MAX_SIZE` says, and fits.

use hil_protocol::*;
use serde::Serialize;

fn payload(value: &impl Serialize) -> usize {
    postcard::to_slice(value, &mut [0; 1024]).unwrap().len()
}

/// A value without a zero among its bytes.
const FLOAT: f64 = f64::from_bits(0x4142_4344_4546_4748);

fn longest_scan() -> LidarScan {
    let value = f32::from_bits(0x4142_4344);
    LidarScan {
        tick: u32::MAX,
        angle_min: value,
        angle_increment: value,
        ranges: [value; MAX_BEAMS].into_iter().collect(),
    }
}

#[test]
fn of_the_session() {
    let hello = Hello {
        role: Role::Core,
        software: [u8::MAX; 3],
        tick_period_us: u32::MAX,
        beams_max: u16::MAX,
        stages: u16::MAX,
    };
    assert_eq!(payload(&hello), Hello::MAX_SIZE);
    let configure = Configure {
        preset: Preset::Flight,
        aircraft: Aircraft {
            stall: Some(1.0),
            ..Aircraft::REFERENCE
        },
        paths: u16::MAX,
        replan_period_ticks: u32::MAX,
        latency_ticks: u32::MAX,
        slices_per_tick: u32::MAX,
        seed: u64::MAX,
        beams: u16::MAX,
        range_max: 1.0,
        altitude: FLOAT,
        actuators: ActuatorLimits {
            thrust_max: Some(1.0),
            thrust_lag: Some(1.0),
            elevator_below: Some(1.0),
            elevator_above: Some(1.0),
            elevator_rate: Some(1.0),
            elevator_delay: Some(0.1),
            thrust_delay: Some(0.1),
        },
    };
    assert_eq!(payload(&configure), Configure::MAX_SIZE);
    let reply = ConfigureReply {
        verdict: ConfigureVerdict::Beams { max: u16::MAX },
    };
    assert_eq!(payload(&reply), ConfigureReply::MAX_SIZE);
    let set = SetParameter {
        parameter: u8::MAX,
        value: FLOAT,
    };
    assert_eq!(payload(&set), SetParameter::MAX_SIZE);
    let reply = ParameterReply {
        parameter: u8::MAX,
        verdict: ParameterVerdict::SetUp(reply.verdict),
    };
    assert_eq!(payload(&reply), ParameterReply::MAX_SIZE);
}

#[test]
fn of_a_tick() {
    let sensors = SensorFrame {
        tick: u32::MAX,
        air: Some(AirData {
            tick: u32::MAX,
            airspeed: FLOAT,
            pitch: FLOAT,
        }),
        position: Some(Position {
            tick: u32::MAX,
            x: FLOAT,
            z: FLOAT,
            sigma: 1.0,
            velocity: Some(GroundVelocity {
                x: 1.0,
                z: 1.0,
                sigma: 1.0,
            }),
        }),
    };
    assert_eq!(payload(&sensors), SensorFrame::MAX_SIZE);
    assert_eq!(payload(&longest_scan()), LidarScan::MAX_SIZE);
    let command = ActuatorCommand {
        tick: u32::MAX,
        thrust: FLOAT,
        elevator: FLOAT,
        mode: ControlMode::Tracking,
    };
    assert_eq!(payload(&command), ActuatorCommand::MAX_SIZE);
    let report = StepReport {
        tick: u32::MAX,
        estimate: [FLOAT; 4],
        position: [FLOAT; 2],
        wind: [FLOAT; 2],
        lift: FLOAT,
        sensors: SensorStates::default(),
        reference: [FLOAT; 6],
        plan_age_ticks: u32::MAX,
    };
    assert_eq!(payload(&report), StepReport::MAX_SIZE);
}

#[test]
fn of_the_reports() {
    let plan = PlanReport {
        scan_tick: u32::MAX,
        used_from_tick: u32::MAX,
        outcome: PlanOutcome::Latest,
        candidates: u16::MAX,
        feasible: u16::MAX,
        tree_runs: u16::MAX,
        slices: u32::MAX,
        cost: FLOAT,
        violation: FLOAT,
        complete: true,
    };
    assert_eq!(payload(&plan), PlanReport::MAX_SIZE);
    let value = f32::from_bits(0x4142_4344);
    let trajectory = PlanTrajectory {
        scan_tick: u32::MAX,
        period: value,
        knots: [[value; 3]; MAX_KNOTS].into_iter().collect(),
    };
    assert_eq!(payload(&trajectory), PlanTrajectory::MAX_SIZE);
    let controls = PlanControls {
        scan_tick: u32::MAX,
        knots: [[value; 2]; MAX_KNOTS].into_iter().collect(),
    };
    assert_eq!(payload(&controls), PlanControls::MAX_SIZE);
    let health = HealthReport {
        tick: u32::MAX,
        counters: [u32::MAX; HealthReport::NAMES.len()],
    };
    assert_eq!(payload(&health), HealthReport::MAX_SIZE);
    let cause = RejectionCause::TickOrder {
        expected: u32::MAX,
        found: u32::MAX,
    };
    assert_eq!(
        payload(&Rejection {
            tick: u32::MAX,
            cause
        }),
        Rejection::MAX_SIZE
    );
}

#[test]
fn of_a_frame() {
    let mut buffer = [0; MAX_FRAME];
    let longest = Message::LidarScan(longest_scan());
    assert_eq!(encode(&longest, &mut buffer).unwrap().len(), MAX_FRAME);
}

#[test]
fn of_an_aircraft_in_space() {
    let value = f32::from_bits(0x4142_4344);
    let part = Derivatives {
        sideslip: FLOAT,
        roll_rate: FLOAT,
        yaw_rate: FLOAT,
        aileron: FLOAT,
        rudder: FLOAT,
    };
    let lateral = ConfigureLateral {
        airframe: LateralAirframe {
            span: FLOAT,
            roll_inertia: FLOAT,
            yaw_inertia: FLOAT,
            product_inertia: FLOAT,
            side: part,
            roll: part,
            yaw: part,
        },
        surfaces_max: [Some(FLOAT); 2],
        surface_rate: Some(FLOAT),
        roll_loop: Some(FLOAT),
    };
    assert_eq!(payload(&lateral), ConfigureLateral::MAX_SIZE);
    let limits = ConfigureSpace {
        bank: [FLOAT; 2],
        margin: FLOAT,
        half_span: FLOAT,
        heights: [FLOAT; 2],
        half_width: FLOAT,
        programs: true,
        open: true,
    };
    assert_eq!(payload(&limits), ConfigureSpace::MAX_SIZE);
    let inertial = InertialFrame {
        tick: u32::MAX,
        attitude: [value; 3],
        sigma: value,
        rates: [value; 3],
        force: [value; 3],
    };
    assert_eq!(payload(&inertial), InertialFrame::MAX_SIZE);
    let position = SpacePosition {
        tick: u32::MAX,
        position: [FLOAT; 3],
        sigma: value,
        velocity: Some(([value; 3], value)),
    };
    assert_eq!(payload(&position), SpacePosition::MAX_SIZE);
    let packet = PointPacket {
        tick: u32::MAX,
        sensor_time: u32::MAX,
        interval: u16::MAX,
        points: [[value; 3]; MAX_POINTS].into_iter().collect(),
    };
    assert_eq!(payload(&packet), PointPacket::MAX_SIZE);
    let command = SurfaceCommand {
        tick: u32::MAX,
        aileron: FLOAT,
        rudder: FLOAT,
    };
    assert_eq!(payload(&command), SurfaceCommand::MAX_SIZE);
    let report = SpaceReport {
        tick: u32::MAX,
        estimate: [FLOAT; 5],
        y: FLOAT,
        wind: FLOAT,
        reference: [FLOAT; 3],
        way_out: value,
    };
    assert_eq!(payload(&report), SpaceReport::MAX_SIZE);
    let trajectory = SpaceTrajectory {
        scan_tick: u32::MAX,
        period: value,
        knots: [[value; 5]; MAX_KNOTS].into_iter().collect(),
    };
    assert_eq!(payload(&trajectory), SpaceTrajectory::MAX_SIZE);
}
