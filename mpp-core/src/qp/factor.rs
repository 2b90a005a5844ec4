//! A Cholesky factor to which the solver appends rows, and from which it removes rows.

use super::controls::{CONTROLS, add_scaled, dot};
use super::triangle::{Triangle, entries};

/// Greatest number of active rows: the number of controls, and some more for rows that yield.
pub(super) const CAPACITY: usize = CONTROLS + 28;

/// Lower factor `L` of the Gram matrix of the active rows, in the order in which they were added.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    rows: Triangle<{ entries(CAPACITY) }>,
    len: usize,
}

impl Factor {
    pub(super) const fn new() -> Self {
        Self {
            rows: Triangle::new(),
            len: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Computes `L^-1 b` in place on the first entries of `b`.
    pub(super) fn forward(&self, b: &mut [f64; CAPACITY]) {
        for (index, row) in self.rows.rows_from(0).take(self.len).enumerate() {
            if let Some((known, [value, ..])) = b.split_at_mut_checked(index)
                && let [factors @ .., diagonal] = row
            {
                *value = (*value - dot(factors, known)) / diagonal;
            }
        }
    }

    /// Computes `L^-T b` in place on the first entries of `b`.
    pub(super) fn backward(&self, b: &mut [f64; CAPACITY]) {
        for row in self.rows.rows_before(self.len) {
            if let [factors @ .., diagonal] = row
                && let Some((earlier, [value, ..])) = b.split_at_mut_checked(factors.len())
            {
                *value /= diagonal;
                add_scaled(earlier, factors, -*value);
            }
        }
    }

    /// Appends a row with the Schur complement `complement` > 0. `products` are the row's products with the
    /// active rows after [`Self::forward`]. Returns false if there is no room.
    pub(super) fn append(&mut self, products: &[f64; CAPACITY], complement: f64) -> bool {
        let [factors @ .., diagonal] = self.rows.row_mut(self.len) else {
            return false;
        };
        for (factor, product) in factors.iter_mut().zip(products) {
            *factor = *product;
        }
        *diagonal = libm::sqrt(complement);
        self.len += 1;
        true
    }

    /// Removes row `index`. Givens rotations bring the other rows back to lower triangular form.
    pub(super) fn remove(&mut self, index: usize) {
        let last = self.len.saturating_sub(1);
        for col in index..last {
            // The next row moves to this place and is then one column too long: rotate (col, col + 1).
            let [.., a, b] = self.rows.row(col + 1) else {
                break;
            };
            let length = libm::sqrt(a * a + b * b);
            let (cos, sin) = (a / length, b / length);
            for row in self
                .rows
                .rows_from_mut(col + 1)
                .take(self.len.saturating_sub(col + 1))
            {
                if let Some([left, right, ..]) = row.get_mut(col..) {
                    (*left, *right) = (cos * *left + sin * *right, cos * *right - sin * *left);
                }
            }
        }
        for row in index..last {
            self.rows.move_up(row);
        }
        self.len = last;
    }
}
