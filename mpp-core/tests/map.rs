//! Tests the occupancy grid against brute force, and the checks of a scan.

use crate::common::draw::Draw;
use crate::common::grids::grid;
use mpp_core::config::MAX_BEAMS;
use mpp_core::paper::config::{GRID_COLS, GRID_ROWS, ORIGIN_COL, ORIGIN_ROW};
use mpp_core::paper::{OccupancyGrid, Rules};
use mpp_core::sense::{LidarScan, ScanError};

const ROWS: i32 = GRID_ROWS as i32;

const COLS: i32 = GRID_COLS as i32;

/// Finds every occupied cell, also far beyond the edges.
fn occupied_cells(grid: &OccupancyGrid) -> Vec<(i32, i32)> {
    (-70..ROWS + 70)
        .flat_map(|row| (-70..COLS + 70).map(move |col| (row, col)))
        .filter(|(row, col)| grid.occupied(*row, *col))
        .collect()
}

/// The cells of the grid within one cell of any of `marked`.
fn padded(marked: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let near = |row: i32, col: i32| {
        marked
            .iter()
            .any(|(r, c)| (r - row).abs() <= 1 && (c - col).abs() <= 1)
    };
    (0..ROWS)
        .flat_map(|row| (0..COLS).map(move |col| (row, col)))
        .filter(|(row, col)| near(*row, *col))
        .collect()
}

#[test]
fn a_mark_marks_its_cell_alone_and_can_be_taken_back() {
    // These are the edges, and the columns on both sides of the words' boundaries.
    for row in [0, 1, 37, ROWS - 1] {
        for col in [0, 1, 62, 63, 64, 65, 126, 127, 128, 129, COLS - 2, COLS - 1] {
            let mut grid = OccupancyGrid::new();
            assert!(grid.mark(row, col));
            assert_eq!(occupied_cells(&grid), [(row, col)]);
            grid.unmark(row as usize, col as usize);
            assert_eq!(occupied_cells(&grid), []);
        }
    }
}

#[test]
fn cells_outside_are_refused_and_stay_free() {
    let mut grid = OccupancyGrid::new();
    for (row, col) in [
        (-1, 5),
        (ROWS, 5),
        (5, -1),
        (5, COLS),
        (5, 191),
        (5, 192),
        (i32::MIN, i32::MIN),
        (i32::MAX, i32::MAX),
    ] {
        assert!(!grid.mark(row, col) && !grid.occupied(row, col));
    }
    grid.unmark(GRID_ROWS, 0);
    grid.unmark(0, usize::MAX);
    assert_eq!(occupied_cells(&grid), []);
}

#[test]
fn padding_marks_the_eight_neighbours_across_words_and_edges() {
    for row in [0, 36, ROWS - 1] {
        for col in [0, 63, 64, 127, 128, COLS - 1] {
            let mut grid = OccupancyGrid::new();
            grid.mark(row, col);
            grid.pad();
            assert_eq!(occupied_cells(&grid), padded(&[(row, col)]));
        }
    }
    let mut draw = Draw::new(1);
    for cells in [10, 300, 3_000] {
        let mut grid = grid(&mut draw, cells);
        let expected = padded(&occupied_cells(&grid));
        grid.pad();
        assert_eq!(occupied_cells(&grid), expected);
    }
}

fn random_scan(draw: &mut Draw, beams: usize) -> LidarScan {
    let mut scan = LidarScan::new();
    scan.angle_min = draw.between(-1.5, 0.0);
    scan.angle_increment = draw.between(0.005, 0.04);
    for _ in 0..beams {
        let hit = draw.between(0.0, 1.0) < 0.7;
        let range = if hit {
            draw.between(0.1, 140.0) as f32
        } else {
            0.0
        };
        scan.ranges.push(range).unwrap();
    }
    scan
}

/// The cell where a beam ended, by plain trigonometry.
fn hit(scan: &LidarScan, beam: usize, pitch: f64) -> Option<(i32, i32)> {
    let range = f64::from(scan.ranges[beam]);
    let angle = pitch + scan.angle_min + scan.angle_increment * beam as f64;
    (range > 0.0).then(|| {
        (
            libm::floor(ORIGIN_ROW as f64 + range * libm::sin(angle)) as i32,
            libm::floor(ORIGIN_COL as f64 + range * libm::cos(angle)) as i32,
        )
    })
}

fn is_inside((row, col): &(i32, i32)) -> bool {
    (0..ROWS).contains(row) && (0..COLS).contains(col)
}

#[test]
fn rebuilding_marks_the_hits_and_their_neighbours_and_counts_the_rest() {
    let mut draw = Draw::new(2);
    let mut grid = grid(&mut draw, 500);
    let mut seen_outside = 0;
    for round in 0..60 {
        let scan = random_scan(&mut draw, 1 + round * 2);
        let pitch = draw.between(-0.8, 0.8);
        let hits: Vec<_> = (0..scan.ranges.len())
            .filter_map(|beam| hit(&scan, beam, pitch))
            .collect();
        let inside: Vec<_> = hits.iter().copied().filter(is_inside).collect();
        for rules in [Rules::Corrected, Rules::Authors] {
            let outside = grid.rebuild(&scan, pitch, rules);
            assert_eq!(outside, hits.len() - inside.len());
            let own = (ORIGIN_ROW as i32, ORIGIN_COL as i32);
            let kept: Vec<_> = inside
                .iter()
                .copied()
                .filter(|cell| rules == Rules::Corrected || *cell != own)
                .collect();
            assert_eq!(occupied_cells(&grid), padded(&kept));
        }
        seen_outside += hits.len() - inside.len();
    }
    assert!(seen_outside > 100, "the rounds tried hits outside");
}

#[test]
fn only_the_corrected_rules_keep_an_obstacle_within_a_metre() {
    let mut scan = LidarScan::new();
    scan.ranges.push(0.5).unwrap();
    let mut grid = OccupancyGrid::new();
    grid.rebuild(&scan, 0.1, Rules::Authors);
    assert_eq!(occupied_cells(&grid), []);
    grid.rebuild(&scan, 0.1, Rules::Corrected);
    assert_eq!(occupied_cells(&grid).len(), 9);
}

#[test]
fn a_scan_is_refused_for_each_fault_of_its_own() {
    let healthy = random_scan(&mut Draw::new(6), MAX_BEAMS);
    assert_eq!(healthy.check(MAX_BEAMS), Ok(()));
    let expected = ScanError::Length {
        expected: 100,
        found: MAX_BEAMS,
    };
    assert_eq!(healthy.check(100), Err(expected));
    let empty = LidarScan::new().check(100);
    assert!(matches!(empty, Err(ScanError::Length { found: 0, .. })));
    // Fewer beams than declared, and what drivers send for no return, are no faults; nor is a bad beam.
    let mut odd = healthy.clone();
    odd.ranges.truncate(64);
    for (beam, range) in [f32::NAN, f32::INFINITY, 81.91, 65.535, -1.0, -0.1]
        .into_iter()
        .enumerate()
    {
        odd.ranges[beam] = range;
    }
    assert_eq!((odd.check(MAX_BEAMS), odd.bad_beams()), (Ok(()), 2));
    odd.ranges[10..41].fill(f32::NEG_INFINITY);
    assert_eq!(odd.check(MAX_BEAMS), Err(ScanError::BadBeams { beam: 4 }));
    let turned = LidarScan {
        angle_min: f64::NAN,
        ..healthy.clone()
    };
    assert_eq!(turned.check(MAX_BEAMS), Err(ScanError::AngleNotFinite));
    let spread = LidarScan {
        angle_increment: f64::INFINITY,
        ..healthy
    };
    assert_eq!(spread.check(MAX_BEAMS), Err(ScanError::AngleNotFinite));
}
