//! An aircraft behind an autopilot's pitch and roll loop: its plant, and whole flights in space.

use crate::forest::flown;
use mpp_core::vehicle::LateralControl;
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::outcome::Outcome;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::{SpaceAircraft, SpaceFile, SpaceState, WindConfig};

const BEHIND: &str = include_str!("../../tests/aircraft/behind.toml");

fn behind() -> AircraftFile {
    AircraftFile::parse("behind", BEHIND).unwrap()
}

/// States after each tick under a constant command of the bank \[rad\].
fn turned(bank: f64, ticks: usize) -> Vec<SpaceState> {
    let scenario = Scenario {
        aircraft: AircraftModel::new(behind()).unwrap(),
        ..Scenario::new(Preset::Flight, 1)
    };
    let mut aircraft = SpaceAircraft::new(&scenario, WindConfig::default()).unwrap();
    let trim = scenario.aircraft.trim.control;
    let command = LateralControl {
        aileron: bank,
        rudder: 0.0,
    };
    let step = |_| {
        aircraft.step(trim, command).unwrap();
        *aircraft.state()
    };
    (0..ticks).map(step).collect()
}

/// A small step of the command, after its dead time, against the equation of a loop of second order.
#[test]
fn the_bank_follows_as_the_loop_says() {
    let (w, damping, command) = (6.0_f64, 0.8_f64, 0.05);
    let damped = w * (1.0 - damping * damping).sqrt();
    for (tick, state) in turned(command, 100).iter().enumerate() {
        // The loop sees the bank of the begin of each tick.
        let t = (0.01 * (tick as f64 + 1.0) - 0.1).max(0.0);
        let (sin, cos) = libm::sincos(damped * t);
        let rest = libm::exp(-damping * w * t) * (cos + damping * w / damped * sin);
        let off = state.bank() / command - (1.0 - rest);
        assert!(off.abs() < 0.05, "{tick}: {off}");
    }
}

#[test]
fn bank_and_rate_stay_within_those_of_the_loop_and_turns_are_coordinated() {
    let states = turned(-1.4, 200);
    let most = |of: fn(&SpaceState) -> f64| states.iter().map(of).fold(0.0, f64::max);
    let (rate, slip) = (
        most(|it| -it.lateral.roll_rate),
        most(|it| it.lateral.sideslip.abs()),
    );
    assert!((2.0..2.6).contains(&rate), "{rate}");
    assert!(slip < 0.05, "{slip}");
    let last = states.last().unwrap().bank();
    // The loop holds a roll rate of the body, which in a turn that sinks is not that of the bank.
    assert!((-1.05..-0.95).contains(&last), "{last}");
}

/// Lidar, estimator, planner and regulator, whose commands are bank and angle of attack.
#[test]
fn it_crosses_a_light_forest() {
    let arrived = (966_400..966_404).filter(|seed| {
        let file = SpaceFile {
            aircraft: Some(behind()),
            density: Some(0.01),
            seed: Some(*seed),
            ..SpaceFile::default()
        };
        let log = flown(file, None).unwrap();
        let (bank, rate) = (&log.lateral.aileron, &log.lateral.roll_rate);
        assert!(bank.iter().all(|it| it.abs() <= 1.05));
        assert!(rate.iter().all(|it| it.abs() < 2.6));
        log.summary.outcome == Outcome::Survived
    });
    assert!(arrived.count() >= 3);
}
