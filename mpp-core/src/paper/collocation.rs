//! Paths of the trees as collocation points, one for each stage boundary (paper, section III-A).

use super::{GridPoint, Rules};
use crate::config::KNOTS;
use crate::paper::config::{ORIGIN_COL, ORIGIN_ROW, PATH_POINTS, SEARCH_ROW};

/// Distance of the goals ahead of the aircraft \[m\].
pub const GOAL_DISTANCE: f64 = 54.0;

/// Goals of the search in grid coordinates: straight ahead, and 5 m above and below.
///
/// The authors list four goals, two of which coincide. The order of the list matters only for the
/// comparison of trees.
pub const GOALS: [GridPoint; 4] = {
    const fn ahead(row_in_box: f64) -> GridPoint {
        GridPoint {
            row: SEARCH_ROW as f64 + row_in_box,
            col: ORIGIN_COL as f64 + GOAL_DISTANCE,
        }
    }
    [ahead(10.0), ahead(5.0), ahead(5.0), ahead(15.0)]
};

const _: () = assert!(ORIGIN_ROW - SEARCH_ROW == 10);

/// The corner points of a path, from the aircraft to a goal.
pub type Path = heapless::Vec<GridPoint, PATH_POINTS>;

/// Points with equal spacing along a path, one for each stage boundary. At cruise speed equal spacing
/// means equal times.
pub type CollocationPoints = [GridPoint; KNOTS];

/// Length of a path \[m\].
#[must_use]
pub fn path_length(path: &[GridPoint]) -> f64 {
    path.windows(2)
        .map(|pair| match pair {
            [from, to] => from.distance(to),
            _ => 0.0,
        })
        .sum()
}

/// Resamples a path to collocation points. A path of a single point gives this point at every stage.
///
/// The authors stretch the last segment by 1 mm to avoid a division by zero, which moves the points of
/// the segment. The corrected rules do not stretch it.
#[must_use]
pub fn resample(path: &[GridPoint], rules: Rules) -> CollocationPoints {
    let mut points = [path.first().copied().unwrap_or(GridPoint::AIRCRAFT); KNOTS];
    let spacing = path_length(path) / (KNOTS - 1) as f64;
    let mut stage = 1;
    let mut passed = 0.0;
    for (index, pair) in path.windows(2).enumerate() {
        let [from, to] = pair else { continue };
        let is_last = index + 2 == path.len();
        let length = from.distance(to);
        let divisor = if rules.are_authors() && is_last {
            length + 1e-3
        } else {
            length
        };
        while let Some(point) = points.get_mut(stage) {
            let along = spacing * stage as f64 - passed;
            if along > length && !is_last {
                break;
            }
            *point = if divisor > 0.0 {
                from.towards(to, along / divisor)
            } else {
                *to
            };
            stage += 1;
        }
        passed += length;
    }
    points
}
