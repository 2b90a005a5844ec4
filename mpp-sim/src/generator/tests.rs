//! Tests of the generators.

use super::*;
use crate::field::{Field, ObstacleField, Point, Shape};

const ALTITUDE: f64 = 50.0;

fn drawn(name: GeneratorName, seed: u64, count: usize) -> Vec<Obstacle> {
    Generator::named(name).obstacles(seed, count, ALTITUDE, 20.0)
}

fn circles(obstacles: &[Obstacle]) -> Vec<(Point, f64)> {
    let circle = |one: &Obstacle| match one.shape {
        Shape::Circle { centre, radius } => Some((centre, radius)),
        _ => None,
    };
    obstacles.iter().filter_map(circle).collect()
}

/// Whether everything that a generator makes is a circle.
fn makes_circles(generator: &Generator) -> bool {
    match generator.name {
        GeneratorName::Paper
        | GeneratorName::Sealed
        | GeneratorName::Endless
        | GeneratorName::Forest => true,
        GeneratorName::Canyon | GeneratorName::Slalom | GeneratorName::Walls => false,
        GeneratorName::Wires => generator.length <= 0.0,
    }
}

#[test]
fn the_papers_field_is_the_papers() {
    let field = circles(&drawn(GeneratorName::Paper, 5, 20));
    assert_eq!(field.len(), 20);
    assert!((field[0].0.0 - 25.0).abs() < 1e-12 && (field[19].0.0 - 240.0).abs() < 1e-12);
    for pair in field.windows(2) {
        assert!((pair[1].0.0 - pair[0].0.0 - 215.0 / 19.0).abs() < 1e-12);
    }
    for ((_, z), radius) in &field {
        assert!((z - ALTITUDE).abs() <= 10.0 && (radius - 1.0).abs() < 1e-15);
    }
    let heights = circles(&drawn(GeneratorName::Paper, 0, 10_000));
    let heights = heights.iter().map(|((_, z), _)| *z);
    let mean = heights.clone().sum::<f64>() / 10_000.0;
    assert!((mean - 50.0).abs() < 0.25, "{mean}");
    assert!(heights.clone().fold(f64::INFINITY, f64::min) < 40.02);
    assert!(heights.fold(0.0, f64::max) > 59.98);
}

#[test]
fn a_seed_is_a_field_and_its_start_is_free() {
    for name in GeneratorName::ALL {
        for seed in 0..50 {
            let obstacles = drawn(name, seed, 12);
            assert_eq!(obstacles, drawn(name, seed, 12), "{name}");
            assert_ne!(obstacles, drawn(name, seed + 1, 12), "{name}");
            let field = ObstacleField::new(obstacles);
            let ahead = field.clearance_of_motion((0.0, ALTITUDE), (5.0, ALTITUDE), 0.0);
            assert!(ahead > 2.0, "{name} {seed}: {ahead}");
        }
        let generator = Generator::named(name);
        assert!(
            name == GeneratorName::Canyon || drawn(name, 1, 0).is_empty(),
            "{name}"
        );
        let all = drawn(name, 1, 30);
        assert_eq!(
            makes_circles(&generator),
            circles(&all).len() == all.len(),
            "{name}"
        );
    }
}

/// The paper's field leaves a lane free along the edge of the band. Through a sealed field leads no
/// level way within the band that is free for all seeds.
#[test]
fn no_free_lane_runs_along_the_band_of_a_sealed_field() {
    let lane = |name, z: f64| {
        let free = |seed: &u64| {
            let field = ObstacleField::new(drawn(name, *seed, 160));
            field.clearance_of_motion((0.0, z), (250.0, z), 0.0) > 0.0
        };
        (0..50).filter(free).count()
    };
    let edge = ALTITUDE + BAND;
    assert_eq!(lane(GeneratorName::Paper, edge), 50);
    for z in [edge, ALTITUDE - BAND, ALTITUDE, edge - 0.9] {
        assert_eq!(lane(GeneratorName::Sealed, z), 0, "{z}");
    }
}

#[test]
fn an_endless_field_goes_on_for_as_long_as_the_flight() {
    let generator = Generator::named(GeneratorName::Endless);
    for (duration, count) in [(20.0, 40), (200.0, 40), (200.0, 5)] {
        let mut found = 0;
        for seed in 0..20 {
            let field = circles(&generator.obstacles(seed, count, ALTITUDE, duration));
            found += field.len();
            assert!(field.iter().all(|((x, _), _)| *x <= 15.0 * duration + 60.0));
            assert!(field.windows(2).all(|pair| pair[0].0.0 <= pair[1].0.0));
        }
        let expected = 20.0 * generator.expected(count, duration);
        // Four standard deviations of a Poisson process.
        let off = (found as f64 - expected).abs();
        assert!(off < 4.0 * expected.sqrt(), "{found} of {expected}");
    }
}

#[test]
fn a_forest_has_clusters_and_many_sizes() {
    let nearest = |name| {
        let field = circles(&drawn(name, 3, 60));
        let nearest = |(x, z): Point| {
            let apart = field.iter().map(|(o, _)| libm::hypot(o.0 - x, o.1 - z));
            apart
                .filter(|apart| *apart > 0.0)
                .fold(f64::INFINITY, f64::min)
        };
        field
            .iter()
            .map(|(centre, _)| nearest(*centre))
            .sum::<f64>()
            / 60.0
    };
    assert!(nearest(GeneratorName::Forest) < 0.75 * nearest(GeneratorName::Sealed));
    let radii: Vec<f64> = circles(&drawn(GeneratorName::Forest, 3, 60))
        .iter()
        .map(|c| c.1)
        .collect();
    assert!(radii.iter().all(|radius| (0.25..1.0).contains(radius)));
    assert!(radii.iter().any(|r| *r < 0.4) && radii.iter().any(|r| *r > 0.85));
}

/// A gap is where it is drawn, and is the only one: the walls bar every other height of the band.
#[test]
fn walls_have_one_gap_and_a_canyon_has_one_way() {
    for name in [GeneratorName::Walls, GeneratorName::Canyon] {
        let gap = Generator::named(name).gap;
        for seed in 0..30 {
            let field = ObstacleField::new(drawn(name, seed, 6));
            for x in [25.0, 68.0, 240.0] {
                let heights = (-1399..1399).map(|k| ALTITUDE + 0.01 * f64::from(k));
                let free: Vec<f64> = heights
                    .filter(|z| field.clearance_of_motion((x, *z), (x, *z), 0.0) > 0.0)
                    .collect();
                let (low, high) = (free[0], free[free.len() - 1]);
                assert!(
                    (high - low - gap).abs() < 0.03,
                    "{name} {seed}: {low} to {high}"
                );
                assert!(
                    (free.len() as f64 * 0.01 - gap).abs() < 0.03,
                    "{name} {seed}"
                );
                assert!(low > ALTITUDE - BAND - 0.02 && high < ALTITUDE + BAND + 0.02);
            }
        }
    }
}

#[test]
fn the_walls_of_a_slalom_come_from_above_and_below_in_turn() {
    let field = ObstacleField::new(drawn(GeneratorName::Slalom, 4, 2));
    let barred = |x: f64, z: f64| field.clearance_of_motion((x, z), (x, z), 0.0) < 0.0;
    for x in [25.0, 240.0] {
        assert!(barred(x, ALTITUDE));
        assert!(barred(x, ALTITUDE + 10.0) != barred(x, ALTITUDE - 10.0));
    }
    assert!(barred(25.0, ALTITUDE + 10.0) != barred(240.0, ALTITUDE + 10.0));
}

/// An obstacle that moves is at its drawn place when an aircraft at 12 m/s comes there.
#[test]
fn what_moves_is_met_where_it_was_drawn() {
    let still = drawn(GeneratorName::Sealed, 8, 30);
    let moving = Generator {
        velocity: (-3.0, 2.0),
        ..Generator::named(GeneratorName::Sealed)
    };
    let moving = moving.obstacles(8, 30, ALTITUDE, 20.0);
    let mut ups = 0;
    for ((place, _), one) in circles(&still).into_iter().zip(&moving) {
        assert!((one.velocity.0 + 3.0).abs() < 1e-12 && (one.velocity.1.abs() - 2.0).abs() < 1e-12);
        ups += usize::from(one.velocity.1 > 0.0);
        assert!((one.clearance(place, place.0 / 12.0) + 1.0).abs() < 1e-9);
    }
    assert!((5..26).contains(&ups), "{ups}");
}
