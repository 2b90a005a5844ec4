//! The continuous algebraic Riccati equation, by a structure-preserving doubling algorithm
//! (Chu, Fan, Lin: "A structure-preserving doubling algorithm for continuous-time algebraic
//! Riccati equations", 2005).

use nalgebra::Matrix4;

/// Greatest number of doublings. Convergence is quadratic, and this problem needs about 8.
const MAX_DOUBLINGS: usize = 40;

/// Greatest accepted residual of the equation, relative to its terms. Rounding leaves 1e-13.
const RESIDUAL: f64 = 1e-8;

/// The reason why the solver found no stabilising solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RiccatiError {
    /// An entry of the equation is not a finite number.
    #[error(
        "the regulator's equation has a number that is not finite: check the airframe, and that \
         the weight of the elevator is positive"
    )]
    NotFinite,
    /// A matrix that must be inverted is singular.
    #[error(
        "the regulator's equation has a matrix without an inverse: check airframe and weights of \
         the regulator"
    )]
    Singular,
    /// The doublings gave a number that is not finite, or did not settle within `MAX_DOUBLINGS`.
    #[error(
        "the regulator's equation was not solved within its bound: check airframe and weights of \
         the regulator"
    )]
    NotConverged,
    /// The doublings settled on a matrix that does not solve the equation or is not positive
    /// semidefinite. The pair is probably not stabilisable.
    #[error(
        "no gain of the regulator stabilises the aircraft: check that the elevator turns it, and \
         the weights of the regulator"
    )]
    NotStabilising,
}

/// Solves `A'X + X A - X G X + Q = 0` for the stabilising `X` (4 x 4, symmetric), with
/// `G = B R^-1 B'`.
///
/// # Errors
/// [`RiccatiError`]: each variant names one cause.
// Not inlined, so that its matrices do not lie on the stack beneath the check of the regulator.
#[inline(never)]
pub fn solve_riccati(
    a: &Matrix4<f64>,
    g: &Matrix4<f64>,
    q: &Matrix4<f64>,
) -> Result<Matrix4<f64>, RiccatiError> {
    if ![a, g, q].into_iter().all(finite) {
        return Err(RiccatiError::NotFinite);
    }
    let one = Matrix4::identity();
    // The Cayley transform with a shift of the size of A maps the stable half-plane into the unit circle.
    let shift = norm(a).max(1.0);
    let shifted = plus(a, -shift, &one);
    let shifted_inverse = inverse(&shifted)?;
    let coupling = product(&[q, &shifted_inverse, g]);
    let w = plus(&transposed(&shifted), 1.0, &coupling);
    let w_inverse = inverse(&w)?;
    let mut ak = plus(&one, 2.0 * shift, &transposed(&w_inverse));
    let doubled = plus(&Matrix4::zeros(), 2.0 * shift, &one);
    let mut gk = product(&[&shifted_inverse, g, &w_inverse, &doubled]);
    let mut hk = product(&[&w_inverse, q, &shifted_inverse, &doubled]);

    for _ in 0..MAX_DOUBLINGS {
        let mix = inverse(&plus(&one, 1.0, &product(&[&gk, &hk])))?;
        let turned = transposed(&ak);
        let step = product(&[&turned, &hk, &mix, &ak]);
        gk = plus(&gk, 1.0, &product(&[&ak, &mix, &gk, &turned]));
        ak = product(&[&ak, &mix, &ak]);
        hk = plus(&hk, 1.0, &step);
        if !finite(&hk) {
            return Err(RiccatiError::NotConverged);
        }
        if norm(&step) <= 1e-15 * norm(&hk) {
            return checked(a, g, q, plus(&hk, 1.0, &transposed(&hk)) * 0.5);
        }
    }
    Err(RiccatiError::NotConverged)
}

/// The product of some matrices, from the left to the right.
// This and the next ones are not inlined, because the image would hold twenty copies of each.
#[inline(never)]
fn product(factors: &[&Matrix4<f64>]) -> Matrix4<f64> {
    let mut factors = factors.iter().copied();
    let first = factors.next().copied().unwrap_or_default();
    factors.fold(first, |product, factor| product * factor)
}

/// `matrix + factor other`
#[inline(never)]
fn plus(matrix: &Matrix4<f64>, factor: f64, other: &Matrix4<f64>) -> Matrix4<f64> {
    matrix + other * factor
}

#[inline(never)]
fn transposed(matrix: &Matrix4<f64>) -> Matrix4<f64> {
    matrix.transpose()
}

#[inline(never)]
fn norm(matrix: &Matrix4<f64>) -> f64 {
    matrix.norm()
}

#[inline(never)]
fn finite(matrix: &Matrix4<f64>) -> bool {
    matrix.iter().all(|value| value.is_finite())
}

fn inverse(matrix: &Matrix4<f64>) -> Result<Matrix4<f64>, RiccatiError> {
    crate::inverse::inverse(matrix).ok_or(RiccatiError::Singular)
}

/// Returns `x` if it solves the equation and is positive semidefinite. The doublings also settle for a
/// pair that is not stabilisable, but then `x` fails one of these two tests.
fn checked(
    a: &Matrix4<f64>,
    g: &Matrix4<f64>,
    q: &Matrix4<f64>,
    x: Matrix4<f64>,
) -> Result<Matrix4<f64>, RiccatiError> {
    let (linear, square) = (product(&[&transposed(a), &x]), product(&[&x, g, &x]));
    let constant = plus(q, -1.0, &square);
    let residual = plus(&plus(&linear, 1.0, &transposed(&linear)), 1.0, &constant);
    let scale = norm(&linear) + norm(&square) + norm(q);
    let lifted = plus(&x, RESIDUAL * norm(&x), &Matrix4::identity());
    if norm(&residual) <= RESIDUAL * scale && lifted.cholesky().is_some() {
        Ok(x)
    } else {
        Err(RiccatiError::NotStabilising)
    }
}
