//! The result of a planning cycle: its summary and its verdict.

use crate::gate::Cause;

/// Greatest violation [m or rad] of a feasible trajectory.
pub(crate) const FEASIBLE: f64 = 1e-6;

/// The summary of a finished or interrupted cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanSummary {
    /// Number of programs solved: one for each candidate, and the further SQP iterations of the best candidates.
    pub candidates: usize,
    /// Number of programs that gave a feasible trajectory. The trajectory of a dominated candidate is not
    /// known, so it does not count.
    pub feasible: usize,
    /// Number of trees.
    pub tree_runs: usize,
    /// Number of slices.
    pub slices: usize,
    /// Number of solver steps.
    pub solver_steps: usize,
    /// Whether the cycle finished all its work.
    pub complete: bool,
    /// Whether the cycle had no scan, or one without a return by a lidar that is not believed: obstacles of the map stood
    /// in the fan of this scan, or of an earlier one since which no beam has returned. The map did not use it. Or
    /// the scan disagrees with the one before it. Plans fly slowly.
    pub blind: bool,
    /// Whether plans leave the altitude band upwards, because a blind lidar does not show what lies beneath.
    pub leaves: bool,
    /// Whether the cycle found that scans are older than their stamps say, or no longer; it began a new map.
    pub aged: bool,
    /// Whether the planner ended the cycle early, because its phase and its workspace did not belong together. This is a
    /// defect of the planner; [`FlightLoop::count_cycle`](crate::flight::FlightLoop::count_cycle) counts it.
    pub inconsistent: bool,
    /// Why the gate refused the plan with the lowest price, if it did.
    pub refused: Option<Cause>,
    /// Cost of the best trajectory. It is infinite if there is no trajectory.
    pub cost: f64,
    /// Worst violation of the best trajectory [m or rad]. It is infinite if there is no trajectory.
    pub violation: f64,
}

impl PlanSummary {
    /// The summary of a cycle that has no trajectory yet.
    pub const NOTHING: Self = Self {
        candidates: 0,
        feasible: 0,
        tree_runs: 0,
        slices: 0,
        solver_steps: 0,
        complete: false,
        blind: false,
        leaves: false,
        aged: false,
        inconsistent: false,
        refused: None,
        cost: f64::INFINITY,
        violation: f64::INFINITY,
    };

    /// The verdict on the best trajectory of the cycle.
    pub(crate) fn verdict(&self) -> Verdict {
        if self.cost == f64::INFINITY {
            Verdict::Nothing
        } else if self.violation <= FEASIBLE {
            Verdict::Feasible
        } else {
            Verdict::LeastViolating
        }
    }
}

/// The verdict on the best trajectory of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A trajectory that keeps every row (the paper's method), or its margin in the map (the flight
    /// planner).
    Feasible,
    /// A trajectory that violates its rows or its margin. The paper's method offers it if no candidate is
    /// feasible. The plane planner also offers it if every feasible candidate has a higher price.
    LeastViolating,
    /// No candidate gave any trajectory.
    Nothing,
    /// The gate refused what the cycle planned, or there was nothing, and the trajectory of the last cycle still passes.
    Kept,
    /// No plan passes the gate, but a path of the lattice, flown out by pursuit.
    Pursuit,
    /// No plan and no path passes the gate, but a reserve: level, slow, or a climb.
    Reserve,
    /// Nothing passes the gate. This is what strikes latest, or what leaves the band latest.
    Latest,
}
