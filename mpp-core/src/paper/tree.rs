//! The arena of an RRT*-AR tree and its rewiring (Choudhury, Scherer, Singh: "RRT*-AR:
//! Sampling-based alternate routes planning", ICRA 2013, algorithm 1).

use super::{GOALS, GridPoint, OccupancyGrid, Path, Rules};
use crate::paper::config::TREE_NODES;

/// Longest edge of a new node \[m\].
pub(super) const STEP: f64 = 2.5;

/// Greatest distance \[m\] of a node that the tree may rewire: 1.5 steps.
const REWIRE_RADIUS: f64 = 1.5 * STEP;

/// Squared distance [m^2] above which a node is certainly beyond the radius, however the root is rounded.
const CERTAINLY_BEYOND: f64 = 1.001 * REWIRE_RADIUS * REWIRE_RADIUS;

/// Cost \[m\] added to a node for each of its children near a new node. Because of this penalty near
/// branches do not all have the same parent, and the tree finds alternative routes.
const CLOSE_PENALTY: f64 = 5.0;

/// A node of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Position of the node.
    pub point: GridPoint,
    /// Index of the parent; `None` for the root.
    pub parent: Option<u16>,
    /// The goal that the node reached, as an index of [`GOALS`].
    pub goal: Option<u8>,
    /// Length of the edge to the parent \[m\]. The authors do not update it when a node gets another parent,
    /// and therefore compare outdated costs.
    pub edge: f64,
}

/// A tree in an arena. The root is node 0.
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: heapless::Vec<Node, TREE_NODES>,
    /// The nodes near the newest one.
    near: heapless::Vec<Neighbour, TREE_NODES>,
}

/// A node near the newest one.
#[derive(Clone, Copy, Debug)]
struct Neighbour {
    index: u16,
    parent: Option<u16>,
    /// Cost from the root \[m\].
    cost: f64,
    /// Cost from the root, with the penalties for the node's children near the new node \[m\].
    penalized: f64,
    distance: f64,
}

impl Tree {
    /// A tree without nodes.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            nodes: heapless::Vec::new(),
            near: heapless::Vec::new(),
        }
    }

    /// The nodes in the order in which they were added.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Clears the tree and adds a root.
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

    /// Adds a node. Returns false if the arena is full.
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

    /// Connects the newest node to the neighbour that gives it the least cost, penalties included. The newest
    /// node then becomes the parent of every neighbour whose cost falls by that.
    pub(super) fn rewire_newest(&mut self, grid: &OccupancyGrid, rules: Rules) {
        let Some((newest, earlier)) = self.nodes.split_last() else {
            return;
        };
        let point = newest.point;
        let parent = newest.parent;
        let current = earlier.len() as u16;
        self.find_neighbours((current, point, parent), grid, rules);
        let cheapest = self
            .near
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
        let Self { nodes, near } = self;
        set_parent(nodes, current, parent.index, parent.distance, rules);

        sort_by_cost(near);
        let mut penalty_due = true;
        for neighbour in near {
            if own_cost + neighbour.distance < neighbour.cost {
                set_parent(nodes, neighbour.index, current, neighbour.distance, rules);
                if penalty_due {
                    own_cost += CLOSE_PENALTY;
                    penalty_due = false;
                }
            }
        }
    }

    /// Lists the nodes before the newest one, `(index, point, parent)`, within its rewiring radius, with their
    /// penalties. The edge from the parent is known to be free.
    fn find_neighbours(
        &mut self,
        (current, point, parent): (u16, GridPoint, Option<u16>),
        grid: &OccupancyGrid,
        rules: Rules,
    ) {
        let Self { nodes, near } = self;
        near.clear();
        for (index, node) in (0..current).zip(nodes.iter()) {
            // Most nodes are far away, and a flight computer computes the root in software.
            let (row, col) = (node.point.row - point.row, node.point.col - point.col);
            if row * row + col * col > CERTAINLY_BEYOND {
                continue;
            }
            let distance = node.point.distance(&point);
            let reachable = distance <= REWIRE_RADIUS
                && (rules.are_authors()
                    || parent == Some(index)
                    || grid.segment_is_free(node.point, point));
            if reachable {
                let cost = cost(nodes, index);
                // The list has as many places as the tree has nodes, so the push cannot fail.
                let _ = near.push(Neighbour {
                    index,
                    parent: node.parent,
                    cost,
                    penalized: cost,
                    distance,
                });
            }
        }
        for child in 0..near.len() {
            let parent = near.get(child).and_then(|child| child.parent);
            let near_parent = near.iter_mut().find(|near| Some(near.index) == parent);
            if let Some(near_parent) = near_parent {
                near_parent.penalized += CLOSE_PENALTY;
            }
        }
    }

    /// Writes the path from the root over node `index` to the goal that the node reached. Returns false if
    /// the node reached no goal.
    pub fn path_over(&self, index: usize, path: &mut Path) -> bool {
        path.clear();
        let Some(node) = self.nodes.get(index) else {
            return false;
        };
        let Some(goal) = node.goal.and_then(|goal| GOALS.get(usize::from(goal))) else {
            return false;
        };
        // The number of nodes bounds the depth, and the path has one place more. The pushes cannot fail.
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

/// Cost from the root to a node \[m\]: the sum of the edges. In a tree of `n` nodes no path has more than
/// `n` nodes, which bounds the walk.
fn cost(nodes: &[Node], index: u16) -> f64 {
    let mut cost = 0.0;
    let mut next = Some(index);
    for _ in 0..TREE_NODES {
        let Some(node) = next.and_then(|index| nodes.get(usize::from(index))) else {
            break;
        };
        cost += node.edge;
        next = node.parent;
    }
    cost
}

fn set_parent(nodes: &mut [Node], index: u16, parent: u16, distance: f64, rules: Rules) {
    if let Some(node) = nodes.get_mut(usize::from(index)) {
        node.parent = Some(parent);
        if !rules.are_authors() {
            node.edge = distance;
        }
    }
}

/// Sorts by cost, then by index. Neighbours are few. The library's sort can panic on an inconsistent
/// order, and the compiler does not see that this order is consistent.
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
