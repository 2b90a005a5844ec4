//! What stands between commands and motion in six degrees of freedom: servos, and wind on three axes.

use mpp_core::vehicle::LateralControl;
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::{Servo, SpaceAircraft, SpaceDynamics, SpaceWind, WindConfig};

fn scenario(seed: u64) -> Scenario {
    Scenario {
        aircraft: AircraftModel::new(AircraftFile::known("ultrastick").unwrap()).unwrap(),
        ..Scenario::new(Preset::Flight, seed)
    }
}

/// The surfaces that turn the aircraft are those that the servos give, not those that were commanded.
#[test]
fn servos_stand_between_command_and_motion() {
    let scenario = scenario(1);
    let table = scenario.aircraft.file.lateral.as_ref().unwrap();
    let mut aircraft = SpaceAircraft::new(&scenario, WindConfig::default()).unwrap();
    let mut alone = SpaceDynamics {
        state: *aircraft.state(),
        ..SpaceDynamics::level(&scenario.aircraft).unwrap()
    };
    let mut aileron = Servo::new(&table.aileron);
    let mut rudder = Servo::new(&table.rudder.unwrap());
    let command = LateralControl {
        aileron: 0.2,
        rudder: -0.1,
    };
    for _ in 0..20 {
        let expected = LateralControl {
            aileron: aileron.follow(command.aileron, 0.01),
            rudder: rudder.follow(command.rudder, 0.01),
        };
        assert!(expected.aileron < command.aileron && expected.rudder > command.rudder);
        let (given, surfaces) = aircraft
            .step(scenario.aircraft.trim.control, command)
            .unwrap();
        assert_eq!(surfaces, expected);
        alone.step(given, expected, 0.01).unwrap();
        assert_eq!(*aircraft.state(), alone.state);
    }
}

/// In the first tick the rolling of the air alone rolls the aircraft.
#[test]
fn rolling_air_rolls_the_aircraft_to_its_own_side() {
    for seed in 1..=10 {
        let scenario = scenario(seed);
        let span = scenario.aircraft.file.lateral.as_ref().unwrap().span;
        let gusty = WindConfig {
            lateral_gusts: 1.0,
            ..WindConfig::default()
        };
        let air = SpaceWind::new(seed, scenario.faults.gusts, gusty, span, 0.01).unwrap();
        let mut aircraft = SpaceAircraft::new(&scenario, gusty).unwrap();
        aircraft
            .step(scenario.aircraft.trim.control, LateralControl::default())
            .unwrap();
        let rolled = aircraft.state().lateral.roll_rate;
        assert!(rolled * air.roll_rate() > 0.0, "{seed}: {rolled}");
    }
}

/// Wind moves the position and turns the nose; a change of it leaves the velocity over ground.
#[test]
fn wind_on_three_axes_moves_the_aircraft_and_gusts_roll_it() {
    let scenario = scenario(4);
    let trim = scenario.trim().unwrap().control;
    let flown = |wind: WindConfig| {
        let mut aircraft = SpaceAircraft::new(&scenario, wind).unwrap();
        let mut most_jump: f64 = 0.0;
        let ground = |aircraft: &SpaceAircraft| {
            let state = aircraft.state();
            let [x, y, z] = state.lateral.attitude.in_world(state.air_velocity());
            let [wind_x, wind_y, wind_z] = aircraft.wind();
            [x + wind_x, y + wind_y, wind_z - z]
        };
        for _ in 0..200 {
            let before = ground(&aircraft);
            aircraft.step(trim, LateralControl::default()).unwrap();
            let after = ground(&aircraft);
            for axis in 0..3 {
                most_jump = most_jump.max((after[axis] - before[axis]).abs());
            }
        }
        (*aircraft.state(), most_jump)
    };
    let (still, _) = flown(WindConfig::default());
    let steady = WindConfig {
        steady: [-2.0, 3.0, 0.0],
        ..WindConfig::default()
    };
    let (blown, _) = flown(steady);
    assert!((blown.lateral.y - still.lateral.y - 6.0).abs() < 1e-9);
    assert!((blown.plane.x - still.plane.x + 4.0).abs() < 1e-9);
    let gusty = WindConfig {
        lateral_gusts: 1.0,
        ..WindConfig::default()
    };
    let (shaken, jump) = flown(gusty);
    assert!(shaken.bank().abs() > 1e-3 && shaken.lateral.sideslip.abs() > 1e-4);
    // No more than the acceleration of a tick, with 3 g.
    assert!(jump < 0.3, "{jump}");
    assert_eq!(flown(gusty).0, shaken);
}
