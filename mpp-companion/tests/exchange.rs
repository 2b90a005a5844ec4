//! Flights of the companion with the stand-in: what holds whatever the exchange does.

use mpp_companion::stand_in::{Fault, Flight};
use mpp_companion::{Companion, CompanionError, Config, Reason, State, Told};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};

#[test]
fn it_flies_past_obstacles_and_the_log_replays_to_the_last_bit() {
    let flight = Flight::new(3);
    let mut log = Vec::new();
    let outcome = flight.fly(Some(&mut log)).unwrap();
    assert!(
        outcome.is_strict(&flight.scenario().unwrap()),
        "{outcome:?}"
    );
    let replayed = flight.replay(&log).unwrap();
    assert!(replayed.same > 900 && outcome.setpoints > 500, "{replayed}");
    assert_eq!(replayed.times.len(), outcome.setpoints as usize);
    assert!(replayed.times.is_sorted());
    // A flight with another aircraft file sends something else.
    let other = Flight {
        told: false,
        ..flight
    };
    assert!(other.replay(&log).is_err());
}

/// In a head wind the damping of the pitch loop looked like an airspeed that reads too much.
#[test]
fn it_flies_past_obstacles_in_wind_and_gusts() {
    let flight = Flight {
        wind: -4.33,
        gusts: 0.5,
        ..Flight::new(910_036)
    };
    let (outcome, scenario) = (flight.fly(None).unwrap(), flight.scenario().unwrap());
    assert!(outcome.is_strict(&scenario), "{outcome:?}");
}

#[test]
fn no_fault_of_the_exchange_brings_a_setpoint_that_must_not_be() {
    for fault in Fault::ALL {
        let flight = Flight {
            fault: Some(fault),
            ..Flight::new(4)
        };
        let outcome = flight.fly(None).unwrap();
        let bad = (outcome.late, outcome.unsound);
        assert_eq!(bad, (0, 0), "{fault:?}");
        assert!(
            outcome.last_after <= 50,
            "{fault:?}: {} ms",
            outcome.last_after
        );
        assert!(outcome.setpoints > 50, "{fault:?} begins in flight");
    }
}

#[test]
fn a_pilot_who_takes_over_has_the_aircraft() {
    let flight = Flight {
        fault: Some(Fault::TakeOver),
        ..Flight::new(5)
    };
    let told = flight.fly(None).unwrap().told;
    let taken = Told::State(State::Off, Reason::TakenOver);
    assert!(told.contains(&taken), "{told:?}");
}

/// The autopilot counts heights above home, and its estimate above another place.
#[test]
fn an_aircraft_that_is_given_back_keeps_its_height() {
    let flight = Flight {
        fault: Some(Fault::LidarSilent),
        ..Flight::new(6)
    };
    let outcome = flight.fly(None).unwrap();
    let back = Told::State(State::GiveBack, Reason::Climbed);
    assert!(outcome.told.contains(&back), "{:?}", outcome.told);
    // The climb ends 30 m above hand-over.
    assert!((outcome.end - 30.0).abs() < 3.0, "{}", outcome.end);
}

/// An elevator that is no angle of attack would be sent as a pitch.
#[test]
fn an_aircraft_without_a_pitch_loop_and_a_range_that_is_none_are_refused() {
    let companion = |text: &str, range| {
        let file = AircraftFile::parse("it", text).unwrap();
        Companion::new(Config::new(
            AircraftModel::new(file).unwrap().plane(),
            range,
        ))
    };
    let (own, moments) = (
        include_str!("../plane.toml"),
        include_str!("../../aircraft/example.toml"),
    );
    assert!(companion(own, 70.0).is_ok());
    let refused = companion(moments, 70.0).err();
    assert!(
        matches!(refused, Some(CompanionError::NoPitchLoop)),
        "{refused:?}"
    );
    for range in [f32::NAN, 0.0, -1.0, f32::INFINITY] {
        assert!(matches!(
            companion(own, range).err(),
            Some(CompanionError::Range(_))
        ));
    }
}
