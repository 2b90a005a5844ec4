//! The corridor of a candidate: half-planes that its stage boundaries stay behind.
//!
//! The obstacles around each segment of a candidate give faces, see [`Corridor::separate`]. In the paper's method rays
//! around each collocation point give them (paper, section III-B; module `paper`).

mod segments;

use crate::config::{DIRECTIONS, KNOTS};
pub use segments::Keep;

/// Ray directions `(row, col)`, counter-clockwise from up to forward, down and back.
///
/// The digits are those of the recorded reference: cosines and sines of multiples of 45 degrees in
/// floating point, with the first zero replaced by 1e-8. Other digits would let a ray that runs along a
/// cell boundary end in another cell.
#[expect(
    clippy::approx_constant,
    reason = "the recorded digits, not the nearest ones"
)]
pub const DIRECTION_VECTORS: [[f64; 2]; DIRECTIONS] = [
    [1.0, 1e-8],
    [0.7071067811865476, 0.7071067811865475],
    [6.123233995736766e-17, 1.0],
    [-0.7071067811865475, 0.7071067811865476],
    [-1.0, 1.2246467991473532e-16],
    [-0.7071067811865477, -0.7071067811865475],
    [-1.8369701987210297e-16, -1.0],
    [0.7071067811865474, -0.7071067811865477],
];

/// Half-planes `g_i . p_k <= bounds[k][i]` \[m\] on the position `p_k = (z, x)` at each stage boundary. The
/// position is relative to straight and level flight; the vectors `g_i` are [`DIRECTION_VECTORS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Corridor {
    /// Right-hand sides \[m\], `KNOTS` x `DIRECTIONS`.
    pub bounds: [[f64; DIRECTIONS]; KNOTS],
}

impl Corridor {
    /// A corridor without bounds.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            bounds: [[f64::INFINITY; DIRECTIONS]; KNOTS],
        }
    }
}
