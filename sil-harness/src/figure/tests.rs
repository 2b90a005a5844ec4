//! The picture of a small flight.

use super::*;
use crate::campaign::{Campaign, Lists, Report};
use crate::faults::Faults;
use crate::lidar::LidarConfig;
use crate::log::{Columns, Header, PlanEntry, SCHEMA, Summary, Tick};
use crate::outcome::{Class, Outcome, Score};
use crate::plant::Plant;
use crate::scenario::{Preset, Scenario, ScenarioFile};
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
            slices_per_tick: None,
            duration: 20.0,
            lidar: LidarConfig::PAPER,
            air_data: AirDataNoise::PAPER,
            faults: Faults::default(),
            scene: None,
            oracle: false,
            field: field.obstacles.iter().map(ObstacleEntry::from).collect(),
        },
        plans: (100..count as u64).step_by(100).map(plan).collect(),
        rejections: Vec::new(),
        orders: Vec::new(),
        summary: Summary {
            outcome: Outcome::Survived,
            strict: true,
            class: Class::Success,
            failure: None,
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

#[test]
fn a_planning_cycle_is_drawn_step_by_step() {
    let scenario = Scenario {
        obstacles: 30,
        ..Scenario::new(Preset::Paper, 1)
    };
    let cycle = Cycle::of_flight(&scenario, 400).unwrap();
    assert_eq!(cycle.candidates.len(), 25);
    let feasible = |cycle: &Cycle| {
        let refined = cycle
            .candidates
            .iter()
            .filter(|candidate| candidate.refined.is_some());
        refined.count()
    };
    assert!(feasible(&cycle) > 0);
    // What is chosen is one of the feasible trajectories, and it starts at the aircraft.
    let start = cycle.chosen.knots[0].state;
    assert!((start.x - cycle.state.x).abs() < 1e-9 && (start.z - cycle.state.z).abs() < 1e-9);
    let end = cycle.chosen.knots[18].state;
    let chosen = cycle
        .candidates
        .iter()
        .filter_map(|candidate| candidate.refined.as_ref());
    let gaps = chosen.map(|path| (path[18].0 - end.x).abs() + (path[18].1 - end.z).abs());
    assert!(gaps.fold(f64::INFINITY, f64::min) < 1e-6);

    let scan = scan_svg(&cycle).unwrap();
    assert_eq!(scan, scan_svg(&cycle).unwrap());
    assert!(scan.starts_with("<svg width=\"600\""));
    // Two panels and the legend.
    assert_eq!(scan.matches("#C81E46").count(), 2 * cycle.hits.len() + 1);
    let paths = candidates_svg(&cycle).unwrap();
    assert_eq!(paths.matches("#009E73").count(), feasible(&cycle) + 1);
    let rays = rays_svg(&cycle).unwrap();
    for words in ["collocation point", "allowed region", "Height (m)"] {
        assert!(rays.contains(words), "{words}");
    }
    let late = Cycle::of_flight(
        &Scenario {
            ticks: 100,
            ..scenario
        },
        5000,
    );
    assert!(matches!(late, Err(FigureError::Cycle(_))));
}

#[test]
fn success_curves_show_every_cell_and_the_papers_results() {
    let lists = Lists {
        preset: vec![Preset::Reference, Preset::Flight],
        obstacles: vec![20, 5, 10],
        paths: vec![1, 25],
        replan_hz: Vec::new(),
    };
    let mut campaign = Campaign::new(ScenarioFile::default(), lists, 4, None).unwrap();
    let report = Report::new(&campaign, &[]);
    // Nothing flown: axes, and the paper's dots.
    assert!(success_svg(&report, Rule::Paper).is_ok());
    let flown = |mut report: Report| {
        for cell in &mut report.cells {
            cell.trials = 4;
            cell.success_rate = Some(0.5);
            cell.strict_success_rate = Some(0.25);
        }
        report
    };
    let report = flown(report);
    let svg = success_svg(&report, Rule::Paper).unwrap();
    // A band for each of four curves; a ring and a dot for five published results of two curves, and
    // the legend's.
    assert_eq!(svg.matches("<polygon").count(), 4);
    assert_eq!(svg.matches("<circle").count(), 2 * 2 * 5 + 1);
    assert!(svg.contains("reference, 1 Hz") && svg.contains("flight, 1 Hz"));
    let strict = success_svg(&report, Rule::Strict).unwrap();
    assert!(strict.contains("Strict success (%)") && !strict.contains("published"));
    // The oracle's curve is in both panels, and in the legend.
    campaign.oracle = true;
    let beside = flown(Report::new(&campaign, &[]));
    let svg = success_svg(&beside, Rule::Strict).unwrap();
    assert_eq!(svg.matches("<polygon").count(), 4 + 2);
    assert!(svg.contains(">\noracle\n<"));
}
