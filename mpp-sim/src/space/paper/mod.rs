//! The paper's method in space, as a baseline. It is the method of [`mpp_core::paper`] with a third dimension: trees of RRT*-AR give
//! paths, rays in 26 directions give each of their points a convex room, and a convex program gives each path a trajectory in these
//! rooms. Of the feasible trajectories the one with the lowest cost is the plan; without one the last plan goes on.
//!
//! The trees and rays see the map of the planner in space in place of a grid of one scan. The tree is not shared with the one in
//! the plane, which keeps its nodes without a heap and knows the faults of the authors' code.

mod points;
mod program;
mod room;
mod tree;

use super::world::Vector;
use crate::random::{Draws, Stream, generator};
use hil_protocol::ConfigureSpace;
use mpp_core::config::{STAGE_PERIOD, STAGES};
use mpp_core::planner::space::{SpacePlan, SpacePlanner};
use mpp_core::vehicle::{SpaceModel, SpacePath};
use points::collocation_points;
use program::Program;
use room::{RAY_LIMIT, Room};
use tree::Tree;

/// Most trees of a cycle. Source: that of the method in the plane.
const TREES: usize = 100;
/// Distance of the goals to the side, above and below \[m\]. Source: that of the goals in the plane.
const BESIDE: f64 = 5.0;

/// The method in a flight.
pub(super) struct PaperMethod {
    /// Number of paths of a cycle.
    paths: usize,
    altitude: f64,
    limits: ConfigureSpace,
    draws: Draws,
    program: Program,
}

impl PaperMethod {
    pub(super) fn new(paths: usize, altitude: f64, limits: &ConfigureSpace, seed: u64) -> Self {
        Self {
            paths,
            altitude,
            limits: *limits,
            draws: generator(seed, Stream::Trees),
            program: Program::new(),
        }
    }

    /// The plan of a cycle, if a path has one.
    pub(super) fn plan(&mut self, planner: &SpacePlanner, start: &SpacePath) -> Option<SpacePlan> {
        let field = planner.field();
        // Beyond the map nothing is in the way.
        let clearance = |at: &Vector| match field.covers(at[0]) {
            true => field.clearance(at),
            false => RAY_LIMIT,
        };
        self.plan_among(&clearance, planner.model(), start)
    }

    /// The plan among things whose distance is told.
    fn plan_among(
        &mut self,
        clearance: &dyn Fn(&Vector) -> f64,
        model: &SpaceModel,
        start: &SpacePath,
    ) -> Option<SpacePlan> {
        let horizon = STAGE_PERIOD * STAGES as f64 * model.trim.state.airspeed;
        let room = Room::new(clearance, &self.limits, start.position, horizon);
        let goals = goals(&room, &start.position, horizon);
        self.program.begin(model, start, self.altitude)?;
        let (mut best, mut tried) = (None, 0);
        for _ in 0..TREES {
            let tree = Tree::grow(&room, &start.position, &goals, &mut self.draws);
            for path in tree.paths().take(self.paths - tried) {
                tried += 1;
                let corridor = room.corridor(&collocation_points(&path));
                best = self.program.better(&corridor).or(best);
            }
            if tried == self.paths {
                break;
            }
        }
        best
    }
}

/// Goals ahead at the distance of the horizon \[m\], straight ahead and to all sides, as far as plans may be there.
fn goals(room: &Room<'_>, [x, y, z]: &Vector, horizon: f64) -> Vec<Vector> {
    let beside = [0.0, -BESIDE, BESIDE];
    let all = beside.map(|side| beside.map(|up| [x + horizon, y + side, z + up]));
    all.into_iter()
        .flatten()
        .filter(|it| room.holds(it))
        .collect()
}

#[cfg(test)]
mod tests;
