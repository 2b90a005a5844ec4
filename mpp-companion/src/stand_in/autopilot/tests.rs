//! Tests of PX4's rules.

use super::*;
use crate::setpoint::Setpoint;
use crate::stand_in::Flight;

fn px4() -> StandIn {
    StandIn::new(Kind::Px4, &Flight::new(1).scenario().unwrap(), 0.0, 0).unwrap()
}

/// Sends level setpoints of a kind for so many ticks, each second tick.
fn flow(autopilot: &mut StandIn, kind: Kind, ticks: u32) {
    let asked = Setpoint {
        pitch: 0.05,
        roll: 0.1,
        throttle: 0.4,
    };
    let (q, type_mask) = kind.target(asked, 0.7);
    let target = SET_ATTITUDE_TARGET_DATA {
        q,
        type_mask,
        thrust: 0.4,
        ..SET_ATTITUDE_TARGET_DATA::DEFAULT
    };
    let frame = Sender::new(SYSTEM, 191).frame(&Mav::SET_ATTITUDE_TARGET(target));
    for tick in 0..ticks {
        if tick.is_multiple_of(2) {
            autopilot.receive(&frame, &mut |_| {});
        }
        autopilot.step().unwrap();
    }
}

#[test]
fn px4_is_given_only_to_whole_attitudes_that_flow_and_takes_itself_back() {
    let mut autopilot = px4();
    flow(&mut autopilot, Kind::ArduPlane, 200);
    autopilot.give();
    assert!(!autopilot.is_given());
    flow(&mut autopilot, Kind::Px4, 110);
    autopilot.give();
    assert!(autopilot.is_given());
    flow(&mut autopilot, Kind::Px4, 100);
    assert!((autopilot.lateral[0] - 0.1 - SLANT).abs() < 0.01);
    for _ in 0..60 {
        autopilot.step().unwrap();
    }
    assert_eq!(autopilot.mode, px4::HOLD);
}

#[test]
fn px4_takes_itself_back_when_the_companion_says_so() {
    let mut autopilot = px4();
    flow(&mut autopilot, Kind::Px4, 110);
    autopilot.give();
    for message in Kind::Px4.give_back(None, 15.0) {
        let frame = Sender::new(SYSTEM, 191).frame(&message);
        autopilot.receive(&frame, &mut |_| {});
    }
    assert_eq!(autopilot.mode, px4::HOLD);
}
