//! Tests flights of the nonlinear aircraft with planner and flight loop together.

use crate::common::motion::after_tick;
use crate::common::sensors::frame;
use crate::common::world::{Disc, clearance, scan};
use mpp_core::config::TICK_PERIOD;
use mpp_core::flight::FlightLoop;
use mpp_core::health::Health;
use mpp_core::planner::Planner;
use mpp_core::settings::Settings;
use mpp_core::vehicle::VehicleState;

/// The result of a flight.
struct Flown {
    end: VehicleState,
    least_clearance: f64,
    health: Health,
}

/// Flies the nonlinear aircraft through a world of discs, one plan a second.
fn fly(settings: &Settings, start_z: f64, discs: &[Disc], seconds: i32) -> Flown {
    let mut planner = Box::new(Planner::new());
    planner.set_up(settings).unwrap();
    let mut flight = FlightLoop::new(settings).unwrap();
    let mut state = VehicleState {
        x: 0.0,
        z: start_z,
        air: planner.trim().state,
    };
    let mut least_clearance = f64::INFINITY;
    for tick in 0..seconds * 100 {
        let time = f64::from(tick) * TICK_PERIOD;
        let out = flight.step(time, &frame(&state));
        if tick % 100 == 0 {
            let scan = scan(discs, &state);
            assert_eq!(scan.check(100), Ok(()));
            planner.begin(time, &flight.state(), &flight.conditions(), &scan);
            while planner.advance() {}
            let verdict = planner.finish();
            flight.adopt(time, verdict, planner.best());
        }
        state = after_tick(&settings.airframe, &state, out.control);
        least_clearance = least_clearance.min(clearance(discs, state.x, state.z));
    }
    Flown {
        end: state,
        least_clearance,
        health: *flight.health(),
    }
}

#[test]
fn an_aircraft_that_is_off_returns_to_its_altitude() {
    // The rest of the way back after 15 s. With a terminal weight of 10 instead of 100 the plan
    // returns slowly.
    for (settings, most_left) in [(Settings::paper(), 0.25), (Settings::flight(), 0.7)] {
        for start in [44.0, 55.0] {
            let flown = fly(&settings, start, &[], 15);
            let left = (flown.end.z - 50.0) / (start - 50.0);
            assert!(
                (0.0..most_left).contains(&left),
                "{} from {start}",
                flown.end.z
            );
            assert!(flown.end.air.flight_path.abs() < 0.03 && flown.end.x > 165.0);
            assert_eq!(flown.health.plans_feasible, 15);
        }
    }
}

#[test]
fn an_aircraft_flies_around_what_is_in_its_way() {
    let discs = [
        (40.0, 50.0, 3.0),
        (75.0, 54.0, 2.0),
        (110.0, 47.0, 3.0),
        (150.0, 51.0, 2.0),
    ];
    let flown = fly(&Settings::flight(), 50.0, &discs, 15);
    assert!(flown.least_clearance > 0.5, "{}", flown.least_clearance);
    assert!(
        flown.end.x > 170.0 && (flown.end.z - 50.0).abs() < 8.0,
        "{:?}",
        flown.end
    );
    assert_eq!(flown.health.plans_trim_hold, 0);
}
