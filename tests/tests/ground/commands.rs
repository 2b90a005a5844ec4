//! Commands are always acknowledged, carried out between ticks, and written to the log.

use super::radio::{CONFIG, Radio, command, heard, scenario, write};
use hil_protocol::mavlink::messages::*;
use mpp_sim::flight::{fly, fly_with};
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Again, Mode, Order, OrderEntry};
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::Scenario;
use sil_harness::ground::vehicle::VehicleConfig;
use sil_harness::link::{PATIENCE, TcpLink, serve};
use std::net::TcpListener;
use std::time::Duration;

const ACCEPTED: u8 = 0;
const DENIED: u8 = 2;
const UNSUPPORTED: u8 = 3;

#[test]
fn every_command_is_acknowledged() {
    let mut radio = Radio::new(&CONFIG);
    let cases = [
        (command(42_424, 0.0, 0.0), UNSUPPORTED),
        (command(16, 0.0, 0.0), UNSUPPORTED),
        (command(400, 1.0, 0.0), ACCEPTED),
        (command(400, 0.0, 0.0), DENIED),
        (command(400, f32::NAN, 0.0), DENIED),
        (command(176, 1.0, 7.0), ACCEPTED),
        (command(176, 1.0, 10.0), ACCEPTED),
        (command(176, 1.0, 3.0), DENIED),
        (command(176, f32::NAN, f32::NAN), DENIED),
        (command(511, 30.0, 50_000.0), ACCEPTED),
        (command(511, 9999.0, 50_000.0), DENIED),
        (command(510, 30.0, 0.0), ACCEPTED),
        (command(512, 148.0, 0.0), ACCEPTED),
        (command(512, 242.0, 0.0), ACCEPTED),
        (command(512, 300.0, 0.0), ACCEPTED),
        (command(512, 330.0, 0.0), DENIED),
        // 0 is the heartbeat's number. A value that is no number must not become 0.
        (command(512, f32::NAN, 0.0), DENIED),
        (command(512, -1.0, 0.0), DENIED),
        (command(512, 30.5, 0.0), DENIED),
        (command(512, f32::INFINITY, 0.0), DENIED),
        (command(511, f32::NAN, 0.0), DENIED),
        (command(510, -30.0, 0.0), DENIED),
        (command(410, 0.0, 0.0), ACCEPTED),
        (command(185, 0.0, 0.0), DENIED),
    ];
    for (number, (command, _)) in cases.iter().enumerate() {
        radio.at(100 + number as i64, command);
    }
    // The same command comes as integers to this vehicle, to everybody, and to another vehicle.
    radio.at(
        200,
        &COMMAND_INT_DATA {
            command: 42_424,
            ..COMMAND_INT_DATA::DEFAULT
        },
    );
    radio.at(
        201,
        &COMMAND_LONG_DATA {
            target_system: 2,
            ..command(42_424, 0.0, 0.0)
        },
    );
    radio.fly(&scenario());
    let mut expected: Vec<_> = cases
        .iter()
        .map(|(c, result)| (c.command, *result))
        .collect();
    expected.push((42_424, UNSUPPORTED));
    assert_eq!(radio.acks(), expected);
}

#[test]
fn an_interval_is_kept_in_simulated_time() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(500, &command(511, 30.0, 20_000.0));
    radio.fly(&scenario());
    let attitudes = radio.all(|message| matches!(message, MavMessage::ATTITUDE(_)).then_some(()));
    let count = |from, to| {
        attitudes
            .iter()
            .filter(|(t, ())| (from..to).contains(t))
            .count()
    };
    assert_eq!((count(0, 500), count(500, 1000)), (50, 250));
}

/// A flight with parameters before it and in it, with modes, and with the motor switched.
fn eventful() -> Radio {
    let mut radio = Radio::new(&VehicleConfig {
        hold: true,
        ..CONFIG
    });
    radio
        .at(-1, &write("LQR_R_ELEVATOR", 0.7))
        .at(-1, &write("MPP_REPLAN_S", 0.5))
        .at(-1, &command(400, 1.0, 0.0))
        .at(333, &write("MPP_ALT_M", 53.0))
        .at(333, &write("MPP_PATHS", 10.0))
        .at(600, &command(176, 1.0, 7.0))
        .at(700, &command(176, 1.0, 10.0))
        .at(900, &command(400, 0.0, 21_196.0))
        .at(950, &command(400, 1.0, 0.0))
        .at(1000, &write("MPP_REPLAN_S", 1.0));
    radio
}

#[test]
fn a_flight_is_reproduced_from_its_log() {
    let log = eventful().fly(&scenario());
    let ticks: Vec<_> = log.orders.iter().map(|entry| entry.tick).collect();
    assert_eq!(ticks, [0, 0, 333, 333, 600, 700, 900, 950, 1000]);
    let read = FlightLog::from_json(&log.to_json().unwrap()).unwrap();
    assert_eq!(read, log);

    struct Nobody;
    impl mpp_sim::orders::Ground for Nobody {}
    let mut again = Again::new(Some(read.orders), Nobody);
    let second = fly_with(&scenario(), &mut PipeLink::new(), &mut again).unwrap();
    assert_eq!(second.hash().unwrap(), log.hash().unwrap());
    let alone = fly(&scenario(), &mut PipeLink::new(), |_| {}).unwrap();
    assert_ne!(second.hash().unwrap(), alone.hash().unwrap());
}

#[test]
fn orders_reach_a_core_over_tcp() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let core =
        std::thread::spawn(move || serve(&listener, true, Duration::from_secs(20), None, |_| {}));
    let mut link = TcpLink::connect(&address, PATIENCE).unwrap();
    let over_tcp = fly_with(&scenario(), &mut link, &mut eventful()).unwrap();
    drop(link);
    core.join().unwrap().unwrap();
    assert_eq!(
        over_tcp.hash().unwrap(),
        eventful().fly(&scenario()).hash().unwrap()
    );
}

#[test]
fn cruise_flies_level_and_slowly_without_scans() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(310, &command(176, 1.0, 7.0));
    let log = radio.fly(&Scenario {
        obstacles: 0,
        ..scenario()
    });
    // The last scan was that of tick 300. The core misses the next one soon after tick 400.
    assert!((401..=410).contains(&log.plans[4].tick));
    assert!(log.rejections.is_empty(), "{:?}", log.rejections);
    let last = log.ticks.airspeed.len() - 1;
    assert!(log.ticks.airspeed[last] < 9.5);
    assert!((log.ticks.z[last] - 50.0).abs() < 1.0);
    assert_eq!(
        log.orders,
        [OrderEntry {
            tick: 310,
            order: Order::Mode { mode: Mode::Cruise }
        }]
    );
    let modes = heard!(radio, HEARTBEAT, |heartbeat| heartbeat.custom_mode);
    assert!(
        modes
            .iter()
            .all(|(tick, mode)| *mode == if *tick < 310 { 10 } else { 7 })
    );
}

#[test]
fn without_its_motor_the_aircraft_sinks() {
    let empty = Scenario {
        obstacles: 0,
        ..scenario()
    };
    let mut radio = Radio::new(&CONFIG);
    radio.at(400, &command(400, 0.0, 21_196.0));
    let log = radio.fly(&empty);
    assert!(log.ticks.thrust[399] > 0.0);
    assert!(log.ticks.thrust[400..].iter().all(|thrust| *thrust == 0.0));
    let last = log.ticks.z.len() - 1;
    assert!(log.ticks.z[last] < log.ticks.z[400] - 5.0 || log.ticks.airspeed[last] < 10.0);
    assert_eq!(radio.acks(), [(400, ACCEPTED)]);
    // The core finds the thrust missing, but the stations know why, and nothing has failed.
    assert!(log.sensors.iter().any(|change| change.sensor == "motor"));
    assert!(
        radio
            .texts()
            .iter()
            .all(|(_, text)| !text.contains("Motor"))
    );
    let motors = heard!(radio, SYS_STATUS, |status| status
        .onboard_control_sensors_health
        & 0x8000);
    assert!(motors.iter().all(|(_, bit)| *bit != 0));
}

#[test]
fn terminate_ends_the_flight_there() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(456, &command(185, 1.0, 0.0));
    let log = radio.fly(&scenario());
    assert_eq!(
        (log.summary.outcome, log.ticks.t.len()),
        (Outcome::Terminated, 456)
    );
    assert_eq!(
        log.orders,
        [OrderEntry {
            tick: 456,
            order: Order::Terminate
        }]
    );
}

#[test]
fn the_vehicle_waits_until_it_is_armed() {
    let mut radio = Radio::new(&VehicleConfig {
        hold: true,
        ..CONFIG
    });
    radio
        .at(-1, &command(185, 1.0, 0.0))
        .at(-1, &command(400, 1.0, 0.0));
    let log = radio.fly(&scenario());
    assert_eq!(radio.acks(), [(185, DENIED), (400, ACCEPTED)]);
    let alone = fly(&scenario(), &mut PipeLink::new(), |_| {}).unwrap();
    assert_eq!(log.hash().unwrap(), alone.hash().unwrap());
}
