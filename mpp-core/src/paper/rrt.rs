//! The growth of an RRT*-AR tree, one sample at a time.

use super::tree::STEP;
use super::{GOALS, GridPoint, Node, OccupancyGrid, Path, Rules, Tree};
use crate::paper::config::{SEARCH_COLS, SEARCH_ROW, SEARCH_ROWS, TREE_SAMPLES};

/// Squared distance [m^2] from a goal within which a node has reached it. The authors compare a squared
/// distance with the step.
const GOAL_RADIUS_SQUARED: f64 = 2.5;

/// The effect of one sample on the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extension {
    /// The tree has a new node.
    Added,
    /// The sample, the new node or (corrected rules) the edge lies in an occupied cell.
    Rejected,
    /// The tree is full, or its samples are used up. The caller can read its paths.
    Complete,
}

/// One tree, from its root to its last sample.
#[derive(Clone, Debug)]
pub struct Search {
    tree: Tree,
    samples: usize,
    rules: Rules,
}

impl Search {
    /// A search before its first tree.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            tree: Tree::new(),
            samples: 0,
            rules: Rules::Corrected,
        }
    }

    /// Starts a new tree at the aircraft.
    pub fn restart(&mut self, rules: Rules) {
        self.tree.plant(GridPoint::AIRCRAFT);
        self.samples = 0;
        self.rules = rules;
    }

    /// The tree so far.
    #[must_use]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Draws one sample in the search box: first the downrange position, then the height. `sample()` gives
    /// uniform numbers in [0, 1).
    pub fn extend(&mut self, grid: &OccupancyGrid, mut sample: impl FnMut() -> f64) -> Extension {
        if self.tree.is_full() || self.samples >= TREE_SAMPLES {
            return Extension::Complete;
        }
        self.samples += 1;
        let col = SEARCH_COLS as f64 * sample();
        let row = SEARCH_ROW as f64 + SEARCH_ROWS as f64 * sample();
        let target = GridPoint { row, col };
        if grid.occupied_at(target) {
            return Extension::Rejected;
        }
        let Some((parent, nearest)) = self.tree.nearest(&target) else {
            return Extension::Rejected;
        };
        let distance = nearest.point.distance(&target);
        let (point, edge) = if distance <= STEP {
            (target, distance)
        } else {
            (nearest.point.towards(&target, STEP / distance), STEP)
        };
        let blocked = grid.occupied_at(point)
            || (!self.rules.are_authors() && !grid.segment_is_free(nearest.point, point));
        if blocked {
            return Extension::Rejected;
        }
        let goal = self.reached_goal(grid, point);
        self.tree.add(Node {
            point,
            parent: Some(parent),
            goal,
            edge,
        });
        self.tree.rewire_newest(grid, self.rules);
        Extension::Added
    }

    /// The first goal within reach of a point. Rules that check edges also ask for free cells on the way.
    fn reached_goal(&self, grid: &OccupancyGrid, point: GridPoint) -> Option<u8> {
        (0..).zip(&GOALS).find_map(|(number, goal)| {
            let (row, col) = (goal.row - point.row, goal.col - point.col);
            let near = row * row + col * col < GOAL_RADIUS_SQUARED;
            let free = self.rules.are_authors() || grid.segment_is_free(point, *goal);
            (near && free).then_some(number)
        })
    }

    /// Finds the first node from `from` on that reached a goal, and writes the path over this node. Returns
    /// the index of the following node, at which the next call continues, or `None` if no such node is left.
    pub fn next_path(&self, from: usize, path: &mut Path) -> Option<usize> {
        (from..self.tree.nodes().len())
            .find(|index| self.tree.path_over(*index, path))
            .map(|index| index + 1)
    }
}
