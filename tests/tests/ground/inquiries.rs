//! Tests the requests of a station that do not change the flight.

use super::radio::{CONFIG, Radio, command, heard, scenario};
use hil_protocol::mavlink::messages::*;
use mpp_sim::scenario::Scenario;
use sil_harness::ground::vehicle::VehicleConfig;

fn short() -> Scenario {
    Scenario {
        ticks: 200,
        ..scenario()
    }
}

#[test]
fn the_heartbeat_is_that_of_a_fixed_wing_in_arduplanes_modes() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(50, &command(176, 1.0, 7.0));
    radio.fly(&short());
    let beats = heard!(radio, HEARTBEAT, |heartbeat| heartbeat.clone());
    let (custom, auto, stabilised, armed) = (1, 4, 16, 128);
    let expected = HEARTBEAT_DATA {
        custom_mode: 10,
        mavtype: 1,
        autopilot: 0,
        base_mode: custom | auto | stabilised | armed,
        system_status: 4,
        mavlink_version: 3,
    };
    assert_eq!(beats[0], (0, expected.clone()));
    let cruise = HEARTBEAT_DATA {
        custom_mode: 7,
        base_mode: custom | stabilised | armed,
        ..expected
    };
    assert_eq!(beats[1], (100, cruise));
}

#[test]
fn an_interval_is_told_in_both_ways() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(10, &command(510, 30.0, 0.0))
        .at(20, &command(512, 244.0, 30.0))
        .at(30, &command(512, 244.0, 9999.0))
        .at(40, &command(512, 244.0, f32::NAN))
        .at(50, &command(511, 30.0, -1.0))
        .at(60, &command(512, 244.0, 30.0))
        .at(70, &command(511, 30.0, 0.0))
        .at(80, &command(512, 244.0, 30.0))
        // More than the answer can tell.
        .at(90, &command(511, 30.0, 3e9))
        .at(95, &command(512, 244.0, 30.0));
    radio.fly(&short());
    let told = heard!(radio, MESSAGE_INTERVAL, |told| (
        told.message_id,
        told.interval_us
    ));
    let told: Vec<_> = told.into_iter().map(|(_, told)| told).collect();
    let expected = [
        (30, 100_000),
        (30, 100_000),
        (9999, 0),
        (30, -1),
        (30, 100_000),
        (30, 2_147_480_000),
    ];
    assert_eq!(told, expected);
    assert_eq!(radio.acks()[3], (512, 2));
}

/// A question is answered if it is for this vehicle. The answer must not look like a question: its
/// time is not 0, not even at the start.
#[test]
fn a_question_for_the_time_is_answered_once() {
    let mut radio = Radio::new(&CONFIG);
    let question = TIMESYNC_DATA {
        ts1: 77,
        ..TIMESYNC_DATA::DEFAULT
    };
    radio
        .at(0, &question)
        .at(
            100,
            &TIMESYNC_DATA {
                target_system: 1,
                ..question.clone()
            },
        )
        .at(
            110,
            &TIMESYNC_DATA {
                target_system: 9,
                ..question.clone()
            },
        )
        .at(120, &TIMESYNC_DATA { tc1: 5, ..question });
    radio.fly(&short());
    let told = heard!(radio, TIMESYNC, |sync| (
        sync.tc1,
        sync.ts1,
        sync.target_system
    ));
    assert_eq!(told, [(0, (1, 77, 255)), (100, (1_000_000_000, 77, 255))]);
}

#[test]
fn a_ping_comes_back_and_an_answer_does_not() {
    let mut radio = Radio::new(&CONFIG);
    let ping = PING_DATA {
        seq: 3,
        ..PING_DATA::DEFAULT
    };
    radio.at(10, &ping).at(
        20,
        &PING_DATA {
            target_system: 1,
            target_component: 1,
            ..ping
        },
    );
    radio.fly(&short());
    let told = heard!(radio, PING, |ping| (
        ping.seq,
        ping.target_system,
        ping.target_component
    ));
    assert_eq!(told, [(10, (3, 255, 190))]);
}

#[test]
fn there_is_no_mission_and_none_is_taken() {
    let mut radio = Radio::new(&CONFIG);
    let upload = MISSION_COUNT_DATA {
        count: 3,
        target_system: 1,
        ..MISSION_COUNT_DATA::DEFAULT
    };
    radio
        .at(10, &MISSION_REQUEST_LIST_DATA::DEFAULT)
        .at(20, &upload)
        .at(
            30,
            &MISSION_COUNT_DATA {
                count: 0,
                mission_type: 1,
                ..upload.clone()
            },
        )
        .at(
            40,
            &MISSION_CLEAR_ALL_DATA {
                mission_type: 2,
                ..MISSION_CLEAR_ALL_DATA::DEFAULT
            },
        )
        .at(
            50,
            &MISSION_COUNT_DATA {
                target_system: 2,
                ..upload
            },
        );
    radio.fly(&short());
    let told = radio.all(|message| match message {
        MavMessage::MISSION_COUNT(count) => Some((44, count.count as u8, count.mission_type)),
        MavMessage::MISSION_ACK(ack) => Some((47, ack.mavtype, ack.mission_type)),
        _ => None,
    });
    let told: Vec<_> = told.into_iter().map(|(_, told)| told).collect();
    assert_eq!(told, [(44, 0, 0), (47, 3, 0), (47, 0, 1), (47, 0, 2)]);
}

/// A station that gets no answer asks again, for seconds.
#[test]
fn what_the_empty_mission_lacks_is_acknowledged_as_an_error() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(
            10,
            &MISSION_REQUEST_DATA {
                mission_type: 1,
                ..MISSION_REQUEST_DATA::DEFAULT
            },
        )
        .at(20, &MISSION_REQUEST_INT_DATA::DEFAULT)
        .at(30, &MISSION_SET_CURRENT_DATA::DEFAULT)
        .at(40, &MISSION_WRITE_PARTIAL_LIST_DATA::DEFAULT)
        .at(
            50,
            &MISSION_SET_CURRENT_DATA {
                target_system: 2,
                ..MISSION_SET_CURRENT_DATA::DEFAULT
            },
        );
    radio.fly(&short());
    let told = heard!(radio, MISSION_ACK, |ack| (
        ack.mavtype,
        ack.mission_type,
        ack.target_system
    ));
    let (invalid_sequence, unsupported) = (13, 3);
    let expected = [
        (10, (invalid_sequence, 1, 255)),
        (20, (invalid_sequence, 0, 255)),
        (30, (invalid_sequence, 0, 255)),
        (40, (unsupported, 0, 255)),
    ];
    assert_eq!(told, expected);
}

#[test]
fn a_map_shows_where_the_log_says() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(10, &command(512, 242.0, 0.0));
    let log = radio.fly(&short());
    let homes = heard!(radio, HOME_POSITION, |home| home.clone());
    let (_, home) = &homes[0];
    let places = heard!(radio, GLOBAL_POSITION_INT, |place| place.clone());
    assert_eq!(places.len(), 10);
    for (tick, place) in places {
        let row = tick as usize;
        // The computation uses a sphere with the equator's radius.
        let north = f64::from(place.lat - home.latitude) * 1e-7_f64.to_radians() * 6_378_137.0;
        assert!(
            (north - log.ticks.est_x[row]).abs() < 0.02,
            "{tick}: {north}"
        );
        let height = f64::from(place.alt - home.altitude) / 1e3;
        assert!((height - log.ticks.est_z[row]).abs() < 1e-3);
        assert_eq!(place.lon, home.longitude);
        assert_eq!(place.relative_alt, place.alt - 488_000);
    }
}

/// Whatever the heading, downrange is ahead.
#[test]
fn a_flight_goes_where_home_is_headed() {
    let mut radio = Radio::new(&VehicleConfig {
        home: "-33.9, 151.2, 20, 90".parse().unwrap(),
        ..CONFIG
    });
    let log = radio.fly(&short());
    let local = heard!(radio, LOCAL_POSITION_NED, |at| (at.x, at.y, at.vx, at.vy));
    let (tick, (north, east, to_north, to_east)) = local[19];
    assert!((f64::from(east) - log.ticks.est_x[tick as usize]).abs() < 1e-4);
    assert!(north.abs() < 1e-4 && to_north.abs() < 1e-4 && to_east > 10.0);
    let global = heard!(radio, GLOBAL_POSITION_INT, |at| at.clone());
    let (tick, at) = &global[9];
    assert_eq!((at.lat, at.hdg), (-339_000_000, 9000));
    assert!(at.lon > 1_512_000_000);
    let height = log.ticks.est_z[*tick as usize];
    assert!((f64::from(at.alt) / 1e3 - 20.0 - height).abs() < 1e-3);
    let yaw = heard!(radio, ATTITUDE, |attitude| attitude.yaw);
    assert_eq!(yaw[5].1, std::f32::consts::FRAC_PI_2);
    let shown = heard!(radio, VFR_HUD, |hud| (hud.heading, hud.alt));
    assert_eq!(shown[0].1, (90, 20.0 + log.ticks.est_z[0] as f32));
}
