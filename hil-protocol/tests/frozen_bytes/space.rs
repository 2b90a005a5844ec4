//! The messages of an aircraft in space.

use super::check;
use hil_protocol::*;

#[test]
fn lateral_aircraft() {
    let derivatives = |first| Derivatives {
        sideslip: first,
        roll_rate: 0.5,
        yaw_rate: 0.25,
        aileron: 2.0,
        rudder: 1.0,
    };
    let message = ConfigureLateral {
        airframe: LateralAirframe {
            span: 2.0,
            roll_inertia: 0.5,
            yaw_inertia: 1.0,
            product_inertia: 0.25,
            side: derivatives(-1.0),
            roll: derivatives(-2.0),
            yaw: derivatives(4.0),
        },
        surfaces_max: [Some(0.5), None],
        surface_rate: Some(8.0),
        roll_loop: None,
    };
    check(&[(
        Message::ConfigureLateral(message),
        "054d50020f0101010101010240010101010103e03f010101010103f03f010101010103d03f010101010103f0bf010101010103e03f010101010103d03f0101010101010240010101010103f03f01010101010102c0010101010103e03f010101010103d03f0101010101010240010101010103f03f0101010101031040010101010103e03f010101010103d03f0101010101010240010101010104f03f01010101010103e03f02010101010101072040605819e700",
    )]);
    // The dead time of a roll loop is a tail, without which the frame above ends.
    let told = Message::ConfigureLateral(ConfigureLateral {
        roll_loop: Some(0.5),
        ..message
    });
    check(&[(
        told,
        "054d50020f0101010101010240010101010103e03f010101010103f03f010101010103d03f010101010103f0bf010101010103e03f010101010103d03f0101010101010240010101010103f03f01010101010102c0010101010103e03f010101010103d03f0101010101010240010101010103f03f0101010101031040010101010103e03f010101010103d03f0101010101010240010101010104f03f01010101010103e03f02010101010101032040010101010107e03f4f4ec6f300",
    )]);
}

#[test]
fn limits_of_plans_in_space() {
    let message = ConfigureSpace {
        bank: [1.0, 2.0],
        margin: 0.5,
        half_span: 1.0,
        heights: [0.5, 16.0],
        half_width: 32.0,
        programs: true,
        open: true,
    };
    check(&[(
        Message::ConfigureSpace(message),
        "054d500216010101010103f03f0101010101010240010101010103e03f010101010103f03f010101010103e03f0101010101033040010101010109404001013cbacbe300",
    )]);
}

#[test]
fn inertial_frame_and_position() {
    let inertial = InertialFrame {
        tick: 200,
        attitude: [0.5, 0.25, -0.5],
        sigma: 0.125,
        rates: [1.0, 2.0, -1.0],
        force: [0.0, 0.5, -8.0],
    };
    let mut position = SpacePosition {
        tick: 200,
        position: [64.0, -2.0, 32.0],
        sigma: 0.5,
        velocity: None,
    };
    let without = Message::SpacePosition(position);
    position.velocity = Some(([12.0, 0.5, -1.0], 0.25));
    check(&[
        (
            Message::InertialFrame(inertial),
            "074d500210c8010101023f0103803e010102bf0101023e0103803f01010240010380bf010101010101023f010106c19ec185ff00",
        ),
        (
            without,
            "074d500211c801010101010103504001010101010102c001010101010340400101023f05f88def1700",
        ),
        (
            Message::SpacePosition(position),
            "074d500211c801010101010103504001010101010102c001010101010340400101033f01010340410101023f010380bf0107803e9d09bd1f00",
        ),
    ]);
}

#[test]
fn point_packet() {
    let packet = PointPacket {
        tick: 200,
        sensor_time: 123_456,
        interval: 50,
        points: [[8.0, -2.0, 1.0], [0.5, 0.0, 0.0]].into_iter().collect(),
    };
    check(&[(
        Message::PointPacket(packet),
        "0c4d500212c801c0c407320201010241010102c00103803f0101023f0101010101010105fe72b94700",
    )]);
}

#[test]
fn command_report_and_trajectory() {
    let command = SurfaceCommand {
        tick: 200,
        aileron: 0.125,
        rudder: -0.25,
    };
    let report = SpaceReport {
        tick: 200,
        estimate: [0.125, 0.5, 1.0, -1.0, 0.25],
        y: -2.0,
        wind: 0.5,
        reference: [1.0, 0.25, 0.125],
        way_out: 1.5,
    };
    let trajectory = SpaceTrajectory {
        scan_tick: 200,
        period: 0.25,
        knots: [[1.0, 2.0, 3.0, 0.5, 0.25]; 2].into_iter().collect(),
    };
    check(&[
        (
            Message::SurfaceCommand(command),
            "074d500213c801010101010103c03f010101010107d0bfdb4eb28200",
        ),
        (
            Message::SpaceReport(report),
            "074d500214c801010101010103c03f010101010103e03f010101010103f03f010101010103f0bf010101010103d03f01010101010102c0010101010103e03f010101010103f03f010101010103d03f010101010103c03f0107c03f88e5692900",
        ),
        (
            Message::SpaceTrajectory(trajectory),
            "074d500215c8010104803e020103803f01010240010340400101023f0103803e0103803f01010240010340400101023f0107803ede59c09900",
        ),
    ]);
}
