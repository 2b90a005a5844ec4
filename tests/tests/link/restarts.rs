//! Tests a core that restarts at any moment.

use super::{Spoilt, causes, short};
use hil_protocol::{Hello, Message, Role, id};
use mpp_sim::flight::{FlyError, fly_with};
use mpp_sim::link::Link;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Again, Ground, Order, OrderEntry};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};

/// Restarts the core, which then says hello like a core after a reset.
fn restart(pipe: &mut PipeLink) {
    *pipe = PipeLink::new();
    let hello = Hello {
        role: Role::Harness,
        software: [0; 3],
        tick_period_us: 10_000,
        beams_max: 100,
        stages: 18,
    };
    assert!(pipe.send(&Message::Hello(hello)).is_ok());
}

/// Orders another number of paths before the flight, and another period in it.
fn orders() -> Vec<OrderEntry> {
    let order = |tick, name: &str, value| OrderEntry {
        tick,
        order: Order::Parameter {
            name: name.to_owned(),
            value,
        },
    };
    vec![
        order(0, "MPP_PATHS", 12.0),
        order(0, "LQR_R_ELEVATOR", 0.7),
        order(150, "MPP_REPLAN_S", 0.5),
    ]
}

/// Flies with these orders. The core restarts before it sees the messages that `when` selects. With
/// `lost` these messages are lost; otherwise they reach the core that has just started.
fn fly_through(lost: bool, mut when: impl FnMut(&Message) -> bool) -> Result<FlightLog, FlyError> {
    struct Nobody;
    impl Ground for Nobody {}
    let mut link = Spoilt {
        pipe: PipeLink::new(),
        spoil: |pipe: &mut PipeLink, message: &Message| {
            let now = when(message);
            if now {
                restart(pipe);
            }
            now && lost
        },
    };
    // This preset refines as many candidates as the parameter says.
    let scenario = Scenario {
        ticks: 400,
        ..Scenario::new(Preset::Paper, 2)
    };
    fly_with(
        &scenario,
        &mut link,
        &mut Again::new(Some(orders()), Nobody),
    )
}

/// Returns `true` for the messages of a kind at these places, counted from 0.
fn places(kind: u8, places: Vec<usize>) -> impl FnMut(&Message) -> bool {
    let mut count = 0;
    move |message| {
        let of_kind = message.id() == kind;
        count += usize::from(of_kind);
        of_kind && places.contains(&(count - 1))
    }
}

#[test]
fn a_core_that_restarts_in_flight_is_configured_anew_and_flies_on() {
    let mut link = Spoilt {
        pipe: PipeLink::new(),
        spoil: {
            let mut when = places(id::SENSOR_FRAME, vec![70]);
            move |pipe: &mut PipeLink, message: &Message| {
                let now = when(message);
                if now {
                    restart(pipe);
                }
                now
            }
        },
    };
    let log = mpp_sim::flight::fly(&short(2), &mut link, |_| {}).unwrap();
    assert_eq!(causes(&log), ["CoreRestarted"]);
    assert_eq!(log.ticks.t.len(), 500);
    // The first plan was lost with the core. The new core holds level trim until the next plan.
    let tracked = |tick: usize| log.ticks.ref_x[tick].is_some();
    assert!(tracked(69) && !tracked(70) && !tracked(99) && tracked(110));
}

/// The core restarts at every message that has an answer: before the flight, in it, and while the
/// core is told its values again. Every lost question is asked again of the next core.
#[test]
fn no_restart_loses_an_order() {
    let undisturbed = fly_through(true, |_| false).unwrap();
    assert_eq!(undisturbed.orders, orders());
    let cases: [(&str, u8, Vec<usize>, usize); 9] = [
        ("the configuration", id::CONFIGURE, vec![0], 0),
        ("the first value", id::SET_PARAMETER, vec![0], 1),
        ("the second value", id::SET_PARAMETER, vec![1], 1),
        ("the value in flight", id::SET_PARAMETER, vec![2], 1),
        (
            "the value in flight, twice",
            id::SET_PARAMETER,
            vec![2, 5],
            2,
        ),
        ("a value told again", id::SET_PARAMETER, vec![2, 3], 2),
        ("another value told again", id::SET_PARAMETER, vec![2, 4], 2),
        ("a tick", id::SENSOR_FRAME, vec![250], 1),
        ("a scan", id::LIDAR_SCAN, vec![2], 1),
    ];
    for (what, kind, at, restarts) in cases {
        for lost in [true, false] {
            let log = fly_through(lost, places(kind, at.clone()))
                .unwrap_or_else(|error| panic!("{what}, lost {lost}: {error}"));
            let restarted = causes(&log)
                .iter()
                .filter(|cause| **cause == "CoreRestarted")
                .count();
            assert_eq!(restarted, restarts, "{what}, lost {lost}");
            assert_eq!(log.orders, orders(), "{what}");
            assert_eq!(log.ticks.t.len(), 400, "{what}");
            let ticks: Vec<_> = log.plans.iter().map(|plan| plan.tick).collect();
            assert!(ticks.ends_with(&[300, 350]), "{what}: {ticks:?}");
            assert!(log.plans.iter().all(|plan| plan.candidates == 12), "{what}");
        }
    }
}

/// A restart before the first tick costs only time.
#[test]
fn a_restart_before_the_flight_changes_nothing_of_it() {
    let undisturbed = fly_through(true, |_| false).unwrap();
    for place in [0, 1] {
        let log = fly_through(true, places(id::SET_PARAMETER, vec![place])).unwrap();
        assert_eq!(causes(&log), ["CoreRestarted"]);
        assert_eq!(
            FlightLog {
                rejections: Vec::new(),
                ..log
            },
            undisturbed
        );
    }
}

#[test]
fn a_core_that_restarts_again_and_again_is_named() {
    for kind in [id::CONFIGURE, id::SET_PARAMETER, id::SENSOR_FRAME] {
        let error = fly_through(true, |message| message.id() == kind).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("restarts again and again"), "{text}");
    }
}
