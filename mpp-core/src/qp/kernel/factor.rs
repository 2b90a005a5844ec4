//! A Cholesky factor to which the solver appends rows, and from which it removes rows.

use super::controls::{CONTROLS, ControlVector, add_all, dot};
use super::triangle::{Triangle, entries};

/// Greatest number of active rows: the number of controls, and some more for rows that yield.
pub(super) const CAPACITY: usize = CONTROLS + 28;

/// A vector over the controls in a place that suits the machine's vectors.
#[derive(Clone, Debug)]
#[repr(C, align(16))]
pub(super) struct Direction(pub(super) ControlVector);

/// Lower factor `L` of the Gram matrix of the active rows, in the order in which they were added.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    rows: Triangle<{ entries(CAPACITY) }>,
    /// Inverse of the diagonal.
    inverse: [f64; CAPACITY],
    /// `L^-1 C_A Y`: the normals of the active rows, each without the part that those before it have.
    directions: [Direction; CAPACITY],
    len: usize,
}

impl Factor {
    pub(super) const fn new() -> Self {
        Self {
            rows: Triangle::new(),
            inverse: [0.0; CAPACITY],
            directions: [const { Direction([0.0; CONTROLS]) }; CAPACITY],
            len: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
        self.inverse = [0.0; CAPACITY];
    }

    /// Computes `L^-1 C_A Y n` for the normal `n` of a row, of which the first `reach` entries are not zero, and the rest
    /// of `n` without the directions. Returns the squared norm of the products.
    #[inline(never)]
    pub(super) fn project(
        &self,
        normal: &Direction,
        reach: usize,
        products: &mut [f64; CAPACITY],
        rest: &mut Direction,
    ) -> f64 {
        let known = normal.0.as_chunks::<4>().0.get(..reach / 4).unwrap_or(&[]);
        let directions = self.directions.get(..self.len).unwrap_or(&[]);
        let mut squares = 0.0;
        for (product, direction) in products.iter_mut().zip(directions) {
            let mut sums = [0.0; 4];
            for (a, b) in direction.0.as_chunks::<4>().0.iter().zip(known) {
                for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
                    *sum += a * b;
                }
            }
            let value = (sums[0] + sums[2]) + (sums[1] + sums[3]);
            *product = value;
            squares += value * value;
        }
        rest.0 = normal.0;
        let (fours, last) = directions.as_chunks::<4>();
        let (factors, last_factors) = products.get(..self.len).unwrap_or(&[]).as_chunks::<4>();
        for ([a, b, c, d], [by_a, by_b, by_c, by_d]) in fours.iter().zip(factors) {
            let terms = a.0.iter().zip(&b.0).zip(&c.0).zip(&d.0);
            for (to, (((a, b), c), d)) in rest.0.iter_mut().zip(terms) {
                *to -= (by_a * a + by_b * b) + (by_c * c + by_d * d);
            }
        }
        for (direction, by) in last.iter().zip(last_factors) {
            add_all(&mut rest.0, &direction.0, -by);
        }
        squares
    }

    /// The direction of a row.
    pub(super) fn direction(&self, index: usize) -> Option<&ControlVector> {
        self.directions.get(index).map(|it| &it.0)
    }

    /// Computes `L^-1 b` in place on the first entries of `b`, of which those before `first` are zero.
    #[inline(never)]
    pub(super) fn forward_from(&self, b: &mut [f64; CAPACITY], first: usize) {
        let rows = self
            .rows
            .rows_from(first)
            .zip(self.inverse.iter().skip(first));
        for (index, (row, inverse)) in rows.take(self.len.saturating_sub(first)).enumerate() {
            let index = index + first;
            if let Some((known, [value, ..])) = b.split_at_mut_checked(index)
                && let (Some(known), Some(factors)) = (known.get(first..), row.get(first..index))
            {
                *value = (*value - dot(known, factors)) * inverse;
            }
        }
    }

    pub(super) fn forward(&self, b: &mut [f64; CAPACITY]) {
        self.forward_from(b, 0);
    }

    /// Computes `L^-T b` in place on the first entries of `b`. It takes four rows at a time; the inverse of the diagonal
    /// is zero beyond the last row.
    #[inline(never)]
    pub(super) fn backward(&self, b: &mut [f64; CAPACITY]) {
        let groups = self.inverse.as_chunks::<4>().0.iter().enumerate();
        for (group, inverse) in groups.take(self.len.div_ceil(4)).rev() {
            let Some(rows) = self.rows.four(4 * group) else {
                return;
            };
            let [(one, _), (two, l), (three, m), (four, n)] = rows.map(|row| {
                let chunks = row.as_chunks::<4>().0;
                match chunks.split_last() {
                    Some((last, chunks)) => (chunks, *last),
                    None => (chunks, [0.0; 4]),
                }
            });
            let chunks = b.as_chunks_mut::<4>().0;
            let Some((earlier, [places, ..])) = chunks.split_at_mut_checked(group) else {
                return;
            };
            let w = places[3] * inverse[3];
            let z = (places[2] - n[2] * w) * inverse[2];
            let y = ((places[1] - n[1] * w) - m[1] * z) * inverse[1];
            let x = (((places[0] - n[0] * w) - m[0] * z) - l[0] * y) * inverse[0];
            *places = [x, y, z, w];
            let rows = one.iter().zip(two).zip(three).zip(four);
            for (places, (((one, two), three), four)) in earlier.iter_mut().zip(rows) {
                for k in 0..4 {
                    places[k] -= (x * one[k] + y * two[k]) + (z * three[k] + w * four[k]);
                }
            }
        }
    }

    /// Appends a row with the Schur complement `complement` > 0. `products` and `rest` are those of
    /// [`Self::project`]. Returns false if there is no room.
    #[inline(never)]
    pub(super) fn append(
        &mut self,
        products: &[f64; CAPACITY],
        rest: &Direction,
        complement: f64,
    ) -> bool {
        let len = self.len;
        let row = self.rows.row_mut(len);
        row.fill(0.0);
        for (factor, product) in row.iter_mut().zip(products.get(..len).unwrap_or(&[])) {
            *factor = *product;
        }
        let root = libm::sqrt(complement);
        let Some(diagonal) = row.get_mut(len) else {
            return false;
        };
        *diagonal = root;
        let (Some(inverse), Some(direction)) =
            (self.inverse.get_mut(len), self.directions.get_mut(len))
        else {
            return false;
        };
        *inverse = 1.0 / root;
        for (to, from) in direction.0.iter_mut().zip(&rest.0) {
            *to = *from * *inverse;
        }
        self.len += 1;
        true
    }

    /// Removes row `index`. Givens rotations bring the other rows back to lower triangular form. Turns the products of
    /// an entering row alike, and gives back to its rest what only the removed row had taken.
    #[inline(never)]
    pub(super) fn remove(
        &mut self,
        index: usize,
        products: &mut [f64; CAPACITY],
        rest: &mut Direction,
    ) {
        let last = self.len.saturating_sub(1);
        for col in index..last {
            // The next row moves to this place and is then one column too long: rotate (col, col + 1).
            let Some([a, b, ..]) = self.rows.row(col + 1).get(col..) else {
                break;
            };
            let length = libm::sqrt(a * a + b * b);
            let inverse = 1.0 / length;
            let (cos, sin) = (a * inverse, b * inverse);
            let turn = |left: &mut f64, right: &mut f64| {
                (*left, *right) = (cos * *left + sin * *right, cos * *right - sin * *left);
            };
            for row in self
                .rows
                .rows_from_mut(col + 1)
                .take(self.len.saturating_sub(col + 1))
            {
                if let Some([left, right, ..]) = row.get_mut(col..) {
                    turn(left, right);
                }
            }
            if let Some([left, right, ..]) = products.get_mut(col..) {
                turn(left, right);
            }
            if let Some([left, right, ..]) = self.directions.get_mut(col..) {
                for (left, right) in left.0.iter_mut().zip(&mut right.0) {
                    turn(left, right);
                }
            }
            if let Some(place) = self.inverse.get_mut(col) {
                *place = inverse;
            }
        }
        if let (Some(product), Some(direction)) =
            (products.get_mut(last), self.directions.get(last))
        {
            add_all(&mut rest.0, &direction.0, *product);
            *product = 0.0;
        }
        for row in index..last {
            self.rows.move_up(row);
        }
        self.len = last;
        if let Some(inverse) = self.inverse.get_mut(last) {
            *inverse = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{CAPACITY, CONTROLS, Direction, Factor, dot};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use std::boxed::Box;
    use std::vec::Vec;

    /// Rows come and go at random. Whatever came before, the multipliers solve the Gram matrix of the rows that are left.
    #[test]
    fn the_factor_solves_the_gram_matrix_of_the_rows_that_are_left() {
        let mut random = Pcg64Mcg::seed_from_u64(11);
        let mut draw = || (random.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        let mut factor = Box::new(Factor::new());
        let mut normals: Vec<[f64; CONTROLS]> = Vec::new();
        let (mut products, mut rest) = ([0.0; CAPACITY], Direction([0.0; CONTROLS]));
        for round in 0..400 {
            if normals.len() < 24 && (normals.len() < 4 || draw() > -0.2) {
                let normal = Direction([0.0; CONTROLS].map(|_: f64| draw()));
                let squares = factor.project(&normal, CONTROLS, &mut products, &mut rest);
                let complement = dot(&normal.0, &normal.0) - squares;
                assert!(factor.append(&products, &rest, complement));
                normals.push(normal.0);
            } else {
                let index = (((draw() + 1.0) * 0.5) * normals.len() as f64) as usize;
                let index = index.min(normals.len() - 1);
                factor.remove(index, &mut products, &mut rest);
                normals.remove(index);
            }
            let mut wanted = [0.0; CAPACITY];
            for value in wanted.iter_mut().take(normals.len()) {
                *value = draw();
            }
            let mut solved = wanted;
            factor.forward(&mut solved);
            factor.backward(&mut solved);
            for (row, normal) in normals.iter().enumerate() {
                let terms = normals.iter().zip(&solved);
                let sum: f64 = terms.map(|(other, by)| dot(normal, other) * by).sum();
                assert!((sum - wanted[row]).abs() < 1e-8, "{round}: {sum}");
            }
        }
    }
}
