//! A few discs, and when a plan past them is feasible.

use crate::common::world::Disc;

/// A trajectory within this violation counts as feasible [m, rad].
pub(crate) const FEASIBLE: f64 = 1e-6;

pub(crate) const SCATTERED: [Disc; 5] = [
    (118.0, 51.0, 1.0),
    (128.0, 46.0, 1.5),
    (131.0, 55.0, 1.0),
    (140.0, 50.0, 1.0),
    (146.0, 57.0, 1.0),
];
