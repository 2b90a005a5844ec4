//! Working sets of several rows: a start between faces that cross, and blocks of rows of inputs.

use super::super::super::layout::LAST_ROWS;
use super::super::controls::add_all;
use super::super::dot;
use super::{Active, Aligned, CAPACITY, CONTROLS, Condensed, Solver, Stands};
use crate::qp::Status;

/// Rows of a block that are taken up, or dropped, in one part of a step.
const PART_ROWS: usize = 6;
/// Share of its norm that a row of a block has to have apart from the rows before it.
const APART: f64 = 0.1;
/// Least crossing \[m\] of faces between which a program starts.
const LEAST_CROSSING: f64 = 1e-6;
/// Most pairs of faces between which a program starts.
const PAIRS: usize = 16;
/// Most changes of the set until the multipliers fit.
const ROUNDS: usize = 4;

impl Solver {
    /// Starts with both faces of each pair that crosses. No position keeps both, so in the optimum one of them yields at
    /// least, and nearly always both. One after the other, the first one would drag the whole plan to its side.
    // Not inlined, so that it does not lie on the stack beneath the steps.
    #[inline(never)]
    pub(super) fn start_between_crossing_faces(&mut self, shared: &Condensed) {
        let mut pairs: heapless::Vec<(usize, usize), PAIRS> = heapless::Vec::new();
        self.problem
            .bounds
            .crossing_faces(LEAST_CROSSING, |one, other| {
                if shared.prices.get(one).is_some_and(|price| *price > 0.0) {
                    let _ = pairs.push((one, other));
                }
            });
        if pairs.is_empty() {
            return;
        }
        for row in pairs.iter().flat_map(|(one, other)| [*one, *other]) {
            let _ = self.take_up(shared, row, true, 0.0);
        }
        self.start_settle(shared);
    }

    /// Begins to take up all violated rows of inputs at once, if the worst row is one. They hardly depend on each other.
    /// Returns false, and changes nothing, if there is only one.
    pub(super) fn begin_block(
        &mut self,
        shared: &Condensed,
        worst: Active,
        violation: f64,
    ) -> bool {
        if worst.row < LAST_ROWS {
            return false;
        }
        self.block.clear();
        let limits = self.open.0.get(LAST_ROWS..).unwrap_or(&[]);
        for (pair, [rise, reserve]) in limits.as_chunks::<2>().0.iter().enumerate() {
            let row = LAST_ROWS + 2 * pair;
            let Some(pattern) = shared.pattern(row) else {
                continue;
            };
            let input = if self.stale {
                pattern.value(&self.free) + shared.change(&pattern, &self.normalised)
            } else {
                pattern.value(&self.outputs)
            };
            if input - rise > 0.0 {
                let _ = self.block.push(row);
            } else if -input - reserve > 0.0 {
                let _ = self.block.push(row + 1);
            }
        }
        let begins = self.block.len() >= 2;
        if begins {
            self.stands = Stands::TakingUp(worst, violation, 0);
        }
        begins
    }

    /// Takes up some rows of a block, from one on. Returns false, and drops the block, if fewer than two have room.
    pub(super) fn take_up_rows(
        &mut self,
        shared: &Condensed,
        (worst, violation): (Active, f64),
        from: usize,
    ) -> bool {
        let end = (from + PART_ROWS).min(self.block.len());
        for index in from..end {
            if let Some(row) = self.block.get(index).copied() {
                let _ = self.take_up(shared, row, false, APART);
            }
        }
        if end < self.block.len() {
            self.stands = Stands::TakingUp(worst, violation, end);
            return true;
        }
        let before = self.active.iter().take_while(|own| !own.fresh).count();
        if self.active.len() < before + 2 {
            self.drop_from(before);
            return false;
        }
        // From here on it holds the places of the rows that leave.
        self.block.clear();
        self.stands = Stands::Settling(worst);
        true
    }

    /// Moves the multipliers of a block to the next event, or drops some of the rows that leave there.
    pub(super) fn settle_block(&mut self, shared: &Condensed) -> Option<Status> {
        if !self.block.is_empty() {
            let left = self.block.len().saturating_sub(PART_ROWS);
            while self.block.len() > left {
                self.block.pop().and_then(|index| self.deactivate(index));
            }
            return None;
        }
        match self.settle(shared) {
            Err(status) => return Some(status),
            Ok(false) => return None,
            Ok(true) => {}
        }
        let Stands::Settling(worst) = core::mem::replace(&mut self.stands, Stands::Free) else {
            return None;
        };
        if self.dual > self.problem.cost_limit {
            return Some(Status::Dominated);
        }
        if self.dual > 2.0 * self.absurd_rise {
            return Some(self.excessive_multipliers(shared, &worst));
        }
        (!self.dual.is_finite()).then_some(Status::NumericalFailure)
    }

    /// Appends a row to the active rows, if more than a share `apart` of its norm does not depend on them.
    #[inline(never)]
    fn take_up(&mut self, shared: &Condensed, row: usize, yielded: bool, apart: f64) -> bool {
        self.inactive(shared, row).is_some_and(|own| {
            let own = Active {
                yielded,
                fresh: true,
                ..own
            };
            let mut normal = Aligned([0.0; CONTROLS]);
            shared.add_normal(&mut normal.0, &own.pattern, 1.0);
            let reach = shared.reach(&own.pattern);
            let squares = self
                .factor
                .project(&normal, reach, &mut self.products, &mut self.rest);
            let norm = dot(&normal.0, &normal.0);
            if !yielded && norm - squares <= apart * norm {
                return false;
            }
            let complement = self.complement(&own, norm, norm - squares);
            complement > 0.0 && self.activate(own, complement).is_none()
        })
    }

    /// Moves the multipliers towards where all fresh rows are tight, to the next event: rows whose multiplier reaches zero
    /// leave, and rows whose multiplier reaches their price change sides. The dual objective only rises. Returns true when
    /// all rows are tight.
    #[inline(never)]
    fn settle(&mut self, shared: &Condensed) -> Result<bool, Status> {
        if self.iterations >= super::MAX_ITERATIONS {
            return Err(Status::IterationLimit);
        }
        self.iterations += 1;
        let Some(first) = self.active.iter().position(|own| own.fresh) else {
            return Ok(true);
        };
        let violations = self.fresh_violations(shared, first);
        let mut moves = violations;
        self.factor.forward_from(&mut moves, first);
        let mut rises = moves;
        self.factor.backward(&mut rises);
        self.find_falling(first, &rises);
        if !self.block.is_empty() {
            return Ok(false);
        }
        let (length, event) = self.first_change(&rises);
        let active = self.active.iter_mut().zip(&rises);
        for (own, rise) in active {
            own.multiplier = (own.multiplier + length * rise).max(0.0);
        }
        self.move_controls(first, &moves, length);
        let slope: f64 = rises
            .iter()
            .zip(&violations)
            .map(|(rise, by)| rise * by)
            .sum();
        self.dual += slope * length * (1.0 - 0.5 * length);
        let Some((index, toggles)) = event else {
            for own in &mut self.active {
                own.fresh = false;
            }
            return Ok(true);
        };
        let Some(row) = self.deactivate(index) else {
            return Ok(true);
        };
        if toggles {
            let row = Active {
                yielded: !row.yielded,
                ..row
            };
            if !self.append(shared, row, None) {
                return Err(Status::IterationLimit);
            }
        }
        Ok(false)
    }

    /// Violations of the fresh rows, of which `first` is the first; zero for the others.
    fn fresh_violations(&self, shared: &Condensed, first: usize) -> [f64; CAPACITY] {
        let mut violations = [0.0; CAPACITY];
        let rows = violations.iter_mut().zip(&self.active).skip(first);
        for (violation, own) in rows.filter(|(_, own)| own.fresh) {
            *violation = self.excess_now(shared, own) - self.allowed(own);
        }
        violations
    }

    /// Finds the fresh rows whose multipliers would fall below zero at once: the next parts drop them, the last one first.
    fn find_falling(&mut self, first: usize, rises: &[f64; CAPACITY]) {
        for (index, (own, rise)) in self.active.iter().zip(rises).enumerate().skip(first) {
            if own.fresh && !own.yielded && own.multiplier <= 0.0 && *rise < 0.0 {
                // As many places as rows of inputs, of which each is here once at most.
                let _ = self.block.push(index);
            }
        }
    }

    /// Share of a step up to the first row that leaves or changes sides, and this row: its index and whether it changes
    /// sides.
    fn first_change(&self, rises: &[f64; CAPACITY]) -> (f64, Option<(usize, bool)>) {
        let (mut length, mut event) = (1.0, None);
        for (index, (own, rise)) in self.active.iter().zip(rises).enumerate() {
            let distance = if *rise < 0.0 {
                own.multiplier - if own.yielded { own.price } else { 0.0 }
            } else if !own.yielded {
                own.price - own.multiplier
            } else {
                continue;
            };
            if distance < length * libm::fabs(*rise) {
                length = (distance / libm::fabs(*rise)).max(0.0);
                event = Some((index, own.yielded || *rise > 0.0));
            }
        }
        (length, event)
    }

    /// Moves the controls against the directions of the active rows from `first` on.
    fn move_controls(&mut self, first: usize, moves: &[f64; CAPACITY], length: f64) {
        for (index, by) in moves.iter().enumerate().take(self.active.len()).skip(first) {
            if let Some(direction) = self.factor.direction(index) {
                add_all(&mut self.normalised, direction, -length * by);
            }
        }
        self.stale = true;
        self.rolled = false;
        self.drift += 1;
    }

    /// The same at the start, where all rows are fresh: rows whose multipliers do not fit leave or change sides at once,
    /// and if that does not help, the start is empty.
    #[inline(never)]
    fn start_settle(&mut self, shared: &Condensed) {
        let penalty = self.problem.penalty;
        for _ in 0..ROUNDS {
            self.iterations += 1;
            let mut rises = [0.0; CAPACITY];
            for (rise, own) in rises.iter_mut().zip(&self.active) {
                let given = match penalty {
                    Some(penalty) if own.yielded => penalty.linear / penalty.quadratic,
                    _ => 0.0,
                };
                *rise = self.excess_now(shared, own) + given;
            }
            self.factor.forward_from(&mut rises, 0);
            let moves = rises;
            self.factor.backward(&mut rises);
            let mut again: heapless::Vec<(usize, bool), CAPACITY> = heapless::Vec::new();
            let mut fits = true;
            for index in (0..self.active.len()).rev() {
                let (Some(own), Some(value)) = (self.active.get(index).copied(), rises.get(index))
                else {
                    continue;
                };
                let changes = own.yielded != (*value > own.price);
                if !changes && *value >= 0.0 {
                    continue;
                }
                fits = false;
                self.deactivate(index);
                if changes && *value > 0.0 {
                    let _ = again.push((own.row, !own.yielded));
                }
            }
            if fits {
                for (own, rise) in self.active.iter_mut().zip(&rises) {
                    own.multiplier = *rise;
                    own.fresh = false;
                }
                self.move_controls(0, &moves, 1.0);
                self.dual = self.value();
                return;
            }
            for (row, yielded) in &again {
                let _ = self.take_up(shared, *row, *yielded, 1e-4);
            }
        }
        self.drop_from(0);
    }

    /// Removes the active rows from `first` on.
    fn drop_from(&mut self, first: usize) {
        while self.active.len() > first {
            self.deactivate(self.active.len() - 1);
        }
    }

    /// The dual objective where all active rows are tight.
    fn value(&self) -> f64 {
        let mut sum = self.free_cost + 0.5 * dot(&self.normalised, &self.normalised);
        if let Some(penalty) = self.problem.penalty {
            for own in self.active.iter().filter(|own| own.yielded) {
                let s = (own.multiplier - penalty.linear) / penalty.quadratic;
                sum += penalty.linear * s + 0.5 * penalty.quadratic * s * s;
            }
        }
        sum
    }
}
