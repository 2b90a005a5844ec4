//! Flights of the companion with the stand-in: what holds whatever the exchange does.

use mpp_companion::stand_in::{Fault, Flight};
use mpp_companion::{
    Companion, CompanionError, Config, Kind, Mounting, Reason, ScanSource, State, Told,
};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};

const KINDS: [Kind; 2] = [Kind::ArduPlane, Kind::Px4];

/// A flight with PX4.
fn px4(seed: u64, fault: Option<Fault>) -> Flight {
    Flight {
        kind: Kind::Px4,
        fault,
        ..Flight::new(seed)
    }
}

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

/// Points in space and distances in one plane show what frames of the link show.
#[test]
fn other_sources_of_scans_fly_it_past_obstacles() {
    let livox = ScanSource::Livox(Mounting::SIDE, 2.0);
    let obstacles = ScanSource::Obstacles(Mounting::SIDE);
    for (kind, source) in KINDS.into_iter().zip([livox, obstacles]) {
        let fly = |fault| {
            let flight = Flight {
                kind,
                source,
                fault,
                ..Flight::forty(12)
            };
            let mut log = Vec::new();
            let outcome = flight.fly(Some(&mut log)).unwrap();
            assert!(flight.replay(&log).unwrap().same > 300);
            (outcome, flight.scenario().unwrap())
        };
        let (outcome, scenario) = fly(None);
        assert!(outcome.is_strict(&scenario), "{outcome:?}");
        let trouble = |told: &Told| matches!(told, Told::Lidar(_));
        assert!(!outcome.told.iter().any(trouble), "{outcome:?}");
        // Each third attitude is none: the one before places the points.
        let (outcome, scenario) = fly(Some(Fault::NotFinite));
        assert!(outcome.is_strict(&scenario), "{outcome:?}");
        for fault in [Fault::LidarSilent, Fault::LidarFrozen] {
            let back = Told::State(State::GiveBack, Reason::Climbed);
            assert!(fly(Some(fault)).0.told.contains(&back), "{fault:?}");
        }
    }
}

/// PX4 banks as it is told, and its wings hang: without a loop of the companion it would be tens of metres from its course.
#[test]
fn px4_is_flown_past_obstacles_and_along_its_course() {
    let (flight, mut log) = (px4(3, None), Vec::new());
    let outcome = flight.fly(Some(&mut log)).unwrap();
    assert!(
        outcome.is_strict(&flight.scenario().unwrap()),
        "{outcome:?}"
    );
    assert!((0.1..3.0).contains(&outcome.aside), "{outcome:?}");
    // Level setpoints flowed before, and do not count.
    let replayed = flight.replay(&log).unwrap();
    assert!(replayed.times.len() > outcome.setpoints as usize + 300);
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
    for (kind, fault) in KINDS
        .iter()
        .flat_map(|kind| Fault::ALL.map(|fault| (*kind, fault)))
    {
        let flight = Flight {
            kind,
            fault: Some(fault),
            ..Flight::new(4)
        };
        let outcome = flight.fly(None).unwrap();
        let bad = (outcome.late, outcome.unsound);
        assert_eq!(bad, (0, 0), "{kind:?} {fault:?}");
        let most = match (kind, fault) {
            // A late message tells the old mode; PX4 does not obey.
            (Kind::Px4, Fault::Late(ticks)) => 10 * ticks as u32,
            _ => 50,
        };
        assert!(
            outcome.last_after <= most,
            "{kind:?} {fault:?}: {} ms",
            outcome.last_after
        );
        assert!(
            outcome.setpoints > 50,
            "{kind:?} {fault:?} begins in flight"
        );
    }
}

#[test]
fn a_pilot_who_takes_over_has_the_aircraft() {
    for kind in KINDS {
        let flight = Flight {
            kind,
            fault: Some(Fault::TakeOver),
            ..Flight::new(5)
        };
        let told = flight.fly(None).unwrap().told;
        let taken = Told::State(State::Off, Reason::TakenOver);
        assert!(told.contains(&taken), "{told:?}");
    }
}

/// PX4 leaves OFFBOARD when setpoints end. It is not entered again by a companion that knows an old mode.
#[test]
fn px4_that_has_left_its_mode_in_silence_is_not_flown_again() {
    let told = px4(7, Some(Fault::Silent(300))).fly(None).unwrap().told;
    let states = told.iter().filter_map(|told| match told {
        Told::State(state, _) => Some(*state),
        _ => None,
    });
    let lost = states.skip_while(|state| *state != State::Lost);
    assert_eq!(
        lost.collect::<Vec<_>>(),
        [State::Lost, State::Off, State::Ready]
    );
}

/// The autopilot counts heights above home, and its estimate above another place.
#[test]
fn an_aircraft_that_is_given_back_keeps_its_height() {
    for kind in KINDS {
        let flight = Flight {
            kind,
            fault: Some(Fault::LidarSilent),
            ..Flight::new(6)
        };
        let outcome = flight.fly(None).unwrap();
        let back = Told::State(State::GiveBack, Reason::Climbed);
        assert!(outcome.told.contains(&back), "{:?}", outcome.told);
        // The climb ends 30 m above hand-over.
        assert!((outcome.end - 30.0).abs() < 3.0, "{kind:?} {}", outcome.end);
    }
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
