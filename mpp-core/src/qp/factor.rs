//! A Cholesky factor that rows are appended to and removed from.

use super::dense::{backward, forward};
use super::solve::CAPACITY;

/// Lower factor `L` of the Gram matrix of the active rows, in the order in which they were added.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    rows: [[f64; CAPACITY]; CAPACITY],
    len: usize,
}

impl Factor {
    pub(super) const fn new() -> Self {
        Self {
            rows: [[0.0; CAPACITY]; CAPACITY],
            len: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// `L^-1 b`, in place on the first entries of `b`.
    pub(super) fn forward(&self, b: &mut [f64; CAPACITY]) {
        forward(&self.rows, self.len, b);
    }

    /// `L^-T b`, in place on the first entries of `b`.
    pub(super) fn backward(&self, b: &mut [f64; CAPACITY]) {
        backward(&self.rows, self.len, b);
    }

    /// Appends a row whose products with the active rows, passed through [`Self::forward`], are
    /// `products`, and whose Schur complement is `complement` > 0. False when there is no room.
    pub(super) fn append(&mut self, products: &[f64; CAPACITY], complement: f64) -> bool {
        let Some(row) = self.rows.get_mut(self.len) else {
            return false;
        };
        row.copy_from_slice(products);
        if let Some(diagonal) = row.get_mut(self.len) {
            *diagonal = libm::sqrt(complement);
        }
        self.len += 1;
        true
    }

    /// Removes row `index`; Givens rotations bring the rest back to lower triangular form.
    pub(super) fn remove(&mut self, index: usize) {
        let len = self.len.min(CAPACITY).saturating_sub(1);
        for row in index..len {
            self.rows[row] = self.rows[row + 1];
        }
        self.len = len;
        for col in index..len {
            // Row `col` now reaches one column too far: rotate columns (col, col + 1).
            let (a, b) = (self.rows[col][col], self.rows[col][col + 1]);
            let length = libm::sqrt(a * a + b * b);
            let (cos, sin) = (a / length, b / length);
            for row in col..len {
                let (left, right) = (self.rows[row][col], self.rows[row][col + 1]);
                self.rows[row][col] = cos * left + sin * right;
                self.rows[row][col + 1] = cos * right - sin * left;
            }
        }
    }
}
