//! The planner in space: receding horizon planning through a map of voxels, for an aircraft that banks to turn.
//!
//! | phase | file | what it does |
//! |---|---|---|
//! | field | [`VoxelField`] | distances to what the map knows |
//! | lattice | `lattice.rs`, `paths.rs`, `cost_to_go.rs` | paths on different sides of obstacles, and the cost-to-go |
//! | candidates | `candidate.rs`, `judge.rs` | the previous plan (warm start) and the paths, flown under all limits, with their price |
//! | programs | `faces.rs`, `program.rs` | each candidate gets a corridor and a QP that improves it; its controls are flown out |
//! | refinement | `refine.rs` | a direct search moves the bank of the cheapest trajectory |
//! | ways out | `way_out.rs`, `seek.rs` | where the cheapest trajectory can turn to a circle in space that was seen free |
//!
//! The cheapest trajectory is the plan. Any call of [`SpacePlanner::advance`] does a bounded amount of work, and
//! [`SpacePlanner::best`] is a plan at any time after the first candidate.
//!
//! World: x ahead, y to the right, z up \[m\].

mod candidate;
mod cost_to_go;
mod edges;
mod faces;
mod judge;
mod keep;
mod lattice;
mod offered;
mod paths;
mod program;
mod refine;
mod seek;
mod slices;
mod way_out;
mod workspace;

pub use candidate::{SpacePlan, next_start, next_start_on_circle, towards};
pub use judge::SpaceJudgement;
pub use keep::Keep;
pub use way_out::WayOut;

use crate::config::STAGES;
use crate::map::voxel_field::LENGTH;
use crate::map::{VoxelField, VoxelGrid};
use crate::tuning::space_pursuit::AIMS;
use crate::vehicle::{SpaceModel, SpacePath, within_half_turn};
use candidate::Grid;
use cost_to_go::{CostToGo, Path, STATIONS};
use lattice::ROW_SLICES;
use refine::Unmoved;
use way_out::WaysOut;
use workspace::{Program, Workspace};

/// Most candidates: the previous plan and paths of the lattice.
pub const SPACE_CANDIDATES: usize = 7;
/// Least distance of the minima of paths, in places of the lattice.
const APART: usize = 2;
/// Slices of the map that a slice of the cycle looks at.
const LOOK_SLICES: usize = 8;
/// Steps of the solver in a program, each a slice.
const MOST_STEPS: usize = 120;
/// Most slices of a cycle: field, lattice with its paths, candidates with the previous plan and the
/// one straight on, programs with their solves, and the refinement, in which each move may find a new best plan.
pub const MOST_SPACE_SLICES: usize = 1
    + LENGTH.div_ceil(LOOK_SLICES)
    + LENGTH
    + 2 * ROW_SLICES * (STATIONS - 1)
    + 3
    + SPACE_CANDIDATES * AIMS.len()
    + 2
    + SPACE_CANDIDATES * (STAGES + MOST_STEPS + 3)
    + 2 * refine::TRIALS
    + way_out::SLICES
    + 1;
/// Share of half the span that the lattice keeps level [-]: paths do not know the bank. Source: S of `tuning/space.rs`.
const LEVEL_SPAN: f64 = 0.75;
/// What a cycle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Idle,
    Begin,
    /// Slices of the field: what the map has, and the distances.
    Look(usize),
    Measure(usize),
    /// Edges of the lattice: their station, and a slice of rows.
    Price(usize, usize),
    Choose(usize, usize),
    /// The lattice is done, and others bring the plans.
    Offers,
    /// The previous plan, tracked and as a path.
    Previous,
    PreviousPath,
    Paths,
    /// A path, and a distance of the aim.
    Pursue(usize, usize),
    /// A candidate, and a stage.
    Faces(usize, usize),
    /// A candidate, and a part of its program's set-up.
    Pose(usize, usize),
    Solve(usize),
    FlyOut(usize),
    Refine(usize),
    /// The way out that is flown, the best plan of the cycle, and a circle.
    Renew,
    LookAgain,
    WaysOut,
    WayOut(usize),
}

/// What the next slice of a cycle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceStage {
    /// Distances to what the map knows.
    Field,
    /// A station of the lattice.
    Lattice,
    /// A candidate, flown.
    Candidate,
    /// Faces and program of a candidate.
    Program,
    /// Steps of the solver.
    Solve,
    /// Moves of the best plan.
    Refine,
    /// Ways out.
    WayOut,
}

/// A candidate and its worth.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    plan: SpacePlan,
    judgement: SpaceJudgement,
}

/// Workspace of the planner in space, the map beside.
#[derive(Clone, Debug)]
pub struct SpacePlanner {
    model: SpaceModel,
    keep: Keep,
    /// Number of candidates that a cycle proposes, and whether they get programs.
    wanted: usize,
    programs: bool,
    field: VoxelField,
    to_go: CostToGo,
    workspace: Workspace,
    paths: heapless::Vec<Path, SPACE_CANDIDATES>,
    candidates: heapless::Vec<Candidate, SPACE_CANDIDATES>,
    /// The cheapest flight of a path so far.
    tried: Option<Candidate>,
    best: Option<Candidate>,
    /// The best plan as moves begin with it, once one was tried.
    unmoved: Option<Unmoved>,
    /// Work of this cycle's moves.
    work: usize,
    start: SpacePath,
    /// When the knots of plans are.
    grid: Grid,
    /// Runaway of the nose at the start \[rad\].
    runaway: f64,
    /// The plan of the last cycle, and the time from its first knot to the start of this one \[s\].
    previous: Option<(SpacePlan, f64)>,
    /// Time from the first knot of what is flown to the start of this cycle \[s\].
    since: f64,
    ways: WaysOut,
    phase: Phase,
    steps: usize,
}

impl SpacePlanner {
    /// A planner that waits for [`set_up`](Self::set_up). The value is large: place it in a `static` or a box.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            model: SpaceModel::NONE,
            keep: Keep::NONE,
            wanted: 0,
            programs: true,
            field: VoxelField::new(),
            to_go: CostToGo::new(),
            workspace: Workspace::PROGRAM,
            paths: heapless::Vec::new(),
            candidates: heapless::Vec::new(),
            tried: None,
            best: None,
            unmoved: None,
            work: 0,
            start: SpacePath::ORIGIN,
            grid: Grid::EVEN,
            runaway: 0.0,
            previous: None,
            since: 0.0,
            ways: WaysOut::NONE,
            phase: Phase::Idle,
            steps: 0,
        }
    }

    /// Sets the planner up in place for an aircraft, and forgets the last flight.
    pub fn set_up(&mut self, model: SpaceModel, keep: Keep) {
        (self.model, self.keep) = (model, keep);
        self.choose(SPACE_CANDIDATES, true);
        self.to_go.set_up(&model);
        self.phase = Phase::Idle;
        self.candidates.clear();
        (self.best, self.previous) = (None, None);
        self.ways = WaysOut::NONE;
    }

    /// Chooses the number of candidates, from 1 to [`SPACE_CANDIDATES`], and whether a program improves each.
    pub fn choose(&mut self, candidates: usize, programs: bool) {
        self.wanted = candidates.clamp(1, SPACE_CANDIDATES);
        self.programs = programs;
    }

    /// Tells the wind that plans count on [m/s].
    pub fn set_wind(&mut self, wind: [f64; 3]) {
        self.model.wind = wind;
    }

    /// Tells the runaway of the nose at the start of the next plan \[rad\].
    pub fn set_runaway(&mut self, runaway: f64) {
        self.runaway = runaway;
    }

    /// The model of the aircraft, with the wind.
    #[must_use]
    pub fn model(&self) -> &SpaceModel {
        &self.model
    }

    /// Begins a cycle at the state in which the plan will begin, `shift` \[s\] after the first knot of the last plan.
    pub fn begin(&mut self, start: &SpacePath, shift: f64) {
        // Without a new plan the one before is still flown.
        match (self.taken().copied(), &mut self.previous) {
            (Some(plan), previous) => *previous = Some((plan, shift)),
            (None, Some((_, since))) => *since = shift,
            (None, None) => {}
        }
        // Plans of others have even stages.
        self.grid = match &self.previous {
            Some((plan, _)) if self.wanted > 0 => plan.grid.later(shift),
            _ => Grid::EVEN,
        };
        (self.tried, self.best, self.unmoved) = (None, None, None);
        (self.work, self.since) = (0, shift);
        self.start = SpacePath {
            course: within_half_turn(start.course),
            ..*start
        };
        self.candidates.clear();
        self.paths.clear();
        self.phase = Phase::Begin;
    }

    /// Does a slice of the cycle, or a part of one. Returns true when the cycle is done.
    pub fn advance(&mut self, map: &VoxelGrid) -> bool {
        self.phase = match self.phase {
            Phase::Idle | Phase::Offers => return true,
            Phase::Begin => self.begin_search(map),
            Phase::Look(first) => self.look(map, first),
            Phase::Measure(slice) => self.measure(slice),
            Phase::Price(station, slice) => self.price(station, slice),
            Phase::Choose(station, slice) => self.choose_edges(station, slice),
            Phase::Previous => self.propose_previous(),
            Phase::PreviousPath => self.propose_previous_path(),
            Phase::Paths => self.find_paths(),
            Phase::Pursue(path, aim) => self.propose(path, aim),
            Phase::Faces(candidate, stage) => self.separate(candidate, stage),
            Phase::Pose(candidate, part) => self.pose(candidate, part),
            Phase::FlyOut(candidate) => self.fly_out(candidate),
            Phase::Solve(candidate) => self.solve(candidate),
            Phase::Refine(number) => self.refine(number),
            Phase::Renew => self.renew(),
            Phase::LookAgain => self.look_again(map),
            Phase::WaysOut => self.begin_ways_out(map),
            Phase::WayOut(number) => self.seek_way_out(map, number),
        };
        matches!(self.phase, Phase::Idle | Phase::Offers)
    }

    /// Whether the last call of [`advance`](Self::advance) ended a slice: to set a program up takes several calls, and some
    /// steps of the solver do.
    #[must_use]
    pub fn is_between_slices(&self) -> bool {
        match (self.phase, &self.workspace) {
            (Phase::Pose(_, part), _) => part == 0,
            (Phase::Solve(_), Workspace::Program(program)) => program.solver.is_between_steps(),
            _ => true,
        }
    }

    /// What the next slice does; `None` if the cycle is done.
    #[must_use]
    pub fn stage(&self) -> Option<SpaceStage> {
        match self.phase {
            Phase::Idle | Phase::Offers => None,
            Phase::Begin | Phase::Look(_) | Phase::Measure(_) => Some(SpaceStage::Field),
            Phase::Price(..) | Phase::Choose(..) => Some(SpaceStage::Lattice),
            Phase::Paths => Some(SpaceStage::Lattice),
            Phase::Previous | Phase::PreviousPath | Phase::Pursue(..) => {
                Some(SpaceStage::Candidate)
            }
            Phase::Faces(..) | Phase::Pose(..) => Some(SpaceStage::Program),
            Phase::Solve(_) | Phase::FlyOut(_) => Some(SpaceStage::Solve),
            Phase::Refine(_) => Some(SpaceStage::Refine),
            Phase::Renew | Phase::LookAgain | Phase::WaysOut | Phase::WayOut(_) => {
                Some(SpaceStage::WayOut)
            }
        }
    }

    /// The best plan so far, and its worth.
    #[must_use]
    pub fn best(&self) -> Option<(&SpacePlan, &SpaceJudgement)> {
        let best = self.best.as_ref()?;
        Some((&best.plan, &best.judgement))
    }

    /// The candidates of this cycle so far, as they were proposed: each flown, before programs and refinement.
    pub fn candidates(&self) -> impl Iterator<Item = &SpacePlan> {
        self.candidates.iter().map(|candidate| &candidate.plan)
    }

    /// Number of candidates of this cycle so far.
    #[must_use]
    pub fn proposed(&self) -> usize {
        self.candidates.len()
    }

    /// Work of this cycle's moves: less than [`MOST_WORK`](crate::tuning::space_refinement::MOST_WORK) and that of one move more.
    #[must_use]
    pub fn work(&self) -> usize {
        self.work
    }

    /// The distances of this cycle.
    #[must_use]
    pub fn field(&self) -> &VoxelField {
        &self.field
    }
}
