//! Whole flights of the planner in space through worlds.

use mpp_core::planner::space::Keep;
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::lidar::LidarName;
use mpp_sim::space::world::{Body, Extent, World, WorldConfig, WorldName};
use mpp_sim::space::{
    Deskew, Hull, SensorErrors, SpaceConfig, SpaceEnd, SpaceOutcome, WindConfig, fly_through,
};

const SPHERE: Hull = Hull {
    half_span: 0.0,
    half_length: 0.0,
    radius: 0.4,
};

fn config() -> SpaceConfig {
    SpaceConfig {
        keep: Keep {
            margin: 0.85,
            half_span: 0.0,
            heights: [0.9, 14.7],
            half_width: 29.5,
            altitude: 7.5,
        },
        bank: [1.05, 1.57],
        replan_ticks: 25,
        latency_ticks: 10,
        candidates: 3,
        programs: true,
        sight: 45.0,
        sweep: 0.1,
        deskew: Deskew::RIGHT,
        ahead: 0.12,
        errors: Some(SensorErrors::RTK),
        wind: WindConfig::default(),
    }
}

/// Flies on a thread with room for the workspaces of planner and map.
fn flown(world: World, seed: u64, config: SpaceConfig) -> Result<SpaceOutcome, String> {
    let body = move || {
        let mut file = AircraftFile::known("ultrastick").unwrap();
        file.cruise = 13.0;
        let scenario = Scenario {
            aircraft: AircraftModel::new(file).unwrap(),
            ..Scenario::new(Preset::Flight, seed)
        };
        fly_through(&world, &SPHERE, LidarName::Grid90x16, &scenario, config)
            .map_err(|error| error.to_string())
    };
    let thread = std::thread::Builder::new().stack_size(32 << 20);
    thread.spawn(body).unwrap().join().unwrap()
}

fn forest(density: f64, seed: u64) -> World {
    WorldConfig {
        density,
        ..WorldConfig::usual(WorldName::Forest, seed)
    }
    .build()
    .unwrap()
}

#[test]
fn light_forests_are_crossed_and_the_same_seed_flies_the_same() {
    let mut arrived = 0;
    for seed in 70..74 {
        let outcome = flown(forest(0.01, seed), seed, config()).unwrap();
        assert_ne!(outcome.end, SpaceEnd::Extreme, "{seed}");
        assert!(outcome.tracking < 0.2, "{seed}: {outcome:?}");
        arrived += usize::from(outcome.end == SpaceEnd::Arrived && outcome.clearance > 0.0);
    }
    assert!(arrived >= 3, "{arrived}");
    let again = || flown(forest(0.01, 70), 70, config());
    assert_eq!(again(), again());
}

/// Who plans must do better than who flies straight on, and who sees nothing hits what stands in the way.
#[test]
fn a_trunk_in_the_way_is_passed_with_the_lidar_and_hit_without_sight() {
    let trunk = || {
        let body = Body::Cylinder {
            x: 60.0,
            y: 0.1,
            radius: 0.4,
            height: f64::INFINITY,
        };
        World::new(vec![body], Extent::USUAL).unwrap()
    };
    assert_eq!(flown(trunk(), 1, config()).unwrap().end, SpaceEnd::Arrived);
    // A cycle that begins after the end of the flight never looks.
    let blind = SpaceConfig {
        replan_ticks: 1_000_000,
        latency_ticks: 1_000_000,
        ..config()
    };
    assert_eq!(flown(trunk(), 1, blind).unwrap().end, SpaceEnd::Hit);
}

#[test]
fn a_start_in_a_trunk_is_refused() {
    let body = Body::Cylinder {
        x: 0.0,
        y: 0.0,
        radius: 0.4,
        height: f64::INFINITY,
    };
    let world = World::new(vec![body], Extent::USUAL).unwrap();
    let refused = flown(world, 1, config()).unwrap_err();
    assert!(refused.contains("start"), "{refused}");
}
