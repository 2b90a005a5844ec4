//! Tests what comes unasked: place, accuracy, motion and throttle.

use super::radio::{CONFIG, Radio, command, heard, short};
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Framer, MessageData};
use mpp_node::parameters::Tuning;
use mpp_sim::navigation::NavigationConfig;
use mpp_sim::scenario::ScenarioFile;
use sil_harness::ground::vehicle::{Vehicle, VehicleConfig};

/// What a vehicle sent of one kind.
fn sent<M: MessageData, T>(vehicle: &mut Vehicle, pick: impl Fn(M) -> T) -> Vec<T> {
    let mut told = Vec::new();
    for frame in vehicle.take_outgoing() {
        let plain = frame.plain.unwrap();
        Framer::new().receive_datagram(plain.as_bytes(), |frame| {
            told.extend(frame.decode().map(&pick));
        });
    }
    told
}

/// What a receiver tells of its accuracy is what the source declares.
#[test]
fn the_fix_is_that_of_the_navigation_source() {
    let fix = |navigation| {
        let mut vehicle = Vehicle::new(&VehicleConfig {
            navigation,
            ..CONFIG
        });
        vehicle.hold();
        let told = sent(&mut vehicle, |fix: GPS_RAW_INT_DATA| {
            let accuracy = (fix.eph, fix.h_acc, fix.v_acc, fix.vel_acc);
            (fix.fix_type, fix.satellites_visible, accuracy)
        });
        told[0]
    };
    let rtk = (6, 10, (2, 20, 20, 0));
    assert_eq!(fix(NavigationConfig::RTK), rtk);
    assert_eq!(fix(NavigationConfig::IDEAL), (6, 10, (1, 1, 1, 0)));
    let satellites = (3, 10, (10, 100, 100, 100));
    assert_eq!(fix(NavigationConfig::GNSS_INS), satellites);
    let odometry = (0, 0, (3, 30, 30, 0));
    assert_eq!(fix(NavigationConfig::LIDAR_ODOMETRY), odometry);
}

/// What a station waits for comes unasked, and faster if it asks.
#[test]
fn what_stations_wait_for_is_sent() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(150, &command(511, HOME_POSITION_DATA::ID as f32, 1e5));
    let log = radio.fly(&short());
    let kinds = radio.all(|message| match message {
        MavMessage::HOME_POSITION(_) => Some(HOME_POSITION_DATA::ID),
        MavMessage::ALTITUDE(_) => Some(ALTITUDE_DATA::ID),
        MavMessage::SYSTEM_TIME(_) => Some(SYSTEM_TIME_DATA::ID),
        MavMessage::HIGHRES_IMU(_) => Some(HIGHRES_IMU_DATA::ID),
        MavMessage::ODOMETRY(_) => Some(ODOMETRY_DATA::ID),
        _ => None,
    });
    let ticks = |id| {
        let own = kinds.iter().filter(|(_, kind)| *kind == id);
        own.map(|(tick, _)| *tick).collect::<Vec<_>>()
    };
    for id in [
        ALTITUDE_DATA::ID,
        SYSTEM_TIME_DATA::ID,
        HIGHRES_IMU_DATA::ID,
        ODOMETRY_DATA::ID,
    ] {
        assert_eq!(ticks(id), [0, 100, 200], "{id}");
    }
    let homes = ticks(HOME_POSITION_DATA::ID);
    assert_eq!(
        (homes[0], homes[1], homes[2], homes.len()),
        (0, 150, 160, 16)
    );
    let odometry = heard!(radio, ODOMETRY, |odometry| odometry.clone());
    let (tick, told) = &odometry[1];
    let row = *tick as usize;
    let pitch = log.ticks.est_pitch[row];
    assert!((2.0 * libm::asin(told.q[2].into()) - pitch).abs() < 1e-6);
    // Body axes: nearly all of the speed is ahead, and the angle of attack shows.
    let speed = libm::hypot(told.vx.into(), told.vz.into());
    assert!((speed - log.ticks.est_airspeed[row]).abs() < 2.0);
    let steep = f64::from(told.vz / told.vx) - (pitch - log.ticks.est_flight_path[row]);
    assert!(steep.abs() < 0.05, "{steep}");
    // Near level flight an accelerometer shows gravity, upwards.
    let imu = heard!(radio, HIGHRES_IMU, |imu| imu.clone());
    let (_, told) = &imu[0];
    let felt = libm::hypot(told.xacc.into(), told.zacc.into());
    assert!((felt - 9.81).abs() < 0.3 && told.zacc < -9.0, "{told:?}");
    assert_eq!(told.yacc, 0.0);
    assert!(imu.iter().all(|(_, told)| told.zacc.is_finite()));
}

/// The motor of an aircraft file counts, not a number of newtons.
#[test]
fn full_throttle_is_the_aircrafts_greatest_thrust() {
    for (aircraft, full) in [
        ("reference", 3.2 * 9.81),
        ("zagi", 12.0),
        ("cessna182", 3500.0),
    ] {
        let text = format!("aircraft = \"{aircraft}\"\nduration = 3\nobstacles = 0");
        let file = ScenarioFile::parse("throttle", &text).unwrap();
        let mut radio = Radio::new(&CONFIG);
        let log = radio.fly(&file.build().unwrap());
        let told = heard!(radio, VFR_HUD, |hud| hud.throttle);
        for (tick, throttle) in &told[1..] {
            let share = 100.0 * log.ticks.thrust[*tick as usize] / full;
            let off = f64::from(*throttle) - share.clamp(0.0, 100.0);
            assert!(off.abs() <= 0.5, "{aircraft}: {throttle} for {share}");
        }
    }
}

/// Its height and airspeed are those of its start, and it does not move.
#[test]
fn a_waiting_vehicle_hangs_in_the_air() {
    let mut vehicle = Vehicle::new(&VehicleConfig {
        hold: true,
        ..CONFIG
    });
    let short = short();
    let tuning = Tuning::new(&short.configure()).unwrap();
    vehicle.begin(&tuning, &short.start().unwrap());
    vehicle.hold();
    let landed = |state: EXTENDED_SYS_STATE_DATA| state.landed_state;
    assert_eq!(sent(&mut vehicle, landed), [2]);
    for _ in 0..100 {
        vehicle.hold();
    }
    let motion = |at: LOCAL_POSITION_NED_DATA| [at.z, at.vx, at.vz];
    assert_eq!(sent(&mut vehicle, motion)[9], [-50.0, 0.0, 0.0]);
}
