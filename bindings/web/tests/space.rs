//! The answers of the desk in space, on the host: the flight of the simulation, with trees, and an error for every bad question.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

use mpp_sim::space::{SpaceFile, fly_space};
use mpp_web::space::Desk;
use serde_json::{Value, json};

/// The core is built on the stack.
fn aside(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(mpp_sim::space::STACK);
    thread.spawn(work).unwrap().join().unwrap();
}

#[expect(
    clippy::needless_pass_by_value,
    reason = "questions are written where they are asked"
)]
fn ask(desk: &mut Desk, question: Value) -> Value {
    serde_json::from_slice(&desk.answer(question.to_string().as_bytes())).unwrap()
}

fn begin(desk: &mut Desk, orders: &Value) -> Value {
    let scenario = json!({ "seed": 5, "density": 0.005 });
    ask(
        desk,
        json!({ "ask": "begin", "scenario": scenario, "orders": orders }),
    )
}

fn fly(desk: &mut Desk, ticks: u32, orders: &[Value]) -> Value {
    ask(
        desk,
        json!({ "ask": "fly", "ticks": ticks, "orders": orders }),
    )
}

#[test]
fn its_flight_is_the_simulations_and_shows_what_it_sees_and_plans() {
    aside(|| {
        let file = SpaceFile {
            seed: Some(5),
            density: Some(0.005),
            ..SpaceFile::default()
        };
        let expected = fly_space(&file.build(None).unwrap()).unwrap();
        let mut desk = Desk::new(|| 0.0);
        let begun = begin(&mut desk, &json!([]));
        let trunks = begun["trunks"].as_array().unwrap().len();
        assert_eq!(trunks, expected.header.obstacles);
        let flown = fly(&mut desk, 60, &[]);
        assert_eq!(flown["states"].as_array().unwrap().len(), 60);
        let cycle = flown["cycles"].as_array().unwrap().last().unwrap();
        assert!(cycle["hits"].as_array().unwrap().len() > 30);
        // The candidates, and the plan, which begins near the aircraft.
        let paths = cycle["paths"].as_array().unwrap();
        assert!((2..=4).contains(&paths.len()));
        let first = paths.last().unwrap()[0][0].as_f64().unwrap();
        let x = flown["states"][50][0][0].as_f64().unwrap();
        assert!((first / 100.0 - x).abs() < 3.0, "{first} {x}");
        assert_eq!(fly(&mut desk, 6000, &[])["ended"], true);
        let log = ask(&mut desk, json!({ "ask": "log" }));
        assert_eq!(log["hash"], expected.hash().unwrap());
    });
}

#[test]
fn trees_of_a_flight_are_planted_again_and_bad_ones_are_refused() {
    aside(|| {
        let tree =
            |x: f64, radius: f64| json!({ "order": "trunk", "x": x, "y": 0.5, "radius": radius });
        let mut live = Desk::new(|| 0.0);
        begin(&mut live, &json!([]));
        let flown = fly(&mut live, 100, &[tree(40.0, 0.3), tree(50.0, -1.0)]);
        assert_eq!(flown["refused"], json!(["out of range"]));
        assert_eq!(flown["orders"].as_array().unwrap().len(), 1);
        fly(&mut live, 200, &[]);
        let mut again = Desk::new(|| 0.0);
        begin(&mut again, &flown["orders"]);
        fly(&mut again, 300, &[]);
        let log = ask(&mut live, json!({ "ask": "log" }));
        assert_eq!(log, ask(&mut again, json!({ "ask": "log" })));
        assert_eq!(log["ticks"], 300);
        for bad in [
            json!({ "ask": "land" }),
            json!({ "ask": "begin", "scenario": { "density": -1 } }),
        ] {
            assert!(ask(&mut live, bad)["error"].is_string());
        }
        assert!(ask(&mut Desk::new(|| 0.0), json!({ "ask": "log" }))["error"].is_string());
    });
}
