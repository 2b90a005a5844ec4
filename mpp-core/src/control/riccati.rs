//! The continuous algebraic Riccati equation, by a structure-preserving doubling algorithm
//! (Chu, Fan, Lin: "A structure-preserving doubling algorithm for continuous-time algebraic
//! Riccati equations", 2005).

use core::fmt;
use nalgebra::Matrix4;

/// Greatest number of doublings. Convergence is quadratic, and this problem needs about 8.
const MAX_DOUBLINGS: usize = 40;

/// Greatest accepted residual of the equation, relative to its terms. Rounding leaves 1e-13.
const RESIDUAL: f64 = 1e-8;

/// The reason why the solver found no stabilising solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RiccatiError {
    /// An entry of the equation is not a finite number.
    NotFinite,
    /// A matrix that must be inverted is singular.
    Singular,
    /// The doublings gave a number that is not finite, or did not settle within `MAX_DOUBLINGS`.
    NotConverged,
    /// The doublings settled on a matrix that does not solve the equation or is not positive
    /// semidefinite. The pair is probably not stabilisable.
    NotStabilising,
}

impl fmt::Display for RiccatiError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => {
                "the regulator's equation has a number that is not finite: check the airframe, and \
                 that the weight of the elevator is positive"
            }
            Self::Singular => {
                "the regulator's equation has a matrix without an inverse: check airframe and \
                 weights of the regulator"
            }
            Self::NotConverged => {
                "the regulator's equation was not solved within its bound: check airframe and \
                 weights of the regulator"
            }
            Self::NotStabilising => {
                "no gain of the regulator stabilises the aircraft: check that the elevator turns it, \
                 and the weights of the regulator"
            }
        })
    }
}

impl core::error::Error for RiccatiError {}

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
    let entries = a.iter().chain(g).chain(q);
    if !entries.copied().all(f64::is_finite) {
        return Err(RiccatiError::NotFinite);
    }
    // The Cayley transform with a shift of the size of A maps the stable half-plane into the unit circle.
    let shift = a.norm().max(1.0);
    let shifted = a - Matrix4::identity() * shift;
    let shifted_inverse = inverse(&shifted)?;
    let w = shifted.transpose() + product(&[q, &shifted_inverse, g]);
    let w_inverse = inverse(&w)?;
    let mut ak = Matrix4::identity() + w_inverse.transpose() * (2.0 * shift);
    let mut gk = product(&[&shifted_inverse, g, &w_inverse]) * (2.0 * shift);
    let mut hk = product(&[&w_inverse, q, &shifted_inverse]) * (2.0 * shift);

    for _ in 0..MAX_DOUBLINGS {
        let mix = inverse(&(Matrix4::identity() + product(&[&gk, &hk])))?;
        let turned = ak.transpose();
        let step = product(&[&turned, &hk, &mix, &ak]);
        gk += product(&[&ak, &mix, &gk, &turned]);
        ak = product(&[&ak, &mix, &ak]);
        hk += step;
        if !hk.iter().all(|value| value.is_finite()) {
            return Err(RiccatiError::NotConverged);
        }
        if step.norm() <= 1e-15 * hk.norm() {
            return checked(a, g, q, (hk + hk.transpose()) * 0.5);
        }
    }
    Err(RiccatiError::NotConverged)
}

/// The product of some matrices, from the left to the right.
// Not inlined, because the image would hold twenty products.
#[inline(never)]
fn product(factors: &[&Matrix4<f64>]) -> Matrix4<f64> {
    let mut factors = factors.iter().copied();
    let first = factors.next().copied().unwrap_or_default();
    factors.fold(first, |product, factor| product * factor)
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
    let (linear, square) = (product(&[&a.transpose(), &x]), product(&[&x, g, &x]));
    let residual = linear + linear.transpose() - square + q;
    let scale = linear.norm() + square.norm() + q.norm();
    let lifted = x + Matrix4::identity() * (RESIDUAL * x.norm());
    if residual.norm() <= RESIDUAL * scale && lifted.cholesky().is_some() {
        Ok(x)
    } else {
        Err(RiccatiError::NotStabilising)
    }
}
