//! The inverse of a small matrix. It uses plain loops: nalgebra's decompositions keep range checks that
//! the compiler cannot always remove, and each such check is a path to a panic.

use nalgebra::SMatrix;

/// The inverse by Householder's QR decomposition (Golub, Van Loan: "Matrix Computations", 5.2), or `None`
/// for a singular matrix.
///
/// The reflections turn the matrix into `R`, which is upper triangular with a positive diagonal, and the
/// identity into `Q'`. Back substitution then solves `R X = Q'`.
pub(crate) fn inverse<const N: usize>(matrix: &SMatrix<f64, N, N>) -> Option<SMatrix<f64, N, N>> {
    // Both matrices are arrays of columns.
    let mut r: [[f64; N]; N] = (*matrix).into();
    let mut x: [[f64; N]; N] = SMatrix::<f64, N, N>::identity().into();
    let mut diagonal = [0.0; N];
    for (pivot, norm) in diagonal.iter_mut().enumerate() {
        let (column, later) = r.get_mut(pivot..)?.split_first_mut()?;
        let axis = column.get_mut(pivot..)?;
        let sign;
        (*norm, sign) = reflection_axis(axis)?;
        for other in later.iter_mut().chain(&mut x) {
            reflect(other.get_mut(pivot..)?, axis, sign);
        }
    }
    for column in &mut x {
        for row in (0..N).rev() {
            let value = column[row] / diagonal[row];
            column[row] = value;
            for (above, factor) in column.iter_mut().zip(&r[row]).take(row) {
                *above -= value * factor;
            }
        }
    }
    Some(x.into())
}

/// Replaces a column by the unit axis `v` of the reflection `sign (I - 2 v v')` that maps the column to
/// `(norm, 0, ..)`. Returns `(norm, sign)`, or `None` if the column is zero.
fn reflection_axis(column: &mut [f64]) -> Option<(f64, f64)> {
    let norm_squared = dot(column, column);
    let norm = libm::sqrt(norm_squared);
    let first = column.first_mut()?;
    // The first entry moves away from zero, so that no digits cancel.
    let away = if *first >= 0.0 { 1.0 } else { -1.0 };
    let length_squared = 2.0 * (norm_squared + first.abs() * norm);
    *first += away * norm;
    if length_squared == 0.0 {
        return None;
    }
    // The axis is normalised twice, because the first length has a rounding error.
    unscale(column, libm::sqrt(length_squared));
    let length = libm::sqrt(dot(column, column));
    unscale(column, length);
    Some((norm, -away))
}

/// `y <- sign (y - 2 v (v' y))`
fn reflect(y: &mut [f64], axis: &[f64], sign: f64) {
    let factor = -2.0 * sign * dot(axis, y);
    for (y, axis) in y.iter_mut().zip(axis) {
        *y = factor * axis + sign * *y;
    }
}

fn unscale(column: &mut [f64], length: f64) {
    column.iter_mut().for_each(|value| *value /= length);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

#[cfg(test)]
mod tests {
    use super::inverse;
    use nalgebra::{Matrix3, Matrix4};

    #[test]
    fn the_inverse_times_the_matrix_is_the_identity() {
        #[rustfmt::skip]
        let matrix = Matrix4::new(
            0.0,  2.0, -1.0, 0.5,
            3.0, -1.0,  4.0, 0.0,
            0.0,  0.0, -2.0, 1e3,
            1e-3, 7.0,  0.0, 1.0,
        );
        let product = inverse(&matrix).expect("regular") * matrix;
        assert!((product - Matrix4::identity()).norm() < 1e-12);
    }

    #[test]
    fn a_singular_matrix_has_none() {
        assert_eq!(
            inverse(&Matrix3::new(1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 4.0)),
            None
        );
        assert_eq!(inverse(&Matrix3::zeros()), None);
    }
}
