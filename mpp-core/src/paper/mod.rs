//! The paper's method, all of it, behind the feature `paper`: every path of every tree gives a corridor and a program, and the feasible solution
//! with the lowest cost wins. The presets `reference` (the authors' code with its faults) and `paper` use
//! it.
//!
//! ```text
//! begin --> Map --> Tree --> Corridor --> Program --+--> Done
//!                    ^  ^                  |        |
//!                    |  +-- next path -----+        |
//!                    +----- tree read out ----------+
//! ```
//!
//! | file | content | paper |
//! |---|---|---|
//! | `grid`, `point`, `walk` | the occupancy grid of one scan, its points, and the cells on a line | II-C |
//! | `rrt`, `tree` | RRT*-AR: the growth of a tree in an arena | III-A |
//! | `collocation` | paths as points at the stage boundaries | III-A |
//! | `rays` | half-planes by raytracing | III-B |
//! | `model` | the discrete model of the program | III-D |
//! | `refine` | the phases of a cycle | III |
//! | `trajectory` | solutions and paths as trajectories | III |
//! | `rules`, `settings` | what differs between the paper's text and the authors' code | |

mod collocation;
pub mod config;
mod grid;
mod model;
mod point;
mod rays;
mod refine;
mod rrt;
mod rules;
mod settings;
mod trajectory;
mod tree;
mod walk;

use crate::config::KNOTS;
use crate::corridor::Corridor;
use crate::planner::{PlanSummary, SetupError, Verdict, check, check_planner};
use crate::qp::{Condensed, Problem, Solution, Solver};
use crate::sense::LidarScan;
use crate::settings::{PlannerSettings, Settings};
use crate::trajectory::Trajectory;
use crate::vehicle::{AirState, Airframe, Trim, VehicleState};
pub use collocation::{CollocationPoints, GOAL_DISTANCE, GOALS, Path, path_length, resample};
use grid::MAX_WALK;
pub use grid::OccupancyGrid;
pub use model::{Initial, ModelError, StageModel};
pub use point::GridPoint;
use rand_core::SeedableRng;
use rand_pcg::Pcg64Mcg;
pub use rays::{Padding, authors_ray, cast_ray};
pub use rrt::{Extension, Search};
pub use rules::Rules;
pub use settings::PaperSettings;
pub use tree::{Node, Tree};
use walk::CellWalk;

/// The work of the next slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The slice does nothing, because no cycle is under way.
    Idle,
    /// Builds the occupancy grid from the scan.
    Map,
    /// Grows a tree.
    Tree,
    /// Traces the corridor of a path.
    Corridor,
    /// Solves the program of a corridor.
    Program,
    /// The slice does nothing, because the cycle has ended.
    Done,
}

/// The paper's planner and all its workspaces. Large: place it in a `static` or a box.
#[derive(Clone, Debug)]
pub struct PaperPlanner {
    paths: usize,
    altitude: f64,
    rules: Rules,
    padding: Padding,
    airframe: Airframe,
    pub(crate) trim: Trim,
    model: StageModel,
    shared: Condensed,
    /// Random numbers of the tree; `None` until the planner is set up.
    random: Option<Pcg64Mcg>,
    phase: Phase,
    time: f64,
    state: VehicleState,
    scan: LidarScan,
    grid: OccupancyGrid,
    search: Search,
    next_node: usize,
    path: Path,
    points: CollocationPoints,
    corridor: Corridor,
    problem: Problem,
    solver: Solver,
    solution: Solution,
    best_length: f64,
    pub(crate) best: Trajectory,
    pub(crate) summary: PlanSummary,
}

impl PaperPlanner {
    /// An idle planner that is not set up.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            paths: 0,
            altitude: 0.0,
            rules: Rules::Corrected,
            padding: Padding::AUTHORS,
            airframe: Airframe::REFERENCE,
            trim: Trim::NONE,
            model: StageModel::at_rest(),
            shared: Condensed::new(),
            random: None,
            phase: Phase::Idle,
            time: 0.0,
            state: VehicleState {
                x: 0.0,
                z: 0.0,
                air: AirState::NONE,
            },
            scan: LidarScan::new(),
            grid: OccupancyGrid::new(),
            search: Search::new(),
            next_node: 0,
            path: Path::new(),
            points: [GridPoint::AIRCRAFT; KNOTS],
            corridor: Corridor::new(),
            problem: Problem::EMPTY,
            solver: Solver::new(),
            solution: Solution::new(),
            best_length: f64::INFINITY,
            best: Trajectory::new(),
            summary: PlanSummary::NOTHING,
        }
    }

    /// Sets up the model about level trim.
    pub(crate) fn set_up(
        &mut self,
        settings: &Settings,
        own: &PaperSettings,
    ) -> Result<(), SetupError> {
        // If a check below fails, the planner is not set up completely and must plan nothing.
        self.random = None;
        self.phase = Phase::Idle;
        let planner = &settings.planner;
        let airframe = &settings.airframe;
        let trim = check(settings)?;
        self.model = StageModel::new(airframe, &trim, own.jacobian, own.initial)
            .map_err(|ModelError| SetupError::NoSteadyState)?;
        self.shared
            .condense(&self.model.dynamics(), &planner.weights)
            .map_err(SetupError::Condense)?;
        self.paths = planner.paths;
        self.altitude = planner.altitude;
        self.rules = own.rules;
        self.padding = own.padding;
        self.trim = trim;
        self.airframe = *airframe;
        // A flight computer hands over zeroed memory, so the code must not rely on the values of `new`.
        self.problem.bounds.clear();
        self.problem.penalty = None;
        self.random = Some(Pcg64Mcg::seed_from_u64(planner.seed));
        self.best.clear();
        Ok(())
    }

    /// Takes over number of paths, altitude and padding.
    pub(crate) fn retune(
        &mut self,
        planner: &PlannerSettings,
        own: &PaperSettings,
    ) -> Result<(), SetupError> {
        check_planner(planner)?;
        self.paths = planner.paths;
        self.altitude = planner.altitude;
        self.padding = own.padding;
        Ok(())
    }

    /// Starts a cycle; see [`crate::planner::Planner::begin`].
    pub fn begin(&mut self, time: f64, state: &VehicleState, scan: Option<&LidarScan>) {
        self.time = time;
        self.state = *state;
        if let Some(scan) = scan {
            self.scan.clone_from(scan);
        }
        self.problem.initial = self.model.initial_state(&self.trim, &state.air);
        self.problem.target = [0.0, self.altitude - state.z, 0.0, 0.0, 0.0, 0.0];
        self.problem
            .bounds
            .set_thrust([f64::INFINITY, self.trim.control.thrust]);
        self.summary = PlanSummary::NOTHING;
        self.best_length = f64::INFINITY;
        self.phase = if state.is_finite() && scan.is_some() {
            Phase::Map
        } else {
            // No plan starts there.
            Phase::Done
        };
    }

    /// The work of the next slice.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether a cycle is under way.
    #[must_use]
    pub fn is_working(&self) -> bool {
        !matches!(self.phase, Phase::Idle | Phase::Done)
    }

    /// Does one bounded slice of work. Returns true until the cycle ends.
    pub fn advance(&mut self) -> bool {
        if self.is_working() {
            self.summary.slices += 1;
        }
        match self.phase {
            Phase::Idle | Phase::Done => {}
            Phase::Map => {
                self.grid
                    .rebuild(&self.scan, self.state.air.pitch, self.rules);
                self.start_tree();
            }
            Phase::Tree => self.grow_tree(),
            Phase::Corridor => self.trace_corridor(),
            Phase::Program => self.solve(),
        }
        self.is_working()
    }

    /// Ends the cycle and returns its verdict.
    pub fn finish(&mut self) -> Verdict {
        self.summary.complete = self.phase == Phase::Done;
        self.phase = Phase::Idle;
        self.summary.verdict()
    }

    /// The grid of the cycle.
    #[must_use]
    pub fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    /// The linear model of the programs.
    #[must_use]
    pub fn model(&self) -> &StageModel {
        &self.model
    }

    /// Collocation points of the present candidate.
    #[must_use]
    pub fn points(&self) -> &CollocationPoints {
        &self.points
    }

    /// The program of the present candidate, while the solver works on it.
    #[must_use]
    pub fn program(&self) -> Option<&Problem> {
        (self.phase == Phase::Program).then_some(&self.problem)
    }

    /// The path of the present candidate and its program; see [`crate::planner::Planner::candidate`].
    #[must_use]
    pub fn candidate(&self) -> Option<([(f64, f64); KNOTS], Problem)> {
        let origin = GridPoint::AIRCRAFT;
        let VehicleState { x, z, .. } = self.state;
        let place = |point: GridPoint| (x + point.col - origin.col, z + point.row - origin.row);
        self.program()
            .map(|problem| (self.points.map(place), *problem))
    }
}
