//! Tests paths as collocation points: equally spaced, ends exact, degenerate paths.

use crate::common::draw::Draw;
use mpp_core::config::KNOTS;
use mpp_core::paper::{GridPoint, Rules, path_length, resample};

/// Rounding of lengths that are summed in another order \[m\].
const ROUNDING: f64 = 1e-9;

fn polyline(draw: &mut Draw, corners: usize) -> Vec<GridPoint> {
    let mut at = GridPoint::AIRCRAFT;
    let mut path = vec![at];
    for _ in 0..corners {
        at.row += draw.between(-2.0, 2.0);
        at.col += draw.between(0.0, 3.0);
        path.push(at);
        if draw.unit() < 0.2 {
            path.push(at);
        }
    }
    path
}

/// Distance along a polyline at which a point of it lies; `None` if the point is not on it.
fn arc_length(path: &[GridPoint], point: GridPoint, from: f64) -> Option<f64> {
    let mut passed = 0.0;
    for pair in path.windows(2) {
        let length = pair[0].distance(&pair[1]);
        let along = pair[0].distance(&point);
        let on_it = along + point.distance(&pair[1]) - length < 1e-9;
        if on_it && passed + along >= from - 1e-6 {
            return Some(passed + along);
        }
        passed += length;
    }
    None
}

#[test]
fn resampled_points_are_spaced_equally_along_the_path() {
    let mut draw = Draw::new(4);
    for corners in 1..100 {
        let path = polyline(&mut draw, corners);
        let points = resample(&path, Rules::Corrected);
        let spacing = path_length(&path) / (KNOTS - 1) as f64;
        assert_eq!(points[0], path[0]);
        assert!(points[KNOTS - 1].distance(path.last().unwrap()) < ROUNDING);
        let mut passed = 0.0;
        for (stage, point) in points.iter().enumerate() {
            let at = arc_length(&path, *point, passed);
            assert!(
                at.is_some_and(|at| (at - spacing * stage as f64).abs() < 1e-5),
                "{stage}"
            );
            passed = spacing * stage as f64;
        }
    }
}

#[test]
fn the_authors_points_fall_short_by_their_millimetre_on_the_last_segment_alone() {
    let mut draw = Draw::new(7);
    let path = polyline(&mut draw, 30);
    let (ours, theirs) = (
        resample(&path, Rules::Corrected),
        resample(&path, Rules::Authors),
    );
    let worst = ours
        .iter()
        .zip(&theirs)
        .map(|(a, b)| a.distance(b))
        .fold(0.0, f64::max);
    assert!(worst > 1e-5 && worst <= 1e-3 + ROUNDING, "{worst}");
    assert_eq!(ours[..KNOTS / 2], theirs[..KNOTS / 2]);
}

#[test]
fn degenerate_paths_stay_where_they_are() {
    let here = GridPoint { row: 3.0, col: 4.0 };
    assert_eq!(
        resample(&[], Rules::Corrected),
        [GridPoint::AIRCRAFT; KNOTS]
    );
    for path in [vec![here], vec![here, here], vec![here; 5]] {
        for rules in [Rules::Corrected, Rules::Authors] {
            let points = resample(&path, rules);
            assert!(
                points.iter().all(|point| point.distance(&here) < ROUNDING),
                "{path:?}"
            );
        }
    }
}
