//! Access to map, candidates and programs of a cycle, for a caller who inspects them or chooses a candidate himself.

use super::judge::PriceParts;
use super::workspace::Workspace;
use super::{Phase, PlanePlanner};
use crate::config::{KNOTS, STAGES};
use crate::map::{DistanceField, RollingGrid};
use crate::qp::{Dynamics, Problem};
use crate::trajectory::Trajectory;

impl PlanePlanner {
    /// Distances to the obstacles in the map.
    #[must_use]
    pub fn clearance(&self) -> &DistanceField {
        &self.field
    }

    /// The grid, for a caller who knows the obstacles better than the lidar.
    pub fn map_mut(&mut self) -> &mut RollingGrid {
        &mut self.map
    }

    /// The path of the present candidate and a copy of its program; see [`crate::planner::Planner::candidate`].
    #[must_use]
    pub fn candidate(&self) -> Option<([(f64, f64); KNOTS], Problem)> {
        if self.phase != Phase::Improve {
            return None;
        }
        let candidate = self.candidates.get(self.at_hand)?;
        let path = candidate
            .flown
            .knots
            .each_ref()
            .map(|knot| (knot.x, knot.z));
        Some((path, self.solver.problem))
    }

    /// The dynamics of every stage in the program of [`Self::candidate`], if there is one.
    #[must_use]
    pub fn stages(&self) -> Option<&[Dynamics; STAGES]> {
        let Workspace::Program(shared) = &self.workspace else {
            return None;
        };
        Some(shared.stages())
    }

    /// Price of the best trajectory so far, by which the planner ranks trajectories. It is infinite without one.
    #[must_use]
    pub fn price(&self) -> f64 {
        self.best_price
    }

    /// Number of candidates of the last cycle.
    #[must_use]
    pub fn offers(&self) -> usize {
        self.candidates.len()
    }

    /// Writes a candidate of the last cycle, as its last SQP iteration left it, into a trajectory in SI units, and gives
    /// its price. The price is infinite if no program of the candidate had a solution; the trajectory is then the
    /// path that the candidate began with. `None` if there is no such candidate.
    pub fn offer(&self, index: usize, trajectory: &mut Trajectory) -> Option<f64> {
        let candidate = self.candidates.get(index)?;
        trajectory.fly_out(
            &candidate.flown,
            &self.units,
            &self.conditions.airframe(&self.si_airframe),
            &self.conditions.wind,
            &self.lag,
            self.time,
        );
        Some(candidate.price)
    }

    /// The [seal](Trajectory::seal) of the trajectory that the cycle offers, as the gate let it through.
    #[must_use]
    pub fn seal(&self) -> u64 {
        self.ladder.seal
    }

    /// Index of the candidate that the planner improved last or improves now.
    #[must_use]
    pub fn at_hand(&self) -> usize {
        self.at_hand
    }

    /// The price of a candidate of the present cycle, as its last SQP iteration left it, and the parts of this price.
    /// `None` if there is no such candidate, or if no program of the candidate had a solution.
    #[must_use]
    pub fn price_parts(&self, index: usize) -> Option<(f64, PriceParts)> {
        let candidate = self.candidates.get(index)?;
        let priced = candidate.price.is_finite();
        priced.then(|| (candidate.price, self.parts_of(&candidate.flown)))
    }

    /// Takes a candidate of the last cycle for the best one: the next cycle then assumes that the aircraft flies it. Gives
    /// its price as [`Self::offer`] does.
    pub fn choose(&mut self, index: usize) -> Option<f64> {
        let chosen = *self.candidates.get(index)?;
        self.keep(&chosen.flown);
        Some(chosen.price)
    }

    /// The grid, in own units.
    #[must_use]
    pub fn map(&self) -> &RollingGrid {
        &self.map
    }
}
