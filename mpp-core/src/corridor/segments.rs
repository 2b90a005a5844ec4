//! Half-planes between the segments of a trajectory and the obstacles around it.
//!
//! Rays from the collocation points do not see obstacles between these points. A face is a half-plane
//! that holds at both ends of a segment, and therefore on the whole segment. Each occupied cell gets that
//! one of the eight directions that keeps it farthest from the segment.

use super::{Corridor, DIRECTION_VECTORS};
use crate::config::{DIRECTIONS, KNOTS, STAGE_PERIOD};
use crate::map::DistanceField;
use crate::tuning::faces::{FREE, GIVE, REACH};
use crate::vehicle::PathState;

/// Index of the upward direction in [`DIRECTION_VECTORS`].
const UP: usize = 0;
/// Index of the downward direction in [`DIRECTION_VECTORS`].
const DOWN: usize = 4;

/// Distances and heights that a trajectory must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keep {
    /// Least distance of the aircraft from the centres of occupied cells \[m\].
    pub margin: f64,
    /// Distance that a trajectory keeps where it already has that much room \[m\]. A value below the margin
    /// has no effect.
    pub room: f64,
    /// Radius of the aircraft \[m\].
    pub body_radius: f64,
    /// Least height \[m\].
    pub floor: f64,
    /// Greatest height \[m\].
    pub ceiling: f64,
}

impl Corridor {
    /// Separates each segment of a trajectory from the obstacles around it. The half-planes are relative to
    /// straight and level flight at the airspeed `cruise` [m/s].
    pub fn separate(
        &mut self,
        field: &DistanceField,
        knots: &[PathState; KNOTS],
        cruise: f64,
        keep: &Keep,
    ) {
        let [start, ..] = knots;
        for (stage, (bounds, knot)) in self.bounds.iter_mut().zip(knots).enumerate() {
            let level = start.x + cruise * STAGE_PERIOD * stage as f64;
            for (bound, [up, forward]) in bounds.iter_mut().zip(&DIRECTION_VECTORS) {
                *bound = up * (knot.z - start.z) + forward * (knot.x - level) + FREE;
            }
            bounds[UP] = bounds[UP].min(keep.ceiling - start.z);
            bounds[DOWN] = bounds[DOWN].min(start.z - keep.floor);
        }
        for stage in 0..KNOTS - 1 {
            let (Some([from, to]), Some([before, after])) = (
                knots.get(stage..stage + 2),
                self.bounds.get_mut(stage..stage + 2),
            ) else {
                continue;
            };
            let distance = kept(field, from, to, keep) + keep.body_radius;
            let range = |a: f64, b: f64| [a.min(b) - REACH, a.max(b) + REACH];
            field.surface(range(from.x, to.x), range(from.z, to.z), |x, z| {
                let (direction, vector) = farthest_direction(from, to, x, z);
                let [up, forward] = *vector;
                let mut reach = up * (z - start.z) - distance;
                reach += forward * (x - start.x - cruise * STAGE_PERIOD * stage as f64);
                before[direction] = before[direction].min(reach);
                let later = reach - forward * cruise * STAGE_PERIOD;
                after[direction] = after[direction].min(later);
            });
        }
    }
}

/// The distance that a segment keeps \[m\]. A program may use up [`GIVE`] of the room that the segment has.
fn kept(field: &DistanceField, from: &PathState, to: &PathState, keep: &Keep) -> f64 {
    if keep.room <= keep.margin {
        return keep.margin;
    }
    let (run, rise) = (to.x - from.x, to.z - from.z);
    let room = [0.0, 0.5, 1.0]
        .map(|share| field.distance(from.x + share * run, from.z + share * rise))
        .into_iter()
        .fold(keep.room + GIVE, f64::min);
    (room - GIVE).max(keep.margin)
}

/// The direction in which a point is farthest beyond both ends of a segment.
fn farthest_direction<'a>(
    from: &PathState,
    to: &PathState,
    x: f64,
    z: f64,
) -> (usize, &'a [f64; 2]) {
    let mut farthest = (f64::NEG_INFINITY, (0, &DIRECTION_VECTORS[0]));
    for (direction, vector) in DIRECTION_VECTORS.iter().enumerate() {
        let [up, forward] = *vector;
        let beyond = |end: &PathState| up * (z - end.z) + forward * (x - end.x);
        let distance = beyond(from).min(beyond(to));
        if distance > farthest.0 {
            farthest = (distance, (direction % DIRECTIONS, vector));
        }
    }
    farthest.1
}
