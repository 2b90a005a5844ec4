//! The continuous algebraic Riccati equation, by a structure-preserving doubling algorithm
//! (Chu, Fan, Lin: "A structure-preserving doubling algorithm for continuous-time algebraic
//! Riccati equations", 2005).

use nalgebra::Matrix4;

/// Bound of the doublings; convergence is quadratic, about 8 are needed here.
const MAX_DOUBLINGS: usize = 40;

/// Residual of the equation relative to its terms in a solution; rounding leaves 1e-13.
const RESIDUAL: f64 = 1e-8;

/// No stabilising solution was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RiccatiError {
    /// A matrix that must be inverted is singular, or an entry is not finite.
    Singular,
    /// The doublings did not settle: the pair is probably not stabilisable.
    NotConverged,
}

/// Solves `A'X + X A - X G X + Q = 0` for the stabilising `X` (4 x 4, symmetric), with
/// `G = B R^-1 B'`.
///
/// # Errors
/// [`RiccatiError`] as its variants say.
pub fn solve_riccati(
    a: &Matrix4<f64>,
    g: &Matrix4<f64>,
    q: &Matrix4<f64>,
) -> Result<Matrix4<f64>, RiccatiError> {
    // The Cayley transform with a shift of the size of A maps the stable plane into the circle.
    let shift = a.norm().max(1.0);
    let shifted = a - Matrix4::identity() * shift;
    let shifted_inverse = inverse(&shifted)?;
    let w = shifted.transpose() + q * shifted_inverse * g;
    let w_inverse = inverse(&w)?;
    let mut ak = Matrix4::identity() + w_inverse.transpose() * (2.0 * shift);
    let mut gk = shifted_inverse * g * w_inverse * (2.0 * shift);
    let mut hk = w_inverse * q * shifted_inverse * (2.0 * shift);

    for _ in 0..MAX_DOUBLINGS {
        let mix = inverse(&(Matrix4::identity() + gk * hk))?;
        let step = ak.transpose() * hk * mix * ak;
        gk += ak * mix * gk * ak.transpose();
        ak = ak * mix * ak;
        hk += step;
        if !hk.iter().all(|value| value.is_finite()) {
            return Err(RiccatiError::Singular);
        }
        if step.norm() <= 1e-15 * hk.norm() {
            return checked(a, g, q, (hk + hk.transpose()) * 0.5);
        }
    }
    Err(RiccatiError::NotConverged)
}

fn inverse(matrix: &Matrix4<f64>) -> Result<Matrix4<f64>, RiccatiError> {
    crate::inverse::inverse(matrix).ok_or(RiccatiError::Singular)
}

/// The doublings of a pair that cannot be stabilised settle too: on numbers that solve nothing, or on
/// a solution that is no cost, because it is negative somewhere.
fn checked(
    a: &Matrix4<f64>,
    g: &Matrix4<f64>,
    q: &Matrix4<f64>,
    x: Matrix4<f64>,
) -> Result<Matrix4<f64>, RiccatiError> {
    let (linear, square) = (a.transpose() * x, x * g * x);
    let residual = linear + linear.transpose() - square + q;
    let scale = linear.norm() + square.norm() + q.norm();
    let lifted = x + Matrix4::identity() * (RESIDUAL * x.norm());
    if residual.norm() <= RESIDUAL * scale && lifted.cholesky().is_some() {
        Ok(x)
    } else {
        Err(RiccatiError::NotConverged)
    }
}
