use super::super::*;
use crate::scenario::ScenarioFile;
use mpp_core::vehicle::linearize_lateral;

/// ArduPlane's simulated plane with its pitch loop, as a flight log gave it.
const LOOPED: &str = r#"
name = "looped"
derivatives = "radian"
mass = 2.0
wing_area = 0.45
chord = 0.3
air_density = 1.15
cruise = 15.0
body_radius = 0.6
lift = { zero = 0.51, alpha = 5.0, stall = 0.4 }
drag = { zero = 0.084, induced = 0.08 }
thrust = { max = 23.5, lag = 0.3 }
pitch_loop = { frequency = 7.0, damping = 0.84, delay = 0.1, min = -0.25, max = 0.22 }
"#;

/// The elevator is a commanded angle of attack, and the pitch follows it as the loop does.
#[test]
fn a_pitch_loop_stands_for_the_moments() {
    for text in [LOOPED.to_owned(), per_degree()] {
        let model = AircraftModel::new(AircraftFile::parse("looped", &text).unwrap()).unwrap();
        let (a, trim) = (&model.known.airframe, &model.trim);
        let angle = trim.state.angle_of_attack();
        assert!((trim.control.elevator - angle).abs() < 1e-9);
        assert_eq!(model.actuators.elevator_delay, Some(0.1));
        let unit = 0.5 * a.air_density * 225.0 * a.wing_area * a.moment_length / a.pitch_inertia;
        assert!((unit * a.moment_alpha + 49.0).abs() < 1e-9);
        assert!((unit * a.moment_elevator - 49.0).abs() < 1e-9);
        assert!((unit * a.moment_pitch_rate + 2.0 * 0.84 * 7.0).abs() < 1e-9);
    }
}

/// A table of a scenario is read as a file is.
#[test]
fn a_scenario_may_have_an_aircraft_with_a_pitch_loop() {
    let text = format!("[aircraft]{LOOPED}");
    let scenario = ScenarioFile::parse("s.toml", &text)
        .unwrap()
        .build()
        .unwrap();
    let file = AircraftFile::parse("looped", LOOPED).unwrap();
    assert_eq!(scenario.aircraft.file, file);
}

/// Its roll loop besides.
const ROLLED: &str = "roll_loop = { span = 1.4, frequency = 6.0, damping = 0.8, delay = 0.1, max_bank = 0.8, max_rate = 1.2 }";

/// The lateral table is that of the loop, a log holds it, and plans keep its limits.
#[test]
fn a_roll_loop_stands_for_the_lateral_table() {
    let file = AircraftFile::parse("rolled", &format!("{LOOPED}{ROLLED}")).unwrap();
    let text = serde_json::to_string(&file).unwrap();
    assert_eq!(serde_json::from_str::<AircraftFile>(&text).unwrap(), file);
    assert_eq!(
        file.plan_bank().map(f64::to_bits),
        [0.8, 1.2].map(f64::to_bits)
    );
    let model = AircraftModel::new(file).unwrap();
    let lateral = model.file.lateral.as_ref().unwrap().airframe();
    let linear = linearize_lateral(&model.known.airframe, &lateral, &model.trim);
    assert!((linear.a.m22 + 2.0 * 0.8 * 6.0).abs() < 1e-9);
    assert!((linear.b.m21 - 36.0).abs() < 1e-9);
}

/// The same with its lift per degree.
fn per_degree() -> String {
    let lift = format!("alpha = {}", 5.0 * PI / 180.0);
    let text = LOOPED.replace("alpha = 5.0", &lift);
    text.replace("\"radian\"", "\"degree\"")
}

#[test]
fn a_pitch_loop_that_makes_no_sense_is_refused_by_its_key() {
    for (was, is, key) in [
        ("frequency = 7.0", "frequency = 0.0", "pitch_loop.frequency"),
        ("frequency = 7.0", "frequency = nan", "pitch_loop.frequency"),
        ("damping = 0.84", "damping = -1.0", "pitch_loop.damping"),
        ("delay = 0.1", "delay = 0.4", "elevator.delay"),
        ("min = -0.25", "min = 0.2", "elevator.min"),
        (
            "mass = 2.0",
            "mass = 2.0\npitch_inertia = 1.0",
            "pitch_loop",
        ),
    ] {
        assert!(LOOPED.contains(was));
        let text = LOOPED.replace(was, is);
        let file = AircraftFile::parse("looped", &text);
        let error = file.and_then(AircraftModel::new).unwrap_err();
        assert!(error.to_string().contains(key), "{is}: {error}");
    }
    for (was, is, key) in [
        ("span = 1.4", "span = 0.0", "aircraft.roll_loop.span"),
        (
            "frequency = 6.0",
            "frequency = nan",
            "aircraft.roll_loop.frequency",
        ),
        (
            "damping = 0.8",
            "damping = -1.0",
            "aircraft.roll_loop.damping",
        ),
        ("delay = 0.1", "delay = 0.4", "aircraft.roll_loop.delay"),
        (
            "max_bank = 0.8",
            "max_bank = 2.0",
            "aircraft.roll_loop.max_bank",
        ),
        (
            "max_rate = 1.2",
            "max_rate = 0.0",
            "aircraft.roll_loop.max_rate",
        ),
        ("span = 1.4, ", "", "missing field `span`"),
    ] {
        let text = format!("{LOOPED}{}", ROLLED.replace(was, is));
        let file = AircraftFile::parse("rolled", &text);
        let error = file.and_then(AircraftModel::new).unwrap_err();
        assert!(error.to_string().contains(key), "{is}: {error}");
    }
    let example = include_str!("../../../../aircraft/example.toml");
    let (alone, lateral) = example.split_once("[lateral]").unwrap();
    for (text, told) in [
        (format!("{ROLLED}\n{alone}"), "`pitch_loop`, too"),
        (
            format!("{LOOPED}{ROLLED}\n[lateral]{lateral}"),
            "leave out `lateral`",
        ),
    ] {
        let error = AircraftFile::parse("rolled", &text)
            .unwrap_err()
            .to_string();
        assert!(error.contains(told), "{error}");
    }
    let unknown = LOOPED.replace("delay = 0.1", "lag = 0.1");
    let error = AircraftFile::parse("looped", &unknown).unwrap_err();
    assert!(error.to_string().contains("lag"), "{error}");
}
