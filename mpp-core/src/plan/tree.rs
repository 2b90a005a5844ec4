//! The arena of an RRT*-AR tree and its rewiring (Choudhury, Scherer, Singh: "RRT*-AR:
//! Sampling-based alternate routes planning", ICRA 2013, algorithm 1).

use super::{GOALS, Path};
use crate::Rules;
use crate::config::TREE_NODES;
use crate::map::{GridPoint, OccupancyGrid};

/// Nodes within this distance [m] may be rewired: 1.5 steps.
const REWIRE_RADIUS: f64 = 1.5 * super::rrt::STEP;

/// Squares of distances [m^2] above this are of nodes beyond the radius, however the root is rounded.
const CERTAINLY_BEYOND: f64 = 1.001 * REWIRE_RADIUS * REWIRE_RADIUS;

/// Cost [m] added to a node for each of its children near a new node, so that near branches do
/// not all hang on the same parent: that is what makes routes alternate.
const CLOSE_PENALTY: f64 = 5.0;

/// A node of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Where it is.
    pub point: GridPoint,
    /// Its parent; none for the root.
    pub parent: Option<u16>,
    /// The goal that it reached, as an index of [`GOALS`].
    pub goal: Option<u8>,
    /// Length of the edge to its parent [m]. The authors do not renew it when a node gets another
    /// parent, and so compare stale costs.
    pub edge: f64,
}

/// A tree in an arena; the root is node 0.
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: heapless::Vec<Node, TREE_NODES>,
}

/// A node near the one to be wired.
#[derive(Clone, Copy)]
struct Neighbour {
    index: u16,
    parent: Option<u16>,
    /// Cost from the root [m].
    cost: f64,
    /// The same with the penalties of its children near by [m].
    penalized: f64,
    distance: f64,
}

impl Tree {
    /// A tree without nodes.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            nodes: heapless::Vec::new(),
        }
    }

    /// Its nodes in the order in which they were added.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Starts anew from a root.
    pub fn plant(&mut self, root: GridPoint) {
        self.nodes.clear();
        self.add(Node {
            point: root,
            parent: None,
            goal: None,
            edge: 0.0,
        });
    }

    /// Whether no more nodes fit.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.nodes.is_full()
    }

    /// Adds a node; a full arena takes no more, and says so.
    pub(super) fn add(&mut self, node: Node) -> bool {
        self.nodes.push(node).is_ok()
    }

    /// The nearest node that has not reached a goal.
    pub(super) fn nearest(&self, point: &GridPoint) -> Option<(u16, &Node)> {
        let mut nearest = None;
        let mut least = f64::INFINITY;
        for (index, node) in self.nodes.iter().enumerate() {
            let (row, col) = (point.row - node.point.row, point.col - node.point.col);
            let squared = row * row + col * col;
            if squared < least && node.goal.is_none() {
                least = squared;
                nearest = u16::try_from(index).ok().map(|index| (index, node));
            }
        }
        nearest
    }

    /// Cost from the root to a node [m]: the sum of the edges. A tree of `n` nodes has no path
    /// longer than `n`, which bounds the walk.
    fn cost(&self, index: u16) -> f64 {
        let mut cost = 0.0;
        let mut next = Some(index);
        for _ in 0..TREE_NODES {
            let Some(node) = next.and_then(|index| self.nodes.get(usize::from(index))) else {
                break;
            };
            cost += node.edge;
            next = node.parent;
        }
        cost
    }

    /// Wires the newest node: to the neighbour from which it is cheapest, penalties included, and
    /// then every neighbour to it that gets cheaper by it.
    pub(super) fn rewire_newest(&mut self, grid: &OccupancyGrid, rules: Rules) {
        let Some((newest, earlier)) = self.nodes.split_last() else {
            return;
        };
        let point = newest.point;
        let current = earlier.len() as u16;
        let mut neighbours = heapless::Vec::new();
        self.find_neighbours(current, point, grid, rules, &mut neighbours);
        let cheapest = neighbours
            .iter()
            .fold(None, |best: Option<(f64, Neighbour)>, n| {
                let cost = n.penalized + n.distance;
                match best {
                    Some((least, _)) if cost >= least => best,
                    _ => Some((cost, *n)),
                }
            });
        let Some((mut own_cost, parent)) = cheapest else {
            return;
        };
        self.set_parent(current, parent.index, parent.distance, rules);

        sort_by_cost(&mut neighbours);
        let mut penalty_due = true;
        for neighbour in &neighbours {
            if own_cost + neighbour.distance < neighbour.cost {
                self.set_parent(neighbour.index, current, neighbour.distance, rules);
                if penalty_due {
                    own_cost += CLOSE_PENALTY;
                    penalty_due = false;
                }
            }
        }
    }

    fn set_parent(&mut self, index: u16, parent: u16, distance: f64, rules: Rules) {
        if let Some(node) = self.nodes.get_mut(usize::from(index)) {
            node.parent = Some(parent);
            if rules == Rules::Corrected {
                node.edge = distance;
            }
        }
    }

    /// Adds the nodes before `current` within the rewiring radius of `point`, with their penalties.
    /// (Returned by value, the list would be copied each time.)
    fn find_neighbours(
        &self,
        current: u16,
        point: GridPoint,
        grid: &OccupancyGrid,
        rules: Rules,
        neighbours: &mut heapless::Vec<Neighbour, TREE_NODES>,
    ) {
        for (index, node) in (0..current).zip(&self.nodes) {
            // Most nodes are far away, and a flight computer takes the root in software.
            let (row, col) = (node.point.row - point.row, node.point.col - point.col);
            if row * row + col * col > CERTAINLY_BEYOND {
                continue;
            }
            let distance = node.point.distance(&point);
            let reachable = distance <= REWIRE_RADIUS
                && (rules == Rules::Authors || grid.segment_is_free(node.point, point));
            if reachable {
                let cost = self.cost(index);
                // As many places as nodes: the push cannot fail.
                let _ = neighbours.push(Neighbour {
                    index,
                    parent: node.parent,
                    cost,
                    penalized: cost,
                    distance,
                });
            }
        }
        for child in 0..neighbours.len() {
            let parent = neighbours.get(child).and_then(|child| child.parent);
            let near_parent = neighbours
                .iter_mut()
                .find(|near| Some(near.index) == parent);
            if let Some(near_parent) = near_parent {
                near_parent.penalized += CLOSE_PENALTY;
            }
        }
    }

    /// Writes the path from the root over node `index` to the goal that it reached; false when it
    /// reached none.
    pub fn path_over(&self, index: usize, path: &mut Path) -> bool {
        path.clear();
        let Some(node) = self.nodes.get(index) else {
            return false;
        };
        let Some(goal) = node.goal.and_then(|goal| GOALS.get(usize::from(goal))) else {
            return false;
        };
        // Depth is bounded by the number of nodes, and the path has a place more than that.
        let _ = path.push(*goal);
        let mut next = Some(node);
        for _ in 0..TREE_NODES {
            let Some(node) = next else { break };
            let _ = path.push(node.point);
            next = node
                .parent
                .and_then(|parent| self.nodes.get(usize::from(parent)));
        }
        path.reverse();
        true
    }
}

/// Sorts by cost, then by index. Neighbours are few, and the library's sort can panic (on an order
/// that contradicts itself, which the compiler does not see is none).
fn sort_by_cost(mut neighbours: &mut [Neighbour]) {
    while let Some((first, others)) = neighbours.split_first_mut() {
        for other in others.iter_mut() {
            if other
                .cost
                .total_cmp(&first.cost)
                .then(other.index.cmp(&first.index))
                .is_lt()
            {
                core::mem::swap(first, other);
            }
        }
        neighbours = others;
    }
}

impl Default for Tree {
    fn default() -> Self {
        Self::new()
    }
}
