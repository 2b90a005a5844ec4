//! Tests rays, segments and corridors against marching in tiny steps.

use crate::common::draw::Draw;
use crate::common::grids::{grid, point};
use mpp_core::config::{KNOTS, STAGE_PERIOD, STAGES};
use mpp_core::corridor::{Corridor, DIRECTION_VECTORS};
use mpp_core::paper::config::{ORIGIN_COL, ORIGIN_ROW, RAY_LIMIT};
use mpp_core::paper::{GridPoint, OccupancyGrid, Padding, Rules, cast_ray};

/// Step of the marching with which rays are compared \[m\].
const MARCH: f64 = 1e-3;

/// Finds the first occupied cell by tiny steps. Returns its distance, or the limit.
fn march(grid: &OccupancyGrid, from: GridPoint, direction: [f64; 2], limit: f64) -> f64 {
    (0..)
        .map(|step| f64::from(step) * MARCH)
        .take_while(|travelled| *travelled < limit)
        .find(|travelled| {
            grid.occupied_at(GridPoint {
                row: from.row + direction[0] * travelled,
                col: from.col + direction[1] * travelled,
            })
        })
        .unwrap_or(limit)
}

/// Whether a ray that marching misses only clips a corner: it enters an occupied cell, but for no
/// more than a few steps.
fn clips_a_corner(
    grid: &OccupancyGrid,
    from: GridPoint,
    direction: [f64; 2],
    entered: f64,
) -> bool {
    let at = |travelled: f64| {
        grid.occupied_at(GridPoint {
            row: from.row + direction[0] * travelled,
            col: from.col + direction[1] * travelled,
        })
    };
    (-5..=100).any(|part| at(entered + f64::from(part) * MARCH / 50.0))
}

#[test]
fn rays_end_where_marching_ends() {
    let mut draw = Draw::new(3);
    let (mut short, mut full) = (0, 0);
    for round in 0..40 {
        let grid = grid(&mut draw, 20 + round * 20);
        for _ in 0..10 {
            let from = point(&mut draw);
            let angle = draw.between(-4.0, 4.0);
            let direction = [libm::sin(angle), libm::cos(angle)];
            let found = cast_ray(&grid, from, &direction);
            let expected = march(&grid, from, direction, RAY_LIMIT);
            let agrees = (found - expected).abs() <= 2.0 * MARCH
                || (found < expected && clips_a_corner(&grid, from, direction, found));
            assert!(
                agrees,
                "{found} against {expected} from {from:?} at {angle}"
            );
            short += usize::from(found < RAY_LIMIT);
            full += usize::from(found == RAY_LIMIT);
        }
    }
    assert!(short > 50 && full > 50, "{short} hits, {full} misses");
}

#[test]
fn rays_along_the_eight_directions_stop_at_the_near_side() {
    // A wall surrounds the aircraft's cell, 5 cells away on every side.
    let mut grid = OccupancyGrid::new();
    let (row, col) = (ORIGIN_ROW as i32, ORIGIN_COL as i32);
    for off in -6..=6 {
        for (r, c) in [(6, off), (-6, off), (off, 6), (off, -6)] {
            grid.mark(row + r, col + c);
        }
    }
    let middle = GridPoint {
        row: f64::from(row) + 0.5,
        col: f64::from(col) + 0.5,
    };
    for (index, direction) in DIRECTION_VECTORS.iter().enumerate() {
        let expected = if index % 2 == 0 {
            5.5
        } else {
            5.5 * libm::sqrt(2.0)
        };
        let found = cast_ray(&grid, middle, direction);
        assert!(
            (found - expected).abs() < 1e-6,
            "direction {index}: {found}"
        );
    }
    grid.mark(row, col);
    assert!(
        cast_ray(&grid, middle, &DIRECTION_VECTORS[0]) == 0.0,
        "within an obstacle"
    );
}

#[test]
fn segments_are_free_exactly_when_dense_samples_are() {
    let mut draw = Draw::new(4);
    let (mut free, mut blocked) = (0, 0);
    for round in 0..60 {
        let grid = grid(&mut draw, 10 + round * 20);
        for _ in 0..30 {
            let from = point(&mut draw);
            let to = from.towards(&point(&mut draw), draw.between(0.0, 0.4));
            let length = from.distance(&to);
            let direction = [(to.row - from.row) / length, (to.col - from.col) / length];
            let found = grid.segment_is_free(from, to);
            if found {
                assert!(
                    march(&grid, from, direction, length) >= length,
                    "{from:?} to {to:?}"
                );
                free += 1;
            } else {
                // Some cell on the way is occupied: finer samples find cells that coarse samples
                // may miss.
                let nearly = (0..=100_000).any(|part| {
                    let share = f64::from(part) / 1e5;
                    grid.occupied_at(from.towards(&to, share))
                });
                assert!(nearly, "{from:?} to {to:?}");
                blocked += 1;
            }
            assert_eq!(
                found,
                grid.segment_is_free(to, from),
                "both ways are the same"
            );
        }
    }
    assert!(
        free > 200 && blocked > 200,
        "{free} free, {blocked} blocked"
    );
}

#[test]
fn a_segment_of_no_length_is_free_where_its_cell_is() {
    let mut grid = OccupancyGrid::new();
    grid.mark(10, 20);
    let point = |row, col| GridPoint { row, col };
    assert!(!grid.segment_is_free(point(10.5, 20.5), point(10.5, 20.5)));
    assert!(grid.segment_is_free(point(11.5, 20.5), point(11.5, 20.5)));
}

#[test]
fn corridors_are_the_rays_less_the_padding_from_level_flight() {
    let mut draw = Draw::new(5);
    let padding = Padding {
        near: 0.75,
        far: 1.25,
    };
    let cruise = 12.0;
    for _ in 0..10 {
        let grid = grid(&mut draw, 200);
        let points: [GridPoint; KNOTS] = core::array::from_fn(|_| point(&mut draw));
        let mut corridor = Corridor::new();
        corridor.trace(&grid, &points, cruise, &padding, Rules::Corrected);
        for (stage, point) in points.iter().enumerate() {
            let share = stage as f64 / STAGES as f64;
            for (direction, bound) in DIRECTION_VECTORS.iter().zip(&corridor.bounds[stage]) {
                let reach = cast_ray(&grid, *point, direction);
                // A flight to the ray's end minus the padding is just on the half-plane.
                let kept = reach - padding.near - (padding.far - padding.near) * share;
                let level = cruise * STAGE_PERIOD * stage as f64;
                let up = point.row + kept * direction[0] - ORIGIN_ROW as f64;
                let forward = point.col + kept * direction[1] - ORIGIN_COL as f64 - level;
                let value = direction[0] * up + direction[1] * forward;
                assert!((value - bound).abs() < 1e-9);
            }
        }
    }
}
