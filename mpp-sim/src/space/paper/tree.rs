//! RRT*-AR in space (Choudhury, Scherer, Singh: "RRT*-AR: Sampling-based alternate routes planning", ICRA 2013, algorithm 1).

use super::points::{distance, mixed};
use super::room::Room;
use crate::random::{Draws, uniform};
use crate::space::world::Vector;

/// Nodes of a tree, and samples that it may draw. Source: those of the method in the plane, for a third dimension twice.
const NODES: usize = 300;
const SAMPLES: usize = 4 * NODES;
/// Longest edge of a new node \[m\], distance of nodes that it may rewire, and of a goal that it reaches. Source: as in the plane.
const STEP: f64 = 2.5;
const REWIRE: f64 = 1.5 * STEP;
const REACHED: f64 = STEP;
/// Cost of each child of a node near a new one \[m\]: it finds alternate routes. Source: as in the plane.
const CLOSE: f64 = 5.0;

struct Node {
    point: Vector,
    /// Itself for the root.
    parent: usize,
    /// Length of the edge to the parent \[m\].
    edge: f64,
    goal: Option<Vector>,
}

/// A tree whose root is its first node.
pub(super) struct Tree {
    nodes: Vec<Node>,
}

/// A node near the newest one.
struct Near {
    index: usize,
    /// Cost from the root, and with the penalties for its children near the newest node \[m\].
    cost: f64,
    penalized: f64,
    distance: f64,
}

impl Tree {
    /// Grows a tree from a root towards goals.
    pub(super) fn grow(
        room: &Room<'_>,
        root: &Vector,
        goals: &[Vector],
        draws: &mut Draws,
    ) -> Self {
        let mut tree = Self {
            nodes: vec![Node {
                point: *root,
                parent: 0,
                edge: 0.0,
                goal: None,
            }],
        };
        for _ in 0..SAMPLES {
            let [low, high] = &room.corners;
            let sample =
                core::array::from_fn(|axis| low[axis] + (high[axis] - low[axis]) * uniform(draws));
            tree.extend(room, &sample, goals);
            if tree.nodes.len() == NODES {
                break;
            }
        }
        tree
    }

    /// Adds a node towards a sample, if the way is free.
    fn extend(&mut self, room: &Room<'_>, sample: &Vector, goals: &[Vector]) {
        let open = self.nodes.iter().enumerate();
        let open = open.filter(|(_, node)| node.goal.is_none());
        let Some((far, parent)) = open
            .map(|(index, node)| (distance(&node.point, sample), index))
            .min_by(|a, b| a.0.total_cmp(&b.0))
        else {
            return;
        };
        let edge = far.min(STEP);
        let from = self.nodes[parent].point;
        let point = mixed(&from, sample, edge / far.max(1e-6));
        if !room.is_free(&from, &point, edge) {
            return;
        }
        let reached = |goal: &&Vector| {
            let left = distance(&point, goal);
            left < REACHED && room.is_free(&point, goal, left)
        };
        let goal = goals.iter().find(reached).copied();
        self.nodes.push(Node {
            point,
            parent,
            edge,
            goal,
        });
        self.rewire_newest(room);
    }

    /// Connects the newest node to the neighbour that gives it the least cost, penalties included. It becomes the parent of every
    /// neighbour whose cost falls by that.
    fn rewire_newest(&mut self, room: &Room<'_>) {
        let newest = self.nodes.len() - 1;
        let mut near = self.neighbours(newest, room);
        let cheapest = near.iter().min_by(|a, b| {
            let cost = |it: &Near| it.penalized + it.distance;
            cost(a).total_cmp(&cost(b))
        });
        let Some(parent) = cheapest else { return };
        let mut cost = parent.penalized + parent.distance;
        self.connect(newest, parent.index, parent.distance);
        near.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut penalty = CLOSE;
        for it in near {
            if cost + it.distance < it.cost {
                self.connect(it.index, newest, it.distance);
                cost += core::mem::take(&mut penalty);
            }
        }
    }

    fn connect(&mut self, node: usize, parent: usize, edge: f64) {
        self.nodes[node].parent = parent;
        self.nodes[node].edge = edge;
    }

    /// The nodes within the radius of a node with a free way to it.
    fn neighbours(&self, newest: usize, room: &Room<'_>) -> Vec<Near> {
        let (point, parent) = (self.nodes[newest].point, self.nodes[newest].parent);
        let mut near = Vec::new();
        for (index, node) in self.nodes[..newest].iter().enumerate() {
            let distance = distance(&node.point, &point);
            let is_near = distance <= REWIRE;
            if is_near && (index == parent || room.is_free(&node.point, &point, distance)) {
                let cost = self.to_root(index).map(|node| node.edge).sum();
                near.push(Near {
                    index,
                    cost,
                    penalized: cost,
                    distance,
                });
            }
        }
        for child in 0..near.len() {
            let node = near[child].index;
            let parent = self.nodes[node].parent;
            let mut parents = near.iter_mut();
            if let Some(it) = parents.find(|it| it.index == parent && node > 0) {
                it.penalized += CLOSE;
            }
        }
        near
    }

    /// The nodes from one to the root.
    fn to_root(&self, index: usize) -> impl Iterator<Item = &Node> {
        core::iter::successors(Some(index), |index| {
            Some(self.nodes[*index].parent).filter(|_| *index > 0)
        })
        .map(|index| &self.nodes[index])
        .take(NODES)
    }

    /// The paths from the root to goals, one for each node that reached one.
    pub(super) fn paths(&self) -> impl Iterator<Item = Vec<Vector>> {
        let ends = self.nodes.iter().enumerate();
        ends.filter_map(|(index, node)| {
            let mut path: Vec<Vector> = self.to_root(index).map(|node| node.point).collect();
            path.reverse();
            path.push(node.goal?);
            Some(path)
        })
    }
}
