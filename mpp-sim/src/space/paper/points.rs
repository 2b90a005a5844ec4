//! Points of a path.

use crate::space::world::{Vector, length, minus, plus};
use mpp_core::config::{KNOTS, STAGES};

/// Points with equal spacing along a path, one for each boundary of a stage: at cruise speed they have equal times.
pub(super) fn collocation_points(path: &[Vector]) -> [Vector; KNOTS] {
    let lengths: Vec<f64> = path.windows(2).map(|it| distance(&it[0], &it[1])).collect();
    let spacing = lengths.iter().sum::<f64>() / STAGES as f64;
    let (mut segment, mut passed) = (0, 0.0);
    core::array::from_fn(|stage| {
        let along = spacing * stage as f64;
        while segment + 1 < lengths.len() && along > passed + lengths[segment] {
            passed += lengths[segment];
            segment += 1;
        }
        let share = (along - passed) / lengths[segment].max(1e-6);
        mixed(&path[segment], &path[segment + 1], share)
    })
}

/// Distance of two points \[m\].
pub(super) fn distance(a: &Vector, b: &Vector) -> f64 {
    length(minus(*a, *b))
}

/// The point at a share of the way.
pub(super) fn mixed(from: &Vector, to: &Vector, share: f64) -> Vector {
    plus(*from, minus(*to, *from), share)
}
