//! Tests the bytes of a log.

use super::*;
use crate::entries::{LateralColumns, Tick, finite};
use crate::faults::Faults;
use crate::field::Obstacle;
use crate::lidar::LidarConfig;
use crate::outcome::{Class, Outcome};
use crate::sensors::{AirDataNoise, Measurement};
use mpp_core::vehicle::{AirState, Conditions, Control, VehicleState, Wind};

fn tick(t: f64, reference: Option<VehicleState>) -> Tick {
    let air = AirState {
        airspeed: 12.0,
        pitch: 0.1,
        pitch_rate: 0.01,
        flight_path: -0.1,
    };
    Tick {
        t,
        state: VehicleState {
            x: 12.0 * t,
            z: 50.0,
            air,
        },
        measured: Measurement {
            airspeed: 12.3,
            pitch: 0.11,
        },
        estimate: VehicleState {
            x: 12.0 * t + 0.02,
            z: 49.99,
            air,
        },
        conditions: Conditions {
            wind: Wind { x: 0.25, z: 0.5 },
            lift: 0.03,
        },
        reference,
        control: Control {
            thrust: 4.3,
            elevator: 3.9,
        },
        applied: Control {
            thrust: 4.2,
            elevator: 3.9,
        },
        wind: (0.5, -0.25),
    }
}

fn example() -> FlightLog {
    let mut ticks = Columns::default();
    ticks.push(&tick(0.0, None));
    ticks.push(&tick(
        0.01,
        Some(VehicleState {
            x: 0.1,
            z: f64::NAN,
            ..VehicleState::default()
        }),
    ));
    let obstacle = Obstacle::circle(25.0, 47.5, 1.0);
    FlightLog {
        schema: SCHEMA,
        header: Header {
            package_version: "0.0.0".into(),
            seed: u64::MAX,
            obstacles: 1,
            generator: Generator::PAPER,
            paths: 25,
            preset: "paper".into(),
            aircraft: AircraftModel::reference().plane().file,
            world_scale: 1.0,
            replan_hz: 1.0,
            latency: 0.0,
            slices_per_tick: None,
            duration: 20.0,
            lidar: LidarConfig::PAPER,
            air_data: AirDataNoise::PAPER,
            navigation: NavigationConfig::IDEAL,
            faults: Faults::default(),
            scene: None,
            oracle: false,
            known_map: false,
            body_radius: 0.0,
            field: FieldFile::of(&[obstacle]),
            space: None,
        },
        ticks,
        lateral: LateralColumns::default(),
        plans: vec![PlanEntry {
            way_out: None,
            tick: 0,
            used_from_tick: Some(1),
            outcome: "optimal".into(),
            candidates: 25,
            feasible: 20,
            tree_runs: 3,
            slices: 700,
            cost: Some(0.1 + 0.2),
            violation: finite(Some(f64::INFINITY)),
        }],
        rejections: vec![RejectionEntry {
            tick: 1,
            cause: "stale scan".into(),
        }],
        sensors: Vec::new(),
        health: [("plans_feasible".to_owned(), 2)].into(),
        orders: Vec::new(),
        summary: Summary {
            outcome: Outcome::FlightPathLimit,
            strict: false,
            class: Class::FlightPath,
            failure: None,
            t_end: 0.01,
            x_end: 0.12,
            min_clearance: None,
            max_altitude_deviation: 1.5,
            replans: 1,
            candidates: 25,
            feasible: 20,
            slices: 700,
        },
    }
}

#[test]
fn a_log_reads_back_as_it_was() {
    let log = example();
    let bytes = log.to_json().unwrap();
    assert_eq!(FlightLog::from_json(&bytes).unwrap(), log);
}

#[test]
fn the_layout_is_frozen() {
    let text = String::from_utf8(example().to_json().unwrap()).unwrap();
    assert!(text.starts_with(
        r#"{"schema":4,"header":{"package_version":"0.0.0","seed":18446744073709551615,"#
    ));
    for part in [
        r#""field":{"circle":[{"x":25.0,"z":47.5,"radius":1.0}]}},"ticks":{"t":[0.0,0.01],"#,
        r#""ref_x":[null,0.1],"ref_z":[null,null],"#,
        r#""cost":0.30000000000000004,"violation":null}],"rejections":[{"tick":1,"#,
        r#""summary":{"outcome":"flight-path-limit","strict":false,"class":"flight-path","t_end":0.01,"x_end":0.12,"min_clearance":null,"#,
    ] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    assert_eq!(
        example().hash().unwrap(),
        "876d383ed83fa7fd",
        "the bytes of a log changed: raise SCHEMA"
    );
}

#[test]
fn the_hash_sees_every_bit() {
    let mut log = example();
    let before = log.hash().unwrap();
    log.ticks.z[1] = f64::from_bits(log.ticks.z[1].to_bits() + 1);
    assert_ne!(log.hash().unwrap(), before);
}

#[test]
fn another_schema_is_refused_by_name() {
    let error = FlightLog::from_json(br#"{"schema":9}"#).unwrap_err();
    assert!(matches!(error, LogError::Schema(9)));
    assert_eq!(
        error.to_string(),
        "flight log has schema 9, this program reads 4"
    );
    assert!(matches!(
        FlightLog::from_json(b"nonsense"),
        Err(LogError::Json(_))
    ));
}
