//! Whole flights of aircraft from files: in other units, in other sizes, with terms that the core did not know.

use mpp_analysis::aircraft::{AircraftReport, Variant, flown_cells, in_sizes, in_units};
use mpp_core::vehicle::{AirState, Control, StallGuard, Trim, air_rate};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::ScenarioFile;

fn flown(file: &AircraftFile, obstacles: usize, seed: u64) -> FlightLog {
    let model = AircraftModel::new(file.clone()).unwrap();
    let (_, replan_hz) = flown_cells(&[obstacles], model.units().time)[0];
    let scenario = ScenarioFile {
        aircraft: Some(file.clone()),
        obstacles: Some(obstacles),
        replan_hz: Some(replan_hz),
        seed: Some(seed),
        ..ScenarioFile::default()
    };
    let scenario = scenario.build().unwrap();
    fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap()
}

#[test]
fn every_known_aircraft_flies_past_scaled_obstacles() {
    for (name, _) in AircraftFile::KNOWN {
        let file = AircraftFile::known(name).unwrap();
        for seed in [50_000, 50_001] {
            let log = flown(&file, 20, seed);
            assert!(log.summary.strict, "{name}, seed {seed}: {:?}", log.summary);
        }
    }
}

fn brought(name: &str, text: &str) -> AircraftFile {
    AircraftFile::parse(name, text).unwrap()
}

/// From a wing of 2 m to an airliner of 288 t, which needs 17 km of sight.
#[test]
fn published_aircraft_fly_past_scaled_obstacles() {
    for text in [
        include_str!("../aircraft/navion.toml"),
        include_str!("../aircraft/b747-cruise.toml"),
        include_str!("../aircraft/hansa3.toml"),
        include_str!("../aircraft/f16-fwd.toml"),
    ] {
        let file = brought("published", text);
        let log = flown(&file, 20, 780_000);
        assert!(log.summary.strict, "{}: {:?}", file.name, log.summary);
    }
}

/// Heavy damping: a third of the elevator's moment turns the aircraft, the rest turns against the damping.
#[test]
fn a_heavily_damped_aircraft_flies_an_empty_sky() {
    let text = include_str!("../aircraft/skywalker2013.toml");
    let file = brought("skywalker2013", text);
    for seed in 770_124..770_130 {
        let log = flown(&file, 0, seed);
        assert!(log.summary.strict, "seed {seed}: {:?}", log.summary);
    }
}

/// It answers its elevator within seconds. What has not come within the reference aircraft's times is not missing: a watch that
/// thought so doubled the commands, and stalled the wing.
#[test]
fn the_elevator_of_a_slow_aircraft_is_not_suspected() {
    let file = brought("stol", include_str!("../aircraft/stol.toml"));
    for seed in [781_516, 781_517, 781_521] {
        let log = flown(&file, 20, seed);
        assert!(log.summary.strict, "seed {seed}: {:?}", log.summary);
        assert!(log.sensors.is_empty(), "seed {seed}: {:?}", log.sensors);
    }
}

/// Its greatest lift is 1.29 times that of level flight, and climbs make it slow.
#[test]
fn a_wing_with_little_lift_in_hand_does_not_creep_into_the_stall() {
    let stol = brought("stol", include_str!("../aircraft/stol.toml"));
    let strict = |seed| flown(&stol, 20, seed).summary.strict;
    let passed = (780_030..780_050).filter(|seed| strict(*seed)).count();
    assert!(passed >= 19, "{passed} of 20");
}

/// The wing pitches up half way to the stall, fast enough to swing through, and the elevator is asked for all it has.
#[test]
fn the_guard_stops_a_wing_that_swings_up_before_the_stall() {
    let stol = brought("stol", include_str!("../aircraft/stol.toml"));
    let known = AircraftFile::KNOWN.iter();
    let known = known.map(|(name, _)| AircraftFile::known(name).unwrap());
    let mut guarded = 0;
    for file in known.chain([stol]) {
        let model = AircraftModel::new(file.clone()).unwrap();
        let a = model.known.airframe;
        let Some(stall) = model.known.stall else {
            continue;
        };
        let trim = Trim::at_speed(&a, model.known.cruise, 0.0).unwrap();
        let guard = StallGuard::new(stall, &a, &trim);
        let mut worst = 0.0_f64;
        for elevator in [file.elevator.min, file.elevator.max].into_iter().flatten() {
            let mut air = trim.state;
            air.pitch += 0.5 * stall;
            air.pitch_rate = 1.5 * stall / model.units().time;
            for _ in 0..150 {
                let asked = Control {
                    elevator,
                    ..trim.control
                };
                let rate = air_rate(&a, &air, guard.within(asked, &air)).to_vector();
                air = AirState::from_vector(&(air.to_vector() + rate * 0.01));
                worst = worst.max(air.angle_of_attack() - trim.state.angle_of_attack());
            }
        }
        println!("{}: {:.3} of the stall", file.name, worst / stall);
        assert!(worst < 0.9 * stall, "{}: {worst} of {stall} rad", file.name);
        guarded += 1;
    }
    assert!(guarded >= 5, "{guarded} aircraft have a stall");
}

#[test]
fn the_unit_of_the_command_does_not_matter() {
    let file = AircraftFile::known("example").unwrap();
    for Variant { name, file } in in_units(&file) {
        for seed in 50_000..50_003 {
            assert!(flown(&file, 20, seed).summary.strict, "{name}, seed {seed}");
        }
    }
}

#[test]
fn similar_aircraft_fly_alike() {
    let file = AircraftFile::known("reference").unwrap();
    for Variant { name, file } in in_sizes(&file) {
        for seed in 50_000..50_003 {
            assert!(flown(&file, 20, seed).summary.strict, "{name}, seed {seed}");
        }
    }
}

/// The report of the reference aircraft has the numbers that are known of it, and no doubt; a file with slips
/// of the pen is flown if it can be, and doubted by the names of its keys.
#[test]
fn a_report_tells_what_follows_and_what_is_implausible() {
    let report = |file: AircraftFile| AircraftReport::new(&AircraftModel::new(file).unwrap());
    let reference = report(AircraftFile::known("reference").unwrap());
    assert!(reference.doubts.is_empty(), "{:?}", reference.doubts);
    assert!((reference.elevator - 3.749).abs() < 1e-3);
    assert!((reference.length_unit - 1.0).abs() < 1e-15);
    assert!((reference.turn_radius - 18.2).abs() < 0.1);

    let mut odd = AircraftFile::known("example").unwrap();
    odd.pitch_inertia *= 100.0;
    odd.air_density = 1.6;
    odd.thrust.max = Some(1.05 * report(odd.clone()).thrust);
    let keys: Vec<&str> = report(odd).doubts.iter().map(|doubt| doubt.key).collect();
    for key in ["pitch_inertia", "air_density", "thrust.max"] {
        assert!(keys.contains(&key), "{key} of {keys:?}");
    }
}

/// Each change of the template gives a doubt; the template has none.
#[test]
fn a_slip_of_the_pen_is_doubted_by_its_key() {
    type Change = fn(&mut AircraftFile);
    let changes: [(Change, &str, &str); 4] = [
        // The span is in the file, or follows from the wing.
        (
            |it| (it.pitch_inertia, it.lateral.as_mut().unwrap().span) = (2.0 * 0.75 * 0.75, 1.88),
            "pitch_inertia",
            "a radius of gyration of 0.750 m does not fit a span of 1.88 m",
        ),
        (
            |it| (it.pitch_inertia, it.lateral) = (2.0 * 0.75 * 0.75, None),
            "pitch_inertia",
            "a radius of gyration of 0.750 m does not fit a span of 1.55 m",
        ),
        (
            |it| (it.elevator.min, it.elevator.max) = (Some(-250.0), Some(200.0)),
            "elevator.moment",
            "of angle of attack: check",
        ),
        // A glider of 44 g.
        (
            |it| {
                *it = it.similar(0.28);
                (it.wing_area, it.cruise) = (0.047, 4.95);
            },
            "cruise",
            "a radius of 0.17 m, and positions of `rtk` err by 0.054 m",
        ),
    ];
    for (change, key, what) in changes {
        let mut file = AircraftFile::known("example").unwrap();
        change(&mut file);
        let report = AircraftReport::new(&AircraftModel::new(file).unwrap());
        let told = report.doubts.iter().find(|doubt| doubt.key == key);
        let told = told.map(|doubt| doubt.what.as_str()).unwrap_or_default();
        assert!(told.contains(what), "{key}: {:?}", report.doubts);
    }
    let template = AircraftModel::new(AircraftFile::known("example").unwrap()).unwrap();
    assert_eq!(AircraftReport::new(&template).doubts, vec![]);
}

/// An airliner with mass, inertia and wing of a Boeing 747; its derivatives are about those of airliners.
#[test]
fn an_airliner_is_no_nonsense() {
    let text = r#"
        name = "747"
        derivatives = "radian"
        mass = 288772.0
        pitch_inertia = 4.49e7
        wing_area = 511.0
        chord = 8.3
        air_density = 0.302
        cruise = 265.5
        lift = { zero = 0.2, alpha = 5.7 }
        drag = { zero = 0.02, induced = 0.05 }
        moment = { zero = 0.0, alpha = -1.26, pitch_rate = -24.0, alpha_rate = -3.2 }
        elevator = { unit = "deg", moment = -1.4, lift = 0.34, min = -25.0, max = 20.0, rate = 40.0 }
        thrust = { max = 800000.0, lag = 2.0 }
    "#;
    let file = AircraftFile::parse("747.toml", text).unwrap();
    let report = AircraftReport::new(&AircraftModel::new(file).unwrap());
    assert_eq!(report.doubts, vec![]);
    // By hand: the root of `-C_ma q S c / I_yy`, and more by the damping.
    let pressure = 0.5 * 0.302 * 265.5 * 265.5;
    let stiffness: f64 = 1.26 * pressure * 511.0 * 8.3 / 4.49e7;
    let frequency = report.modes.short_period.frequency;
    assert!(
        (1.0..1.2).contains(&(frequency / stiffness.sqrt())),
        "{frequency}"
    );
}

/// The roll modes of published tables against `2 J_x / (rho v S b^2 C_lp / 2)` by hand, and the greatest roll rates against
/// `C_la / C_lp range 2 v / b`; the circles against `v^2 / (g tan bank)`.
#[test]
fn lateral_reports_are_those_of_the_published_tables() {
    for (name, roll_time, roll_rate) in [
        ("aerosonde", 0.0863, 132.8),
        ("aerosonde2", 0.0440, 143.9),
        ("zagi", 0.1424, 331.6),
        ("x8", 0.0323, 153.0),
        ("ultrastick", 0.0614, 245.1),
        ("rascal", 0.1404, 93.0),
    ] {
        let model = AircraftModel::new(AircraftFile::known(name).unwrap()).unwrap();
        let report = AircraftReport::new(&model).lateral.unwrap();
        let near = |is: f64, expected: f64| (is / expected - 1.0).abs() < 0.05;
        let time = report.modes.roll_time.unwrap();
        assert!(near(time, roll_time), "{name}: {time} s");
        let rate = report.roll_rate_deg;
        assert!(near(rate, roll_rate), "{name}: {rate} deg/s");
        let circle = model.known.cruise.powi(2) / 9.81;
        assert!(near(report.turns[1].radius, circle), "{name}");
        assert!(report.turns[0].carried && report.smallest.unwrap().carried);
    }
}

/// The inertia of the X8 as printed belongs to no body, and the book's rudder of the Aerosonde pushes to the wrong side.
#[test]
fn implausible_lateral_tables_are_doubted_by_key() {
    let keys = |file: AircraftFile| {
        let model = AircraftModel::new(file).unwrap();
        let report = AircraftReport::new(&model);
        report.doubts.iter().map(|it| it.key).collect::<Vec<_>>()
    };
    let mut x8 = AircraftFile::known("x8").unwrap();
    assert_eq!(keys(x8.clone()), Vec::<&str>::new());
    let lateral = x8.lateral.as_mut().unwrap();
    lateral.roll_inertia = 1.229;
    lateral.yaw_inertia = 0.8808;
    lateral.product_inertia = 0.9343;
    let doubted = keys(x8);
    for key in ["lateral.yaw_inertia", "lateral.product_inertia"] {
        assert!(doubted.contains(&key), "{doubted:?}");
    }
    assert_eq!(
        keys(AircraftFile::known("aerosonde").unwrap()),
        ["lateral.side.rudder"]
    );
    assert_eq!(
        keys(AircraftFile::known("reference").unwrap()),
        Vec::<&str>::new()
    );
    let zagi = keys(AircraftFile::known("zagi").unwrap());
    assert!(zagi.contains(&"lateral.yaw.aileron"), "{zagi:?}");
    let without = AircraftFile {
        lateral: None,
        ..AircraftFile::known("example").unwrap()
    };
    assert_eq!(
        AircraftReport::new(&AircraftModel::new(without).unwrap()).lateral,
        None
    );
}
