//! The phases of a cycle: trees, corridors, programs.

use super::{FEASIBLE, Phase, Planner};
use crate::config::TREE_RUNS;
use crate::plan::{Extension, path_length, resample};
use crate::qp::Status;
use crate::vehicle::VehicleState;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

/// Samples drawn in one slice.
const SAMPLES_PER_SLICE: usize = 10;
/// Solver steps taken in one slice.
const STEPS_PER_SLICE: usize = 8;
/// Paths of which the baseline takes the shortest.
const BASELINE_PATHS: usize = 25;

impl Planner {
    pub(super) fn start_tree(&mut self) {
        if self.summary.tree_runs >= TREE_RUNS {
            self.phase = Phase::Done;
            return;
        }
        self.summary.tree_runs += 1;
        self.search.restart(self.settings.rules);
        self.next_node = 0;
        self.phase = Phase::Tree;
    }

    pub(super) fn grow_tree(&mut self) {
        let Some(random) = &mut self.random else {
            self.phase = Phase::Done;
            return;
        };
        for _ in 0..SAMPLES_PER_SLICE {
            if self.search.extend(&self.grid, || unit_interval(random)) == Extension::Complete {
                match self.settings.iteration {
                    Some(_) => self.take_tree_paths(),
                    None => self.next_candidate(),
                }
                return;
            }
        }
    }

    /// Goes on to the tree's next path, to the next tree, or to the end.
    fn next_candidate(&mut self) {
        let wanted = match self.settings.paths {
            0 => BASELINE_PATHS,
            paths => paths,
        };
        if self.summary.candidates >= wanted {
            self.phase = Phase::Done;
        } else if let Some(next) = self.search.next_path(self.next_node, &mut self.path) {
            self.next_node = next;
            self.phase = Phase::Corridor;
        } else {
            self.start_tree();
        }
    }

    pub(super) fn trace_corridor(&mut self) {
        let rules = self.settings.rules;
        self.points = resample(&self.path, rules);
        if self.settings.paths == 0 {
            self.follow_path();
            return;
        }
        let cruise = self.trim.state.airspeed;
        self.corridor.trace(
            &self.grid,
            &self.points,
            cruise,
            &self.settings.padding,
            rules,
        );
        self.problem.bounds.set_corridor(&self.corridor);
        self.problem.cost_limit = if self.summary.violation <= FEASIBLE {
            self.summary.cost
        } else {
            f64::INFINITY
        };
        self.solver.start(&self.shared, &self.problem);
        self.phase = Phase::Program;
    }

    pub(super) fn refine(&mut self) {
        let Some(status) = self.solve_some() else {
            return;
        };
        self.summary.candidates += 1;
        if status == Status::Optimal
            && self.solver.solution(&self.shared, &mut self.candidate) == Status::Optimal
        {
            self.keep_if_best();
        }
        self.next_candidate();
    }

    /// Some steps of the program; its status at the end.
    pub(super) fn solve_some(&mut self) -> Option<Status> {
        let before = self.solver.iterations();
        let status = self.solver.advance(&self.shared, STEPS_PER_SLICE);
        self.summary.solver_steps += self.solver.iterations() - before;
        status
    }

    /// Ranks by violation, then by cost.
    fn keep_if_best(&mut self) {
        let violation = self.candidate.violation;
        self.summary.feasible += usize::from(violation <= FEASIBLE);
        let rank = |violation: f64, cost: f64| (violation.max(FEASIBLE), cost);
        let best = rank(self.summary.violation, self.summary.cost);
        if rank(violation, self.candidate.cost) < best {
            self.summary.cost = self.candidate.cost;
            self.summary.violation = violation;
            let VehicleState { x, z, .. } = self.state;
            self.best
                .place(&self.candidate, &self.trim, self.time, x, z);
        }
    }

    /// The baseline: the shortest path itself, flown at cruise speed in steady climbs and descents.
    fn follow_path(&mut self) {
        self.summary.candidates += 1;
        self.summary.feasible += 1;
        let length = path_length(&self.path);
        if length < self.best_length {
            self.best_length = length;
            self.summary.cost = length;
            self.summary.violation = 0.0;
            self.best.follow(
                &self.points,
                &self.trim,
                &self.airframe,
                self.time,
                &self.state,
            );
        }
        self.next_candidate();
    }
}

/// The 53 high bits of a draw, as a number in [0, 1).
fn unit_interval(random: &mut Pcg64Mcg) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
    (random.next_u64() >> 11) as f64 * STEP
}
