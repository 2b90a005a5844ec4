//! What a plan keeps clear of.

use super::candidate::dot;
use crate::map::{MOST_CLEARANCE, VoxelField};

/// Step for the direction to the nearest obstacle \[m\].
const GRADIENT: f64 = 0.25;

/// Distances and heights that a plan keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keep {
    /// Least distance of the body from the centres of occupied voxels \[m\]: its radius, half a voxel's diagonal, and errors.
    pub margin: f64,
    /// Half the span of a wing that banks \[m\]; 0 for a sphere.
    pub half_span: f64,
    /// Least and greatest height of the body \[m\].
    pub heights: [f64; 2],
    /// Half the width of the band \[m\].
    pub half_width: f64,
    /// Wanted height \[m\].
    pub altitude: f64,
}

impl Keep {
    /// Distance that the body keeps from an obstacle in the direction of a normal, with its wing along a unit vector \[m\].
    pub(super) fn distance(&self, normal: &[f64; 3], wing: &[f64; 3]) -> f64 {
        self.margin + self.half_span * libm::fabs(dot(normal, wing))
    }

    /// The same at a point of a field with a clearance \[m\] there.
    pub(super) fn margin(
        &self,
        field: &VoxelField,
        point: &[f64; 3],
        clearance: f64,
        wing: &[f64; 3],
    ) -> f64 {
        if self.half_span <= 0.0 || clearance >= MOST_CLEARANCE {
            return self.margin;
        }
        let slope: [f64; 3] = core::array::from_fn(|axis| {
            let mut ahead = *point;
            ahead[axis] += GRADIENT;
            let mut back = *point;
            back[axis] -= GRADIENT;
            field.clearance(&ahead) - field.clearance(&back)
        });
        let steep = libm::sqrt(dot(&slope, &slope));
        if steep < 1e-6 {
            return self.margin + self.half_span;
        }
        self.distance(&slope.map(|it| it / steep), wing)
    }

    /// Distance beyond the band \[m\].
    pub(super) fn outside(&self, [_, y, z]: &[f64; 3]) -> f64 {
        let [low, high] = self.heights;
        (low - z).max(z - high).max(0.0) + (libm::fabs(*y) - self.half_width).max(0.0)
    }
}
