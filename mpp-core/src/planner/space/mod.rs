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

pub use candidate::{SpacePlan, towards};
pub use judge::SpaceJudgement;
pub use keep::Keep;

use crate::config::{KNOTS, STAGE_PERIOD};
use crate::map::{VoxelField, VoxelGrid};
use crate::qp::Status;
use crate::qp::space::{Condensed, Faces, Problem, Solution, Solver};
use crate::tuning::space_lattice::MORE_MARGIN;
use crate::tuning::space_pursuit::AIMS;
use crate::vehicle::{SpaceControl, SpaceModel, SpacePath};
use candidate::{Pursuit, limited};
use edges::ROWS;
use judge::Judge;
use lattice::{Lattice, Path, Rules, STATIONS, VIA};
use program::{Frame, WEIGHTS};
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

    fn rules(&self) -> Rules {
        let level = LEVEL_SPAN * self.keep.half_span;
        Rules {
            margin: self.keep.margin + MORE_MARGIN + level,
            altitude: self.keep.altitude,
            heights: [self.keep.heights[0] + 0.5, self.keep.heights[1] - 0.5],
            half_width: self.keep.half_width - 0.5,
        }
    }

    fn extend(&mut self, station: usize) -> Phase {
        let rules = self.rules();
        let rows = self.lattice.reached(station);
        self.lattice.price(station, &self.field, &rules, rows);
        self.lattice.extend(station);
        if station + 1 < VIA {
            Phase::Forward(station + 1)
        } else {
            Phase::Backward(STATIONS - 2)
        }
    }

    fn retreat(&mut self, station: usize) -> Phase {
        let rules = self.rules();
        (self.lattice).price(station, &self.field, &rules, 0..ROWS);
        self.lattice.retreat(station);
        if station > VIA {
            Phase::Backward(station - 1)
        } else if self.wanted == 0 {
            Phase::Offers
        } else {
            Phase::Previous
        }
    }

    /// The previous plan is flown twice from where the aircraft is: by its controls, and as a path. The better one counts.
    fn propose_previous(&mut self) -> Phase {
        if let Some((plan, shift)) = self.previous.filter(|_| self.wanted > 1) {
            let model = self.model;
            let at = |stage: usize| plan.at(&model, shift + stage as f64 * STAGE_PERIOD);
            let mut flown = SpacePlan::new();
            flown.fly(&model, &self.start, |stage, state| {
                let ((now, control), (next, _)) = (at(stage), at(stage + 1));
                let wanted = SpaceControl {
                    bank_rate: (next.bank - now.bank) / STAGE_PERIOD,
                    angle_of_attack_rate: (next.angle_of_attack - now.angle_of_attack)
                        / STAGE_PERIOD,
                    thrust: control.thrust,
                };
                limited(&model, state, &wanted)
            });
            let points: [[f64; 3]; KNOTS] = core::array::from_fn(|stage| at(stage).0.position);
            let [aim, ..] = AIMS;
            let (flown, pursued) = (self.judged(flown), self.pursued(&points, aim));
            let better = if pursued.judgement.price < flown.judgement.price {
                pursued
            } else {
                flown
            };
            self.take(better);
        }
        self.lattice.paths(APART, &mut self.paths);
        self.paths
            .truncate(self.wanted - self.candidates.len().min(self.wanted));
        Phase::Candidate(0)
    }

    fn propose(&mut self, path: usize) -> Phase {
        let candidate = if let Some(points) = self.paths.get(path) {
            let [first, more @ ..] = AIMS;
            let mut best = self.pursued(points, first);
            for aim in more {
                let other = self.pursued(points, aim);
                if other.judgement.price < best.judgement.price {
                    best = other;
                }
            }
            best
        } else if self.candidates.is_empty() {
            // No way through the lattice: straight on and level is something to start from.
            let (model, mut plan) = (self.model, SpacePlan::new());
            plan.fly(&model, &self.start, |_, state| {
                let up = crate::vehicle::GRAVITY - state.flight_path * state.airspeed;
                towards(&model, state, [up, 0.0], STAGE_PERIOD)
            });
            self.judged(plan)
        } else {
            return if self.programs {
                Phase::Pose(0)
            } else {
                Phase::Refine(0)
            };
        };
        self.take(candidate);
        Phase::Candidate(path + 1)
    }

    /// The pursuit of a path.
    fn pursued(&self, points: &[[f64; 3]], aim: f64) -> Candidate {
        let (model, mut plan) = (self.model, SpacePlan::new());
        let mut pursuit = Pursuit::new(points, aim);
        plan.fly(&model, &self.start, |_, state| {
            pursuit.control(&model, state)
        });
        self.judged(plan)
    }

    fn judge(&self) -> Judge<'_> {
        Judge {
            field: &self.field,
            lattice: &self.lattice,
            model: &self.model,
            keep: &self.keep,
        }
    }

    fn judged(&self, plan: SpacePlan) -> Candidate {
        let judgement = self.judge().judge(&plan);
        Candidate { plan, judgement }
    }

    fn take(&mut self, candidate: Candidate) {
        self.consider(candidate);
        let _ = self.candidates.push(candidate);
    }

    fn consider(&mut self, candidate: Candidate) {
        let better = self
            .best
            .is_none_or(|best| candidate.judgement.price < best.judgement.price);
        if better {
            self.best = Some(candidate);
            self.unmoved = None;
        }
    }

    /// Tries the next moves of the best plan.
    fn refine(&mut self, first: usize) -> Phase {
        let end = (first + SLICE_TRIALS).min(refine::TRIALS);
        for number in first..end {
            let Some(best) = self.best else {
                continue;
            };
            if self.unmoved.is_none() {
                self.unmoved = Some(Unmoved::of(&self.judge(), &best.plan));
            }
            let by = refine::Move::of(number);
            let moved = (self.unmoved.as_ref()).and_then(|unmoved| {
                unmoved.moved(&self.judge(), &best.plan, best.judgement.price, &by)
            });
            if let Some((plan, judgement)) = moved {
                self.consider(Candidate { plan, judgement });
            }
        }
        if end < refine::TRIALS {
            Phase::Refine(end)
        } else {
            Phase::Idle
        }
    }

    /// Poses the program of a candidate.
    fn pose(&mut self, index: usize) -> Phase {
        let Some(candidate) = self.candidates.get(index) else {
            return Phase::Refine(0);
        };
        let plan = candidate.plan;
        let frame = Frame {
            model: &self.model,
            start: self.start,
        };
        faces::separate(&self.field, &plan, &self.keep, &mut self.faces);
        frame.pose(&plan, &self.faces, &self.keep, &mut self.problem);
        let condensed = self
            .shared
            .condense_varying(&WEIGHTS, |dynamics| frame.linearise(&plan, dynamics));
        if condensed.is_err() {
            return Phase::Pose(index + 1);
        }
        self.shared.set_faces(&self.faces);
        self.solver.start(&self.shared, &self.problem);
        self.steps = 0;
        Phase::Solve(index)
    }

    fn solve(&mut self, index: usize) -> Phase {
        self.steps += SLICE_STEPS;
        let status = self.solver.advance(&self.shared, SLICE_STEPS);
        if status.is_none() && self.steps < MOST_STEPS {
            return Phase::Solve(index);
        }
        // The controls of a program that is not finished are flown out too: a roll-out keeps the limits.
        let ended = self.solver.solution(&self.shared, &mut self.solution);
        if ended != Status::NumericalFailure {
            let frame = Frame {
                model: &self.model,
                start: self.start,
            };
            let controls = frame.controls(&self.solution);
            let model = self.model;
            let mut plan = SpacePlan::new();
            plan.fly(&model, &self.start, |stage, state| {
                let wanted = controls.get(stage).copied().unwrap_or_default();
                limited(&model, state, &wanted)
            });
            let candidate = self.judged(plan);
            self.consider(candidate);
        }
        Phase::Pose(index + 1)
    }
}
