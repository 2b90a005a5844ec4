//! Whole flights with faults: what each fault does between the aircraft and the core.
#![expect(
    clippy::float_cmp,
    reason = "a command is the same one or another one, to the last bit"
)]

use mpp_sim::flight::{FlyError, fly};
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Scenario, ScenarioFile};

fn scenario(text: &str) -> Scenario {
    let base = "seed = 3\nobstacles = 40\nduration = 4\nreplan_hz = 2.0\n";
    let base = ScenarioFile::parse("base.toml", base).unwrap();
    base.under("test.toml", text).unwrap().build().unwrap()
}

fn flown(text: &str) -> Result<FlightLog, FlyError> {
    let scenario = scenario(text);
    fly(&scenario, &mut PipeLink::of(&scenario), |_| {})
}

fn log(text: &str) -> FlightLog {
    flown(text).unwrap()
}

#[test]
fn a_fault_changes_nothing_before_it_begins_and_is_in_the_header() {
    let clean = log("");
    let text = String::from_utf8(clean.to_json().unwrap()).unwrap();
    assert!(!text.contains("\"clock\"") && !text.contains("\"scan\""));
    for fault in [
        "airspeed]\nfrom = 2.0\nbias = 3.0",
        "pitch]\nfrom = 2.0\nbias = 5.0",
        "x]\nfrom = 2.0\nbias = 5.0",
        "z]\nfrom = 2.0\nbias = 2.0",
        "air]\nfrom = 2.0\nmissing = true",
        "position]\nfrom = 2.0\ndelay_ms = 200",
        "scan]\nfrom = 2.0\nshow = \"zeros\"",
        "scan]\nfrom = 2.0\nrotation_deg = 10.0",
        "elevator]\nfrom = 2.0\nbias = 0.2",
        "thrust]\nfrom = 2.0\nscale = 0.5",
        "link]\nfrom = 2.0\nsilent = true",
        "clock]\nfrom = 2.0\njump = -1.0",
    ] {
        let faulty = log(&format!("[faults.{fault}"));
        assert_eq!(faulty.ticks.x[..200], clean.ticks.x[..200], "{fault}");
        assert_ne!(faulty.ticks.x[201..], clean.ticks.x[201..], "{fault}");
        let again = FlightLog::from_json(&faulty.to_json().unwrap()).unwrap();
        let scenario = scenario(&format!("[faults.{fault}"));
        assert_eq!(again.header.scenario().unwrap(), scenario, "{fault}");
    }
}

#[test]
fn over_a_silent_link_the_aircraft_flies_the_plan_that_it_heard() {
    let log = log("[faults.link]\nfrom = 2.0\nuntil = 3.0\nsilent = true");
    let elevator = &log.ticks.elevator;
    // It keeps the last command for some ticks. Then it flies the plan, whose elevator moves in straight lines.
    let kept = elevator[200..]
        .iter()
        .take_while(|command| **command == elevator[199])
        .count();
    assert_eq!(kept, 7);
    let turns = elevator[207..300]
        .windows(3)
        .filter(|of| (of[2] - 2.0 * of[1] + of[0]).abs() > 1e-9);
    assert!((1..=4).contains(&turns.count()));
    assert_eq!(log.ticks.t.len(), 400);
    let order = log
        .rejections
        .iter()
        .filter(|entry| entry.cause.starts_with("TickOrder"));
    assert_eq!(order.count(), 1, "{:?}", log.rejections);
}

#[test]
fn lost_commands_and_lost_measurements_do_not_stop_a_flight() {
    let log = log("[faults.link]\nloss = 0.5");
    assert_eq!(log.ticks.t.len(), 400);
    let kept = log
        .ticks
        .elevator
        .windows(2)
        .filter(|pair| pair[0] == pair[1]);
    let share = kept.count() as f64 / 399.0;
    // A command is new only if both ways come through.
    assert!((share - 0.75).abs() < 0.1, "{share}");
    // A scan that no command answers is sent again, so that no plan is missing.
    assert_eq!(log.plans.len(), 8);
}

#[test]
fn a_counter_that_passes_its_greatest_number_changes_no_byte_of_the_flight() {
    let clean = log("");
    let wrapped = log("[faults.clock]\nstart = 4294967196");
    assert_eq!(wrapped.ticks, clean.ticks);
    assert_eq!(wrapped.plans, clean.plans);
    assert_eq!(wrapped.rejections, clean.rejections);
}

#[test]
fn a_counter_that_jumps_is_noted_at_the_tick_of_the_flight() {
    for jump in ["1.0", "100.0", "-1.0"] {
        let scenario = scenario(&format!("[faults.clock]\nfrom = 2.0\njump = {jump}"));
        let mut observer = FlightObserver::of(&scenario);
        let log = fly(&scenario, &mut PipeLink::of(&scenario), |record| {
            observer.watch(record);
        });
        let log = log.unwrap();
        assert!(observer.flagged().is_some_and(|time| time < 0.05), "{jump}");
        assert!(
            log.plans.iter().all(|plan| plan.tick < 400),
            "{:?}",
            log.plans
        );
        assert!(
            log.rejections.iter().all(|entry| entry.tick < 400),
            "{jump}"
        );
    }
}

#[test]
fn a_stuck_elevator_and_a_lost_motor_act_and_the_commands_go_on() {
    let stuck = log("[faults.elevator]\nfrom = 2.0\nuntil = 3.0\nfrozen = true");
    let applied = &stuck.ticks.applied_elevator;
    assert!(applied[200..300].iter().all(|value| *value == applied[200]));
    assert_eq!(applied[300..], stuck.ticks.elevator[300..]);
    let lost = log("[faults.thrust]\nfrom = 2.0\nuntil = 3.0\nscale = 0.0");
    assert!(
        lost.ticks.applied_thrust[200..300]
            .iter()
            .all(|value| *value == 0.0)
    );
    let trim = scenario("").trim().unwrap().control.elevator;
    let weak = log("[faults.elevator]\nscale = 0.25");
    for (given, asked) in weak.ticks.applied_elevator.iter().zip(&weak.ticks.elevator) {
        assert!((given - trim - 0.25 * (asked - trim)).abs() < 1e-12);
    }
}
