//! Whole flights over terrain.

use mpp_sim::outcome::Outcome;
use mpp_sim::space::world::Terrain;
use mpp_sim::space::{Look, SpaceFile, fly_space};

/// A hill of 60 m, as wide as the band and wider: 150 m ahead, slopes up to 0.8.
fn hill() -> Terrain {
    let height = |x: f64, y: f64| {
        let distance = (libm::hypot(x - 150.0, y) / 120.0).min(1.0);
        60.0 * libm::cos(0.5 * core::f64::consts::PI * distance).powi(2)
    };
    let row = |row: u32| {
        let y = -40.0 + 5.0 * f64::from(row);
        (0..=60)
            .map(|at| height(-20.0 + 5.0 * f64::from(at), y))
            .collect()
    };
    Terrain {
        corner: [-20.0, -40.0],
        cell: 5.0,
        rows: (0..=16).map(row).collect(),
    }
}

fn home(baseline: Option<&str>) -> SpaceFile {
    SpaceFile {
        airspeed: Some(12.0),
        terrain: Some(hill()),
        altitude: Some(30.0),
        baseline: baseline.map(str::to_owned),
        ..SpaceFile::default()
    }
}

/// A return at constant height flies into the hill. The planner climbs over it, and comes down to its height behind. The log alone
/// brings the same flight again.
#[test]
fn the_hill_in_the_way_home_is_passed() {
    let thread = std::thread::Builder::new().stack_size(mpp_sim::space::STACK);
    let flown = thread.spawn(|| {
        let fly = |file: &SpaceFile| fly_space(&file.build(None).unwrap()).unwrap();
        let straight = fly(&home(Some("straight")));
        assert_eq!(straight.summary.outcome, Outcome::Collision);
        assert!((85.0..95.0).contains(&straight.summary.x_end));
        let ours = fly(&home(None));
        assert_eq!(ours.summary.outcome, Outcome::Survived);
        let heights = &ours.ticks.z;
        let top = heights.iter().fold(0.0_f64, |top, z| top.max(*z));
        assert!((40.0..75.0).contains(&top), "{top}");
        assert!(heights.last().unwrap() < &(top - 5.0));
        assert!(Look::again(&ours).is_some());
    });
    flown.unwrap().join().unwrap();
}

#[test]
fn heights_over_level_ground_are_refused() {
    let refused = |file: SpaceFile| file.build(None).unwrap_err().to_string();
    let level = SpaceFile {
        altitude: Some(9.0),
        ..SpaceFile::default()
    };
    assert!(refused(level).contains("half of the ceiling"));
    let two = SpaceFile {
        world: Some("forest".to_owned()),
        ..home(None)
    };
    assert!(refused(two).contains("or this height map"));
    let low = SpaceFile {
        altitude: Some(-1.0),
        ..home(None)
    };
    assert!(refused(low).contains("altitude: give more than 0"));
}
