//! The phases from candidates to trajectories: faces, program and roll-out, for one candidate after the
//! other.

use super::super::shared::STEPS_PER_SLICE;
use super::super::summary::FEASIBLE;
use super::candidate::{ANGLE_SCALE, Candidate};
use super::limits::Limits;
use super::workspace::Workspace;
use super::{MAX_CANDIDATES, Phase, PlanePlanner};
use crate::corridor::{Corridor, Keep};
use crate::qp::{Solution, Status};
use crate::trajectory::RollOut;
use crate::tuning::candidates::HOPELESS;
use crate::tuning::faces::ROUNDING;

impl PlanePlanner {
    /// Selects the next candidate, and sets the faces between it and the obstacles around it.
    #[inline(never)]
    pub(super) fn separate(&mut self) {
        if self.improvements == self.candidates.len() {
            self.order = order(&self.candidates);
        }
        let next = self.turn();
        let Some((index, candidate)) = next.and_then(|it| Some((it, self.candidates.get(it)?)))
        else {
            return self.climb_down();
        };
        let own = &self.settings;
        let [middle, half] = self.band;
        let keep = Keep {
            margin: own.margin + ROUNDING,
            room: self.limits.room,
            body_radius: own.body_radius,
            floor: middle - half,
            ceiling: middle + half,
        };
        let cruise = self.trim.state.airspeed;
        let mut corridor = Corridor::new();
        corridor.separate(&self.field, &candidate.flown.knots, cruise, &keep);
        self.solver.problem.bounds.set_corridor(&corridor);
        self.at_hand = index;
        self.phase = Phase::Linearise;
    }

    /// Index of the candidate to improve next. Each candidate gets one SQP iteration; then each of the best few gets
    /// all its further ones before the next candidate.
    fn turn(&self) -> Option<usize> {
        let Some(further) = self.improvements.checked_sub(self.candidates.len()) else {
            return Some(self.improvements);
        };
        let iterations = usize::from(self.settings.sqp_iterations).saturating_sub(1);
        let refined = self.settings.refined_candidates.min(self.candidates.len());
        let best = (0..refined).find(|place| further < iterations * (place + 1))?;
        self.order.get(best).copied()
    }

    /// Sets up the program of the candidate, linearised about the candidate itself.
    #[inline(never)]
    pub(super) fn linearise(&mut self) {
        let frame = self.frame();
        let (Some(candidate), Workspace::Program(shared)) =
            (self.candidates.get(self.at_hand), &mut self.workspace)
        else {
            return self.end_inconsistent();
        };
        let condensed = shared.condense_varying(&self.weights, |dynamics| {
            frame.linearise(candidate, dynamics);
        });
        if condensed.is_err() {
            // The planner skips a candidate whose model cannot be condensed.
            self.improvements += 1;
            self.phase = Phase::Faces;
            return;
        }
        let Limits {
            angle_of_attack: [down, up],
            held_by_elevator: [held_down, held_up],
            flight_path,
            ..
        } = self.limits;
        let scaled = |limits: [f64; 2]| limits.map(|limit| ANGLE_SCALE * limit);
        (self.solver.problem.bounds)
            .set_attitude(scaled([up, flight_path]), scaled([-down, -flight_path]));
        self.solver.problem.hard_angle_of_attack = [held_up, held_down];
        self.solver.problem.cost_limit = HOPELESS * self.best_price;
        self.solver.problem.initial = frame.deviation(&frame.start, self.thrust, 0).into();
        self.solver.begin(shared);
        self.phase = Phase::Improve;
    }

    /// Makes some steps of the solver. After an optimal solution the roll-out replaces the candidate.
    #[inline(never)]
    pub(super) fn improve(&mut self) {
        let Workspace::Program(shared) = &self.workspace else {
            return self.end_inconsistent();
        };
        let before = self.solver.iterations();
        let status = self.solver.advance(shared, STEPS_PER_SLICE);
        self.summary.solver_steps += self.solver.iterations() - before;
        if let Some(status) = status {
            self.conclude(status);
        }
    }

    /// Ends the work on a program.
    // Not inlined, so that the solution does not lie on the stack beneath the solver.
    #[inline(never)]
    fn conclude(&mut self, status: Status) {
        let mut solution = Solution::new();
        let solved = status == Status::Optimal
            && matches!(&self.workspace, Workspace::Program(shared)
                if self.solver.solution(shared, &mut solution) == Status::Optimal);
        if solved {
            self.fly_out(&solution);
        }
        self.summary.candidates += 1;
        self.improvements += 1;
        self.phase = Phase::Faces;
    }

    /// Computes the roll-out of the solution, judges it, and keeps it if it is the best.
    #[inline(never)]
    fn fly_out(&mut self, solution: &Solution) {
        let mut candidate = self.cruising();
        candidate.roll_out(solution, &self.frame(), &self.limits);
        let judgement = self.judge(&candidate.flown);
        candidate.price = judgement.price;
        self.summary.feasible += usize::from(judgement.lack <= FEASIBLE);
        if judgement.price < self.best_price {
            self.best_price = judgement.price;
            self.summary.cost = judgement.effort;
            self.summary.violation = judgement.lack;
            self.keep(&candidate.flown);
        }
        if let Some(place) = self.candidates.get_mut(self.at_hand) {
            *place = candidate;
        }
    }

    /// Takes a roll-out for the best trajectory.
    #[inline(never)]
    pub(super) fn keep(&mut self, flown: &RollOut) {
        self.best.fly_out(
            flown,
            &self.units,
            &self.conditions.airframe(&self.si_airframe),
            &self.conditions.wind,
            &self.lag,
            self.time,
        );
    }
}

/// Indices of the candidates from the lowest to the highest price.
pub(super) fn order(candidates: &[Candidate]) -> [usize; MAX_CANDIDATES] {
    let mut order = [0; MAX_CANDIDATES];
    for (index, candidate) in candidates.iter().enumerate() {
        let before = |(other, price): (usize, f64)| {
            price
                .total_cmp(&candidate.price)
                .then(other.cmp(&index))
                .is_lt()
        };
        let prices = candidates.iter().map(|other| other.price).enumerate();
        let place = prices.filter(|other| before(*other)).count();
        if let Some(place) = order.get_mut(place) {
            *place = index;
        }
    }
    order
}
