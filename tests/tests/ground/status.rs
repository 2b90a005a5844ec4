//! Tests what a station asks of a healthy vehicle, and what it gets where there is nothing to get.

use super::radio::{CONFIG, Radio, command, heard, short};
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{MessageData, Sender, text};
use mpp_sim::scenario::ScenarioFile;

const GEOFENCE: u32 = 0x10_0000;
const PREARM: u32 = 0x1000_0000;
const MOTORS: u32 = 0x8000;
const GYRO_ACCEL_MAG: u32 = 7;
const ACCEPTED: u8 = 0;
const DENIED: u8 = 2;
const FAILED: u8 = 4;

fn request(message: u32, first: f32) -> COMMAND_LONG_DATA {
    command(512, message as f32, first)
}

#[test]
fn a_flying_vehicle_is_in_the_air_healthy_and_has_a_fix() {
    let mut radio = Radio::new(&CONFIG);
    let log = radio.fly(&short());
    let landed = heard!(radio, EXTENDED_SYS_STATE, |state| state.landed_state);
    assert_eq!(landed[1..], [(100, 2), (200, 2)]);
    let health = heard!(radio, SYS_STATUS, |status| status
        .onboard_control_sensors_health);
    let bits = GYRO_ACCEL_MAG | PREARM | GEOFENCE;
    assert!(health.iter().all(|(_, health)| health & bits == bits));
    let fixes = heard!(radio, GPS_RAW_INT, |fix| fix.vel);
    let (tick, speed) = fixes[2];
    let estimate = log.ticks.est_airspeed[tick as usize];
    assert!((f64::from(speed) / 100.0 - estimate).abs() < 2.0);
}

/// Stations hear of a weak elevator and of a motor that stops, and see by the motors' bit that an actuator does not answer.
#[test]
fn faults_of_the_actuators_are_told() {
    let fly = |seed: u32, fault: &str| {
        let text = format!("seed = {seed}\nobstacles = 40\nreplan_hz = 4.0\n[faults.{fault}");
        let file = ScenarioFile::parse("actuator", &text).unwrap();
        let mut radio = Radio::new(&CONFIG);
        radio.fly(&file.build().unwrap());
        radio
    };
    let told = |radio: &Radio, what: &str| radio.texts().iter().any(|(_, text)| text == what);
    let weak = fly(10_000, "elevator]\nscale = 0.25");
    assert!(told(&weak, "Elevator is weak, commands grow"));
    // While an elevator stands near what the regulator asks for, it does not show that it is stuck. In this flight it does.
    let stuck = fly(10_002, "elevator]\nfrom = 8.0\nuntil = 11.0\nfrozen = true");
    assert!(told(&stuck, "Elevator does not answer"));
    assert!(!told(&stuck, "Sensor elevator failed"));
    let stopped = fly(10_000, "thrust]\nfrom = 8.0\nuntil = 11.0\nscale = 0.0");
    assert!(told(&stopped, "Motor gives no thrust"));
    assert!(told(&stopped, "Motor works again"));
    assert!(!told(&stopped, "Sensor airspeed failed"));
    for radio in [stuck, stopped] {
        let motors = heard!(radio, SYS_STATUS, |status| status
            .onboard_control_sensors_health
            & MOTORS);
        assert!(motors[..8].iter().all(|(_, bit)| *bit == MOTORS));
        assert!(motors.iter().any(|(_, bit)| *bit == 0));
    }
}

/// A sensor that fails for a moment again and again is never excluded. Stations hear of it, and its bit goes off.
#[test]
fn a_sensor_that_blinks_is_told() {
    let text = "obstacles = 20\n[faults.airspeed]\nfrom = 3.0\ntoggle_hz = 3.0\nfrozen = true";
    let file = ScenarioFile::parse("blinking", text).unwrap();
    let mut radio = Radio::new(&CONFIG);
    radio.fly(&file.build().unwrap());
    let texts = radio.texts();
    let doubtful = texts
        .iter()
        .find(|(_, text)| text == "Sensor airspeed is doubtful");
    assert!(doubtful.is_some_and(|(tick, _)| *tick < 1000), "{texts:?}");
    let airspeed = heard!(radio, SYS_STATUS, |status| status
        .onboard_control_sensors_health
        & 0x10);
    assert!(airspeed[..3].iter().all(|(_, bit)| *bit == 0x10));
    assert!(airspeed.iter().any(|(_, bit)| *bit == 0));
}

/// The wind on the link is the core's estimate, and the velocity over ground has it.
#[test]
fn the_wind_is_told_and_is_in_the_speed_over_ground() {
    let mut windy = short();
    windy.faults.gusts.intensity = 2.0;
    let mut radio = Radio::new(&CONFIG);
    let log = radio.fly(&windy);
    let winds = heard!(radio, WIND_COV, |wind| (wind.wind_x, wind.wind_z));
    for (tick, (ahead, down)) in &winds[1..] {
        let tick = *tick as usize;
        let wind = [log.ticks.est_wind_x[tick], log.ticks.est_wind_z[tick]];
        assert_eq!([*ahead, -down], wind.map(|wind| wind as f32));
    }
    assert!(winds.iter().any(|(_, (ahead, _))| ahead.abs() > 0.2));
    let speeds = heard!(radio, LOCAL_POSITION_NED, |at| at.vx);
    let (tick, forward) = speeds[20];
    let tick = tick as usize;
    let forward_in_air = log.ticks.est_airspeed[tick] * libm::cos(log.ticks.est_flight_path[tick]);
    let expected = forward_in_air + log.ticks.est_wind_x[tick];
    assert!(
        (f64::from(forward) - expected).abs() < 1e-3,
        "{forward} {expected}"
    );
}

#[test]
fn there_are_no_logs() {
    let mut radio = Radio::new(&CONFIG);
    radio.at(
        50,
        &LOG_REQUEST_LIST_DATA {
            target_system: 1,
            target_component: 1,
            start: 0,
            end: u16::MAX,
        },
    );
    radio.fly(&short());
    let logs = heard!(radio, LOG_ENTRY, |entry| entry.num_logs);
    assert_eq!(logs, [(50, 0)]);
}

#[test]
fn what_a_parameter_lacks_is_told_by_its_name() {
    let mut radio = Radio::new(&CONFIG);
    let read = PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: text("NO_SUCH_THING"),
    };
    let write = |name, param_value| PARAM_SET_DATA {
        param_value,
        target_system: 1,
        target_component: 1,
        param_id: text(name),
        param_type: 9,
    };
    radio
        .at(10, &read)
        .at(20, &write("NO_SUCH_THING", 1.0))
        .at(30, &write("MPP_PATHS", 99.0))
        .at(40, &write("MPP_CRUISE_MS", 15.0));
    radio.fly(&short());
    let errors = heard!(radio, PARAM_ERROR, |error| (
        error.param_id.to_str().unwrap().to_owned(),
        error.error
    ));
    let errors: Vec<_> = errors.into_iter().map(|(_, error)| error).collect();
    let named = |name: &str, error| (name.to_owned(), error);
    assert_eq!(
        errors,
        [
            named("NO_SUCH_THING", 1),
            named("NO_SUCH_THING", 1),
            named("MPP_PATHS", 2),
            named("MPP_CRUISE_MS", 3)
        ]
    );
}

#[test]
fn modes_and_the_last_of_each_event_are_sent_on_request() {
    let mut radio = Radio::new(&CONFIG);
    let asked = [
        (AVAILABLE_MODES_DATA::ID, 0.0, ACCEPTED),
        (AVAILABLE_MODES_DATA::ID, 2.0, ACCEPTED),
        (AVAILABLE_MODES_DATA::ID, 3.0, DENIED),
        (CURRENT_MODE_DATA::ID, 0.0, ACCEPTED),
        (GPS_GLOBAL_ORIGIN_DATA::ID, 0.0, ACCEPTED),
        (COMPONENT_METADATA_DATA::ID, 0.0, ACCEPTED),
        (MPP_LIDAR_SCAN_DATA::ID, 0.0, ACCEPTED),
        (MPP_PLAN_STATUS_DATA::ID, 0.0, ACCEPTED),
        (MPP_TRAJECTORY_DATA::ID, 0.0, ACCEPTED),
        (9999, 0.0, DENIED),
    ];
    for (place, (message, first, _)) in (0..).zip(asked) {
        radio.at(150 + 10 * place, &request(message, first));
    }
    radio.fly(&short());
    let results: Vec<_> = radio.acks().into_iter().map(|(_, result)| result).collect();
    assert_eq!(results, asked.map(|(_, _, result)| result));
    let modes = heard!(radio, AVAILABLE_MODES, |mode| (
        mode.mode_index,
        mode.custom_mode,
        mode.mode_name.to_str().unwrap().to_owned(),
    ));
    let modes: Vec<_> = modes.into_iter().map(|(_, mode)| mode).collect();
    let [auto, cruise] = [(1, 10, "AUTO".to_owned()), (2, 7, "CRUISE".to_owned())];
    assert_eq!(modes, [auto, cruise.clone(), cruise]);
    let plans = heard!(radio, MPP_PLAN_STATUS, |plan| plan.scan_tick);
    // It is the last one, and it did not come before.
    assert_eq!(plans, [(220, 200)]);
}

#[test]
fn altitude_and_airspeed_are_commanded_within_limits() {
    let mut radio = Radio::new(&CONFIG);
    let (altitude, speed) = (186, 178);
    radio
        // Above home, above the sea, and in no frame that it knows.
        .at(10, &command(altitude, 53.0, 3.0))
        .at(15, &command(altitude, 488.0 + 54.5, 0.0))
        .at(17, &command(altitude, 53.0, 10.0))
        .at(20, &command(altitude, 5000.0, 3.0))
        .at(30, &command(speed, 0.0, 14.0))
        .at(40, &command(speed, 1.0, 14.0));
    radio.fly(&short());
    let expected = [
        (altitude, ACCEPTED),
        (altitude, ACCEPTED),
        (altitude, DENIED),
        (altitude, FAILED),
        (speed, FAILED),
        (speed, DENIED),
    ];
    assert_eq!(radio.acks(), expected);
    let values = radio.all(|message| match message {
        MavMessage::PARAM_VALUE(value) if value.param_id.to_str() == Ok("MPP_ALT_M") => {
            Some(value.param_value)
        }
        _ => None,
    });
    assert_eq!((values[0].1, values[1].1), (53.0, 54.5));
    let texts: Vec<_> = radio.texts().into_iter().map(|(_, text)| text).collect();
    for said in [
        "MPP_ALT_M: out of range",
        "MPP_CRUISE_MS: not in flight",
        "Only the airspeed can be changed",
    ] {
        assert!(texts.iter().any(|text| text == said), "{said}: {texts:?}");
    }
}

#[test]
fn another_vehicle_with_the_same_number_is_told_once() {
    let mut radio = Radio::new(&CONFIG);
    let beat = Sender::new(1, 1).frame(&HEARTBEAT_DATA::DEFAULT);
    for tick in [10, 110] {
        radio.bytes_at(tick, beat.as_bytes());
    }
    radio.fly(&short());
    let told = radio
        .notes
        .iter()
        .filter(|note| note.contains("--instance"));
    assert_eq!(told.count(), 1);
}

/// The mode in force is told at the rate that a station asks for, and not unasked.
#[test]
fn the_mode_is_told_to_those_who_ask() {
    let mut radio = Radio::new(&CONFIG);
    let interval = command(511, CURRENT_MODE_DATA::ID as f32, 1e6);
    radio.at(90, &interval).at(150, &command(176, 1.0, 7.0));
    radio.fly(&short());
    let modes = heard!(radio, CURRENT_MODE, |mode| (
        mode.custom_mode,
        mode.standard_mode
    ));
    let (auto, cruise) = ((10, 0), (7, 3));
    assert_eq!(modes, [(100, auto), (200, cruise)]);
}
