//! Logs from strangers: whatever stands in one, it is read or refused, in bounded time and memory.

use mpp_analysis::picture::replay::replay;
use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};
use proptest::prelude::*;
use serde_json::Value;

/// A short flight's log.
fn log() -> Value {
    let scenario = Scenario {
        ticks: 25,
        obstacles: 6,
        paths: 3,
        ..Scenario::new(Preset::Flight, 2)
    };
    let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
    serde_json::to_value(log).unwrap()
}

/// The places of all values below this one, as JSON pointers.
fn places(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                places(value, &format!("{at}/{key}"), found);
            }
        }
        // One element of a column stands for all.
        Value::Array(list) => {
            for (index, value) in list.iter().enumerate().take(2) {
                places(value, &format!("{at}/{index}"), found);
            }
        }
        _ => {}
    }
}

fn hostile() -> impl Strategy<Value = Value> {
    let number = prop_oneof![
        Just(0.0),
        Just(-1.0),
        Just(1e-300),
        Just(1e12),
        Just(4e7),
        Just(1e300),
        Just(-1e300),
        any::<f64>().prop_filter("JSON knows no other", |value| value.is_finite()),
    ];
    prop_oneof![
        number.prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        (0_u64..5000).prop_map(Value::from),
        Just(Value::from(1_u64 << 63)),
        Just(Value::Null),
        Just(Value::Bool(true)),
        Just(Value::from("</script>")),
        Just(Value::Array(Vec::new())),
        Just(Value::Object(serde_json::Map::new())),
    ]
}

/// Reads a log and makes its page, if there is one to be made.
fn look(bytes: &[u8]) {
    if let Ok(log) = FlightLog::from_json(bytes)
        && let Ok((page, _)) = replay(&log, None)
    {
        assert!(page.len() < 100 * (bytes.len() + 10_000));
    }
}

#[test]
fn a_mutated_log_is_read_or_refused() {
    let log = log();
    let mut all = Vec::new();
    places(&log, "", &mut all);
    // Most of a log is columns; most of the harm is in its header.
    let header: Vec<String> = all
        .iter()
        .filter(|at| at.starts_with("/header"))
        .cloned()
        .collect();
    let place = prop_oneof![
        3 => prop::sample::select(header),
        1 => prop::sample::select(all),
    ];
    let mutations = prop::collection::vec((place, hostile()), 1..4);
    let mut runner = proptest::test_runner::TestRunner::new_with_rng(
        ProptestConfig::with_cases(400),
        proptest::test_runner::TestRng::deterministic_rng(Default::default()),
    );
    let result = runner.run(&mutations, |mutations| {
        let mut hostile = log.clone();
        for (place, value) in mutations {
            if let Some(at) = hostile.pointer_mut(&place) {
                *at = value;
            }
        }
        look(hostile.to_string().as_bytes());
        Ok(())
    });
    assert!(result.is_ok(), "{}", result.unwrap_err());
}

#[test]
fn a_log_with_a_damaged_byte_is_read_or_refused() {
    let text = log().to_string().into_bytes();
    for at in (0..text.len()).step_by(97) {
        for byte in [b'0', b'9', b'-', b'"', b'{', b'e', 0xff] {
            let mut damaged = text.clone();
            damaged[at] = byte;
            look(&damaged);
        }
        look(&text[..at]);
    }
}
