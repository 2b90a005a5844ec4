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

/// Sine of 45 degrees.
const DIAGONAL: f64 = core::f64::consts::FRAC_1_SQRT_2;

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
            let segment = Segment::new(from, to);
            let distance = kept(field, from, to, keep) + keep.body_radius;
            let flown = cruise * STAGE_PERIOD * stage as f64;
            let range = |a: f64, b: f64| [a.min(b) - REACH, a.max(b) + REACH];
            let mut least = [f64::INFINITY; DIRECTIONS];
            field.surface(range(from.x, to.x), range(from.z, to.z), |x, z| {
                let direction = segment.farthest_direction(x, z) % DIRECTIONS;
                let [up, forward] = DIRECTION_VECTORS[direction];
                let mut reach = up * (z - start.z) - distance;
                reach += forward * (x - start.x - flown);
                least[direction] = least[direction].min(reach);
            });
            let ends = before.iter_mut().zip(after);
            for ((before, after), (reach, [_, forward])) in
                ends.zip(least.iter().zip(&DIRECTION_VECTORS))
            {
                *before = before.min(*reach);
                *after = after.min(reach - forward * cruise * STAGE_PERIOD);
            }
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

/// A segment of a trajectory, for callers that ask for many points.
struct Segment<'a> {
    from: &'a PathState,
    to: &'a PathState,
    /// Its middle `(x, z)` \[m\].
    middle: [f64; 2],
    /// Half its extent along each pair of opposite directions, the first four of [`DIRECTION_VECTORS`] \[m\].
    half: [f64; AXES],
    /// How much farther the best direction must be than the others, so that rounding decides nothing \[m\].
    doubt: f64,
}

/// Number of pairs of opposite directions.
const AXES: usize = DIRECTIONS / 2;

impl<'a> Segment<'a> {
    fn new(from: &'a PathState, to: &'a PathState) -> Self {
        let (run, rise) = (0.5 * (to.x - from.x), 0.5 * (to.z - from.z));
        let [first, second] = [rise + run, rise - run].map(|sum| DIAGONAL * sum);
        Self {
            from,
            to,
            middle: [from.x + run, from.z + rise],
            half: [rise, first, run, second].map(libm::fabs),
            doubt: if (run + rise).is_finite() {
                1e-6
            } else {
                f64::INFINITY
            },
        }
    }

    /// The direction in which a point is farthest beyond both ends: that is how far it is beyond the middle, less half the
    /// extent. Of the two opposite directions of an axis the one towards the point counts.
    fn farthest_direction(&self, x: f64, z: f64) -> usize {
        let [ahead, up] = [x - self.middle[0], z - self.middle[1]];
        let places = [up, DIAGONAL * (up + ahead), ahead, DIAGONAL * (ahead - up)];
        let beyond = |axis: usize| libm::fabs(places[axis % AXES]) - self.half[axis % AXES];
        let [a, b, c, d] = [0, 1, 2, 3].map(|axis| (axis, beyond(axis)));
        // Selections instead of branches, because no processor predicts them.
        let farther = |a: (usize, f64), b: (usize, f64)| if b.1 > a.1 { b } else { a };
        let nearer = |a: (usize, f64), b: (usize, f64)| if b.1 < a.1 { b } else { a };
        let (one, other) = (farther(a, b), farther(c, d));
        let (axis, farthest) = farther(one, other);
        let beside = if axis < 2 { nearer(a, b) } else { nearer(c, d) };
        let (_, second) = farther(nearer(one, other), beside);
        let place = places[axis % AXES];
        if farthest - second > self.doubt && libm::fabs(place) > self.doubt {
            axis + if place > 0.0 { 0 } else { AXES }
        } else {
            self.exactly_farthest_direction(x, z)
        }
    }

    /// The same by the definition: the first of the directions in which the point is farthest.
    #[inline(never)]
    fn exactly_farthest_direction(&self, x: f64, z: f64) -> usize {
        let mut farthest = (f64::NEG_INFINITY, 0);
        for (direction, [up, forward]) in DIRECTION_VECTORS.iter().enumerate() {
            let beyond = |end: &PathState| up * (z - end.z) + forward * (x - end.x);
            let distance = beyond(self.from).min(beyond(self.to));
            if distance > farthest.0 {
                farthest = (distance, direction);
            }
        }
        farthest.1
    }
}
