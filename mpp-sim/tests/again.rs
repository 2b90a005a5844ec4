//! Flights that are interrupted, and flights that are flown again from their logs.

use mpp_sim::flight::fly_with;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Again, Ground, Mode, Order};
use mpp_sim::outcome::{Class, Outcome};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};

/// Orders another mode at one tick, and ends the flight at another.
struct Impatient {
    cruise: u32,
    end: u32,
}

impl Ground for Impatient {
    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let mode = Mode::Cruise;
        let order = (tick == self.cruise).then_some(Order::Mode { mode });
        order.into_iter().collect()
    }

    fn interrupts(&mut self, tick: u32) -> bool {
        tick >= self.end
    }
}

/// Never lets the flight begin.
struct Waiting(u32);

impl Ground for Waiting {
    fn ready(&mut self) -> bool {
        false
    }

    fn interrupts(&mut self, _: u32) -> bool {
        self.0 += 1;
        self.0 > 3
    }
}

fn scenario() -> Scenario {
    Scenario {
        ticks: 300,
        obstacles: 8,
        paths: 5,
        latency_ticks: 2,
        ..Scenario::new(Preset::Flight, 4)
    }
}

fn flown(ground: &mut dyn Ground) -> FlightLog {
    fly_with(&scenario(), &mut PipeLink::new(), ground).unwrap()
}

#[test]
fn an_interrupted_flight_holds_what_was_flown_and_is_flown_again() {
    for (cruise, end) in [(50, 130), (130, 130), (0, 0)] {
        let log = flown(&mut Impatient { cruise, end });
        assert_eq!(log.ticks.t.len(), end as usize);
        assert_eq!(log.summary.outcome, Outcome::Interrupted);
        assert_eq!(log.summary.class, Class::Interrupted);
        assert!(!log.summary.strict && log.summary.failure.is_none());
        assert_eq!(log.orders.len(), 1);
        let never = Impatient {
            cruise: u32::MAX,
            end: u32::MAX,
        };
        let orders = Some(log.orders.clone());
        let again = flown(&mut Again::new(orders, never).until(Some(end)));
        assert_eq!(again.hash().unwrap(), log.hash().unwrap());
    }
    let whole = flown(&mut Impatient {
        cruise: u32::MAX,
        end: 300,
    });
    assert_eq!(whole.summary.outcome, Outcome::Survived);
}

#[test]
fn a_flight_that_waits_can_be_interrupted() {
    let log = flown(&mut Waiting(0));
    assert!(log.ticks.t.is_empty());
    assert_eq!(log.summary.outcome, Outcome::Interrupted);
}

#[test]
fn a_header_gives_its_scenario() {
    let never = || Impatient {
        cruise: u32::MAX,
        end: u32::MAX,
    };
    let log = flown(&mut never());
    assert_eq!(log.header.scenario().unwrap(), scenario());
    let oracle = Scenario {
        ticks: 20,
        ..scenario()
    }
    .informed();
    let mut link = PipeLink::of(&oracle);
    let log = fly_with(&oracle, &mut link, &mut never()).unwrap();
    assert_eq!(log.header.scenario().unwrap(), oracle);
}
