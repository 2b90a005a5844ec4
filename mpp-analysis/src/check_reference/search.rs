//! Check of RRT*-AR with its recorded random stream.

use super::perception::grid_with;
use super::report::{Comparison, worst_difference};
use mpp_core::paper::config::SEARCH_ROW;
use mpp_core::paper::{Extension, Path, Rules, Search};
use serde::Deserialize;

#[derive(Deserialize)]
struct TreeFile {
    /// Occupied cells as `[col, row in the search box]`.
    occupied: Vec<[i32; 2]>,
    first_run: Run,
}

#[derive(Deserialize)]
struct Run {
    stream: Vec<f64>,
    tree: Vec<[f64; 2]>,
    parent: Vec<i32>,
    in_goal: Vec<u8>,
    cost: Vec<f64>,
    paths: Vec<Vec<[f64; 2]>>,
}

/// Grows one tree from the recorded stream: nodes, edges, parents, goals and paths must agree.
pub(super) fn check_tree(text: &str) -> Result<Vec<Comparison>, serde_json::Error> {
    const KIND: &str = "RRT*-AR tree (node for node)";
    let file: TreeFile = serde_json::from_str(text)?;
    let cells: Vec<[i32; 2]> = file
        .occupied
        .iter()
        .map(|[col, row]| [*row, *col])
        .collect();
    let grid = grid_with(&cells, SEARCH_ROW as i32);
    let run = &file.first_run;

    let mut search = Search::new();
    search.restart(Rules::Authors);
    let mut stream = run.stream.iter().copied();
    while search.extend(&grid, || stream.next().unwrap_or(f64::NAN)) != Extension::Complete {}
    if stream.next().is_some() {
        return Ok(vec![Comparison::failed(
            KIND,
            "part of the stream was not drawn",
        )]);
    }
    let nodes = search.tree().nodes();
    let parents: Vec<i32> = nodes
        .iter()
        .map(|node| node.parent.map_or(-1, i32::from))
        .collect();
    let goals: Vec<u8> = nodes
        .iter()
        .map(|node| node.goal.map_or(0, |goal| goal + 1))
        .collect();
    if parents != run.parent || goals != run.in_goal {
        return Ok(vec![Comparison::failed(KIND, "parents or goals differ")]);
    }
    let points: Vec<f64> = nodes.iter().flat_map(|node| in_box(node.point)).collect();
    let edges: Vec<f64> = nodes.iter().map(|node| node.edge).collect();
    let error = worst_difference(&points, run.tree.iter().flatten())
        .max(worst_difference(&edges, &run.cost));
    Ok(vec![
        Comparison::within(KIND, error, 1e-9),
        Comparison::within("RRT*-AR paths", compare_paths(&search, &run.paths), 1e-9),
    ])
}

fn in_box(point: mpp_core::paper::GridPoint) -> [f64; 2] {
    [point.col, point.row - SEARCH_ROW as f64]
}

fn compare_paths(search: &Search, recorded: &[Vec<[f64; 2]>]) -> f64 {
    let mut path = Path::new();
    let mut next = 0;
    let mut worst = 0.0_f64;
    for theirs in recorded {
        match search.next_path(next, &mut path) {
            None => return f64::NAN,
            Some(after) => next = after,
        }
        let ours: Vec<f64> = path.iter().flat_map(|point| in_box(*point)).collect();
        let error = worst_difference(&ours, theirs.iter().flatten());
        if error.is_nan() {
            return error;
        }
        worst = worst.max(error);
    }
    if search.next_path(next, &mut path).is_some() {
        f64::NAN
    } else {
        worst
    }
}
