//! The row that enters next: by a short list while its rows count enough, else by a look at all rows.

use super::super::super::excess::most_violated;
use super::super::dot;
use super::super::shortlist::{LISTED, count};
use super::{Active, Aligned, CONTROLS, Condensed, Entering, Solver, TOLERANCE};
use crate::qp::Status;

/// Number of steps after which the controls are computed again from the multipliers before the solver ends.
const DRIFT: usize = 40;

/// Share of what the first row of the short list counted that another one has to count to enter without a new list. Shares of
/// 0.02 to 0.6 differ by 4 %.
const LISTED_ENOUGH: f64 = 0.1;

impl Solver {
    /// Selects the row that enters next, and its violation. The error is the status of a solver that ends here.
    pub(super) fn select(&mut self, shared: &Condensed) -> Result<(Active, f64), Status> {
        let by_effort = self.problem.penalty.is_none();
        if let Some(row) = self.best_listed(shared, by_effort) {
            return Ok(row);
        }
        // Twice at most: the exact controls have no drift.
        loop {
            self.refresh(shared);
            most_violated(
                shared,
                &self.outputs,
                &self.open,
                by_effort,
                self.attitude_rows,
                &mut self.list,
            );
            if let Some((listed, row)) = self.list.take_first() {
                self.listed = listed;
                let own = self.inactive(shared, row).ok_or(Status::NumericalFailure)?;
                return Ok((own, self.violation(&own)));
            }
            if self.drift < DRIFT {
                return Err(Status::Optimal);
            }
            self.refresh_exactly(shared, None);
        }
    }

    /// A row without a multiplier.
    #[inline(never)]
    pub(super) fn inactive(&self, shared: &Condensed, row: usize) -> Option<Active> {
        let price = match self.problem.penalty {
            Some(penalty) if self.is_soft(row) => penalty.linear,
            _ => f64::INFINITY,
        };
        Some(Active {
            row,
            pattern: shared.pattern(row)?,
            multiplier: 0.0,
            yielded: false,
            price,
            fresh: false,
        })
    }

    /// Excess of a row over its bound at the present controls, whether or not the outputs are up to date.
    pub(super) fn excess_now(&self, shared: &Condensed, own: &Active) -> f64 {
        let value = own.pattern.value(&self.free) + shared.change(&own.pattern, &self.normalised);
        value - self.bound(own)
    }

    fn bound(&self, own: &Active) -> f64 {
        let bound = self.problem.bounds.0.get(own.row);
        bound.copied().unwrap_or(f64::INFINITY)
    }

    /// Amount by which a row yields at its multiplier.
    pub(super) fn allowed(&self, own: &Active) -> f64 {
        match self.problem.penalty {
            Some(penalty) if own.yielded => (own.multiplier - penalty.linear) / penalty.quadratic,
            _ => 0.0,
        }
    }

    /// Excess of a row over its bound at the present outputs, less the amount by which the row yields.
    pub(super) fn violation(&self, own: &Active) -> f64 {
        own.pattern.value(&self.outputs) - self.bound(own) - self.allowed(own)
    }

    /// The row of the short list that counts most at the present controls, if it counts enough. Rows that are no longer
    /// violated leave the list.
    #[inline(never)]
    fn best_listed(&mut self, shared: &Condensed, by_effort: bool) -> Option<(Active, f64)> {
        let mut most = LISTED_ENOUGH * self.listed;
        let mut best = None;
        let mut done: heapless::Vec<usize, LISTED> = heapless::Vec::new();
        for row in self.list.rows() {
            let open = self
                .open
                .0
                .get(row)
                .is_some_and(|bound| *bound < f64::INFINITY);
            let own = self.inactive(shared, row).filter(|_| open);
            let found = own.map(|own| (own, self.excess_now(shared, &own)));
            let Some((own, excess)) = found.filter(|(_, excess)| *excess > TOLERANCE) else {
                let _ = done.push(row);
                continue;
            };
            let price = shared.prices.get(row).copied().unwrap_or(0.0);
            let value = count(excess - TOLERANCE, price, by_effort);
            if value > most {
                most = value;
                best = Some((own, excess));
            }
        }
        let taken = best.map(|(own, _)| own.row);
        (self.list).keep(|row| Some(row) != taken && !done.contains(&row));
        best
    }

    /// Computes the products of a row with the active rows.
    pub(super) fn meet(&mut self, shared: &Condensed, row: Active, violation: f64) -> Entering {
        let mut normal = Aligned([0.0; CONTROLS]);
        shared.add_normal(&mut normal.0, &row.pattern, 1.0);
        let reach = shared.reach(&row.pattern);
        self.factor
            .project(&normal, reach, &mut self.products, &mut self.rest);
        Entering {
            row,
            violation,
            norm: dot(&normal.0, &normal.0),
        }
    }
}
