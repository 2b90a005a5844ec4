//! Tests flights of preset `flight` in moving air, with limited actuators and with an inexact
//! airframe model. The tests judge the physical outcome.

use mpp_sim::faults::{
    ActuatorLimits, Faults, GustConfig, LidarFaultConfig, ModelError, SignalFault, Signs,
};
use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario, ScenarioFile};
use std::error::Error;
use std::path::Path;

/// Six flights past 40 obstacles, replanned at 4 Hz. All must survive inside the band.
fn flown(faults: Faults) -> Vec<FlightLog> {
    let flights = flights(faults, 6);
    let strict = flights.iter().filter(|log| log.summary.strict).count();
    assert_eq!(strict, 6, "of 6");
    flights
}

fn flights(faults: Faults, count: u64) -> Vec<FlightLog> {
    let flights = (0..count).map(|seed| {
        let scenario = Scenario {
            obstacles: 40,
            replan_ticks: 25,
            faults,
            ..Scenario::new(Preset::Flight, seed)
        };
        fly(&scenario, &mut PipeLink::new(), |_| {})
    });
    flights.collect::<Result<_, _>>().unwrap_or_default()
}

#[test]
fn the_core_asks_for_no_more_than_its_actuators_give() {
    let actuators = ActuatorLimits {
        thrust_max: Some(15.0),
        elevator_range: Some(2.0),
        elevator_rate: Some(20.0),
        ..ActuatorLimits::default()
    };
    let faults = Faults {
        actuators,
        ..Faults::default()
    };
    for log in flown(faults) {
        let asked = log.ticks.elevator.iter().zip(&log.ticks.thrust);
        let given = log
            .ticks
            .applied_elevator
            .iter()
            .zip(&log.ticks.applied_thrust);
        for ((elevator, thrust), (given_elevator, given_thrust)) in asked.zip(given) {
            // Limits go over the link in single precision.
            assert!((elevator - given_elevator).abs() < 1e-6);
            assert!((thrust - given_thrust).abs() < 1e-6);
        }
    }
}

#[test]
fn gusts_of_a_metre_a_second_are_flown_through() {
    let faults = Faults {
        gusts: GustConfig { intensity: 1.0 },
        ..Faults::default()
    };
    for log in flown(faults) {
        let strongest = log
            .ticks
            .wind_z
            .iter()
            .fold(0.0, |most: f64, wind| most.max(wind.abs()));
        assert!(strongest > 0.5, "{strongest} m/s");
    }
}

/// The estimator still works for an aircraft that is a tenth heavier or lighter, and stiffer or
/// not. It takes no reading of a healthy sensor for a fault.
#[test]
fn the_estimate_follows_an_aircraft_that_it_does_not_quite_know() {
    let faults = Faults {
        model_error: ModelError {
            mass: 0.1,
            lift_slope: 0.1,
            pitch_stiffness: 0.1,
            signs: Signs::Drawn,
        },
        ..Faults::default()
    };
    for log in flown(faults) {
        assert!(log.rejections.is_empty(), "{:?}", log.rejections);
        let off = log.ticks.est_pitch.iter().zip(&log.ticks.pitch);
        let worst = off.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(worst < 0.05, "{worst} rad");
    }
}

/// A flight of a fault's scenario file, past 40 obstacles.
fn with_fault(name: &str, replan_hz: f64, seed: u64) -> Result<FlightLog, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/scenarios/faults");
    let text = std::fs::read_to_string(folder.join(name).with_extension("toml"))?;
    let mut file = ScenarioFile::parse(name, &text)?;
    (file.seed, file.obstacles, file.replan_hz) = (Some(seed), Some(40), Some(replan_hz));
    let scenario = file.build()?;
    Ok(fly(&scenario, &mut PipeLink::of(&scenario), |_| {})?)
}

/// Faults of the scenario files that the core notices or bridges, 24 flights of each: name, replanning rate, and
/// least number of successes. Without what decisions 26, 27 and 29 tell, 2, 5, 9, 24, 12, 1, 18 and 12 of them failed, without
/// decision 63 a sixth of those with two errors.
/// Of 800 flights past 40 obstacles with scans that are a second old 92 % are successes, so 20 of 24 are asked for.
#[test]
fn faults_that_are_noticed_are_flown_through() {
    for (name, replan_hz, least) in [
        ("pitch-bias", 4.0, 24),
        ("airspeed-bias-low", 4.0, 23),
        ("airspeed-pitch-bias", 4.0, 23),
        ("airspeed-pitch-bias-high", 4.0, 23),
        ("airspeed-ramp", 4.0, 23),
        ("scan-stale", 1.0, 20),
        ("link-loss-50", 1.0, 24),
        ("clock-jump-10s", 4.0, 24),
        ("elevator-quarter", 4.0, 23),
        ("link-silent-3s", 4.0, 20),
    ] {
        let strict = (10_000..10_024)
            .filter(|seed| with_fault(name, replan_hz, *seed).unwrap().summary.strict)
            .count();
        assert!(strict >= least, "{name}: {strict} of 24");
    }
}

/// In these flights the first step after a gap once told of a lost motor, because it took the estimates of three seconds
/// for those of one tick.
#[test]
fn a_gap_between_two_steps_is_no_lost_motor() {
    for seed in [10_028, 10_037] {
        let log = with_fault("link-silent-3s", 4.0, seed).unwrap();
        assert!(log.sensors.iter().all(|change| change.sensor != "motor"));
    }
}

/// Tests limited actuators, gusts, a wrong airframe and a faulty lidar at once. A core that takes
/// the airframe to be as told loses more than a quarter of such flights (decision 12).
#[test]
fn everything_at_once_is_flown_through_by_most() {
    let faults = Faults {
        actuators: ActuatorLimits {
            thrust_max: Some(15.0),
            thrust_lag: Some(0.2),
            elevator_range: Some(2.0),
            elevator_rate: Some(20.0),
            ..ActuatorLimits::default()
        },
        gusts: GustConfig { intensity: 1.0 },
        model_error: ModelError {
            mass: 0.1,
            lift_slope: 0.1,
            pitch_stiffness: 0.1,
            signs: Signs::Drawn,
        },
        lidar: LidarFaultConfig {
            dropouts: 0.1,
            false_hits: 0.01,
        },
        ..Faults::default()
    };
    let flights = flights(faults, 40);
    let strict = flights.iter().filter(|log| log.summary.strict).count();
    assert!(strict >= 34, "{strict} of 40");
}

/// A pitch sensor that sticks, drifts or toggles is told, and nothing else; the flight goes on without it.
#[test]
fn a_pitch_sensor_that_fails_is_named_and_left_out() {
    let stuck = SignalFault {
        from: Some(3.0),
        frozen: true,
        noise: Some(0.05),
        ..SignalFault::default()
    };
    let drifts = SignalFault {
        ramp: Some(0.25),
        ..stuck
    };
    let toggles = SignalFault {
        from: Some(3.0),
        toggle_hz: Some(1.0),
        bias: Some(10.0),
        ..SignalFault::default()
    };
    for pitch in [stuck, drifts, toggles] {
        let faults = Faults {
            pitch,
            ..Faults::default()
        };
        for log in flown(faults) {
            let excluded = log.sensors.iter().filter(|it| it.state == "excluded");
            let sensors: Vec<_> = excluded.map(|it| it.sensor.clone()).collect();
            assert!(sensors.iter().any(|it| it == "pitch"), "{sensors:?}");
        }
    }
}
