//! Tests the parameters that a station reads and writes.

use super::radio::{CONFIG, Radio, command, heard, scenario, write};
use hil_protocol::mavlink::messages::*;
use hil_protocol::{ConfigureVerdict, ParameterVerdict};
use mpp_core::settings::Settings;
use mpp_node::parameters::{PARAMETERS, Tuning};
use mpp_sim::scenario::{Preset, Scenario};
use sil_harness::ground::param_file::values;
use sil_harness::ground::vehicle::VehicleConfig;

fn tuning(preset: Preset) -> Tuning {
    Tuning::new(&Scenario::new(preset, 1).configure()).unwrap()
}

#[test]
fn the_list_is_every_parameter_of_the_preset_as_it_is_flown() {
    for preset in [Preset::Reference, Preset::Paper, Preset::Flight] {
        let mut radio = Radio::new(&CONFIG);
        radio.at(10, &PARAM_REQUEST_LIST_DATA::DEFAULT);
        radio.fly(&Scenario {
            ticks: 100,
            ..Scenario::new(preset, 1)
        });
        let expected: Vec<_> = values(&tuning(preset))
            .map(|(name, value)| (name.to_owned(), value as f32))
            .collect();
        assert_eq!(radio.values(), expected);
        let places = heard!(radio, PARAM_VALUE, |value| (
            value.param_index,
            value.param_count,
            value.param_type
        ));
        for (place, (_, told)) in places.into_iter().enumerate() {
            assert_eq!(told, (place as u16, expected.len() as u16, 9));
        }
    }
}

/// The settings hold every value that is written, and no other field changes.
#[test]
fn each_parameter_is_a_field_of_its_own() {
    let before = tuning(Preset::Flight);
    for (number, parameter) in PARAMETERS.iter().enumerate() {
        let number = number as u8;
        let Some(value) = before.value(number) else {
            continue;
        };
        let other = if parameter.step.is_some() {
            parameter.range[0].max(value + 1.0)
        } else {
            value * 1.25 + 0.5
        };
        let other = other.min(parameter.range[1]);
        // The latency must stay within the period.
        let after = match before.with(number, other, false) {
            Err(ParameterVerdict::SetUp(_)) => before.with(number, 0.5, false).unwrap(),
            after => after.unwrap(),
        };
        assert_ne!(after, before, "{}", parameter.name);
        let moved: Vec<_> = (0..PARAMETERS.len() as u8)
            .filter(|n| after.value(*n) != before.value(*n))
            .collect();
        assert_eq!(moved, [number], "{}", parameter.name);
        let back = after.with(number, value, false).unwrap();
        assert_eq!(back.settings, before.settings, "{}", parameter.name);
    }
}

#[test]
fn refusals_name_their_reason() {
    let tuning = tuning(Preset::Reference);
    let number = |name: &str| PARAMETERS.iter().position(|p| p.name == name).unwrap() as u8;
    let verdict = |name, value, in_flight| tuning.with(number(name), value, in_flight).unwrap_err();
    assert_eq!(verdict("MPP_PATHS", 51.0, false), ParameterVerdict::Range);
    assert_eq!(verdict("MPP_PATHS", -1.0, false), ParameterVerdict::Range);
    assert_eq!(
        verdict("MPP_ALT_M", f64::NAN, false),
        ParameterVerdict::Range
    );
    assert_eq!(verdict("MPP_PATHS", 2.5, false), ParameterVerdict::NotWhole);
    assert_eq!(
        verdict("MPP_REPLAN_S", 0.505, false),
        ParameterVerdict::NotWhole
    );
    assert_eq!(
        verdict("LQR_R_ELEVATOR", 1.0, true),
        ParameterVerdict::InFlight
    );
    // Paths that are tracked without refinement have a cycle of their own.
    assert_eq!(
        verdict("MPP_PATHS", 0.0, true),
        ParameterVerdict::PathsInFlight
    );
    // This preset has hard rows, so it has no penalty.
    assert_eq!(
        verdict("MPP_PEN_LIN", 1.0, false),
        ParameterVerdict::NotInPreset
    );
    assert!(matches!(
        verdict("MPP_LATENCY_S", 2.0, false),
        ParameterVerdict::SetUp(_)
    ));
    assert_eq!(tuning.with(200, 1.0, false), Err(ParameterVerdict::Unknown));
    // The flight planner has no baseline, and its distances from obstacles have other names.
    let flight = self::tuning(Preset::Flight);
    assert_eq!(
        flight.with(number("MPP_PATHS"), 0.0, false),
        Err(ParameterVerdict::SetUp(ConfigureVerdict::PathsZero))
    );
    for name in ["MPP_PAD_NEAR_M", "MPP_PAD_FAR_M"] {
        let verdict = flight.with(number(name), 1.0, false);
        assert_eq!(verdict, Err(ParameterVerdict::NotInPreset));
    }
    // Only preset `flight` uses the actuators' limits. The elevator's range is about one trim.
    assert_eq!(
        verdict("ACT_ELEV_RANGE", 2.0, false),
        ParameterVerdict::NotInPreset
    );
    let flight = self::tuning(Preset::Flight);
    let limited = flight.with(number("ACT_ELEV_RANGE"), 2.0, false).unwrap();
    assert!(flight.with(number("MPP_CRUISE_MS"), 14.0, false).is_ok());
    assert_eq!(
        limited.with(number("MPP_CRUISE_MS"), 14.0, false),
        Err(ParameterVerdict::CruiseFixed)
    );
}

#[test]
fn a_refused_write_is_answered_with_the_value_in_force() {
    let mut radio = Radio::new(&CONFIG);
    radio
        .at(100, &write("MPP_PATHS", 51.0))
        .at(110, &write("MPP_PATHS", f32::NAN))
        .at(120, &write("LQR_R_ELEVATOR", 0.7))
        .at(130, &write("MPP_PATHS", 12.0))
        .at(140, &write("NO_SUCH_THING", 1.0));
    // This preset refines as many candidates as the parameter says.
    let log = radio.fly(&Scenario {
        ticks: 1200,
        ..Scenario::new(Preset::Paper, 1)
    });
    let told = |name: &str, value| (name.to_owned(), value);
    let expected = [
        told("MPP_PATHS", 25.0),
        told("MPP_PATHS", 25.0),
        told("LQR_R_ELEVATOR", 0.5),
        told("MPP_PATHS", 12.0),
    ];
    assert_eq!(radio.values(), expected);
    let texts: Vec<_> = radio.texts().into_iter().map(|(_, text)| text).collect();
    for expected in [
        "MPP_PATHS: out of range",
        "LQR_R_ELEVATOR: not in flight",
        "NO_SUCH_THING: no such parameter",
    ] {
        assert!(texts.iter().any(|text| text == expected), "{texts:?}");
    }
    assert_eq!(log.orders.len(), 1);
    // The value holds from the next cycle on.
    assert!(
        log.plans
            .iter()
            .all(|plan| plan.candidates == if plan.tick < 130 { 25 } else { 12 })
    );
}

/// The core is asked before the flight, so a value with which it cannot fly is refused in time.
#[test]
fn a_value_that_the_core_cannot_fly_with_is_refused_before_the_flight() {
    let mut radio = Radio::new(&VehicleConfig {
        hold: true,
        ..CONFIG
    });
    radio
        .at(-1, &write("MPP_CRUISE_MS", 20.0))
        .at(-1, &write("LQR_Q_PATH", 800.0))
        .at(-1, &write("MPP_LATENCY_S", 2.0))
        .at(-1, &command(400, 1.0, 0.0));
    radio.fly(&scenario());
    let values = radio.values();
    assert_eq!(values[1], ("LQR_Q_PATH".to_owned(), 800.0));
    assert_eq!(values[2], ("MPP_LATENCY_S".to_owned(), 0.01));
}

#[test]
fn a_new_altitude_is_flown_to() {
    let empty = Scenario {
        obstacles: 0,
        ticks: 2000,
        ..Scenario::new(Preset::Flight, 3)
    };
    let mut radio = Radio::new(&CONFIG);
    radio.at(200, &write("MPP_ALT_M", 56.0));
    let log = radio.fly(&empty);
    let last = log.ticks.z.last().unwrap();
    // The plan's weights bring the aircraft there slowly.
    assert!((52.5..57.0).contains(last), "{last}");
}

#[test]
fn the_settings_of_a_preset_are_its_parameters() {
    assert_eq!(
        tuning(Preset::Flight).settings.regulator,
        Settings::flight().regulator
    );
}
