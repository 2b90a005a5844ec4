//! Rows that become active, and rows that leave.

use super::super::dot;
use super::{Active, Aligned, CAPACITY, CONTROLS, Condensed, Solver, TOLERANCE};
use crate::qp::Status;

impl Solver {
    /// Appends a row to the active rows and the factor. With a share `apart`, it appends only a row of which more
    /// than this share of the norm does not depend on the rows before. Returns false if it does not.
    #[inline(never)]
    pub(super) fn append(&mut self, shared: &Condensed, own: Active, apart: Option<f64>) -> bool {
        let mut normal = Aligned([0.0; CONTROLS]);
        shared.add_normal(&mut normal.0, &own.pattern, 1.0);
        let (mut products, mut rest) = ([0.0; CAPACITY], Aligned([0.0; CONTROLS]));
        let squares = self.factor.project(
            &normal,
            shared.reach(&own.pattern),
            &mut products,
            &mut rest,
        );
        let norm = dot(&normal.0, &normal.0);
        if apart.is_some_and(|apart| norm - squares <= apart * norm) {
            return false;
        }
        let complement = self.complement(&own, norm, norm - squares);
        if complement <= 0.0 || self.active.push(own).is_err() {
            return false;
        }
        if !self.factor.append(&products, &rest, complement) {
            self.active.pop();
            return false;
        }
        if let Some(open) = self.open.0.get_mut(own.row) {
            *open = f64::INFINITY;
        }
        true
    }

    pub(super) fn activate(&mut self, row: Active, complement: f64) -> Option<Status> {
        let room = self.active.push(row).is_ok()
            && self.factor.append(&self.products, &self.rest, complement);
        if let Some(open) = self.open.0.get_mut(row.row) {
            *open = f64::INFINITY;
        }
        (!room).then_some(Status::IterationLimit)
    }

    #[inline(never)]
    pub(super) fn deactivate(&mut self, index: usize) -> Option<Active> {
        let from_index = self
            .active
            .get_mut(index..)
            .filter(|rows| !rows.is_empty())?;
        from_index.rotate_left(1);
        let removed = self.active.pop()?;
        self.factor
            .remove(index, &mut self.products, &mut self.rest);
        let bound = self.problem.bounds.0.get(removed.row);
        if let (Some(open), Some(bound)) = (self.open.0.get_mut(removed.row), bound) {
            *open = *bound + TOLERANCE;
        }
        Some(removed)
    }
}
