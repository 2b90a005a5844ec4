//! Rows that depend on the active ones, but for rounding: whether they can be kept with them.
//!
//! The Schur complement of such a row is a difference of nearly equal numbers, and says nothing. The
//! vector whose square it is does: it keeps its digits down to the rounding of the controls.

use super::step::Direction;
use super::{Active, CAPACITY, Solver};
use crate::qp::Status;
use crate::qp::condense::Condensed;
use crate::qp::dense::{ControlVector, dot};
use crate::qp::rows::{OUTPUTS, RowPattern};

/// Rows that contradict each other by less than this [m, rad or N] may do so by rounding.
const NEGLIGIBLE: f64 = 1e-8;

/// Rates below this share of the largest are zero but for rounding.
const NO_RATE: f64 = 1e-13;

/// A sum of rows' patterns, by output.
struct Sum([f64; OUTPUTS]);

impl Sum {
    fn add(&mut self, pattern: &RowPattern, weight: f64) {
        for (output, factor) in [pattern.first, pattern.second] {
            if let Some(sum) = self.0.get_mut(output) {
                *sum += weight * factor;
            }
        }
    }
}

/// How an entering row stands to active rows that it depends on.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Stand {
    /// They leave it room, if only a little: the step that mends it is this long.
    Apart(f64),
    /// It touches them: what is violated may be rounding.
    Touches,
    /// No flight keeps them all.
    Contradicts,
}

impl Solver {
    /// Corrects a direction whose complement is lost in rounding, and tells how the row stands.
    pub(super) fn resolve(
        &self,
        shared: &Condensed,
        entering: &Active,
        violation: f64,
        direction: &mut Direction,
    ) -> Stand {
        self.correct(shared, entering, direction);
        let (rates, complement) = (&direction.rates, direction.complement);
        // Rounding in the active rows counts as well.
        let active = self.active.iter().zip(rates);
        let excess = violation
            - active
                .map(|(active, rate)| rate * self.violation(active))
                .sum::<f64>();
        if excess <= NEGLIGIBLE {
            Stand::Touches
        // Sixteen times the rise from here is more than once from the optimum without rows.
        } else if excess * excess > 32.0 * self.absurd_rise * complement {
            Stand::Contradicts
        } else {
            Stand::Apart(violation / complement)
        }
    }

    /// One step of iterative refinement of the rates, and the complement as a square.
    fn correct(&self, shared: &Condensed, entering: &Active, direction: &mut Direction) {
        let outputs = shared.outputs_of_half(&self.remainder(shared, entering, &direction.rates));
        let mut missing = [0.0; CAPACITY];
        let active = self.active.iter().zip(&direction.rates);
        for (missing, (active, rate)) in missing.iter_mut().zip(active) {
            *missing = active.pattern.value(&outputs) - self.elasticity(active) * rate;
        }
        self.factor.forward(&mut missing);
        for (product, missing) in direction.products.iter_mut().zip(&missing) {
            *product += missing;
        }
        self.factor.backward(&mut missing);
        let mut largest = 1.0;
        for (rate, missing) in direction.rates.iter_mut().zip(&missing) {
            *rate += missing;
            largest = rate.abs().max(largest);
        }
        for rate in &mut direction.rates {
            if rate.abs() < NO_RATE * largest {
                *rate = 0.0;
            }
        }
        let rest = self.remainder(shared, entering, &direction.rates);
        let active = self.active.iter().zip(&direction.rates);
        let elastic: f64 = active
            .map(|(active, rate)| self.elasticity(active) * rate * rate)
            .sum();
        direction.complement = dot(&rest, &rest) + elastic;
    }

    /// `U^-1 Y' (c_p - C_A' r)`
    fn remainder(
        &self,
        shared: &Condensed,
        entering: &Active,
        rates: &[f64; CAPACITY],
    ) -> ControlVector {
        let mut sum = Sum([0.0; OUTPUTS]);
        sum.add(&entering.pattern, 1.0);
        for (active, rate) in self.active.iter().zip(rates) {
            sum.add(&active.pattern, -rate);
        }
        shared.half_push(&sum.0)
    }

    /// The verdict on rows that contradict each other: the entering row and the active ones, whose
    /// left-hand sides cancel.
    pub(super) fn contradiction(
        &mut self,
        shared: &Condensed,
        entering: &Active,
        rates: &[f64; CAPACITY],
    ) -> Status {
        self.certificate.clear();
        let _ = self.certificate.push((entering.row, 1.0));
        for (active, rate) in self.active.iter().zip(rates) {
            if *rate != 0.0 {
                let _ = self.certificate.push((active.row, -rate));
            }
        }
        self.proven(shared)
    }

    /// The verdict on multipliers that have grown beyond what a flight is worth.
    pub(super) fn excessive_multipliers(
        &mut self,
        shared: &Condensed,
        entering: &Active,
    ) -> Status {
        let rows = || self.active.iter().chain([entering]);
        let largest = rows().fold(1.0_f64, |most, row| most.max(row.multiplier));
        self.certificate.clear();
        for row in self.active.iter().chain([entering]) {
            let _ = self.certificate.push((row.row, row.multiplier / largest));
        }
        self.proven(shared)
    }

    /// Whether the certificate proves infeasibility, from the data of the program alone: the weighted
    /// sum of its rows is violated by the optimum without rows, and mending that takes an absurd cost.
    fn proven(&mut self, shared: &Condensed) -> Status {
        let free = shared.unconstrained(&self.problem.initial, &self.problem.target);
        let mut sum = Sum([0.0; OUTPUTS]);
        let mut excess = 0.0;
        for (row, weight) in &self.certificate {
            if let (Some(pattern), Some(bound)) =
                (RowPattern::of(*row), self.problem.bounds.0.get(*row))
            {
                excess += weight * (pattern.value(&free.outputs) - bound);
                sum.add(&pattern, *weight);
            }
        }
        let half = shared.half_push(&sum.0);
        let valid = self.certificate.iter().all(|(_, weight)| *weight >= 0.0);
        if valid
            && excess > NEGLIGIBLE
            && excess * excess > 2.0 * self.absurd_rise * dot(&half, &half)
        {
            Status::Infeasible
        } else {
            Status::NumericalFailure
        }
    }

    /// How far a row gives way per multiplier.
    pub(super) fn elasticity(&self, row: &Active) -> f64 {
        match self.problem.penalty {
            Some(penalty) if row.yielded => 1.0 / penalty.quadratic,
            _ => 0.0,
        }
    }
}
