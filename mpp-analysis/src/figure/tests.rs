//! Tests the pictures of small flights.

use super::panel::{self, Axis};
use super::strips::{CANVAS, FIELD_HEIGHT, field_panels};
use super::*;
use crate::campaign::{Campaign, Lists, Report};
use mpp_core::vehicle::{Airframe, Conditions, Control};
use mpp_sim::dynamics::{Aerodynamics, Dynamics};
use mpp_sim::entries::{Columns, PlanEntry, Tick};
use mpp_sim::log::{FlightLog, Header, SCHEMA, Summary};
use mpp_sim::outcome::{Class, Outcome, Score};
use mpp_sim::scenario::{Preset, Scenario, ScenarioFile};
use mpp_sim::scene::Scene;
use mpp_sim::sensors::{AirDataNoise, AirDataSensors};
use plotters::prelude::Ranged;

/// A flight with swinging thrust and elevator, and with a reference of straight pieces.
fn example(count: usize, obstacles: usize) -> FlightLog {
    const DT: f64 = 0.01;
    let scenario = Scenario {
        obstacles,
        ..Scenario::new(Preset::Paper, 1)
    };
    let (trim, state) = (scenario.trim().unwrap(), scenario.start().unwrap());
    let mut plant = Dynamics {
        airframe: Airframe::REFERENCE,
        more: Aerodynamics::NONE,
        state,
    };
    let mut sensors = AirDataSensors::new(1, AirDataNoise::PAPER);
    let field = scenario.field();
    let mut score = Score::new(50.0, 11.0, 0.0);
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
            estimate: plant.state,
            conditions: Conditions::STILL,
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
        way_out: None,
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
            latency: 0.0,
            ..Header::of(&scenario, &field)
        },
        plans: (100..count as u64).step_by(100).map(plan).collect(),
        lateral: Default::default(),
        rejections: Vec::new(),
        sensors: Vec::new(),
        health: Default::default(),
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
    // The legend has one circle, the field has twenty, and so many plans took over.
    assert_eq!(svg.matches("<circle").count(), 21 + 19);
    // There are five flown curves. The reference of four panels has a piece for each plan, and each plan a dot.
    assert_eq!(svg.matches("#E67800").count(), 5 + 1);
    assert_eq!(svg.matches("#0072B2").count(), 4 * 19 + 19 + 1);
    // Goal, legend and end; both edges of the band; the closest approach in five panels and the legend.
    assert_eq!(svg.matches("#1C7A3E").count(), 1 + 2 + 1);
    assert!(svg.contains("survived"));
    assert_eq!(svg.matches("#783C96").count(), 5 + 1);
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
fn a_flight_that_failed_says_so_and_shows_the_limit_that_it_broke() {
    let mut log = example(2000, 20);
    let limits = |log: &FlightLog| flight_svg(log).unwrap().matches("#E17878").count();
    let before = limits(&log);
    log.ticks.pitch[1200] = 61_f64.to_radians();
    assert_eq!(limits(&log), before + 2);
    log.summary.outcome = Outcome::PitchLimit;
    let svg = flight_svg(&log).unwrap();
    assert!(svg.contains("pitch limit") && !svg.contains("survived"));
    // Two strokes of a cross at the end and two in the legend, and the words.
    assert_eq!(svg.matches("#C62828").count(), 2 + 2 + 1);
}

#[test]
fn a_flight_of_ten_minutes_is_drawn_in_strips_to_scale() {
    let mut log = example(2000, 20);
    // The same motion at another pace, as if it had gone on for ten minutes.
    for (row, (x, t)) in log.ticks.x.iter_mut().zip(&mut log.ticks.t).enumerate() {
        (*x, *t) = (3.6 * row as f64, 0.3 * row as f64);
    }
    log.ticks.ref_x.fill(None);
    let strips = field_panels(&log, None);
    assert_eq!(strips.len(), 8);
    let mut shown = strips[0].0.x.range().start;
    for (panel, height) in &strips {
        let (width, height) = panel::plot_size((CANVAS.0, *height), true);
        let scale = |axis: &Axis, pixels| (axis.range().end - axis.range().start) / pixels;
        let (x, z) = (scale(&panel.x, width), scale(&panel.y, height));
        assert!((x / z - 1.0).abs() < 0.02, "{x} and {z} m/px");
        // One goes on where the other one ends, but for a rounding to whole pixels.
        assert!((panel.x.range().start - shown).abs() < 20.0);
        shown = panel.x.range().end;
    }
    assert!(shown > 7196.0 && shown < 7400.0, "{shown}");
    assert!(flight_svg(&log).unwrap().contains("Downrange distance (m)"));
}

/// A broken sensor gives such references, and a broken log such flights.
#[test]
fn absurd_positions_make_no_great_picture() {
    let plain = flight_svg(&example(600, 20)).unwrap();
    for absurd in [1e6, 1e14, -1e18, 1e300] {
        let mut log = example(600, 20);
        for row in 300..500 {
            log.ticks.ref_x[row] = Some(absurd * row as f64);
            log.ticks.ref_z[row] = Some(-absurd);
            log.ticks.ref_pitch[row] = Some(absurd);
        }
        let stray = flight_svg(&log).unwrap();
        // The flight is still to be seen.
        assert!(field_panels(&log, None).len() <= 2, "{absurd}");
        (log.ticks.x[550], log.ticks.z[550]) = (absurd, absurd);
        for svg in [stray, flight_svg(&log).unwrap()] {
            assert!(svg.len() < 4 * plain.len(), "{absurd}: {} B", svg.len());
        }
    }
}

#[test]
fn a_scene_shows_where_the_flight_with_one_path_failed() {
    let flown = |paths| {
        let mut log = example(700, 3);
        log.header.paths = paths;
        log
    };
    let mut alone = flown(1);
    alone.summary.outcome = Outcome::Collision;
    let both = |logs: Vec<FlightLog>| challenge_svg(&[(Scene::Flytrap, logs)]).unwrap();
    let svg = both(vec![alone, flown(25)]);
    let crosses = |svg: &str| svg.matches("#C62828").count();
    assert_eq!(crosses(&svg), 2 + crosses(&both(vec![flown(1), flown(25)])));
    assert!(svg.contains("flown with 1 path") && svg.contains("failed here"));
}

#[test]
fn circles_and_axes_have_one_scale() {
    for (count, obstacles) in [(2000, 20), (300, 1), (2, 0)] {
        let panels = field_panels(&example(count, obstacles), None);
        let [(field, FIELD_HEIGHT)] = &panels[..] else {
            panic!("{} panels", panels.len());
        };
        let (width, height) = panel::plot_size((CANVAS.0, FIELD_HEIGHT), true);
        let scale = |axis: &Axis, pixels| (axis.range().end - axis.range().start) / pixels;
        let (x, z) = (scale(&field.x, width), scale(&field.y, height));
        assert!((x / z - 1.0).abs() < 1e-9, "{x} and {z} m/px");
        for (_, radius, _) in &field.circles {
            // The radius is a whole number of pixels, so it may be wrong by half a pixel.
            assert!((f64::from(*radius) * x - 1.0).abs() <= 0.5 * x);
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
    let cycle = OneReplan::of_flight(&scenario, 400).unwrap();
    assert_eq!(cycle.candidates.len(), 25);
    let feasible = |cycle: &OneReplan| {
        let refined = cycle
            .candidates
            .iter()
            .filter(|candidate| candidate.refined.is_some());
        refined.count()
    };
    assert!(feasible(&cycle) > 0);
    // The chosen trajectory is one of the feasible ones, and it starts at the aircraft.
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
    // The returns are in two panels and in the legend.
    assert_eq!(scan.matches("#C81E46").count(), 2 * cycle.hits.len() + 1);
    let paths = candidates_svg(&cycle).unwrap();
    assert_eq!(paths.matches("#009E73").count(), feasible(&cycle) + 1);
    // The trajectory of the single path, and the legend.
    let single = trajectory_svg(&cycle).unwrap();
    assert_eq!(single.matches("#0072B2").count(), 1 + 1);
    assert!(single.contains("occupied cell"));
    let rays = rays_svg(&cycle).unwrap();
    for words in ["collocation point", "allowed region", "Height (m)"] {
        assert!(rays.contains(words), "{words}");
    }
    let late = OneReplan::of_flight(
        &Scenario {
            ticks: 100,
            ..scenario
        },
        5000,
    );
    assert!(matches!(late, Err(FigureError::NoCycle(_))));
}

#[test]
fn success_curves_show_every_cell_and_the_papers_results() {
    let lists = Lists {
        preset: vec![Preset::Reference, Preset::Flight],
        obstacles: vec![20, 5, 10],
        paths: vec![1, 25],
        ..Lists::default()
    };
    let mut campaign = Campaign::new(ScenarioFile::default(), lists, 4, None).unwrap();
    let report = Report::new(&campaign, &[]);
    // Nothing is flown: there are only axes and the paper's dots.
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
    // Each of four curves has a band, and a mark for each of three cells; the legend has two marks.
    assert_eq!(svg.matches("<polygon").count(), 4 + 4 * 3 + 2);
    // Two curves have a ring for each of five published results, and the legend has one.
    let published = "#1E1E1E";
    assert_eq!(svg.matches(published).count(), 2 * 5 + 1);
    assert!(svg.contains("reference, 1 Hz, n = 4") && svg.contains("flight, 1 Hz, n = 4"));
    let strict = success_svg(&report, Rule::Strict).unwrap();
    assert!(strict.contains("Strict success (%)") && !strict.contains("published"));
    // The oracle's curve is in both panels, and in the legend.
    campaign.oracle = true;
    let beside = flown(Report::new(&campaign, &[]));
    let svg = success_svg(&beside, Rule::Strict).unwrap();
    // Two curves more: their bands, three marks each, and one in the legend.
    let strict = strict.matches("<polygon").count();
    assert_eq!(svg.matches("<polygon").count(), strict + 2 * (1 + 3) + 1);
    assert!(svg.contains(">\noracle\n<"));
    // With one number of paths the presets are curves of one panel.
    campaign.paths = vec![25];
    let together = success_svg(&flown(Report::new(&campaign, &[])), Rule::Strict).unwrap();
    assert_eq!(
        together.matches("<polygon").count(),
        3 * (1 + 3) + 3,
        "two presets and the oracle"
    );
    assert!(together.contains("reference, flight, 1 Hz, n = 4"));
}
