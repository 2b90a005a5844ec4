//! What a plan keeps clear of.

use super::candidate::dot;
use crate::map::{MOST_CLEARANCE, VoxelGrid};
use crate::tuning::space_judgement::SLOW;

/// Distances and heights that a plan keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keep {
    /// Least distance of the body from the what hits have shown \[m\]: its radius, and errors of map, estimate and regulator.
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
    /// Nothing is kept: the value before a set-up.
    pub(super) const NONE: Self = Self {
        margin: 0.0,
        half_span: 0.0,
        heights: [0.0; 2],
        half_width: 0.0,
        altitude: 0.0,
    };

    /// Distance that the body keeps from an obstacle in the direction of a normal, with its wing along a unit vector \[m\].
    pub(super) fn distance(&self, normal: &[f64; 3], wing: &[f64; 3]) -> f64 {
        self.margin + self.half_span * libm::fabs(dot(normal, wing))
    }

    /// The same at a point with a clearance \[m\] and its slope.
    pub(super) fn margin(
        &self,
        clearance: f64,
        slope: &[f64; 3],
        wing: impl FnOnce() -> [f64; 3],
    ) -> f64 {
        if self.half_span <= 0.0 || clearance >= MOST_CLEARANCE {
            return self.margin;
        }
        let steep = libm::sqrt(dot(slope, slope));
        if steep < 1e-6 {
            return self.margin + self.half_span;
        }
        self.distance(&slope.map(|it| it / steep), &wing())
    }

    /// Cost of the squared lack of airspeed at a knot [s^2/m^2].
    pub(super) fn slow(&self) -> f64 {
        if VoxelGrid::follows(&self.heights) {
            SLOW
        } else {
            0.0
        }
    }

    /// Distance beyond the band \[m\].
    pub(super) fn outside(&self, [_, y, z]: &[f64; 3]) -> f64 {
        let [low, high] = self.heights;
        (low - z).max(z - high).max(0.0) + (libm::fabs(*y) - self.half_width).max(0.0)
    }
}
