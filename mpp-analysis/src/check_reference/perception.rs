//! Checks of lidar, occupancy grid and rays.

use super::report::{Comparison, worst_difference};
use mpp_core::corridor::DIRECTION_VECTORS;
use mpp_core::paper::config::{GRID_COLS, GRID_ROWS, SEARCH_ROW};
use mpp_core::paper::{GridPoint, OccupancyGrid, Rules, authors_ray};
use mpp_core::sense::LidarScan;
use mpp_core::vehicle::{AirState, VehicleState};
use mpp_sim::field::{Obstacle, ObstacleField};
use mpp_sim::lidar::LidarConfig;
use serde::Deserialize;
use std::collections::BTreeSet;

/// A grid with the given cells occupied, `row_offset` added to their rows.
pub(super) fn grid_with(cells: &[[i32; 2]], row_offset: i32) -> OccupancyGrid {
    let mut grid = OccupancyGrid::new();
    for [row, col] in cells {
        grid.mark(row + row_offset, *col);
    }
    grid
}

#[derive(Deserialize)]
struct LidarFile {
    pose_x_z_theta: [f64; 3],
    range: f64,
    fov: f64,
    n_rays: usize,
    relative_angles: Vec<f64>,
    obstacles: Vec<[f64; 3]>,
    rays_dx_dz: Vec<[f64; 2]>,
    occupied_after_padding: Vec<[i32; 2]>,
}

pub(super) fn check_lidar(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: LidarFile = serde_json::from_str(text)?;
    let recorded: Vec<f64> = file
        .rays_dx_dz
        .iter()
        .map(|[dx, dz]| libm::sqrt(dx * dx + dz * dz))
        .collect();
    let obstacles = file.obstacles.iter();
    let field = obstacles.map(|[x, z, radius]| Obstacle::circle(*x, *z, *radius));
    let field = ObstacleField::new(field.collect());
    let lidar = LidarConfig {
        beams: file.n_rays,
        field_of_view: file.fov,
        range_max: file.range,
        ..LidarConfig::AUTHORS
    };
    let [x, z, pitch] = file.pose_x_z_theta;
    let pose = VehicleState {
        x,
        z,
        air: AirState {
            pitch,
            ..AirState::default()
        },
    };
    let ranges = lidar.exact_ranges(&pose, &field);
    Ok(vec![
        Comparison::within("lidar ranges", worst_difference(&ranges, &recorded), 1e-9),
        compare_grid(&file, &recorded),
    ])
}

/// Compares the grid from the recorded ranges with the recorded grid, cell for cell.
fn compare_grid(file: &LidarFile, ranges: &[f64]) -> Comparison {
    const KIND: &str = "occupancy grid (cells)";
    let mut scan = LidarScan::new();
    if let [first, second, ..] = file.relative_angles[..] {
        scan.angle_min = first;
        scan.angle_increment = second - first;
    }
    for range in ranges {
        if scan.ranges.push(*range as f32).is_err() {
            return Comparison::failed(KIND, "more rays than a scan holds");
        }
    }
    let mut grid = OccupancyGrid::new();
    grid.rebuild(&scan, file.pose_x_z_theta[2], Rules::Authors);
    let recorded: BTreeSet<[i32; 2]> = file.occupied_after_padding.iter().copied().collect();
    let ours: BTreeSet<[i32; 2]> = (0..GRID_ROWS as i32)
        .flat_map(|row| (0..GRID_COLS as i32).map(move |col| [row, col]))
        .filter(|[row, col]| grid.occupied(*row, *col))
        .collect();
    Comparison::within(
        KIND,
        ours.symmetric_difference(&recorded).count() as f64,
        0.0,
    )
}

#[derive(Deserialize)]
struct RayFile {
    occupied: Vec<[i32; 2]>,
    origin_row_col: [f64; 2],
    hits_row_col: Vec<[f64; 2]>,
}

pub(super) fn check_rays(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    let file: RayFile = serde_json::from_str(text)?;
    let offset = SEARCH_ROW as i32;
    let grid = grid_with(&file.occupied, offset);
    let origin = GridPoint {
        row: file.origin_row_col[0] + f64::from(offset),
        col: file.origin_row_col[1],
    };
    let hits = DIRECTION_VECTORS.map(|direction| {
        let hit = authors_ray(&grid, origin, &direction);
        [hit.row - f64::from(offset), hit.col]
    });
    let error = worst_difference(hits.iter().flatten(), file.hits_row_col.iter().flatten());
    Ok(vec![Comparison::within("rays", error, 0.0)])
}
