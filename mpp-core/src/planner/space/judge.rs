//! What a trajectory in space is worth.

use super::candidate::SpacePlan;
use super::keep::Keep;
use super::lattice::Lattice;
use crate::config::{STAGE_PERIOD, STAGES};
use crate::map::VoxelField;
use crate::tuning::space_judgement::{END_HEIGHT, LACK, LATER, ROOM, ROOM_WEIGHT, SHORT};
use crate::tuning::space_program::CONTROL;
use crate::tuning::{UNKNOWN_AHEAD, UNKNOWN_COST};
use crate::vehicle::{SpaceModel, SpacePath};

/// Points at which a stage is judged.
const POINTS: usize = 4;

/// Worth of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceJudgement {
    /// The sum of all costs; less is better.
    pub price: f64,
    /// Greatest clearance that is missing up to the via station \[m\]; beyond it counts half.
    pub missing: f64,
}

pub(super) fn judge(
    field: &VoxelField,
    lattice: &Lattice,
    model: &SpaceModel,
    keep: &Keep,
    plan: &SpacePlan,
) -> SpaceJudgement {
    let via = lattice.via();
    let [first, .., last] = &plan.knots;
    let (mut price, mut missing) = (0.0, 0.0_f64);
    let mut to_go = None;
    let segments = plan.knots.iter().zip(plan.knots.iter().skip(1));
    for (stage, (from, to)) in segments.enumerate() {
        let discount = 1.0 - 0.5 * stage as f64 / STAGES as f64;
        for index in 1..=POINTS {
            let share = index as f64 / POINTS as f64;
            let point = between(from, to, &model.wind, share);
            let later = if point[0] <= via { 1.0 } else { LATER };
            if to_go.is_none() && point[0] >= via {
                to_go = Some(lattice.cost_to_go(&point, &to.ground_velocity(&model.wind)));
            }
            let (clearance, slope) = field.clearance_and_slope(&point);
            let margin = keep.margin(clearance, &slope, &wing(from, to, share));
            let lack = (margin - clearance).max(0.0) + keep.outside(&point);
            let room = (margin + ROOM - clearance).max(0.0);
            price += later * discount * (LACK * lack * lack + ROOM_WEIGHT * room * room);
            missing = missing.max(lack * later);
            if field.is_unknown(&point) {
                let near = 1.0 - (point[0] - first.position[0]) / UNKNOWN_AHEAD;
                price += UNKNOWN_COST * later * near.max(0.0);
            }
        }
    }
    let level = model.trim.control.thrust;
    for control in &plan.controls {
        let [bank, attack, thrust] = CONTROL;
        let extra = control.thrust - level;
        price += 0.5
            * (bank * control.bank_rate * control.bank_rate
                + attack * control.angle_of_attack_rate * control.angle_of_attack_rate
                + thrust * extra * extra);
    }
    let off = last.position[2] - keep.altitude;
    let fast = last.airspeed - model.trim.state.airspeed;
    let turned =
        last.flight_path * last.flight_path + last.course * last.course + last.bank * last.bank;
    price += 0.5 * (END_HEIGHT * off * off + fast * fast + turned) + to_go.unwrap_or(SHORT);
    let price = if price.is_finite() {
        price
    } else {
        f64::INFINITY
    };
    SpaceJudgement { price, missing }
}

/// The wing at a share of the way between two knots.
fn wing(from: &SpacePath, to: &SpacePath, share: f64) -> [f64; 3] {
    let (from, to) = (from.numbers(), to.numbers());
    let mixed = core::array::from_fn(|at| from[at] + share * (to[at] - from[at]));
    SpacePath::of(mixed).wing()
}

/// The position at a share of the way between two knots: a cubic with the velocities of both.
fn between(from: &SpacePath, to: &SpacePath, wind: &[f64; 3], share: f64) -> [f64; 3] {
    let (before, after) = (from.ground_velocity(wind), to.ground_velocity(wind));
    let (s2, s3) = (share * share, share * share * share);
    core::array::from_fn(|axis| {
        let ends = (2.0 * s3 - 3.0 * s2 + 1.0) * from.position[axis]
            + (3.0 * s2 - 2.0 * s3) * to.position[axis];
        let turns = (s3 - 2.0 * s2 + share) * before[axis] + (s3 - s2) * after[axis];
        ends + STAGE_PERIOD * turns
    })
}
