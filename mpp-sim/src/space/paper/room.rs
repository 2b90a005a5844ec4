//! Where the aircraft may be: within the band of plans, and away from what the map knows; and convex rooms around points of a path.

use crate::space::world::Vector;
use hil_protocol::ConfigureSpace;
use mpp_core::config::{KNOTS, STAGES};
use mpp_core::qp::space::{FACES, Faces};

/// Greatest length of a ray \[m\]. Source: that of the method in the plane.
pub(super) const RAY_LIMIT: f64 = 20.0;
/// Distance of paths and rays beyond the margin and half span of plans \[m\]: rays 45 deg apart miss thin trunks. More closes gaps.
/// Source: the best of -0.5 to 1 m on other seeds.
const MORE: f64 = 0.2;
/// Distance that faces keep from the ends of rays, at the start and at the last boundary \[m\]. The paper pads "slightly"; more
/// at the end leaves the next cycles room, and closes gaps. Source: the best of ten pairs on other seeds.
const NEAR: f64 = 0.4;
const FAR: f64 = 1.5;
/// Least step along a ray \[m\]. Source: chosen.
const LEAST_STEP: f64 = 0.1;
/// Half the width and height of the box in which trees grow \[m\]. Source: that of the method in the plane.
const BESIDE: f64 = 10.0;
/// Length of this box in horizons [-]. Source: that of the method in the plane.
const LENGTH: f64 = 1.11;

/// Where the aircraft may be.
pub(super) struct Room<'a> {
    /// Distance of a point from what the map knows \[m\].
    pub(super) clearance: &'a dyn Fn(&Vector) -> f64,
    /// Distance that paths keep, and at which rays end \[m\].
    inflated: f64,
    /// Greatest distance to either side of the middle, and least and greatest height \[m\].
    half_width: f64,
    heights: [f64; 2],
    /// The box in which trees grow: its corners \[m\].
    pub(super) corners: [Vector; 2],
}

impl<'a> Room<'a> {
    /// The room around a position that a plan leaves over a horizon \[m\].
    pub(super) fn new(
        clearance: &'a dyn Fn(&Vector) -> f64,
        limits: &ConfigureSpace,
        [x, y, z]: Vector,
        horizon: f64,
    ) -> Self {
        let [low, high] = limits.heights;
        let side = limits.half_width;
        Self {
            clearance,
            inflated: limits.margin + limits.half_span + MORE,
            half_width: side,
            heights: limits.heights,
            corners: [
                [x, (y - BESIDE).max(-side), (z - BESIDE).max(low)],
                [
                    x + LENGTH * horizon,
                    (y + BESIDE).min(side),
                    (z + BESIDE).min(high),
                ],
            ],
        }
    }

    /// Whether a point lies within the band of plans.
    pub(super) fn holds(&self, [_, y, z]: &Vector) -> bool {
        let [low, high] = self.heights;
        y.abs() <= self.half_width && (low..=high).contains(z)
    }

    /// Distance from a point along a unit vector to where something begins \[m\], at most a limit.
    pub(super) fn reach(&self, from: &Vector, direction: &Vector, limit: f64) -> f64 {
        let mut along = 0.0;
        while along < limit {
            let at = core::array::from_fn(|axis| from[axis] + along * direction[axis]);
            let left = (self.clearance)(&at) - self.inflated;
            if left <= 0.0 {
                return along;
            }
            along += left.max(LEAST_STEP);
        }
        limit
    }

    /// Whether nothing is between two points at a distance \[m\].
    pub(super) fn is_free(&self, from: &Vector, to: &Vector, distance: f64) -> bool {
        let way = core::array::from_fn(|axis| (to[axis] - from[axis]) / distance.max(1e-6));
        self.reach(from, &way, distance) >= distance && (self.clearance)(to) > self.inflated
    }

    /// Faces where the rays from points of a path end, and those of the band. The solver has room for some of them: the nearest count.
    pub(super) fn corridor(&self, points: &[Vector; KNOTS]) -> Faces {
        let mut faces = Faces::none();
        let directions = directions();
        for (boundary, point) in points.iter().enumerate().skip(1) {
            let padding = NEAR + (FAR - NEAR) * boundary as f64 / STAGES as f64;
            let mut rays: Vec<(f64, Vector)> = directions
                .iter()
                .map(|direction| (self.reach(point, direction, RAY_LIMIT), *direction))
                .filter(|(reach, _)| *reach < RAY_LIMIT)
                .collect();
            rays.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (reach, direction) in rays.into_iter().take(FACES - 4) {
                let at: f64 = direction.iter().zip(point).map(|(a, b)| a * b).sum();
                faces.push(boundary, direction, at + reach - padding);
            }
            let [low, high] = self.heights;
            faces.push(boundary, [0.0, 0.0, -1.0], -low);
            faces.push(boundary, [0.0, 0.0, 1.0], high);
            faces.push(boundary, [0.0, -1.0, 0.0], self.half_width);
            faces.push(boundary, [0.0, 1.0, 0.0], self.half_width);
        }
        faces
    }
}

/// Unit vectors to the neighbours of a voxel.
pub(super) fn directions() -> Vec<Vector> {
    let steps = [-1.0, 0.0, 1.0];
    let mut all = Vec::new();
    for x in steps {
        for y in steps {
            for z in steps {
                let length = f64::sqrt(x * x + y * y + z * z);
                if length > 0.0 {
                    all.push([x / length, y / length, z / length]);
                }
            }
        }
    }
    all
}
