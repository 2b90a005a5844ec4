//! What each slice of a cycle does, and which phase comes next.

use super::candidate::{Pursuit, SpacePlan, limited, towards};
use super::edges::ROWS;
use super::faces;
use super::judge::Judge;
use super::lattice::{Rules, STATIONS, VIA};
use super::program::{Frame, WEIGHTS};
use super::refine::{self, Unmoved};
use super::{
    APART, Candidate, LEVEL_SPAN, MOST_STEPS, Phase, SLICE_STEPS, SLICE_TRIALS, SpacePlanner,
};
use crate::config::{KNOTS, STAGE_PERIOD};
use crate::qp::Status;
use crate::tuning::space_lattice::MORE_MARGIN;
use crate::tuning::space_pursuit::AIMS;
use crate::vehicle::SpaceControl;

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

    pub(super) fn extend(&mut self, station: usize) -> Phase {
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

    pub(super) fn retreat(&mut self, station: usize) -> Phase {
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
    pub(super) fn propose_previous(&mut self) -> Phase {
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

    pub(super) fn propose(&mut self, path: usize) -> Phase {
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
    pub(super) fn pursued(&self, points: &[[f64; 3]], aim: f64) -> Candidate {
        let (model, mut plan) = (self.model, SpacePlan::new());
        let mut pursuit = Pursuit::new(points, aim);
        plan.fly(&model, &self.start, |_, state| {
            pursuit.control(&model, state)
        });
        self.judged(plan)
    }

    pub(super) fn judge(&self) -> Judge<'_> {
        Judge {
            field: &self.field,
            lattice: &self.lattice,
            model: &self.model,
            keep: &self.keep,
        }
    }

    pub(super) fn judged(&self, plan: SpacePlan) -> Candidate {
        let judgement = self.judge().judge(&plan);
        Candidate { plan, judgement }
    }

    pub(super) fn take(&mut self, candidate: Candidate) {
        self.consider(candidate);
        let _ = self.candidates.push(candidate);
    }

    pub(super) fn consider(&mut self, candidate: Candidate) {
        let better = self
            .best
            .is_none_or(|best| candidate.judgement.price < best.judgement.price);
        if better {
            self.best = Some(candidate);
            self.unmoved = None;
        }
    }

    /// Tries the next moves of the best plan.
    pub(super) fn refine(&mut self, first: usize) -> Phase {
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
    pub(super) fn pose(&mut self, index: usize) -> Phase {
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

    pub(super) fn solve(&mut self, index: usize) -> Phase {
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
