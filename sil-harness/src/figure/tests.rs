//! The picture of a small flight.

use super::*;
use crate::faults::Faults;
use crate::lidar::LidarConfig;
use crate::log::{Columns, Header, PlanEntry, SCHEMA, Summary, Tick};
use crate::outcome::{Class, Outcome, Score};
use crate::plant::Plant;
use crate::sensors::{AirDataNoise, AirDataSensors};
use crate::world::ObstacleField;
use mpp_core::vehicle::{Airframe, Control, Trim, VehicleState};

/// Steady flight with an elevator that swings, against a reference of straight pieces.
fn example(count: usize, obstacles: usize) -> FlightLog {
    const DT: f64 = 0.01;
    let airframe = Airframe::REFERENCE;
    let trim = Trim::at_speed(&airframe, 12.0, 0.0).unwrap();
    let state = VehicleState {
        x: 0.0,
        z: 50.0,
        air: trim.state,
    };
    let mut plant = Plant { airframe, state };
    let mut sensors = AirDataSensors::new(1, AirDataNoise::PAPER);
    let field = ObstacleField::generate(1, obstacles, 0.0, 50.0);
    let mut score = Score::new(50.0);
    let mut ticks = Columns::default();
    let mut wanted = state;
    for k in 0..count {
        let t = k as f64 * DT;
        let swing = libm::sin(0.9 * t);
        let control = Control {
            thrust: trim.control.thrust + 1.5 * swing,
            elevator: trim.control.elevator + 1.2 * swing,
        };
        if k % 100 == 0 {
            wanted = plant.state;
        }
        wanted.x += wanted.air.airspeed * DT;
        wanted.z += wanted.air.airspeed * wanted.air.flight_path * DT;
        ticks.push(&Tick {
            t,
            state: plant.state,
            measured: sensors.measure(&plant.state),
            estimate: plant.state.air,
            reference: (k >= 100).then_some(wanted),
            control,
            applied: control,
            wind: (0.0, 0.0),
        });
        let before = plant.state;
        plant.step(control, DT).unwrap();
        score.update(&field, &before, &plant.state);
    }
    let plan = |tick| PlanEntry {
        tick,
        used_from_tick: Some(tick),
        outcome: "optimal".into(),
        candidates: 25,
        feasible: 20,
        tree_runs: 2,
        slices: 700,
        cost: Some(1.0),
        violation: Some(0.0),
    };
    FlightLog {
        schema: SCHEMA,
        header: Header {
            package_version: "0.0.0".into(),
            seed: 1,
            obstacles,
            paths: 25,
            preset: "paper".into(),
            airframe: "reference".into(),
            replan_hz: 1.0,
            latency: 0.0,
            duration: 20.0,
            lidar: LidarConfig::PAPER,
            air_data: AirDataNoise::PAPER,
            faults: Faults::default(),
            scene: None,
            field: field.obstacles.iter().map(ObstacleEntry::from).collect(),
        },
        plans: (100..count as u64).step_by(100).map(plan).collect(),
        rejections: Vec::new(),
        summary: Summary {
            outcome: Outcome::Survived,
            strict: true,
            class: Class::Success,
            t_end: count as f64 * DT,
            x_end: plant.state.x,
            min_clearance: Some(score.min_clearance).filter(|c| c.is_finite()),
            max_altitude_deviation: score.max_altitude_deviation,
            replans: 19,
            candidates: 475,
            feasible: 380,
            slices: 13_300,
        },
        ticks,
    }
}

#[test]
fn a_flight_is_drawn_and_always_the_same() {
    let log = example(2000, 20);
    let svg = flight_svg(&log).unwrap();
    assert_eq!(svg, flight_svg(&log).unwrap());
    assert!(svg.starts_with("<svg width=\"1000\" height=\"600\" viewBox=\"0 0 4000 2400\""));
    // The legend's and the field's.
    assert_eq!(svg.matches("<circle").count(), 21);
    // Five flown curves, and the reference of four panels in a piece per plan.
    assert_eq!(svg.matches("#E67800").count(), 5 + 1);
    assert_eq!(svg.matches("#0072B2").count(), 4 * 19 + 1);
    for words in [
        "Downrange distance (m)",
        "Height (m)",
        "Time (s)",
        "Thrust (N)",
        "reference",
    ] {
        assert!(svg.contains(words), "{words}");
    }
}

#[test]
fn circles_and_axes_have_one_scale() {
    for (count, obstacles) in [(2000, 20), (300, 1), (2, 0)] {
        let field = field_panel(&example(count, obstacles));
        let (width, height) = panel::plot_size((CANVAS.0, FIELD_HEIGHT), true);
        let scale = |axis: &Axis, pixels| (axis.range().end - axis.range().start) / pixels;
        let (x, z) = (scale(&field.x, width), scale(&field.y, height));
        assert!((x / z - 1.0).abs() < 1e-9, "{x} and {z} m/px");
        for (_, radius, _) in field.circles {
            // Half a pixel of a radius that is a whole number of them.
            assert!((f64::from(radius) * x - 1.0).abs() <= 0.5 * x);
        }
    }
}

#[test]
fn a_flight_of_one_tick_is_drawn_and_an_empty_one_refused() {
    assert!(flight_svg(&example(1, 0)).is_ok());
    assert!(matches!(
        flight_svg(&example(0, 20)),
        Err(FigureError::EmptyFlight)
    ));
}
