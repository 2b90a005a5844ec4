//! Growing an RRT*-AR tree, one sample at a time.

use super::{GOALS, Node, Path, Tree};
use crate::Rules;
use crate::config::{SEARCH_COLS, SEARCH_ROW, SEARCH_ROWS, TREE_SAMPLES};
use crate::map::{GridPoint, OccupancyGrid};

/// Longest edge of a new node [m].
pub(super) const STEP: f64 = 2.5;

/// A node within this squared distance [m^2] of a goal has reached it. (The authors compare a
/// squared distance with the step.)
const GOAL_RADIUS_SQUARED: f64 = 2.5;

/// What a sample did to the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extension {
    /// A node was added.
    Added,
    /// The sample, the new node or (corrected rules) the edge lies in an occupied cell.
    Rejected,
    /// The tree is full, or its samples are used up: it is ready to be read.
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
    /// A search that has not begun.
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

    /// Draws one sample of the search box, `sample()` being uniform in [0, 1): downrange first,
    /// then height.
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
            || (self.rules == Rules::Corrected && !grid.segment_is_free(nearest.point, point));
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

    /// The first goal within reach of a point, over free cells where the rules check edges.
    fn reached_goal(&self, grid: &OccupancyGrid, point: GridPoint) -> Option<u8> {
        (0..).zip(&GOALS).find_map(|(number, goal)| {
            let (row, col) = (goal.row - point.row, goal.col - point.col);
            let near = row * row + col * col < GOAL_RADIUS_SQUARED;
            let free = self.rules == Rules::Authors || grid.segment_is_free(point, *goal);
            (near && free).then_some(number)
        })
    }

    /// Writes the path over the first node from `from` on that reached a goal, and gives the
    /// node after it: where to go on. None when no more such nodes exist.
    pub fn next_path(&self, from: usize, path: &mut Path) -> Option<usize> {
        (from..self.tree.nodes().len())
            .find(|index| self.tree.path_over(*index, path))
            .map(|index| index + 1)
    }
}

impl Default for Search {
    fn default() -> Self {
        Self::new()
    }
}
