//! Tests the lidar against slow, simple computations.

use super::*;
use crate::field::{Obstacle, ObstacleField};
use crate::generator::Generator;
use mpp_core::vehicle::AirState;
use proptest::prelude::*;

const EXACT: LidarConfig = LidarConfig {
    range_error: 0.0,
    ..LidarConfig::PAPER
};

fn pose(x: f64, z: f64, pitch: f64) -> VehicleState {
    VehicleState {
        x,
        z,
        air: AirState {
            pitch,
            ..AirState::default()
        },
    }
}

fn one_obstacle(x: f64, z: f64) -> ObstacleField {
    ObstacleField::new(vec![Obstacle::circle(x, z, 1.0)])
}

/// The paper's field.
fn papers(seed: u64, count: usize) -> ObstacleField {
    ObstacleField::new(Generator::PAPER.obstacles(seed, count, 50.0, 20.0))
}

/// One beam along the body axis.
fn beam(rule: LidarRule) -> LidarConfig {
    LidarConfig {
        beams: 1,
        field_of_view: 0.0,
        rule,
        ..EXACT
    }
}

fn range_of_beam(state: &VehicleState, field: &ObstacleField) -> f64 {
    beam(LidarRule::Nearest).exact_ranges(state, field)[0]
}

#[test]
fn a_beam_measures_the_near_face() {
    let level = pose(0.0, 50.0, 0.0);
    assert!((range_of_beam(&level, &one_obstacle(20.0, 50.0)) - 19.0).abs() < 1e-12);
    assert!((range_of_beam(&level, &one_obstacle(46.0, 50.0)) - 45.0).abs() < 1e-12);
    let climbing = pose(0.0, 0.0, core::f64::consts::FRAC_PI_4);
    assert!((range_of_beam(&climbing, &one_obstacle(10.0, 10.0)) - 13.142_135_623_7).abs() < 1e-9);
}

#[test]
fn a_beam_sees_nothing_behind_aside_or_too_far() {
    let level = pose(0.0, 50.0, 0.0);
    for field in [
        one_obstacle(-20.0, 50.0),
        one_obstacle(20.0, 51.01),
        one_obstacle(46.1, 50.0),
    ] {
        assert!(range_of_beam(&level, &field).abs() < 1e-300);
    }
}

#[test]
fn from_inside_or_on_the_edge_the_obstacle_is_at_the_window() {
    for x in [0.0, 0.5, 1.0] {
        let range = range_of_beam(&pose(0.0, 50.0, 0.0), &one_obstacle(x, 50.0));
        assert!((range - RANGE_MIN).abs() < 1e-15, "{x}: {range}");
    }
}

#[test]
fn beams_turn_with_the_body_and_run_from_low_to_high() {
    let field = one_obstacle(20.0, 50.0);
    let hits = |pitch: f64| {
        let ranges = EXACT.exact_ranges(&pose(0.0, 50.0, pitch), &field);
        assert_eq!(ranges.len(), 100);
        ranges.iter().position(|&range| range > 0.0)
    };
    let level = hits(0.0).unwrap();
    assert!((46..50).contains(&level));
    // Ten beams span a little over ten degrees. With the nose up, a lower beam meets the obstacle.
    assert_eq!(hits(10.0_f64.to_radians()), Some(level - 10));
    assert_eq!(hits(80.0_f64.to_radians()), None);
}

#[test]
fn authors_rule_ignores_an_obstacle_whose_centre_is_outside_the_fan() {
    let fan = LidarConfig {
        field_of_view: 0.02,
        beams: 3,
        ..EXACT
    };
    let field = one_obstacle(20.0, 50.5);
    let count = |rule| {
        let ranges = LidarConfig { rule, ..fan }.exact_ranges(&pose(0.0, 50.0, 0.0), &field);
        ranges.iter().filter(|&&range| range > 0.0).count()
    };
    assert_eq!(count(LidarRule::Nearest), 3);
    assert_eq!(count(LidarRule::Authors), 0);
}

#[test]
fn authors_rule_takes_the_far_face_where_it_is_nearer_to_the_origin() {
    // The beam points steeply downwards early in the flight, so the lower point is nearer to
    // (0, 0).
    let state = pose(0.0, 50.0, -1.2);
    let direction = libm::sincos(-1.2);
    let field = one_obstacle(10.0 * direction.1, 50.0 + 10.0 * direction.0);
    let narrow = |rule| LidarConfig {
        field_of_view: 0.1,
        beams: 3,
        ..beam(rule)
    };
    let range = |rule| narrow(rule).exact_ranges(&state, &field)[1];
    assert!((range(LidarRule::Nearest) - 9.0).abs() < 1e-9);
    assert!((range(LidarRule::Authors) - 11.0).abs() < 1e-9);
}

#[test]
fn a_seed_is_a_scan_and_the_error_grows_with_range() {
    let state = pose(0.0, 50.0, 0.0);
    let wall = ObstacleField::new(vec![Obstacle::circle(130.0, 50.0, 100.0)]);
    let scan = |seed| FanLidar::new(seed, LidarConfig::PAPER).scan(&state, &wall);
    assert_eq!(scan(1), scan(1));
    assert_ne!(scan(1), scan(2));

    let exact = EXACT.exact_ranges(&state, &wall);
    let mut lidar = FanLidar::new(3, LidarConfig::PAPER);
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..500 {
        for (noisy, exact) in lidar.scan(&state, &wall).into_iter().zip(&exact) {
            assert_eq!(noisy > 0.0, *exact > 0.0);
            assert!(noisy <= 45.0);
            // Beyond 43 m the greatest range cuts the error off.
            if *exact > 0.0 && *exact < 43.0 {
                let share = f64::from(noisy) / exact - 1.0;
                sum += share * share;
                count += 1.0;
            }
        }
    }
    let sigma = f64::sqrt(sum / count);
    assert!((sigma - 0.01).abs() < 2e-4, "{sigma}");
}

#[test]
fn without_error_a_scan_is_the_exact_ranges() {
    let field = papers(9, 20);
    let state = pose(20.0, 50.0, 0.15);
    for config in [EXACT, LidarConfig::AUTHORS] {
        let exact = config.exact_ranges(&state, &field);
        let scan = FanLidar::new(0, config).scan(&state, &field);
        assert!(scan.iter().any(|&range| range > 0.0));
        for (scanned, exact) in scan.into_iter().zip(exact) {
            assert_eq!(scanned.to_bits(), (exact as f32).to_bits());
        }
    }
}

/// First point inside an obstacle, found by walking the beam.
fn marched_range(from: Point, direction: Point, field: &ObstacleField, step: f64) -> f64 {
    (1..=(45.0 / step) as usize)
        .map(|k| k as f64 * step)
        .find(|t| {
            let point = (from.0 + t * direction.0, from.1 + t * direction.1);
            field.clearance_of_motion(point, point, 0.0) <= 0.0
        })
        .unwrap_or(0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn nearest_agrees_with_marching(
        seed in 0_u64..1000,
        x in 0.0..230.0,
        z in 42.0..58.0,
        pitch in -0.6..0.6,
    ) {
        const STEP: f64 = 0.002;
        let field = papers(seed, 40);
        prop_assume!(field.clearance_of_motion((x, z), (x, z), 0.0) > 0.1);
        let config = LidarConfig { beams: 12, ..EXACT };
        let ranges = config.exact_ranges(&pose(x, z, pitch), &field);
        for (index, range) in ranges.into_iter().enumerate() {
            let angle = (-50.0 + 100.0 / 11.0 * index as f64).to_radians();
            let direction = (libm::cos(pitch + angle), libm::sin(pitch + angle));
            let marched = marched_range((x, z), direction, &field, STEP);
            // The walk can skip a graze that is shorter than a step; the entry is then the middle
            // of a chord. The walk also misses the last step at the edge of the range.
            let grazes = || {
                let middle = (x + range * direction.0, z + range * direction.1);
                let deeper = (middle.0 + STEP * direction.0, middle.1 + STEP * direction.1);
                field.clearance_of_motion(deeper, deeper, 0.0) > 0.0
            };
            prop_assert!(
                (range..=range + STEP).contains(&marched) || grazes() || range > 45.0 - STEP,
                "beam {index}: {range} against {marched}"
            );
        }
    }
}
