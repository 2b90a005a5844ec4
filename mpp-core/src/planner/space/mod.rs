//! The planner in space: receding horizon planning through a map of voxels, for an aircraft that banks to turn.
//!
//! | phase | file | what it does |
//! |---|---|---|
//! | field | [`VoxelField`] | distances to what the map knows |
//! | lattice | `lattice.rs` | paths on different sides of obstacles, and the cost-to-go |
//! | candidates | `candidate.rs`, `judge.rs` | the previous plan (warm start) and the paths, flown under all limits, with their price |
//! | programs | `faces.rs`, `program.rs` | each candidate gets a corridor and a QP that improves it; its controls are flown out |
//! | refinement | `refine.rs` | a direct search moves the bank of the cheapest trajectory |
//!
//! The cheapest trajectory is the plan. Any call of [`SpacePlanner::advance`] does a bounded amount of work, and
//! [`SpacePlanner::best`] is a plan at any time after the first candidate.
//!
//! World: x ahead, y to the right, z up \[m\].

mod candidate;
mod edges;
mod faces;
mod judge;
mod keep;
mod lattice;
mod offered;
mod paths;
mod program;
mod refine;
mod slices;

pub use candidate::{SpacePlan, towards};
pub use judge::SpaceJudgement;
pub use keep::Keep;

use crate::map::{VoxelField, VoxelGrid};
use crate::qp::space::{Condensed, Faces, Problem, Solution, Solver};
use crate::vehicle::{SpaceModel, SpacePath};
use lattice::{Lattice, Path, STATIONS};
use refine::Unmoved;

/// Most candidates: the previous plan and paths of the lattice.
pub const SPACE_CANDIDATES: usize = 7;
/// Least distance of the minima of paths, in places of the lattice.
const APART: usize = 2;
/// Steps of the solver in a slice, and in a program.
const SLICE_STEPS: usize = 8;
const MOST_STEPS: usize = 120;
/// Roll-outs of the refinement in a slice.
const SLICE_TRIALS: usize = 4;
/// Most calls of [`SpacePlanner::advance`] in a cycle: field, lattice, candidates with the one straight on, programs with
/// their solves, and the refinement.
pub const MOST_SPACE_SLICES: usize = 1
    + STATIONS
    + SPACE_CANDIDATES
    + 2
    + SPACE_CANDIDATES * (2 + MOST_STEPS / SLICE_STEPS + 1)
    + refine::TRIALS / SLICE_TRIALS
    + 1;
/// Share of half the span that the lattice keeps level [-]: paths do not know the bank. Source: S of `tuning/space.rs`.
const LEVEL_SPAN: f64 = 0.75;
/// What a cycle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Idle,
    Field,
    Forward(usize),
    Backward(usize),
    /// The lattice is done, and others bring the plans.
    Offers,
    Previous,
    Candidate(usize),
    Pose(usize),
    Solve(usize),
    Refine(usize),
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
    lattice: Lattice,
    paths: heapless::Vec<Path, SPACE_CANDIDATES>,
    candidates: heapless::Vec<Candidate, SPACE_CANDIDATES>,
    best: Option<Candidate>,
    /// The best plan as moves begin with it, once one was tried.
    unmoved: Option<Unmoved>,
    start: SpacePath,
    /// The plan of the last cycle, and the time from its first knot to the start of this one \[s\].
    previous: Option<(SpacePlan, f64)>,
    phase: Phase,
    faces: Faces,
    problem: Problem,
    shared: Condensed,
    solver: Solver,
    solution: Solution,
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
            lattice: Lattice::new(),
            paths: heapless::Vec::new(),
            candidates: heapless::Vec::new(),
            best: None,
            unmoved: None,
            start: SpacePath::ORIGIN,
            previous: None,
            phase: Phase::Idle,
            faces: Faces::none(),
            problem: Problem::EMPTY,
            shared: Condensed::new(),
            solver: Solver::new(),
            solution: Solution::new(),
            steps: 0,
        }
    }

    /// Sets the planner up in place for an aircraft, and forgets the last flight.
    pub fn set_up(&mut self, model: SpaceModel, keep: Keep) {
        (self.model, self.keep) = (model, keep);
        self.choose(SPACE_CANDIDATES, true);
        self.lattice.set_up(&model);
        self.phase = Phase::Idle;
        self.candidates.clear();
        (self.best, self.previous) = (None, None);
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

    /// The model of the aircraft, with the wind.
    #[must_use]
    pub fn model(&self) -> &SpaceModel {
        &self.model
    }

    /// Begins a cycle at the state in which the plan will be taken over, `shift` \[s\] after the first knot of the last plan.
    pub fn begin(&mut self, start: &SpacePath, shift: f64) {
        self.previous = self.best.map(|best| (best.plan, shift));
        (self.best, self.unmoved) = (None, None);
        self.start = *start;
        self.candidates.clear();
        self.paths.clear();
        self.phase = Phase::Field;
    }

    /// Does a slice of the cycle. Returns true when it is done.
    pub fn advance(&mut self, map: &VoxelGrid) -> bool {
        self.phase = match self.phase {
            Phase::Idle | Phase::Offers => return true,
            Phase::Field => {
                self.field.update(map, &self.start.position);
                let velocity = self.start.ground_velocity(&self.model.wind);
                self.lattice.begin(&self.start.position, &velocity);
                Phase::Forward(0)
            }
            Phase::Forward(station) => self.extend(station),
            Phase::Backward(station) => self.retreat(station),
            Phase::Previous => self.propose_previous(),
            Phase::Candidate(path) => self.propose(path),
            Phase::Pose(candidate) => self.pose(candidate),
            Phase::Solve(candidate) => self.solve(candidate),
            Phase::Refine(number) => self.refine(number),
        };
        matches!(self.phase, Phase::Idle | Phase::Offers)
    }

    /// What the next slice does; `None` if the cycle is done.
    #[must_use]
    pub fn stage(&self) -> Option<SpaceStage> {
        match self.phase {
            Phase::Idle | Phase::Offers => None,
            Phase::Field => Some(SpaceStage::Field),
            Phase::Forward(_) | Phase::Backward(_) => Some(SpaceStage::Lattice),
            Phase::Previous | Phase::Candidate(_) => Some(SpaceStage::Candidate),
            Phase::Pose(_) => Some(SpaceStage::Program),
            Phase::Solve(_) => Some(SpaceStage::Solve),
            Phase::Refine(_) => Some(SpaceStage::Refine),
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

    /// The distances of this cycle.
    #[must_use]
    pub fn field(&self) -> &VoxelField {
        &self.field
    }
}
