//! Tests of the dead time between a command and its effect.

use crate::common::motion::after_tick;
use crate::common::sensors::frame;
use crate::common::world::{Disc, clearance, scan};
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::Trust;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::Planner;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{Control, VehicleState};
use std::collections::VecDeque;

const DISCS: [Disc; 4] = [
    (40.0, 50.0, 3.0),
    (75.0, 54.0, 2.0),
    (110.0, 47.0, 3.0),
    (150.0, 51.0, 2.0),
];

/// Latency from a scan to its plan \[ticks\].
const LATENCY: u32 = 10;

/// A flight.
struct Flown {
    commands: Vec<Control>,
    least_clearance: f64,
    /// Greatest distance \[m\] of the aircraft from where the loop foresaw it, and ticks of an elevator that was suspected.
    missed: f64,
    suspected: usize,
}

/// Settings that are told a dead time of elevator and thrust \[s\].
fn told(elevator: Option<f64>, thrust: Option<f64>) -> Settings {
    let mut settings = Settings::flight();
    settings.actuators.elevator_delay = elevator;
    settings.actuators.thrust_delay = thrust;
    if let Some(own) = settings.planner.plane_mut() {
        own.latency = f64::from(LATENCY) * TICK_PERIOD;
    }
    settings
}

/// Flies the nonlinear aircraft for 15 s, with true dead times \[ticks\] and four plans a second.
fn fly(settings: &Settings, [elevator, thrust]: [usize; 2]) -> Flown {
    let mut planner = Box::new(Planner::new());
    planner.set_up(settings).unwrap();
    let trim = *planner.trim();
    let mut flight = FlightLoop::new(settings).unwrap();
    let mut state = VehicleState {
        x: 0.0,
        z: 52.0,
        air: trim.state,
    };
    let mut waiting = [
        VecDeque::from(vec![trim.control.elevator; elevator]),
        VecDeque::from(vec![trim.control.thrust; thrust]),
    ];
    let mut foreseen = VecDeque::new();
    let mut flown = Flown {
        commands: Vec::new(),
        least_clearance: f64::INFINITY,
        missed: 0.0,
        suspected: 0,
    };
    for tick in 0..1500 {
        let time = f64::from(tick) * TICK_PERIOD;
        if tick % 25 == LATENCY && planner.is_working() {
            while planner.advance() {}
            let verdict = planner.finish();
            flight.adopt(time, verdict, planner.best());
        }
        let out = flight.step(time, &frame(&state));
        if tick % 25 == 0 {
            let (pose, scan) = (flight.poses_at(0).unwrap(), scan(&DISCS, &state));
            let from = flight.planned_from();
            planner.begin_from(time, &pose, &from, &flight.conditions(), Some(&scan));
        }
        foreseen.push_back(flight.planned_from());
        if foreseen.len() > elevator {
            let then: VehicleState = foreseen.pop_front().unwrap();
            let off = libm::hypot(then.x - state.x, then.z - state.z);
            flown.missed = flown.missed.max(off);
        }
        flown.suspected += usize::from(flight.sensors().elevator != Trust::Healthy);
        flown.commands.push(out.control);
        let [elevators, thrusts] = &mut waiting;
        elevators.push_back(out.control.elevator);
        thrusts.push_back(out.control.thrust);
        let acts = Control {
            elevator: elevators.pop_front().unwrap(),
            thrust: thrusts.pop_front().unwrap(),
        };
        state = after_tick(&settings.airframe, &state, acts);
        let clear = clearance(&DISCS, state.x, state.z);
        flown.least_clearance = flown.least_clearance.min(clear);
    }
    flown
}

#[test]
fn a_told_dead_time_is_foreseen_and_no_fault_of_the_elevator() {
    for (elevator, thrust) in [
        (0.1, None),
        (0.1, Some(0.1)),
        (0.06, Some(0.12)),
        (0.3, Some(0.05)),
    ] {
        let ticks = |delay: f64| libm::round(delay / TICK_PERIOD) as usize;
        let settings = told(Some(elevator), thrust);
        let flown = fly(&settings, [ticks(elevator), ticks(thrust.unwrap_or(0.0))]);
        assert!(flown.least_clearance > 0.5, "{}", flown.least_clearance);
        assert!(flown.missed < 0.1, "{}", flown.missed);
        assert_eq!(flown.suspected, 0, "{elevator}");
    }
}

#[test]
fn an_untold_dead_time_is_not_foreseen() {
    let untold = fly(&told(None, None), [10, 10]);
    let known = fly(&told(Some(0.1), Some(0.1)), [10, 10]);
    assert!(
        untold.missed > 4.0 * known.missed,
        "{} {}",
        untold.missed,
        known.missed
    );
}

#[test]
fn less_than_half_a_tick_is_no_dead_time_to_the_last_bit() {
    let none = fly(&told(None, None), [0, 0]);
    let short = fly(&told(Some(0.004), Some(0.004)), [0, 0]);
    assert_eq!(none.commands, short.commands);
}
