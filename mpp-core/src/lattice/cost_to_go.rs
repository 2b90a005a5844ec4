//! The cost-to-go of the lattice from the via station on. It outlives the search, because it is part of the price of a
//! roll-out.

use super::edges::{HEIGHTS, LEVEL, Layer, MIDDLE, NEVER, NO_COSTS, SLOPES, VIA, from_units};
use crate::map::split;
use crate::tuning::lattice::{MOST_COST_TO_GO, RISE, SPACING};

/// The cost-to-go: the cost of the best path from a height and a slope at the via station to the far end.
#[derive(Clone, Debug)]
pub struct CostToGo {
    /// Start of the paths `(x, z)` \[m\].
    pub(super) start: [f64; 2],
    pub(super) spacing: f64,
    pub(super) slope_step: f64,
    pub(super) layer: Layer,
}

impl CostToGo {
    /// The costs before the first search.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            start: [0.0; 2],
            spacing: SPACING,
            slope_step: 0.0,
            layer: NO_COSTS,
        }
    }

    /// Distance between stations \[m\].
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Downrange position of the via station \[m\].
    #[must_use]
    pub fn via(&self) -> f64 {
        self.start[0] + self.spacing * VIA as f64
    }

    /// The cost-to-go from a height \[m\] and a slope at the via station. It is linear between lattice points, and at
    /// most 2,000.
    #[must_use]
    pub fn at(&self, z: f64, slope: f64) -> f64 {
        let (height, up) = split((z - self.start[1]) / RISE + f64::from(MIDDLE), HEIGHTS);
        let (slope, steeper) = split(slope / self.slope_step + f64::from(LEVEL), SLOPES);
        let at = |height: usize, slope: usize| {
            let costs = self.layer.get(slope);
            let cost = costs.and_then(|costs| costs.get(height)).copied();
            from_units(cost.unwrap_or(NEVER)).min(MOST_COST_TO_GO)
        };
        let along = |height| at(height, slope) * (1.0 - steeper) + at(height, slope + 1) * steeper;
        along(height) * (1.0 - up) + along(height + 1) * up
    }
}
