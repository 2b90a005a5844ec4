//! Whole flights of aircraft from files: in other units, in other sizes, with terms that the core did not know.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

use mpp_analysis::aircraft::{AircraftReport, Variant, flown_cells, in_sizes, in_units};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::ScenarioFile;

fn flown(file: &AircraftFile, obstacles: usize, seed: u64) -> FlightLog {
    let model = AircraftModel::new(file.clone()).unwrap();
    let (_, replan_hz) = flown_cells(&[obstacles], model.units().time)[0];
    let scenario = ScenarioFile {
        aircraft: Some(file.clone()),
        obstacles: Some(obstacles),
        replan_hz: Some(replan_hz),
        seed: Some(seed),
        ..ScenarioFile::default()
    };
    let scenario = scenario.build().unwrap();
    fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap()
}

#[test]
fn every_known_aircraft_flies_past_scaled_obstacles() {
    for (name, _) in AircraftFile::KNOWN {
        let file = AircraftFile::known(name).unwrap();
        for seed in [50_000, 50_001] {
            let log = flown(&file, 20, seed);
            assert!(log.summary.strict, "{name}, seed {seed}: {:?}", log.summary);
        }
    }
}

#[test]
fn the_unit_of_the_command_does_not_matter() {
    let file = AircraftFile::known("example").unwrap();
    for Variant { name, file } in in_units(&file) {
        for seed in 50_000..50_003 {
            assert!(flown(&file, 20, seed).summary.strict, "{name}, seed {seed}");
        }
    }
}

#[test]
fn similar_aircraft_fly_alike() {
    let file = AircraftFile::known("reference").unwrap();
    for Variant { name, file } in in_sizes(&file) {
        for seed in 50_000..50_003 {
            assert!(flown(&file, 20, seed).summary.strict, "{name}, seed {seed}");
        }
    }
}

/// The report of the reference aircraft has the numbers that are known of it, and no doubt; a file with slips
/// of the pen is flown if it can be, and doubted by the names of its keys.
#[test]
fn a_report_tells_what_follows_and_what_is_implausible() {
    let report = |file: AircraftFile| AircraftReport::new(&AircraftModel::new(file).unwrap());
    let reference = report(AircraftFile::known("reference").unwrap());
    assert!(reference.doubts.is_empty(), "{:?}", reference.doubts);
    assert!((reference.elevator - 3.749).abs() < 1e-3);
    assert!((reference.length_unit - 1.0).abs() < 1e-15);
    assert!((reference.turn_radius - 18.2).abs() < 0.1);

    let mut odd = AircraftFile::known("example").unwrap();
    odd.pitch_inertia *= 100.0;
    odd.air_density = 1.6;
    odd.thrust.max = Some(1.05 * report(odd.clone()).thrust);
    let keys: Vec<&str> = report(odd).doubts.iter().map(|doubt| doubt.key).collect();
    for key in ["pitch_inertia", "air_density", "thrust.max"] {
        assert!(keys.contains(&key), "{key} of {keys:?}");
    }
}
