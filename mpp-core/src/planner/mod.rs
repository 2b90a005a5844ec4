//! The anytime planner: composes map, path search, raytracing and program, in bounded slices.
//!
//! ```text
//! begin --> Map --> Tree --> Corridor --> Program --+--> Done
//!                    ^  ^                  |        |
//!                    |  +-- next path -----+        |
//!                    +----- tree read out ----------+
//! ```
//!
//! Between any two slices the flight loop may run, and at any slice the best trajectory so far can
//! be taken.

mod candidate;
mod cycle;
mod iterated;
mod judge;
mod propose;
mod setup;

use crate::config::KNOTS;
use crate::corridor::Corridor;
use crate::estimate::Conditions;
use crate::map::{ClearanceField, GridPoint, MemoryMap, OccupancyGrid};
use crate::plan::{CollocationPoints, Path, Search};
use crate::qp::{Bounds, Condensed, Problem, Solution, Solver, StageModel};
use crate::sense::LidarScan;
use crate::settings::{AttitudeLimits, PlannerSettings, Settings};
use crate::trajectory::Trajectory;
use crate::vehicle::{ActuatorLimits, AirState, Airframe, Control, Trim, VehicleState, Wind};
use rand_pcg::Pcg64Mcg;
pub use setup::SetupError;
pub(crate) use setup::check_vehicle;

/// A trajectory whose rows are violated by no more than this [m or rad] is feasible.
const FEASIBLE: f64 = 1e-6;

/// What a finished or interrupted cycle came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanSummary {
    /// Candidate paths refined.
    pub candidates: usize,
    /// Those with a feasible trajectory (a dominated candidate's is not known and not counted).
    pub feasible: usize,
    /// Trees grown.
    pub tree_runs: usize,
    /// Slices used.
    pub slices: usize,
    /// Solver steps used.
    pub solver_steps: usize,
    /// Whether every candidate was looked at.
    pub complete: bool,
    /// Cost of the best trajectory; infinite without one.
    pub cost: f64,
    /// Its worst violation [m or rad]; infinite without one.
    pub violation: f64,
}

/// What the cycle has to offer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A trajectory that keeps every row; with an iteration, one that keeps its margin.
    Feasible,
    /// The best one does not: none does, or, with an iteration, those that do cost more than the little
    /// that is missing here.
    LeastViolating,
    /// No candidate gave any trajectory.
    Nothing,
}

/// What the next slice does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing: no cycle is under way.
    Idle,
    /// Builds the map.
    Map,
    /// Iterated: takes the scan into the map with memory.
    Remember,
    /// Iterated: searches one station of the lattice.
    Lattice,
    /// Grows a tree.
    Tree,
    /// Iterated: sets up a candidate's program.
    Linearise,
    /// Iterated: solves it, and flies it out.
    Improve,
    /// Traces the corridor of a path; iterated: sets the faces about a candidate.
    Corridor,
    /// Solves the program of a corridor.
    Program,
    /// Nothing: the cycle has ended.
    Done,
}

/// The planner and all its workspaces. Large: place it in a `static` or a box, and never on a stack.
#[derive(Clone, Debug)]
pub struct Planner {
    settings: PlannerSettings,
    /// Airframe and trim as set up.
    known: (Airframe, Trim),
    /// Those of the cycle.
    trim: Trim,
    airframe: Airframe,
    actuators: ActuatorLimits,
    shared: Condensed,
    /// None until the planner is set up.
    random: Option<Pcg64Mcg>,
    phase: Phase,
    time: f64,
    state: VehicleState,
    wind: Wind,
    scan: LidarScan,
    grid: OccupancyGrid,
    search: Search,
    next_node: usize,
    path: Path,
    points: CollocationPoints,
    corridor: Corridor,
    problem: Problem,
    solver: Solver,
    candidate: Solution,
    best_length: f64,
    best_price: f64,
    best: Trajectory,
    summary: PlanSummary,
    iterated: iterated::Workspace,
}

impl Planner {
    /// An idle planner that is not set up.
    #[must_use]
    pub const fn new() -> Self {
        let settings = Settings::reference();
        let still = VehicleState {
            x: 0.0,
            z: 0.0,
            air: STILL,
        };
        Self {
            settings: settings.planner,
            known: (settings.airframe, NO_TRIM),
            trim: NO_TRIM,
            airframe: settings.airframe,
            actuators: settings.actuators,
            shared: Condensed::new(),
            random: None,
            phase: Phase::Idle,
            time: 0.0,
            state: still,
            wind: Wind::STILL,
            scan: LidarScan::new(),
            grid: OccupancyGrid::new(),
            search: Search::new(),
            next_node: 0,
            path: Path::new(),
            points: [GridPoint::AIRCRAFT; KNOTS],
            corridor: Corridor::new(),
            problem: Problem {
                initial: [0.0; 6],
                target: [0.0; 6],
                bounds: Bounds::none(),
                penalty: None,
                cost_limit: f64::INFINITY,
            },
            solver: Solver::new(),
            candidate: Solution::new(),
            best_length: f64::INFINITY,
            best_price: f64::INFINITY,
            best: Trajectory::new(),
            summary: NO_SUMMARY,
            iterated: iterated::Workspace::new(),
        }
    }

    /// Starts a cycle at a time [s] from a state under these conditions and a checked scan; drops one
    /// under way. Without an iteration the conditions have no part.
    pub fn begin(
        &mut self,
        time: f64,
        state: &VehicleState,
        conditions: &Conditions,
        scan: &LidarScan,
    ) {
        self.time = time;
        self.state = *state;
        if self.settings.iteration.is_some() {
            self.reckon_with(conditions);
        }
        self.scan.clone_from(scan);
        self.problem.initial = self.shared.initial_state(&self.trim, &state.air);
        self.problem.target = [0.0, self.settings.altitude - state.z, 0.0, 0.0, 0.0, 0.0];
        self.problem.penalty = self.settings.penalty;
        self.problem.bounds.set_thrust(self.trim.control.thrust);
        if let Some(limits) = self.settings.attitude {
            let AttitudeLimits {
                angle_of_attack,
                flight_path,
            } = limits;
            let level = self.trim.state.flight_path;
            self.problem.bounds.set_attitude(
                [angle_of_attack, flight_path - level],
                [-angle_of_attack, -flight_path - level],
            );
        }
        self.summary = NO_SUMMARY;
        self.best_length = f64::INFINITY;
        self.best_price = f64::INFINITY;
        self.iterated.beams = 0;
        self.phase = match self.settings.iteration {
            Some(_) => Phase::Remember,
            None => Phase::Map,
        };
    }

    /// Plans by the airframe as it flies, and cruises at the angle of attack that it is set up for: the
    /// elevator keeps as much of its range to either side, at another airspeed.
    fn reckon_with(&mut self, conditions: &Conditions) {
        let (airframe, trim) = &self.known;
        self.wind = conditions.wind;
        self.airframe = conditions.airframe(airframe);
        let alpha = trim.state.angle_of_attack();
        self.trim = Trim::at_angle_of_attack(&self.airframe, alpha).unwrap_or(*trim);
    }

    /// What the next slice does.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether a cycle is under way.
    #[must_use]
    pub fn is_working(&self) -> bool {
        !matches!(self.phase, Phase::Idle | Phase::Done)
    }

    /// Does one bounded slice of work; true while there is more.
    // The phases that need much stack are never inlined: it would be the sum of theirs.
    pub fn advance(&mut self) -> bool {
        if self.is_working() {
            self.summary.slices += 1;
        }
        match self.phase {
            Phase::Idle | Phase::Done => {}
            Phase::Map => {
                self.grid
                    .rebuild(&self.scan, self.state.air.pitch, self.settings.rules);
                self.start_tree();
            }
            Phase::Remember => self.remember(),
            Phase::Lattice => self.search_lattice(),
            Phase::Tree => self.grow_tree(),
            Phase::Linearise => self.linearise(),
            Phase::Improve => self.improve(),
            Phase::Corridor if self.settings.iteration.is_some() => self.separate(),
            Phase::Corridor => self.trace_corridor(),
            Phase::Program => self.refine(),
        }
        self.is_working()
    }

    /// Ends the cycle and tells what it came to; [`Planner::best`] is the trajectory.
    pub fn finish(&mut self) -> Verdict {
        self.summary.complete = self.phase == Phase::Done;
        self.phase = Phase::Idle;
        if self.summary.cost == f64::INFINITY {
            Verdict::Nothing
        } else if self.summary.violation <= FEASIBLE {
            Verdict::Feasible
        } else {
            Verdict::LeastViolating
        }
    }

    /// The best trajectory of the cycle, if its verdict is not [`Verdict::Nothing`].
    #[must_use]
    pub fn best(&self) -> &Trajectory {
        &self.best
    }

    /// What the cycle came to so far.
    #[must_use]
    pub fn summary(&self) -> &PlanSummary {
        &self.summary
    }

    /// The grid of the cycle.
    #[must_use]
    pub fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    /// What the cycle knows of obstacles, if the preset has a map with memory; the grid is then only
    /// what the tree grows in.
    #[must_use]
    pub fn clearance(&self) -> Option<&ClearanceField> {
        self.settings
            .iteration
            .is_some()
            .then_some(&self.iterated.field)
    }

    /// The map with memory, for whoever knows better than the lidar; used by iterated cycles only.
    pub fn map_mut(&mut self) -> &mut MemoryMap {
        self.iterated.map_mut()
    }

    /// The model that plans are made by.
    #[must_use]
    pub fn model(&self) -> &StageModel {
        self.shared.model()
    }

    /// The program of the candidate at hand, while it is being solved.
    #[must_use]
    pub fn program(&self) -> Option<&Problem> {
        (self.phase == Phase::Program).then_some(&self.problem)
    }

    /// Where the candidate at hand leads, `(x, z)` at the stage boundaries in the world [m], and its
    /// program, while that is being solved.
    #[must_use]
    pub fn candidate(&self) -> Option<([(f64, f64); KNOTS], &Problem)> {
        let path = match self.phase {
            Phase::Program => {
                let origin = GridPoint::AIRCRAFT;
                let VehicleState { x, z, .. } = self.state;
                self.points
                    .map(|point| (x + point.col - origin.col, z + point.row - origin.row))
            }
            Phase::Improve => self.iterated.path(self.settings.iteration.as_ref()?)?,
            _ => return None,
        };
        Some((path, &self.problem))
    }

    /// Collocation points of the candidate at hand.
    #[must_use]
    pub fn points(&self) -> &CollocationPoints {
        &self.points
    }

    /// Level trim, about which plans are made.
    #[must_use]
    pub fn trim(&self) -> &Trim {
        &self.trim
    }
}

impl Default for Planner {
    fn default() -> Self {
        Self::new()
    }
}

const STILL: AirState = AirState {
    airspeed: 0.0,
    pitch: 0.0,
    pitch_rate: 0.0,
    flight_path: 0.0,
};

const NO_TRIM: Trim = Trim {
    state: STILL,
    control: Control {
        thrust: 0.0,
        elevator: 0.0,
    },
};

const NO_SUMMARY: PlanSummary = PlanSummary {
    candidates: 0,
    feasible: 0,
    tree_runs: 0,
    slices: 0,
    solver_steps: 0,
    complete: false,
    cost: f64::INFINITY,
    violation: f64::INFINITY,
};
