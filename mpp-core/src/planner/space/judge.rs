//! What a trajectory in space is worth.

use super::candidate::{Grid, SpacePlan, dot};
use super::cost_to_go::CostToGo;
use super::keep::Keep;
use crate::config::{STAGE_PERIOD, STAGES};
use crate::map::{MOST_CLEARANCE, VoxelField};
use crate::tuning::space_judgement::{END_HEIGHT, LACK, LATER, ROOM, ROOM_WEIGHT, RUNAWAY, SHORT};
use crate::tuning::space_program::CONTROL;
use crate::tuning::space_refinement::STEEP;
use crate::tuning::{UNKNOWN_AHEAD, UNKNOWN_COST};
use crate::vehicle::{SpaceControl, SpaceModel, SpacePath, between};

/// Distance of the points at which a stage is judged \[m\], their least number and their greatest. A wing is judged abeam of what
/// it may hit, so points further apart miss it.
const APART: f64 = 0.75;
const POINTS: [f64; 2] = [4.0, 16.0];

/// Worth of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceJudgement {
    /// The sum of all costs; less is better.
    pub price: f64,
    /// Greatest clearance that is missing up to the via station \[m\]; beyond it a [part](LATER) counts.
    pub missing: f64,
}

/// The costs of a trajectory up to a knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tally {
    price: f64,
    missing: f64,
    /// Cost-to-go, once the trajectory has passed the via station.
    to_go: Option<f64>,
    /// Velocity over ground at the knot [m/s].
    velocity: [f64; 3],
    /// Runaway of the nose at the knot \[rad\].
    runaway: f64,
    /// Where the trajectory begins: x \[m\].
    begun: f64,
    /// Sums of the squared lack of room, and of the part that lies above or below \[m^2\].
    tight: [f64; 2],
}

impl Tally {
    /// Whether room is missing above or below.
    pub(super) fn climbs(&self) -> bool {
        let [all, upright] = self.tight;
        upright > STEEP * all
    }

    /// Greatest clearance that is missing so far \[m\].
    pub(super) fn missing(&self) -> f64 {
        self.missing
    }

    /// The sum of the costs of stages.
    pub(super) fn price(&self) -> f64 {
        self.price
    }

    /// A price that the trajectory exceeds or has, whatever comes: no cost is negative, and rounded sums grow with their terms.
    pub(super) fn least_price(&self) -> f64 {
        self.price + self.to_go.unwrap_or(0.0)
    }
}

/// What a trajectory is judged by.
pub(super) struct Judge<'a> {
    pub(super) field: &'a VoxelField,
    pub(super) to_go: &'a CostToGo,
    pub(super) model: &'a SpaceModel,
    pub(super) keep: &'a Keep,
    pub(super) grid: Grid,
    /// Distance at which no clearance and no room is missing, by [`needed`](crate::map::voxel_field::needed).
    pub(super) clear: u8,
    /// Cost of the squared lack of airspeed at a knot [s^2/m^2].
    pub(super) slow: f64,
    /// Runaway of the nose at the first knot \[rad\].
    pub(super) runaway: f64,
}

impl Judge<'_> {
    /// The worth of a trajectory.
    pub(super) fn judge(&self, plan: &SpacePlan) -> SpaceJudgement {
        let mut tally = self.begin(plan);
        for (stage, knots) in plan.knots.windows(2).enumerate() {
            if let [from, to] = knots {
                self.add([from, to], stage, &mut tally);
            }
        }
        self.end(plan, &tally)
    }

    /// No costs at the first knot.
    pub(super) fn begin(&self, plan: &SpacePlan) -> Tally {
        let [first, ..] = &plan.knots;
        Tally {
            price: 0.0,
            missing: 0.0,
            to_go: None,
            velocity: first.ground_velocity(&self.model.wind),
            runaway: self.runaway,
            begun: first.position[0],
            tight: [0.0; 2],
        }
    }

    /// Adds the costs of a stage. Copies of it would cost flash.
    #[inline(never)]
    pub(super) fn add(&self, knots: [&SpacePath; 2], stage: usize, tally: &mut Tally) {
        let velocities = self.pass(knots, stage, tally);
        self.charge(knots, &velocities, stage, tally);
    }

    /// What a stage hands on to the next ones, and the cost-to-go if it passes the via station. Returns the velocities over ground
    /// at its knots [m/s].
    pub(super) fn pass(
        &self,
        [from, to]: [&SpacePath; 2],
        stage: usize,
        tally: &mut Tally,
    ) -> [[f64; 3]; 2] {
        let velocities = [tally.velocity, to.ground_velocity(&self.model.wind)];
        let [_, after] = velocities;
        tally.velocity = after;
        if let Some(nose) = &self.model.nose {
            let share = self.grid.period(stage) / STAGE_PERIOD;
            let after = nose.after_stage(tally.runaway, 0.5 * (from.bank + to.bank));
            tally.runaway += share * (after - tally.runaway);
        }
        let via = self.to_go.via();
        if tally.to_go.is_none() && to.position[0] >= via {
            let crossed = (self.shares(stage))
                .map(|share| position([from, to], &velocities, share, self.grid.period(stage)))
                .find(|point| point[0] >= via);
            tally.to_go = crossed.map(|point| self.to_go.cost(&point, &after));
        }
        velocities
    }

    /// Number of the points at which a stage is judged.
    fn points(&self) -> f64 {
        let points = libm::round(self.model.trim.state.airspeed * STAGE_PERIOD / APART);
        between(points, POINTS)
    }

    /// Shares of a stage at which it is judged. Those of a short one are its last ones.
    fn shares(&self, stage: usize) -> impl Iterator<Item = f64> {
        let points = self.points();
        let all = points * self.grid.period(stage) / STAGE_PERIOD;
        let count = libm::ceil(all - 1e-6) as usize;
        (0..count).map(move |index| 1.0 - (count - 1 - index) as f64 / all)
    }

    /// Adds the costs of a stage that do not depend on those before.
    pub(super) fn charge(
        &self,
        [from, to]: [&SpacePath; 2],
        velocities: &[[f64; 3]; 2],
        stage: usize,
        tally: &mut Tally,
    ) {
        let (field, keep, via) = (self.field, self.keep, self.to_go.via());
        let discount = 1.0 - self.grid.time(stage) / (STAGES as f64 * STAGE_PERIOD);
        if self.slow > 0.0 {
            let lack = (self.model.trim.state.airspeed - to.airspeed).max(0.0);
            tally.price += self.slow * lack * lack;
        }
        let [least, _] = POINTS;
        let points = self.points();
        let discount = discount * (least / points);
        let half = 0.5 * STAGE_PERIOD / points;
        for share in self.shares(stage) {
            let point = position([from, to], velocities, share, self.grid.period(stage));
            let later = if point[0] <= via { 1.0 } else { LATER };
            let (mut lack, mut room) = (0.0, 0.0);
            if !field.is_clear(&point, self.clear) {
                let (clearance, slope) = field.clearance_and_slope(&point);
                let (clearance, slope) = closest(clearance, &slope, velocities, half);
                let margin = keep.margin(clearance, &slope, || wing(from, to, share));
                lack = (margin - clearance).max(0.0);
                room = (margin + ROOM - clearance).max(0.0);
                if room > 0.0 {
                    let [_, _, up] = slope;
                    let part = up * up / dot(&slope, &slope).max(1e-6);
                    let [all, upright] = &mut tally.tight;
                    *all += room * room;
                    *upright += part * room * room;
                }
            }
            lack += keep.outside(&point);
            tally.price += later * discount * (LACK * lack * lack + ROOM_WEIGHT * room * room);
            tally.missing = tally.missing.max(lack * later);
            let near = 1.0 - (point[0] - tally.begun) / UNKNOWN_AHEAD;
            if near > 0.0 && field.is_unknown(&point) {
                tally.price += UNKNOWN_COST * later * (least / points) * near;
            }
        }
    }

    /// Cost of a control.
    pub(super) fn effort(&self, control: &SpaceControl) -> f64 {
        let [bank, attack, thrust] = CONTROL;
        let extra = control.thrust - self.model.trim.control.thrust;
        0.5 * (bank * control.bank_rate * control.bank_rate
            + attack * control.angle_of_attack_rate * control.angle_of_attack_rate
            + thrust * extra * extra)
    }

    /// Adds effort, end and cost-to-go.
    pub(super) fn end(&self, plan: &SpacePlan, tally: &Tally) -> SpaceJudgement {
        let mut price = tally.price;
        for control in &plan.controls {
            price += self.effort(control);
        }
        let [.., last] = &plan.knots;
        price += self.end_cost(last, tally);
        SpaceJudgement {
            price: if price.is_finite() {
                price
            } else {
                f64::INFINITY
            },
            missing: tally.missing,
        }
    }

    /// Cost of the last knot, and cost-to-go.
    pub(super) fn end_cost(&self, last: &SpacePath, tally: &Tally) -> f64 {
        let trim = &self.model.trim;
        let off = last.position[2] - self.keep.altitude;
        let fast = last.airspeed - trim.state.airspeed;
        let turned =
            last.flight_path * last.flight_path + last.course * last.course + last.bank * last.bank;
        let turned = turned + RUNAWAY * tally.runaway * tally.runaway;
        let to_go = tally.to_go.unwrap_or(SHORT);
        0.5 * (END_HEIGHT * off * off + fast * fast + turned) + to_go
    }
}

/// The wing at a share of the way between two knots.
fn wing(from: &SpacePath, to: &SpacePath, share: f64) -> [f64; 3] {
    let (from, to) = (from.numbers(), to.numbers());
    let mixed = core::array::from_fn(|at| from[at] + share * (to[at] - from[at]));
    SpacePath::of(mixed).wing()
}

/// The position at a share of the way between two knots: a cubic with the velocities of both.
pub(super) fn position(
    [from, to]: [&SpacePath; 2],
    [before, after]: &[[f64; 3]; 2],
    share: f64,
    period: f64,
) -> [f64; 3] {
    let (s2, s3) = (share * share, share * share * share);
    core::array::from_fn(|axis| {
        let ends = (2.0 * s3 - 3.0 * s2 + 1.0) * from.position[axis]
            + (3.0 * s2 - 2.0 * s3) * to.position[axis];
        let turns = (s3 - 2.0 * s2 + share) * before[axis] + (s3 - s2) * after[axis];
        ends + period * turns
    })
}

/// The clearance and its slope where the body comes closest to what is nearest, within some time \[s\] before and after.
fn closest(
    clearance: f64,
    slope: &[f64; 3],
    [before, after]: &[[f64; 3]; 2],
    half: f64,
) -> (f64, [f64; 3]) {
    let steep = libm::sqrt(dot(slope, slope));
    if steep < 1e-6 || clearance >= MOST_CLEARANCE {
        return (clearance, *slope);
    }
    let velocity: [f64; 3] = core::array::from_fn(|axis| 0.5 * (before[axis] + after[axis]));
    let away = slope.map(|it| it * clearance / steep);
    let time = between(
        -dot(&away, &velocity) / dot(&velocity, &velocity).max(1.0),
        [-half, half],
    );
    let away = core::array::from_fn(|axis| away[axis] + time * velocity[axis]);
    (libm::sqrt(dot(&away, &away)), away)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Of an obstacle that is a point: the clearance is the least one on the way, whatever the velocity.
    #[test]
    fn between_two_points_the_closest_one_counts() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        let mut draw =
            |most: f64| most * (f64::from(random.next_u32()) / f64::from(u32::MAX) - 0.5);
        for _ in 0..1000 {
            let away = [draw(3.0), draw(3.0), draw(3.0)];
            let velocity = [12.0 + draw(4.0), draw(12.0), draw(6.0)];
            let clearance = libm::sqrt(dot(&away, &away));
            let (least, slope) = closest(clearance, &away, &[velocity; 2], 0.03);
            let on_the_way = (-30..=30).map(|at| {
                let time = 0.001 * f64::from(at);
                let moved: [f64; 3] =
                    core::array::from_fn(|axis| away[axis] + time * velocity[axis]);
                libm::sqrt(dot(&moved, &moved))
            });
            let found = on_the_way.fold(f64::INFINITY, f64::min);
            assert!(
                least <= found + 1e-9 && least > found - 0.01,
                "{least} {found}"
            );
            assert!((libm::sqrt(dot(&slope, &slope)) - least).abs() < 1e-9);
        }
    }
}
