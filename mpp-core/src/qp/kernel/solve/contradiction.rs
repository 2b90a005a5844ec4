//! Decides whether rows contradict each other: before the first step those that no control can change and opposite faces,
//! later a row that depends on the active rows up to rounding.
//!
//! The Schur complement of the latter is a difference of nearly equal numbers, and has no valid digits.
//! It is also the squared norm of a vector. The vector keeps its digits down to the rounding of the
//! controls, so this module computes the complement from the vector.

use super::super::super::rows::value_at_start;
use super::super::dot;
use super::direction::{Direction, Stand};
use super::{Active, CAPACITY, CONTROLS, Condensed, ControlVector, Entering, Solver, TOLERANCE};
use crate::qp::Status;

/// Greatest contradiction between rows [m, rad or N] that may come from rounding.
const NEGLIGIBLE: f64 = 1e-8;

/// Share of the largest rate below which a rate is zero up to rounding.
const NO_RATE: f64 = 1e-13;

/// Share of the lengths of weighted normals below which their sum is zero up to rounding.
const CANCELS: f64 = 1e-12;

/// Least crossing of opposite faces \[m\] that decides a program before its first step. The method itself
/// decides on smaller ones, because the directions are opposite only up to 1e-8.
const CROSSING: f64 = 1e-5;

impl Solver {
    /// Checks the hard rows that no control can change. If one of them is violated, the problem is
    /// infeasible.
    pub(super) fn check_constant_rows(&mut self, shared: &Condensed) -> Option<Status> {
        let rows = shared.prices.iter().zip(&self.problem.bounds.0);
        for (row, (price, bound)) in rows.enumerate() {
            if *price > 0.0 || self.is_soft(row) {
                continue;
            }
            let pattern = shared.pattern(row);
            let value = pattern.map(|pattern| pattern.value(&self.outputs));
            let Some(value) = value.or_else(|| value_at_start(row, &self.problem.initial)) else {
                continue;
            };
            if value - bound > TOLERANCE {
                let _ = self.certificate.push((row, 1.0));
                return Some(Status::Infeasible);
            }
        }
        None
    }

    /// Checks the opposite faces of a corridor. Faces that cross by more than rounding leave no room for a
    /// position, so two rows are the whole proof of infeasibility.
    pub(super) fn check_opposite_faces(&mut self) -> Option<Status> {
        if self.problem.penalty.is_some() {
            return None;
        }
        let mut found = None;
        let bounds = &self.problem.bounds;
        bounds.crossing_faces(CROSSING, |one, other| {
            found = found.or(Some((one, other)));
        });
        let (first, second) = found?;
        let _ = self.certificate.push((first, 1.0));
        let _ = self.certificate.push((second, 1.0));
        Some(Status::Infeasible)
    }

    /// Corrects a direction whose complement is lost in rounding. Returns the relation of the entering row to
    /// the active rows.
    pub(super) fn resolve(
        &mut self,
        shared: &Condensed,
        entering: &Entering,
        direction: &mut Direction,
    ) -> Stand {
        let violation = entering.violation;
        self.correct(shared, &entering.row, direction);
        let (rates, complement) = (&self.rates, direction.complement);
        // The excess includes the rounding errors of the active rows.
        let active = self.active.iter().zip(rates);
        let excess = violation
            - active
                .map(|(active, rate)| rate * self.violation(active))
                .sum::<f64>();
        if excess <= NEGLIGIBLE {
            Stand::Touches
        // The cost would rise by more than the absurd rise above the unconstrained optimum, so the rows contradict each other.
        } else if excess * excess > 32.0 * self.absurd_rise * complement {
            Stand::Contradicts
        } else {
            Stand::Apart(violation / complement)
        }
    }

    /// Makes one step of iterative refinement of the rates, and computes the complement as a squared norm.
    fn correct(&mut self, shared: &Condensed, entering: &Active, direction: &mut Direction) {
        let rest = self.remainder(shared, entering);
        let mut missing = [0.0; CAPACITY];
        let active = self.active.iter().zip(&self.rates);
        for (missing, (active, rate)) in missing.iter_mut().zip(active) {
            *missing = shared.change(&active.pattern, &rest) - self.elasticity(active) * rate;
        }
        self.factor.forward(&mut missing);
        for (product, missing) in self.products.iter_mut().zip(&missing) {
            *product += missing;
        }
        self.factor.backward(&mut missing);
        let mut largest = 1.0;
        let known = self.active.len();
        for (rate, missing) in self.rates.iter_mut().zip(&missing).take(known) {
            *rate += missing;
            largest = rate.abs().max(largest);
        }
        for rate in self.rates.iter_mut().take(known) {
            if rate.abs() < NO_RATE * largest {
                *rate = 0.0;
            }
        }
        let rest = self.remainder(shared, entering);
        let active = self.active.iter().zip(&self.rates);
        let elastic: f64 = active
            .map(|(active, rate)| self.elasticity(active) * rate * rate)
            .sum();
        direction.complement = dot(&rest, &rest) + elastic;
        direction.slope = direction.complement;
        self.rest.0 = rest;
    }

    /// `Y' (c_p - C_A' r)`
    pub(super) fn remainder(&self, shared: &Condensed, entering: &Active) -> ControlVector {
        let mut rest = [0.0; CONTROLS];
        shared.add_normal(&mut rest, &entering.pattern, 1.0);
        for (active, rate) in self.active.iter().zip(&self.rates) {
            if *rate != 0.0 {
                shared.add_normal(&mut rest, &active.pattern, -rate);
            }
        }
        rest
    }

    /// The verdict on an entering row that contradicts the active rows. Their weighted left-hand sides cancel
    /// each other.
    pub(super) fn contradiction(&mut self, shared: &Condensed, entering: &Active) -> Status {
        self.certificate.clear();
        let _ = self.certificate.push((entering.row, 1.0));
        for (active, rate) in self.active.iter().zip(&self.rates) {
            if *rate != 0.0 {
                let _ = self.certificate.push((active.row, -rate));
            }
        }
        self.proven(shared)
    }

    /// The verdict on multipliers that have grown until the cost is absurd.
    // Not inlined: two callers, and it is rare.
    #[inline(never)]
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

    /// What the certificate proves from the data of the program alone. The optimum without rows violates the weighted sum of
    /// the certificate's rows. If the normals cancel in this sum, no controls correct the violation. Otherwise the shortest
    /// correction has a cost, and it may be absurd.
    fn proven(&mut self, shared: &Condensed) -> Status {
        self.normalised = [0.0; CONTROLS];
        self.outputs = self.free;
        self.rolled = false;
        let mut sum = [0.0; CONTROLS];
        let (mut excess, mut lengths) = (0.0, 0.0);
        for (row, weight) in &self.certificate {
            if let (Some(pattern), Some(bound), Some(price)) = (
                shared.pattern(*row),
                self.problem.bounds.0.get(*row),
                shared.prices.get(*row),
            ) {
                excess += weight * (pattern.value(&self.outputs) - bound);
                shared.add_normal(&mut sum, &pattern, *weight);
                // The price is the inverse of the normal's squared length.
                lengths += weight / libm::sqrt(*price);
            }
        }
        let mut terms = self.certificate.iter();
        let valid = terms.all(|(row, weight)| *weight >= 0.0 && !self.is_soft(*row));
        let rest = dot(&sum, &sum);
        if !valid || excess.is_nan() || excess <= NEGLIGIBLE {
            Status::NumericalFailure
        // No controls keep a bound of minus infinity.
        } else if excess == f64::INFINITY || rest <= CANCELS * CANCELS * lengths * lengths {
            Status::Infeasible
        } else if excess * excess > 2.0 * self.absurd_rise * rest {
            Status::TooDear
        } else {
            Status::NumericalFailure
        }
    }

    /// Distance by which a row yields, per unit of its multiplier.
    pub(super) fn elasticity(&self, row: &Active) -> f64 {
        match self.problem.penalty {
            Some(penalty) if row.yielded => 1.0 / penalty.quadratic,
            _ => 0.0,
        }
    }
}
