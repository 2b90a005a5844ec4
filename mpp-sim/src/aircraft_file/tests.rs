mod loops;

use super::*;
use mpp_core::settings::{Aircraft, Settings};
use mpp_core::units::Units;
use mpp_core::vehicle::{ActuatorLimits, Airframe};

fn known(name: &str) -> AircraftModel {
    AircraftModel::new(AircraftFile::known(name).unwrap()).unwrap()
}

#[test]
fn every_known_aircraft_flies_level_and_is_told_to_the_core() {
    for (name, _) in AircraftFile::KNOWN {
        let model = known(name);
        assert_eq!(model.file.name, name);
        assert!((model.known.cruise - model.trim.state.airspeed).abs() < 1e-12);
        // A log holds the aircraft as JSON.
        let text = serde_json::to_string(&model.file).unwrap();
        assert_eq!(
            serde_json::from_str::<AircraftFile>(&text).unwrap(),
            model.file
        );
    }
}

#[test]
fn the_first_two_are_those_of_the_core_to_the_last_bit() {
    assert_eq!(known("reference").known, Aircraft::REFERENCE);
    assert_eq!(known("paper").known.airframe, Airframe::PAPER);
}

/// Published derivatives, by hand: C_mq c / 2v, and an elevator per degree.
#[test]
fn derivatives_are_converted() {
    let airframe = known("aerosonde").known.airframe;
    let damping = -3.6 * 0.18994 / (2.0 * 25.0);
    assert!((airframe.moment_pitch_rate - damping).abs() < 1e-15);
    assert!((airframe.moment_elevator + 0.5 / 57.295_779_513).abs() < 1e-9);
    assert!((airframe.lift_elevator + 0.36 / 57.295_779_513).abs() < 1e-9);
}

/// The rows of a table: what stands in the example, what stands there instead, and what follows.
fn rows(table: &str) -> impl Iterator<Item = [&str; 3]> {
    let rows = table.lines().filter(|row| row.contains('|'));
    rows.map(|row| {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        cells.try_into().unwrap()
    })
}

/// Changes of the example, and the key that is refused.
const NONSENSE: &str = r"
mass = 2.0 | mass = -2.0 | aircraft.mass
mass = 2.0 | mass = nan | aircraft.mass
cruise = 15.0 | cruise = 0.0 | aircraft.cruise
alpha = -0.9 | alpha = 0.1 | aircraft.moment.alpha
moment = -1.0 | moment = 0.0 | aircraft.elevator.moment
max = 20.0 | max = -5.0 | aircraft.elevator.max
max = 10.0 | max = 0.5 | aircraft.thrust.max
stall = 0.24 | stall = 0.01 | aircraft.lift.stall
pitch_rate = -10.0 | pitch_rate = 10.0 | aircraft.moment.pitch_rate
body_radius = 0.15 | body_radius = -1.0 | aircraft.body_radius
lag = 0.1 | lag = inf | aircraft.thrust.lag
# Wider than the planner's clearance field.
body_radius = 0.15 | body_radius = 30.0 | aircraft.body_radius
span = 1.5 | span = 0.0 | aircraft.lateral.span
product_inertia = 0.01 | product_inertia = 0.2 | aircraft.lateral.product_inertia
aileron = 0.17 | aileron = -0.17 | aircraft.lateral.roll.aileron
rudder = 0.08 | rudder = -0.08 | aircraft.lateral.yaw.rudder
roll_rate = -0.45 | roll_rate = 0.1 | aircraft.lateral.roll.roll_rate
yaw_rate = -0.12 | yaw_rate = inf | aircraft.lateral.yaw.yaw_rate
damping = 1.0 | damping = 0.0 | aircraft.lateral.aileron.damping
# So fast that a regulator of 100 Hz does not hold it.
pitch_inertia = 0.08 | pitch_inertia = 0.00002 | aircraft";

/// The same with more than a line.
const WITHOUT: [[&str; 3]; 3] = [
    [
        "[lateral.rudder]\nrange = 25.0\nrate = 300.0\nbandwidth = 30.0",
        "",
        "aircraft.lateral.side.rudder",
    ],
    ["\nrudder = -0.2", "", "aircraft.lateral.side.rudder"],
    ["\nrudder = 0.08", "", "aircraft.lateral.yaw.rudder"],
];

/// Changes that make the example no aircraft file, and what is told.
const UNREADABLE: &str = r#"
mass = 2.0 | | my.toml: missing field `mass`
yaw_rate = -0.12 | | my.toml: table [lateral.yaw]: missing field `yaw_rate`
yaw_inertia = 0.17 | | my.toml: table [lateral]: missing field `yaw_inertia`
mass = 2.0 | mas = 2.0 | unknown field `mas`
unit = "deg" | unit = "degrees" | unknown variant `degrees`"#;

/// Changes of the example, and key and range that are told.
const OUT_OF_RANGE: &str = r"
mass = 2.0 | mass = 2e6 | mass: give 0.01 to 1000000 kg
wing_area = 0.3 | wing_area = 3e4 | wing_area: give 0.001 to 1000 m^2
chord = 0.2 | chord = 200.0 | chord: give 0.001 to 100 m
zero = 0.2 | zero = 9.0 | lift.zero: give -5 to 5
alpha_rate = 1.5 | alpha_rate = 1e3 | lift.alpha_rate: give -0.4 to 0.4 1/rad, times 4 mass
alpha_rate = -3.0 | alpha_rate = 3.0 | moment.alpha_rate: give -100 to 0
alpha_rate = -3.0 | alpha_rate_time = 3.0 | moment.alpha_rate_time: give -100 to 0 s/rad
lift = 0.35 | lift = 1e4 | elevator.lift: give -100 to 100 per unit
min = -25.0 | min = nan | elevator.min: give 0.001 to 10000 units below
max = 20.0 | max = inf | elevator.max: give 0.001 to 10000 units above
rate = 300.0 | rate = 0.0 | elevator.rate: give 0.001 to 1000000 units/s
stall = 0.24 | stall = 2.0 | lift.stall: give 0.001 to 1.5 rad above
lag = 0.1 | lag = 0.0001 | thrust.lag: give 0.001 to 60 s
# Plans may not turn the wing by so much.
alpha = 4.8 | alpha = 0.1 | lift.alpha: it gives the planner";

#[test]
fn nonsense_is_refused_by_the_name_of_its_key() {
    let usual = include_str!("../../../aircraft/example.toml");
    for [from, to, key] in rows(NONSENSE).chain(WITHOUT) {
        let text = usual.replacen(from, to, 1);
        assert_ne!(text, usual, "{from}");
        let error = AircraftModel::new(AircraftFile::parse("a", &text).unwrap()).unwrap_err();
        assert!(
            error.to_string().starts_with(&format!("{key}: ")),
            "{error}"
        );
    }
    for [from, to, named] in rows(UNREADABLE) {
        let error = AircraftFile::parse("my.toml", &usual.replacen(from, to, 1)).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("my.toml") && text.contains(named), "{text}");
        let missing = named.contains("missing");
        assert!(!missing || text.lines().count() == 1, "{text}");
    }
}

/// Every number of the vertical plane that is out of its range is refused by its key and range, and so is a sum of two keys.
#[test]
fn a_number_out_of_range_is_refused_with_the_range() {
    let usual = include_str!("../../../aircraft/example.toml");
    for [from, to, told] in rows(OUT_OF_RANGE) {
        let text = usual.replacen(from, to, 1);
        assert_ne!(text, usual, "{from}");
        let error = AircraftModel::new(AircraftFile::parse("a", &text).unwrap()).unwrap_err();
        let error = error.to_string();
        assert!(error.starts_with(&format!("aircraft.{told}")), "{error}");
    }
}

/// What follows from cruise and mass alone is in range at the ends of theirs.
#[test]
fn the_units_of_an_aircraft_are_in_range_where_cruise_and_mass_are() {
    for (cruise, mass, wing_area) in [(1.0, 0.01, 0.1), (300.0, 1e6, 130.0), (20.0, 0.01, 1e-3)] {
        let aircraft = Aircraft {
            airframe: Airframe {
                mass,
                wing_area,
                ..Airframe::REFERENCE
            },
            cruise,
            ..Aircraft::REFERENCE
        };
        let settings = Settings::flight_of(&aircraft, &ActuatorLimits::NONE);
        assert_eq!(settings.out_of_range(), None, "{cruise} m/s, {mass} kg");
    }
}

/// The motor of an aircraft with much drag is as strong as the file says, and not as plans of the reference aircraft are.
#[test]
fn the_thrust_of_a_file_carries_level_flight() {
    let mut file = AircraftFile::known("example").unwrap();
    file.drag.zero = 0.6;
    file.thrust.max = Some(40.0);
    let model = AircraftModel::new(file.clone()).unwrap();
    let needed = model.trim.control.thrust;
    let plans = model.settings().planner.plane().unwrap().thrust_max;
    assert!(needed > 0.7 * 2.0 * 9.81, "{needed}");
    assert!((plans - 40.0).abs() < 1e-12);
    for (most, refused) in [
        (Some(1.01 * needed), false),
        (Some(0.99 * needed), true),
        (None, true),
    ] {
        file.thrust.max = most;
        let told = AircraftModel::new(file.clone()).map_err(|error| error.to_string());
        let advice = format!("aircraft.thrust.max: level flight at `cruise` needs {needed:.2} N");
        assert_eq!(
            told.is_err_and(|error| error.starts_with(&advice)),
            refused,
            "{most:?}"
        );
    }
}

/// The files of a flight have the aircraft's name in theirs.
#[test]
fn a_name_that_no_file_can_have_is_refused() {
    let named = |name: &str| {
        let name = name.to_owned();
        let example = AircraftFile::known("example").unwrap();
        AircraftModel::new(AircraftFile { name, ..example })
    };
    for name in ["", "a/b", "..\\a", "a\nb", "a\0", &"a".repeat(65)] {
        let error = named(name).unwrap_err().to_string();
        assert!(
            error.starts_with("aircraft.name: give 1 to 64 bytes"),
            "{error}"
        );
    }
    for name in ["a", "Šidlo 2, left wing", &"a".repeat(64)] {
        assert_eq!(named(name).unwrap().file.name, name);
    }
}

/// In own units similar aircraft have the same numbers, and so have their settings.
#[test]
fn similar_aircraft_are_one_aircraft_in_own_units() {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    let file = AircraftFile::known("example").unwrap();
    let own = |scale: f64| {
        let model = AircraftModel::new(file.similar(scale)).unwrap();
        let units: Units = model.units();
        let settings = model.settings();
        let flight = units.own_settings(settings.planner.plane().unwrap());
        let a = units.own_airframe(&model.known.airframe);
        [
            a.mass,
            a.pitch_inertia,
            a.wing_area,
            a.moment_length,
            a.air_density,
            a.moment_pitch_rate,
            flight.margin,
            flight.body_radius,
            flight.band,
            flight.thrust_max,
            units.own_actuators(&model.actuators).elevator_rate.unwrap(),
            settings.regulator.elevator,
            settings.cross_track * units.length,
        ]
    };
    let first = own(1.0);
    for scale in [0.25, 4.0, 16.0] {
        for (index, (a, b)) in first.into_iter().zip(own(scale)).enumerate() {
            assert!(near(a, b), "{scale}, number {index}: {a} and {b}");
        }
    }
}

/// The unit of the command changes the command, and nothing else.
#[test]
fn the_unit_of_the_command_is_a_unit() {
    for name in ["reference", "example", "cessna182"] {
        let file = AircraftFile::known(name).unwrap();
        let model = AircraftModel::new(file.clone()).unwrap();
        let other = AircraftModel::new(file.with_command(7.0)).unwrap();
        let (one, many) = (model.trim.control.elevator, other.trim.control.elevator);
        assert!((many - 7.0 * one).abs() < 1e-9 * many.abs().max(1.0));
        let unit = other.known.elevator_unit() / model.known.elevator_unit();
        assert!((unit - 7.0).abs() < 1e-9);
        let (a, b) = (model.settings(), other.settings());
        let weights = a.regulator.elevator / b.regulator.elevator;
        assert!((weights - 49.0).abs() < 1e-6);
        assert_eq!(a.planner.weights, b.planner.weights);
    }
}

/// A log of a flight in the vertical plane says nothing about turns.
#[test]
fn the_vertical_plane_does_without_the_lateral_table() {
    let file = AircraftFile::known("example").unwrap();
    let lateral = file.lateral.unwrap().airframe();
    assert!((lateral.roll.aileron - 0.17).abs() < 1e-15);
    let plane = known("example").plane().file;
    assert_eq!(plane.lateral, None);
    assert_eq!(
        AircraftModel::new(plane).unwrap().known,
        known("example").known
    );
}
