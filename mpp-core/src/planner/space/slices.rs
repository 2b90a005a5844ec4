//! What each slice of a cycle does, and which phase comes next.

use super::candidate::{Pursuit, SpacePlan, limited, towards, tracking};
use super::cost_to_go::{STATIONS, VIA};
use super::faces;
use super::judge::Judge;
use super::lattice::{Lattice, ROW_SLICES, Rules};
use super::program::{Frame, WEIGHTS};
use super::refine::{self, Unmoved};
use super::{
    APART, Candidate, LEVEL_SPAN, LOOK_SLICES, MOST_STEPS, Phase, Program, SpacePlanner, Workspace,
};
use crate::config::{KNOTS, STAGES};
use crate::map::VoxelGrid;
use crate::map::voxel_field::{LENGTH, NearSlices, needed};
use crate::qp::Status;
use crate::tuning::space_judgement::ROOM;
use crate::tuning::space_lattice::MORE_MARGIN;
use crate::tuning::space_pursuit::AIMS;
use crate::tuning::space_refinement::MOST_WORK;

impl SpacePlanner {
    pub(super) fn rules(&self) -> Rules {
        let level = LEVEL_SPAN * self.keep.half_span;
        Rules {
            margin: self.keep.margin + MORE_MARGIN + level,
            altitude: self.keep.altitude,
            heights: [self.keep.heights[0] + 0.5, self.keep.heights[1] - 0.5],
            half_width: self.keep.half_width - 0.5,
        }
    }

    /// Begins the field.
    pub(super) fn begin_search(&mut self, map: &VoxelGrid) -> Phase {
        self.settle_ways_out();
        self.field
            .begin(map, &self.start.position, self.start.course);
        self.to_go.origin = self.start.position;
        self.workspace = Workspace::Field(NearSlices::ZEROS);
        Phase::Look(0)
    }

    /// Looks at some slices of the map.
    pub(super) fn look(&mut self, map: &VoxelGrid, first: usize) -> Phase {
        let end = (first + LOOK_SLICES).min(LENGTH);
        self.field.look(map, first..end);
        if end < LENGTH {
            Phase::Look(end)
        } else {
            Phase::Measure(0)
        }
    }

    /// Measures a slice. After the last one the lattice begins.
    pub(super) fn measure(&mut self, slice: usize) -> Phase {
        if let Workspace::Field(near) = &mut self.workspace {
            self.field.measure(slice, near);
        }
        if slice + 1 < LENGTH {
            return Phase::Measure(slice + 1);
        }
        let (rules, velocity) = (self.rules(), self.start.ground_velocity(&self.model.wind));
        self.workspace = Workspace::Search(Lattice::ZEROS);
        if let Workspace::Search(lattice) = &mut self.workspace {
            lattice.begin(&mut self.to_go, &velocity, (&self.field, &rules));
        }
        Phase::Price(0, 0)
    }

    /// Prices some rows for the edges from a station.
    pub(super) fn price(&mut self, station: usize, slice: usize) -> Phase {
        let rules = self.rules();
        let Workspace::Search(lattice) = &mut self.workspace else {
            return Phase::Idle;
        };
        let by = (&self.field, &rules);
        lattice.price(&self.to_go, station, by, Lattice::rows(slice));
        if slice + 1 < ROW_SLICES {
            Phase::Price(station, slice + 1)
        } else {
            Phase::Choose(station, 0)
        }
    }

    /// Chooses the edges from a station, in some rows. Then comes the next station on the way to the via station, and beyond it
    /// the one before.
    pub(super) fn choose_edges(&mut self, station: usize, slice: usize) -> Phase {
        let Workspace::Search(lattice) = &mut self.workspace else {
            return Phase::Idle;
        };
        let rows = Lattice::rows(slice);
        if station < VIA {
            lattice.extend(station, rows);
        } else {
            lattice.retreat(&mut self.to_go, station, rows);
        }
        if slice + 1 < ROW_SLICES {
            return Phase::Choose(station, slice + 1);
        }
        if station < VIA {
            lattice.note_reached(station + 1);
        }
        if station + 1 < VIA {
            Phase::Price(station + 1, 0)
        } else if station < VIA {
            Phase::Price(STATIONS - 2, 0)
        } else if station > VIA {
            Phase::Price(station - 1, 0)
        } else if self.wanted == 0 {
            Phase::Offers
        } else {
            Phase::Previous
        }
    }

    /// The previous plan is flown twice from where the aircraft is: tracked as the regulator does, and as a path. The better one
    /// counts.
    pub(super) fn propose_previous(&mut self) -> Phase {
        let Some((plan, shift)) = self.previous.filter(|_| self.wanted > 1) else {
            return Phase::Paths;
        };
        let model = self.model;
        let at = |knot: usize| plan.at(&model, shift + self.grid.time(knot));
        let mut flown = self.new_plan();
        flown.fly(&model, &self.start, |stage, state| {
            let ((now, control), (next, _)) = (at(stage), at(stage + 1));
            let period = self.grid.period(stage);
            tracking(&model, state, &now, (&next, &control), period)
        });
        self.attempt(flown);
        Phase::PreviousPath
    }

    pub(super) fn propose_previous_path(&mut self) -> Phase {
        if let Some((plan, shift)) = self.previous {
            let points: [[f64; 3]; KNOTS] = core::array::from_fn(|stage| {
                let time = shift + self.grid.time(stage);
                plan.at(&self.model, time).0.position
            });
            let [aim, ..] = AIMS;
            self.attempt(self.pursuit(&points, aim));
        }
        self.take_tried();
        Phase::Paths
    }

    pub(super) fn find_paths(&mut self) -> Phase {
        if let Workspace::Search(lattice) = &self.workspace {
            lattice.paths(&self.to_go, APART, &mut self.paths);
        }
        self.paths
            .truncate(self.wanted - self.candidates.len().min(self.wanted));
        Phase::Pursue(0, 0)
    }

    /// Pursues a path with one of the aims; the cheapest one counts.
    pub(super) fn propose(&mut self, path: usize, aim: usize) -> Phase {
        if let (Some(points), Some(ahead)) = (self.paths.get(path), AIMS.get(aim)) {
            self.attempt(self.pursuit(points, *ahead));
            if aim + 1 < AIMS.len() {
                return Phase::Pursue(path, aim + 1);
            }
            self.take_tried();
            return Phase::Pursue(path + 1, 0);
        }
        if self.candidates.is_empty() {
            // No way through the lattice: straight on and level is something to start from.
            let (model, grid, mut plan) = (self.model, self.grid, self.new_plan());
            plan.fly(&model, &self.start, |stage, state| {
                let up = crate::vehicle::GRAVITY - state.flight_path * state.airspeed;
                towards(&model, state, [up, 0.0], grid.period(stage))
            });
            self.attempt(plan);
            self.take_tried();
        }
        if self.programs {
            self.workspace = Workspace::PROGRAM;
            Phase::Faces(0, 0)
        } else {
            Phase::Refine(0)
        }
    }

    /// Judges a flight of a path. The best one stays.
    fn attempt(&mut self, plan: SpacePlan) {
        let flown = self.judged(plan);
        if (self.tried).is_none_or(|tried| self.is_better(&flown, &tried)) {
            self.tried = Some(flown);
        }
    }

    fn take_tried(&mut self) {
        if let Some(candidate) = self.tried.take() {
            self.consider(candidate);
            let _ = self.candidates.push(candidate);
        }
    }

    /// The pursuit of a path.
    fn pursuit(&self, points: &[[f64; 3]], aim: f64) -> SpacePlan {
        let (model, grid, mut plan) = (self.model, self.grid, self.new_plan());
        let mut pursuit = Pursuit::new(points, aim);
        plan.fly(&model, &self.start, |stage, state| {
            pursuit.control(&model, state, grid.period(stage))
        });
        plan
    }

    /// A plan of this cycle, to be filled.
    pub(super) fn new_plan(&self) -> SpacePlan {
        SpacePlan {
            grid: self.grid,
            ..SpacePlan::new()
        }
    }

    pub(super) fn judge(&self) -> Judge<'_> {
        Judge {
            grid: self.grid,
            field: &self.field,
            to_go: &self.to_go,
            model: &self.model,
            keep: &self.keep,
            clear: needed(self.keep.margin + self.keep.half_span + ROOM),
            slow: self.keep.slow(),
            runaway: self.runaway,
        }
    }

    pub(super) fn judged(&self, plan: SpacePlan) -> Candidate {
        let judgement = self.judge().judge(&plan);
        Candidate { plan, judgement }
    }

    /// Whether a candidate is worth more than another one: its price is less. Where the way out is lost that was flown, what keeps some
    /// of its margin is before what does not: before a wall the price of the way through it is less than that of turning back.
    fn is_better(&self, candidate: &Candidate, than: &Candidate) -> bool {
        let lost = self.ways.flown && self.ways.held.is_none();
        let worth = |it: &Candidate| {
            let hits = it.judgement.missing > self.keep.margin;
            (lost && hits, it.judgement.price)
        };
        worth(candidate) < worth(than)
    }

    pub(super) fn consider(&mut self, candidate: Candidate) {
        let better = self
            .best
            .is_none_or(|best| self.is_better(&candidate, &best));
        if better {
            self.best = Some(candidate);
            self.unmoved = None;
        }
    }

    /// Tries the next move of the best plan. A new best plan is flown first as moves begin with it.
    pub(super) fn refine(&mut self, number: usize) -> Phase {
        let Some(best) = &self.best else {
            return Phase::Idle;
        };
        let Some(unmoved) = &self.unmoved else {
            self.unmoved = Some(Unmoved::of(&self.judge(), &best.plan, number));
            return Phase::Refine(number);
        };
        let (price, mut work) = (best.judgement.price, self.work);
        let moved = (unmoved.next(number))
            .and_then(|by| unmoved.moved(&self.judge(), &best.plan, price, &by, &mut work));
        self.work = work;
        if let Some((plan, judgement)) = moved {
            self.consider(Candidate { plan, judgement });
        }
        if number + 1 < refine::TRIALS && self.work < MOST_WORK {
            Phase::Refine(number + 1)
        } else {
            Phase::Renew
        }
    }

    /// Separates a stage of a candidate from what the map knows.
    pub(super) fn separate(&mut self, index: usize, stage: usize) -> Phase {
        let (Some(candidate), Workspace::Program(program)) =
            (self.candidates.get(index), &mut self.workspace)
        else {
            return Phase::Refine(0);
        };
        let faces = &mut program.faces;
        if stage == 0 {
            faces.clear();
        }
        faces::separate(&self.field, &candidate.plan, &self.keep, stage, faces);
        if stage + 1 < STAGES {
            Phase::Faces(index, stage + 1)
        } else {
            Phase::Pose(index, 0)
        }
    }

    /// Sets the program of a candidate up, in four parts: its models, their feedback, the responses, its rows.
    pub(super) fn pose(&mut self, index: usize, part: usize) -> Phase {
        let (Some(candidate), Workspace::Program(program)) =
            (self.candidates.get(index), &mut self.workspace)
        else {
            return Phase::Refine(0);
        };
        let Program {
            faces,
            shared,
            solver,
            ..
        } = program;
        let plan = &candidate.plan;
        let frame = Frame {
            model: &self.model,
            start: self.start,
        };
        match part {
            0 => shared.linearise(|dynamics| frame.linearise(plan, dynamics)),
            1 => {
                if shared.design(&WEIGHTS).is_err() {
                    return Phase::Faces(index + 1, 0);
                }
            }
            2 => shared.respond_to_controls(),
            _ => {
                frame.pose(plan, faces, &self.keep, &mut solver.problem);
                shared.set_faces(faces);
                solver.begin(shared);
                self.steps = 0;
                return Phase::Solve(index);
            }
        }
        Phase::Pose(index, part + 1)
    }

    pub(super) fn solve(&mut self, index: usize) -> Phase {
        let Workspace::Program(Program { shared, solver, .. }) = &mut self.workspace else {
            return Phase::Refine(0);
        };
        if !solver.advance_part(shared) {
            return Phase::Solve(index);
        }
        self.steps += 1;
        if solver.status.is_none() && self.steps < MOST_STEPS {
            Phase::Solve(index)
        } else {
            Phase::FlyOut(index)
        }
    }

    /// Flies the controls of a program out, of one that is not finished too: a roll-out keeps the limits.
    pub(super) fn fly_out(&mut self, index: usize) -> Phase {
        let Workspace::Program(program) = &mut self.workspace else {
            return Phase::Refine(0);
        };
        let solution = &mut program.solution;
        let ended = program.solver.solution(&program.shared, solution);
        if ended != Status::NumericalFailure {
            let frame = Frame {
                model: &self.model,
                start: self.start,
            };
            let controls = frame.controls(solution);
            let model = self.model;
            let (grid, mut plan) = (self.grid, self.new_plan());
            plan.fly(&model, &self.start, |stage, state| {
                let wanted = controls.get(stage).copied().unwrap_or_default();
                limited(&model, state, &wanted, grid.period(stage))
            });
            let candidate = self.judged(plan);
            self.consider(candidate);
        }
        Phase::Faces(index + 1, 0)
    }
}
