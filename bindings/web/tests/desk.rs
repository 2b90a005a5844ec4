//! The desk's answers, on the host: the flight of the simulation, and an error for every bad question.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

use mpp_sim::flight::fly;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_web::desk::Desk;
use serde_json::{Value, json};

fn desk() -> Desk {
    Desk::new(|| 0.0)
}

#[expect(
    clippy::needless_pass_by_value,
    reason = "questions are written where they are asked"
)]
fn ask(desk: &mut Desk, question: Value) -> Value {
    serde_json::from_slice(&desk.answer(question.to_string().as_bytes())).unwrap()
}

fn begin(scenario: Value, orders: Value, details: bool) -> Value {
    json!({ "ask": "begin", "scenario": scenario, "orders": orders, "details": details })
}

#[test]
fn its_flight_is_the_simulations_with_and_without_details() {
    let scenario = Scenario {
        ticks: 500,
        ..Scenario::new(Preset::Flight, 7)
    };
    let expected = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap();
    for details in [false, true] {
        let mut desk = desk();
        let question = begin(json!({ "seed": 7, "duration": 5 }), json!([]), details);
        let begun = ask(&mut desk, question);
        assert_eq!(begun["header"]["seed"], 7);
        let (mut ticks, mut plans, mut cycles) = (0, 0, 0);
        loop {
            let flown = ask(&mut desk, json!({ "ask": "fly", "ticks": 70 }));
            ticks += flown["ticks"]["t"].as_array().unwrap().len();
            plans += flown["plans"].as_array().unwrap().len();
            cycles += flown["details"].as_array().unwrap().len();
            if flown["ended"] == true {
                break;
            }
        }
        assert_eq!((ticks, plans), (500, expected.plans.len()));
        assert_eq!(cycles, if details { 5 } else { 0 });
        let log = ask(&mut desk, json!({ "ask": "log" }));
        assert_eq!(log["hash"], expected.hash().unwrap());
        assert_eq!(
            desk.answer(br#"{"ask":"bytes"}"#),
            expected.to_json().unwrap()
        );
    }
}

#[test]
fn orders_now_and_orders_at_their_ticks_give_the_same_flight() {
    let scenario = json!({ "seed": 2, "obstacles": 5, "duration": 4 });
    let circle = json!({ "circle": [{ "x": 30.0, "z": 50.5, "radius": 1.0 }] });
    let order = json!({ "order": "obstacles", "field": circle });
    let wind = json!({ "order": "disturb", "gusts": 1.0 });
    let mut live = desk();
    ask(&mut live, begin(scenario.clone(), json!([]), false));
    ask(&mut live, json!({ "ask": "fly", "ticks": 90 }));
    let flown = ask(
        &mut live,
        json!({ "ask": "fly", "ticks": 310, "orders": [order, wind] }),
    );
    assert_eq!(flown["orders"].as_array().unwrap().len(), 2);
    let mut again = desk();
    ask(&mut again, begin(scenario, flown["orders"].clone(), false));
    ask(&mut again, json!({ "ask": "fly", "ticks": 400 }));
    assert_eq!(
        ask(&mut live, json!({ "ask": "log" })),
        ask(&mut again, json!({ "ask": "log" }))
    );
}

#[test]
fn a_bad_question_gets_an_error_and_the_flight_goes_on() {
    let mut desk = desk();
    for question in ["", "{", "[]", "{\"ask\":\"land\"}", "{\"ask\":\"log\"}"] {
        let answer: Value = serde_json::from_slice(&desk.answer(question.as_bytes())).unwrap();
        assert!(answer["error"].is_string(), "{question}: {answer}");
    }
    ask(&mut desk, begin(json!({ "duration": 3 }), json!([]), false));
    for scenario in [
        json!({ "obstacles": 100_000 }),
        json!({ "aircraft": "kite" }),
        json!({ "sead": 1 }),
        json!({ "replan_hz": 0.37 }),
    ] {
        let answer = ask(&mut desk, begin(scenario, json!([]), false));
        assert!(answer["error"].is_string(), "{answer}");
    }
    let order = json!({ "order": "disturb", "gusts": 99.0 });
    let flown = ask(
        &mut desk,
        json!({ "ask": "fly", "ticks": 10, "orders": [order] }),
    );
    assert_eq!(flown["refused"], json!(["out of range"]));
    assert_eq!(ask(&mut desk, json!({ "ask": "log" }))["ticks"], 10);
}
