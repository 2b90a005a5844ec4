//! Tests each transition, and that no other happens.

use super::*;

/// Everything is well, and the pilot gave the aircraft.
fn well(now: f64) -> Sight {
    Sight {
        now,
        silence: 0.02,
        verified: true,
        ours: true,
        level: true,
        fresh: true,
        plans: 2,
        planless: 0.0,
        unseen: 0.1,
        sees: true,
        knows: true,
        age: 0.02,
        bank: 0.1,
        aside: 1.0,
        climbed: 0.0,
    }
}

fn after(state: State, lasts: f64, change: impl Fn(&mut Sight)) -> (State, Option<Reason>) {
    let mut guard = Guard { state, since: 10.0 };
    let mut sight = well(10.0 + lasts);
    change(&mut sight);
    let reason = guard.look(&sight);
    (guard.state, reason)
}

fn goes(state: State, to: State, reason: Reason, change: impl Fn(&mut Sight)) {
    assert_eq!(after(state, 1.0, change), (to, Some(reason)), "{state:?}");
}

const OWNED: [State; 4] = [
    State::Listening,
    State::Flying,
    State::Climb,
    State::GiveBack,
];

#[test]
fn a_flight_begins_step_by_step() {
    goes(State::Off, State::Ready, Reason::Verified, |_| {});
    goes(State::Ready, State::Listening, Reason::Chosen, |_| {});
    let settled = after(State::Listening, 5.0, |_| {});
    assert_eq!(settled, (State::Flying, Some(Reason::Settled)));
    assert_eq!(after(State::Flying, 1.0, |_| {}), (State::Flying, None));
}

#[test]
fn without_verification_or_choice_nothing_begins() {
    assert_eq!(after(State::Off, 9.0, |s| s.verified = false).0, State::Off);
    goes(State::Ready, State::Off, Reason::NotVerified, |s| {
        s.verified = false;
    });
    goes(State::Listening, State::Off, Reason::NotVerified, |s| {
        s.verified = false;
    });
    assert_eq!(after(State::Ready, 9.0, |s| s.ours = false).0, State::Ready);
}

#[test]
fn listening_waits_for_each_condition() {
    let waits = |change: fn(&mut Sight)| {
        assert_eq!(
            after(State::Listening, 9.0, change),
            (State::Listening, None)
        );
    };
    assert_eq!(after(State::Listening, 4.9, |_| {}).0, State::Listening);
    waits(|s| s.level = false);
    waits(|s| s.plans = 1);
    waits(|s| s.knows = false);
    waits(|s| s.sees = false);
    waits(|s| s.unseen = 2.0);
    waits(|s| s.age = f64::NAN);
    waits(|s| s.bank = 1.0);
    waits(|s| s.planless = 2.0);
}

#[test]
fn the_pilot_takes_over_from_every_state() {
    for state in OWNED {
        goes(state, State::Off, Reason::TakenOver, |s| s.ours = false);
    }
}

#[test]
fn silence_is_a_loss_and_comes_before_all_else() {
    for state in OWNED.into_iter().chain([State::Ready]) {
        goes(state, State::Lost, Reason::Silent, |s| {
            (s.silence, s.ours) = (0.21, false);
        });
    }
    let silent = |s: &mut Sight| s.silence = 0.21;
    assert_eq!(after(State::Off, 1.0, silent), (State::Off, None));
    assert_eq!(after(State::Lost, 1.0, silent), (State::Lost, None));
    goes(State::Lost, State::Off, Reason::Heard, |_| {});
}

#[test]
fn what_the_core_lacks_ends_a_flight() {
    goes(State::Flying, State::Climb, Reason::Blind, |s| {
        s.sees = false;
    });
    goes(State::Flying, State::Climb, Reason::Blind, |s| {
        s.unseen = 1.1;
    });
    goes(State::Flying, State::Climb, Reason::NoPlan, |s| {
        s.planless = 1.1;
    });
    goes(State::Flying, State::GiveBack, Reason::Estimate, |s| {
        s.knows = false;
    });
    for state in [State::Flying, State::Climb] {
        goes(state, State::GiveBack, Reason::Late, |s| s.age = 0.2);
        goes(state, State::GiveBack, Reason::Late, |s| s.age = f64::NAN);
        goes(state, State::GiveBack, Reason::Aside, |s| s.bank = 0.6);
        goes(state, State::GiveBack, Reason::Aside, |s| s.aside = 16.0);
    }
}

#[test]
fn a_climb_ends_by_height_or_time_and_the_aircraft_stays_given_back() {
    goes(State::Climb, State::GiveBack, Reason::Climbed, |s| {
        s.climbed = 30.0;
    });
    let long = after(State::Climb, 20.0, |s| s.sees = false);
    assert_eq!(long, (State::GiveBack, Some(Reason::Climbed)));
    assert_eq!(after(State::Climb, 1.0, |s| s.sees = false).0, State::Climb);
    assert_eq!(
        after(State::Climb, 1.0, |s| s.knows = false).0,
        State::Climb
    );
    assert_eq!(
        after(State::GiveBack, 99.0, |_| {}),
        (State::GiveBack, None)
    );
}

#[test]
fn setpoints_are_sent_in_two_states_and_level_ones_before_where_they_must_flow() {
    let sends = |state, flows| Guard { state, since: 0.0 }.sends(flows);
    for flows in [false, true] {
        assert!(sends(State::Flying, flows) && sends(State::Climb, flows));
        for state in [State::Off, State::GiveBack, State::Lost] {
            assert!(!sends(state, flows));
        }
        for state in [State::Ready, State::Listening] {
            assert_eq!(sends(state, flows), flows);
        }
    }
}

#[test]
fn a_core_that_has_listened_for_long_does_not_take_over() {
    let old = after(State::Listening, 9.0, |s| s.fresh = false);
    assert_eq!(old, (State::Listening, None));
}
