//! Orders that change the world: obstacles and disturbances in flight, and flights tick by tick.

use mpp_core::vehicle::{Control, VehicleState};
use mpp_node::parameters::Tuning;
use mpp_sim::disturbance::Disturbance;
use mpp_sim::field::{Capsule, Circle, FieldFile};
use mpp_sim::flight::{Flight, fly_in, fly_with};
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Again, Ground, Order, OrderEntry, Refused};
use mpp_sim::pipe::PipeLink;
use mpp_sim::plant::{Plant, PlantError};
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::world::World;

/// Gives orders at their ticks, and notes which were refused.
#[derive(Default)]
struct Giver {
    orders: Vec<OrderEntry>,
    refused: Vec<Refused>,
}

impl Ground for Giver {
    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let due = self
            .orders
            .iter()
            .filter(|entry| entry.tick == u64::from(tick));
        due.map(|entry| entry.order.clone()).collect()
    }

    fn settled(&mut self, _: &Order, result: Result<(), Refused>, _: &Tuning) {
        self.refused.extend(result.err());
    }
}

/// A plant that cannot be disturbed: it glides on level.
struct Glider(VehicleState);

impl Plant for Glider {
    fn state(&self) -> &VehicleState {
        &self.0
    }

    fn wind(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn step(&mut self, command: Control) -> Result<Control, PlantError> {
        self.0.x += 0.12;
        Ok(command)
    }
}

fn scenario() -> Scenario {
    Scenario {
        ticks: 600,
        obstacles: 0,
        replan_ticks: 25,
        ..Scenario::new(Preset::Flight, 4)
    }
}

fn circle(x: f64, z: f64, radius: f64) -> Order {
    let velocity = (0.0, 0.0);
    let circle = Circle {
        x,
        z,
        radius,
        velocity,
    };
    Order::Obstacles {
        field: FieldFile {
            circle: vec![circle],
            ..FieldFile::default()
        },
    }
}

fn disturb(disturbance: Disturbance) -> Order {
    Order::Disturb { disturbance }
}

fn giver(orders: &[(u64, Order)]) -> Giver {
    let entry = |(tick, order): &(u64, Order)| OrderEntry {
        tick: *tick,
        order: order.clone(),
    };
    Giver {
        orders: orders.iter().map(entry).collect(),
        refused: Vec::new(),
    }
}

fn flown(orders: &[(u64, Order)]) -> (FlightLog, Vec<Refused>) {
    let mut ground = giver(orders);
    let log = fly_with(&scenario(), &mut PipeLink::new(), &mut ground).unwrap();
    (log, ground.refused)
}

/// The heights of a flight [m].
fn span(log: &FlightLog) -> f64 {
    let low = log.ticks.z.iter().copied().fold(f64::INFINITY, f64::min);
    let high = log
        .ticks
        .z
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    high - low
}

#[test]
fn an_obstacle_that_is_put_into_the_way_is_flown_round() {
    let (free, _) = flown(&[]);
    assert!(span(&free) < 1.0, "{}", span(&free));
    // 24 m ahead of the aircraft, at its height.
    let (x, z) = (free.ticks.x[200] + 24.0, free.ticks.z[200]);
    let (log, refused) = flown(&[(200, circle(x, z, 1.0))]);
    assert_eq!(refused, []);
    assert!(log.summary.strict, "{:?}", log.summary);
    assert!(span(&log) > 1.0 && log.summary.min_clearance.unwrap() > 0.0);
    assert_eq!(log.ticks.z[..200], free.ticks.z[..200]);
    // An obstacle on the aircraft ends the flight.
    let (hit, _) = flown(&[(200, circle(x - 23.0, z, 2.0))]);
    assert_eq!(hit.ticks.t.len(), 201);
}

#[test]
fn disturbances_act_from_their_order_on_until_the_next() {
    let gusts = |gusts| {
        disturb(Disturbance {
            gusts: Some(gusts),
            ..Disturbance::default()
        })
    };
    let stuck = |stuck| {
        disturb(Disturbance {
            elevator_stuck: Some(stuck),
            ..Disturbance::default()
        })
    };
    let blind = disturb(Disturbance {
        dropouts: Some(1.0),
        ..Disturbance::default()
    });
    let (log, refused) = flown(&[
        (100, gusts(1.5)),
        (200, gusts(0.0)),
        (300, stuck(true)),
        (350, stuck(false)),
    ]);
    assert_eq!(refused, []);
    for (tick, wind) in log.ticks.wind_x.iter().enumerate() {
        assert_eq!(wind.abs() > 0.0, (100..200).contains(&tick), "{tick}");
    }
    let given = &log.ticks.applied_elevator;
    let moves = |pair: &[f64]| (pair[0] - pair[1]).abs() > 0.0;
    assert!(!given[300..350].windows(2).any(moves));
    assert!(given[350..].windows(2).any(moves));
    // A lidar without returns does not see what is in the way.
    let free = flown(&[]).0;
    let ahead = circle(free.ticks.x[100] + 30.0, free.ticks.z[100], 1.0);
    let (log, _) = flown(&[(100, ahead), (100, blind)]);
    assert!(!log.summary.strict);
}

#[test]
fn a_log_with_such_orders_is_flown_again_from_its_bytes() {
    let bar = Order::Obstacles {
        field: FieldFile {
            capsule: vec![Capsule {
                from: (50.0, 49.0),
                to: (50.0, 52.0),
                radius: 0.5,
                velocity: (0.0, 0.0),
            }],
            ..FieldFile::default()
        },
    };
    let wind = disturb(Disturbance {
        gusts: Some(1.0),
        dropouts: Some(0.3),
        elevator_stuck: None,
    });
    let (log, _) = flown(&[(150, bar), (220, wind)]);
    let read = FlightLog::from_json(&log.to_json().unwrap()).unwrap();
    assert_eq!(read, log);
    let scenario = read.header.scenario().unwrap();
    let mut ground = Again::new(Some(read.orders), Giver::default());
    let again = fly_with(&scenario, &mut PipeLink::new(), &mut ground).unwrap();
    assert_eq!(again.hash().unwrap(), log.hash().unwrap());
}

#[test]
fn what_makes_no_sense_or_cannot_be_done_is_refused_and_not_logged() {
    let (log, refused) = flown(&[
        (10, circle(40.0, 50.0, -1.0)),
        (10, circle(f64::NAN, 50.0, 1.0)),
        (
            10,
            disturb(Disturbance {
                gusts: Some(f64::INFINITY),
                ..Disturbance::default()
            }),
        ),
        (
            10,
            disturb(Disturbance {
                dropouts: Some(1.5),
                ..Disturbance::default()
            }),
        ),
    ]);
    assert_eq!(refused, [Refused::Range; 4]);
    assert!(log.orders.is_empty());
    assert_eq!(log.hash().unwrap(), flown(&[]).0.hash().unwrap());
}

/// The glider knows no gusts. The lidar could lose beams, but the order is carried out whole or not at all.
#[test]
fn what_the_plant_refuses_does_not_change_the_lidar() {
    let scenario = Scenario {
        obstacles: 20,
        ..scenario()
    };
    let glide = |orders: &[(u64, Order)]| {
        let mut world = World {
            plant: Box::new(Glider(scenario.start().unwrap())),
            ..World::of(&scenario).unwrap()
        };
        let mut ground = giver(orders);
        let log = fly_in(&mut world, &scenario, &mut PipeLink::new(), &mut ground).unwrap();
        (log, ground.refused)
    };
    let dropouts = Disturbance {
        dropouts: Some(1.0),
        ..Disturbance::default()
    };
    let both = Disturbance {
        gusts: Some(1.0),
        ..dropouts
    };
    let (untouched, _) = glide(&[]);
    let (log, refused) = glide(&[(10, disturb(both))]);
    assert_eq!(refused, [Refused::World]);
    assert_eq!(log.hash().unwrap(), untouched.hash().unwrap());
    // What the lidar alone can do is done.
    let (log, refused) = glide(&[(10, disturb(dropouts))]);
    assert!(refused.is_empty() && log.orders.len() == 1);
    assert!(log.plans != untouched.plans);
}

#[test]
fn a_flight_tick_by_tick_has_the_log_of_an_interrupted_one_until_it_ends() {
    let scenario = Scenario {
        obstacles: 8,
        ticks: 300,
        ..scenario()
    };
    let mut world = World::of(&scenario).unwrap();
    let (mut link, mut ground) = (PipeLink::new(), Giver::default());
    let mut flight = Flight::begin(&mut world, &scenario, &mut link, &mut ground).unwrap();
    for _ in 0..120 {
        assert!(flight.tick(&mut world, &mut link, &mut ground).unwrap());
    }
    let mut until = Again::new(None, Giver::default()).until(Some(120));
    let interrupted = fly_with(&scenario, &mut PipeLink::new(), &mut until).unwrap();
    assert_eq!(flight.log(&world), interrupted);
    while flight.tick(&mut world, &mut link, &mut ground).unwrap() {}
    assert!(flight.has_ended() && flight.flown() == 300);
    let whole = fly_with(&scenario, &mut PipeLink::new(), &mut Giver::default()).unwrap();
    assert_eq!(flight.log(&world), whole);
}
