//! Verdicts about fields with a known answer, and about flights that prove the opposite.

use super::*;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{Control, air_rate};
use mpp_sim::field::{Obstacle, Shape};
use mpp_sim::flight::fly;
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::generator::{Generator, GeneratorName};
use mpp_sim::outcome::Score;
use mpp_sim::pipe::DirectLink;
use mpp_sim::scenario::Preset;
use proptest::prelude::*;

fn scenario(name: GeneratorName, obstacles: usize, seed: u64) -> Scenario {
    Scenario {
        generator: Generator::named(name),
        obstacles,
        ..Scenario::new(Preset::Flight, seed)
    }
}

/// A field with walls across the band: place, and the heights between which each is open.
fn walls(open: &[(f64, f64, f64)]) -> Scenario {
    let wall = |x: f64, low: f64, high: f64| {
        let corners = vec![
            (x - 0.5, low),
            (x + 0.5, low),
            (x + 0.5, high),
            (x - 0.5, high),
        ];
        Obstacle::at_rest(Shape::Polygon { corners })
    };
    let placed = open
        .iter()
        .flat_map(|(x, low, high)| [wall(*x, 30.0, *low), wall(*x, *high, 70.0)]);
    Scenario {
        placed: placed.collect(),
        ..scenario(GeneratorName::Paper, 0, 1)
    }
}

#[test]
fn an_empty_field_is_passable_and_a_closed_one_is_blocked_at_its_wall() {
    assert_eq!(decide(&walls(&[]), 0.0), Ok(Feasibility::Passable));
    let Ok(Feasibility::Blocked(place)) = decide(&walls(&[(60.0, 51.0, 49.0)]), 0.0) else {
        panic!("a wall without a gap");
    };
    assert!((59.4..60.6).contains(&place), "{place}");
}

/// A wall that is open above a height. A flight that turns up as tightly as it can from level flight rises by
/// `(1 - cos(angle)) / turn` until its flight path angle reaches the limit, and on along a line from there.
#[test]
fn a_step_is_blocked_where_the_tightest_turn_does_not_reach_its_edge() {
    let question = Question::new(&walls(&[]), 0.0).unwrap();
    let turn = question.envelope.turn[1];
    for distance in [3.0, 6.0, 12.0] {
        let limit = mpp_sim::outcome::FLIGHT_PATH_LIMIT;
        let curve = (libm::sin(limit) / turn).min(distance);
        let sine = turn * curve;
        let rise =
            (1.0 - (1.0 - sine * sine).sqrt()) / turn + (distance - curve) * libm::tan(limit);
        let stepped = |edge: f64| {
            let corners = vec![
                (distance, 0.0),
                (distance + 2.0, 0.0),
                (distance + 2.0, 50.0 + edge),
                (distance, 50.0 + edge),
            ];
            let mut scenario = walls(&[]);
            scenario.placed = vec![Obstacle::at_rest(Shape::Polygon { corners })];
            Question::new(&scenario, 0.0)
                .unwrap()
                .blocked_at(&PROOFS[1])
        };
        assert_eq!(stepped(0.97 * rise - 0.05), None, "{distance}");
        assert!(stepped(1.03 * rise + 0.1).is_some(), "{distance}");
    }
}

/// From two seconds before a collision: what no turn reaches is proven, and a circle alone has a witness.
#[test]
fn a_wall_too_near_is_unavoidable_and_a_circle_two_seconds_ahead_is_not() {
    let verdict = |scenario: &Scenario, place| {
        let aircraft = Aircraft::new(scenario).unwrap();
        let question = Question::before(scenario, aircraft, place).unwrap();
        question.verdict()
    };
    // The gap is 10 m higher, and the wall 12 m ahead. A flight that may take 50 m gets there.
    let [near, far] = [12.0, 50.0].map(|x| walls(&[(x, 59.0, 61.0)]));
    assert!(matches!(verdict(&near, 11.5), Feasibility::Blocked(_)));
    assert_eq!(verdict(&far, 49.5), Feasibility::Passable);
    let mut circle = walls(&[]);
    circle.placed = vec![Obstacle::circle(25.0, ALTITUDE, 1.0)];
    assert_eq!(verdict(&circle, 24.0), Feasibility::Passable);
    // What stands farther on than a second of flight does not count.
    circle.placed.extend(walls(&[(40.0, 51.0, 49.0)]).placed);
    assert_eq!(verdict(&circle, 24.0), Feasibility::Passable);
    // A proof about still air says nothing about gusts.
    let mut gusty = near.clone();
    gusty.faults.gusts.intensity = 1.0;
    assert_eq!(verdict(&gusty, 11.5), Feasibility::Undecided);
}

/// The aircraft before a collision is that of the flight, with its actuators and its air.
#[test]
fn the_aircraft_before_the_end_is_that_of_the_flight() {
    let mut scenario = scenario(GeneratorName::Paper, 160, 7);
    scenario.ticks = 400;
    scenario.faults.gusts.intensity = 1.0;
    scenario.faults.actuators.elevator_rate = Some(20.0);
    scenario.faults.actuators.thrust_lag = Some(0.2);
    let mut observer = FlightObserver::of(&scenario);
    let mut ticks = Vec::new();
    fly(&scenario, &mut DirectLink::of(&scenario), |record| {
        observer.watch(record);
        ticks.push(*record.tick);
    })
    .unwrap();
    let mut aircraft = observer.aircraft_before(&scenario, 200).unwrap();
    let place = ticks.len() - 200;
    assert_eq!(*aircraft.state(), ticks[place].state);
    for (before, after) in ticks[place..].iter().zip(&ticks[place + 1..]) {
        assert_eq!(aircraft.step(before.control), Ok(before.applied));
        assert_eq!(*aircraft.state(), after.state);
    }
}

#[test]
fn the_papers_fields_are_passable() {
    for seed in 1..4 {
        assert_eq!(
            decide(&scenario(GeneratorName::Paper, 40, seed), 0.3),
            Ok(Feasibility::Passable)
        );
    }
}

/// The commands of a witness, flown again tick by tick against the whole field, reach the end.
#[test]
fn a_witness_can_be_flown_again() {
    let scenario = scenario(GeneratorName::Sealed, 160, 5);
    let question = Question::new(&scenario, 0.3).unwrap();
    let commands = question.witness(&EFFORTS[0]).unwrap();
    let way = Guide::new(&Way {
        obstacles: &[],
        start: (0.0, ALTITUDE),
        end: question.end,
        band: question.band,
        margin: 0.0,
        room: 1.0,
        turn: 0.1,
        rise: 0.5,
        slopes: 4,
    });
    let search = question.search(&way, &EFFORTS[0]);
    let mut aircraft = Aircraft::new(&scenario).unwrap();
    let mut score = Score::new(ALTITUDE, scenario.band(), 0.3);
    for angle_of_attack in commands {
        for _ in 0..10 {
            let before = *aircraft.state();
            aircraft
                .step(search.command(&before, angle_of_attack))
                .unwrap();
            assert_eq!(
                score.update(&question.field, &before, aircraft.state()),
                None
            );
        }
    }
    assert!(aircraft.state().x >= END && score.in_band() && score.min_clearance >= 0.0);
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let mut moving = scenario(GeneratorName::Paper, 20, 1);
    moving.generator.velocity = (-1.0, 0.0);
    assert_eq!(decide(&moving, 0.0), Err(CeilingError::Moving));
    for margin in [-0.1, f64::NAN, f64::INFINITY] {
        let refused = decide(&scenario(GeneratorName::Paper, 20, 1), margin);
        assert!(matches!(refused, Err(CeilingError::Margin(_))));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// A field from which everything is taken that a random flight of the envelope hits is not blocked as far as this flight
    /// goes, from any of its states on.
    #[test]
    fn no_flight_passes_a_blocked_field(
        seed in 0_u64..1000,
        margin in 0.0_f64..0.4,
        from in 0_usize..30,
        tried in proptest::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 60),
    ) {
        let mut scenario = scenario(GeneratorName::Sealed, 600, seed);
        let question = Question::new(&scenario, margin).unwrap();
        let envelope = question.envelope;
        let airframe = scenario.aircraft.known.airframe;
        let [low, high] = envelope.angle_of_attack;
        let mut aircraft = Aircraft::new(&scenario).unwrap();
        let (mut start, mut path) = (aircraft.clone(), vec![(0.0, ALTITUDE)]);
        'flight: for (number, (angle, thrust)) in tried.into_iter().enumerate() {
            if number == from {
                let state = *aircraft.state();
                (start, path) = (aircraft.clone(), vec![(state.x, state.z)]);
            }
            for _ in 0..15 {
                // A flight that climbs or sinks already turns back.
                let slope = aircraft.state().air.flight_path;
                let angle = (angle - 0.8 * slope).clamp(0.05, 0.95);
                let control = Control {
                    thrust: thrust * envelope.thrust,
                    elevator: airframe.elevator_for(low + angle * (high - low)),
                };
                aircraft.step(control).unwrap();
                let state = aircraft.state();
                let inside = (question.band.0..=question.band.1).contains(&state.z);
                if !(inside && envelope.holds(&state.air)) {
                    break 'flight;
                }
                path.push((state.x, state.z));
            }
        }
        let end = path.last().map_or(0.0, |last| last.0).min(question.end);
        scenario.placed = question.field.obstacles.iter().filter(|one| {
            path.windows(2).all(|leg| {
                one.clearance_of_motion(leg[0], leg[1], [0.0, TICK_PERIOD]) > margin
            })
        }).cloned().collect();
        scenario.obstacles = 0;
        let question = Question { end, aircraft: start, ..Question::new(&scenario, margin).unwrap() };
        prop_assert_eq!(question.blocked_at(&PROOFS[0]), None);
        prop_assert_eq!(question.blocked_at(&PROOFS[1]), None);
    }

    /// What has a witness is not proven to be unavoidable, whatever the aircraft flew before.
    #[test]
    fn an_avoidable_collision_is_not_proven_unavoidable(
        seed in 0_u64..1000,
        rate in proptest::option::of(10.0_f64..60.0),
        tried in proptest::collection::vec((-0.8_f64..0.8, 0.0_f64..1.0), 1..40),
    ) {
        let mut scenario = scenario(GeneratorName::Paper, 400, seed);
        scenario.faults.actuators.elevator_rate = rate;
        let mut aircraft = Aircraft::new(&scenario).unwrap();
        let trim = scenario.aircraft.trim;
        let airframe = scenario.aircraft.known.airframe;
        for (turn, thrust) in tried {
            let slope = aircraft.state().air.flight_path;
            let angle = trim.state.angle_of_attack() + 0.3 * (turn - slope).clamp(-0.8, 0.8);
            for _ in 0..15 {
                let elevator = airframe.elevator_for(angle);
                aircraft.step(Control { thrust: 3.0 * thrust * trim.control.thrust, elevator }).unwrap();
            }
        }
        let place = aircraft.state().x + 24.0;
        let question = Question::before(&scenario, aircraft, place).unwrap();
        if question.witness(&EFFORTS[0]).is_some() {
            prop_assert_eq!(question.blocked(), None);
        }
    }

    /// The turn of every state and control of the envelope lies within its bounds, for aircraft with every term.
    #[test]
    fn turns_are_bounded(
        name in prop_oneof![Just("reference"), Just("zagi"), Just("aerosonde"), Just("cessna182")],
        share in proptest::array::uniform6(0.0_f64..=1.0),
    ) {
        let file = mpp_sim::aircraft_file::AircraftFile::known(name).unwrap();
        let model = mpp_sim::aircraft_file::AircraftModel::new(file).unwrap();
        let scenario = Scenario { aircraft: model, ..scenario(GeneratorName::Paper, 0, 1) };
        let envelope = Envelope::of(&scenario).unwrap();
        let between = |[low, high]: [f64; 2], share: f64| low + share * (high - low);
        let limit = mpp_sim::outcome::FLIGHT_PATH_LIMIT;
        let flight_path = between([-limit, limit], share[0]);
        let air = mpp_core::vehicle::AirState {
            airspeed: between(envelope.airspeed, share[1]),
            pitch: flight_path + between(envelope.angle_of_attack, share[2]),
            pitch_rate: between([-envelope.pitch_rate, envelope.pitch_rate], share[3]),
            flight_path,
        };
        let limits = scenario.limits();
        let trim = scenario.aircraft.trim.control.elevator;
        let elevator = [
            trim - limits.elevator_below.unwrap_or(0.0),
            trim + limits.elevator_above.unwrap_or(0.0),
        ];
        let control = Control {
            thrust: between([0.0, envelope.thrust], share[4]),
            elevator: between(elevator, share[5]),
        };
        let airframe = &scenario.aircraft.known.airframe;
        let turn = air_rate(airframe, &air, control).flight_path / air.airspeed;
        prop_assert!((envelope.turn[0]..=envelope.turn[1]).contains(&turn), "{turn} {:?}", envelope.turn);
    }
}
