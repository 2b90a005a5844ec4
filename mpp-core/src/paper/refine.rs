//! The phases of a cycle of the paper's method: trees, corridors, programs.

use super::{Extension, PaperPlanner, Phase, path_length, resample};
use crate::paper::config::TREE_RUNS;
use crate::planner::{FEASIBLE, STEPS_PER_SLICE};
use crate::qp::Status;
use crate::vehicle::VehicleState;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

/// Number of samples of the tree in one slice.
const SAMPLES_PER_SLICE: usize = 10;

/// Number of paths from which the baseline takes the shortest.
const BASELINE_PATHS: usize = 25;

impl PaperPlanner {
    pub(super) fn start_tree(&mut self) {
        if self.summary.tree_runs >= TREE_RUNS {
            self.phase = Phase::Done;
            return;
        }
        self.summary.tree_runs += 1;
        self.search.restart(self.rules);
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
                self.next_candidate();
                return;
            }
        }
    }

    /// Continues with the next path of the tree, with the next tree, or with the end of the cycle.
    fn next_candidate(&mut self) {
        let wanted = match self.paths {
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
        self.points = resample(&self.path, self.rules);
        if self.paths == 0 {
            self.follow_path();
            return;
        }
        let cruise = self.trim.state.airspeed;
        self.corridor
            .trace(&self.grid, &self.points, cruise, &self.padding, self.rules);
        self.problem.bounds.set_corridor(&self.corridor);
        self.problem.cost_limit = if self.summary.violation <= FEASIBLE {
            self.summary.cost
        } else {
            f64::INFINITY
        };
        self.solver.start(&self.shared, &self.problem);
        self.phase = Phase::Program;
    }

    /// Makes some steps of the solver. At the end of the program it keeps the solution if it is the best.
    pub(super) fn solve(&mut self) {
        let before = self.solver.iterations();
        let status = self.solver.advance(&self.shared, STEPS_PER_SLICE);
        self.summary.solver_steps += self.solver.iterations() - before;
        let Some(status) = status else {
            return;
        };
        self.summary.candidates += 1;
        if status == Status::Optimal
            && self.solver.solution(&self.shared, &mut self.solution) == Status::Optimal
        {
            self.keep_if_best();
        }
        self.next_candidate();
    }

    /// Keeps the solution if it is the best: the lower violation wins, and at equal violation the lower cost.
    /// All violations up to `FEASIBLE` count as equal.
    fn keep_if_best(&mut self) {
        let violation = self.solution.violation;
        self.summary.feasible += usize::from(violation <= FEASIBLE);
        let rank = |violation: f64, cost: f64| (violation.max(FEASIBLE), cost);
        let best = rank(self.summary.violation, self.summary.cost);
        if rank(violation, self.solution.cost) < best {
            self.summary.cost = self.solution.cost;
            self.summary.violation = violation;
            let VehicleState { x, z, .. } = self.state;
            self.best.place(&self.solution, &self.trim, self.time, x, z);
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

/// The 53 high bits of a random number, scaled to [0, 1).
fn unit_interval(random: &mut Pcg64Mcg) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
    (random.next_u64() >> 11) as f64 * STEP
}
