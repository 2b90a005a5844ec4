//! Direct search about the best plan: its bank is moved for a while, its lift keeps the height, and the cheaper roll-out stays.
//!
//! Programs hold faces and wing as the candidate has them; a roll-out is judged as it is flown.

use super::candidate::{SpacePlan, limited};
use crate::config::{KNOTS, STAGE_PERIOD};
use crate::tuning::space_refinement::{ROUNDS, SIZE, SIZES};
use crate::vehicle::{SpaceControl, SpaceModel, SpacePath, between};

/// First knots and numbers of knots of the moves.
const FIRST: [usize; 8] = [1, 2, 3, 4, 5, 6, 8, 10];
const WIDTHS: [usize; 3] = [1, 2, 3];
/// Number of different moves: both sides, and with and without the way back.
const MOVES: usize = FIRST.len() * WIDTHS.len() * 4;
/// Number of moves that a cycle tries.
pub(super) const TRIALS: usize = ROUNDS * MOVES;

/// A change of the bank \[rad\] at each knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Move([f64; KNOTS]);

impl Move {
    /// The move of a number: the bank goes to one side for some knots, and where the track shall only be displaced as far to
    /// the other side for the next ones. Each round halves the moves; after [`SIZES`] rounds they are as large as at first.
    pub(super) fn of(number: usize) -> Self {
        let size = SIZE / f64::from(1_u32 << (number / MOVES % SIZES));
        let side = if number.is_multiple_of(2) {
            size
        } else {
            -size
        };
        let back = number / 2 % 2 == 1;
        let width = WIDTHS[number / 4 % WIDTHS.len()];
        let first = FIRST[number / (4 * WIDTHS.len()) % FIRST.len()];
        Self(core::array::from_fn(|knot| {
            if knot >= first && knot < first + width {
                side
            } else if back && knot >= first + width && knot < first + 2 * width {
                -side
            } else {
                0.0
            }
        }))
    }
}

/// The plan with its bank moved.
pub(super) fn moved(
    model: &SpaceModel,
    start: &SpacePath,
    plan: &SpacePlan,
    by: &Move,
) -> SpacePlan {
    let mut flown = SpacePlan::new();
    flown.fly(model, start, |stage, state| {
        let (Some(next), Some(control), Some(change)) = (
            plan.knots.get(stage + 1),
            plan.controls.get(stage),
            by.0.get(stage + 1),
        ) else {
            return SpaceControl::default();
        };
        let wanted = SpaceControl {
            bank_rate: (next.bank + change - state.bank) / STAGE_PERIOD,
            ..*control
        };
        let banked = limited(model, state, &wanted);
        // The lift upwards stays what it was.
        let bank = state.bank + banked.bank_rate * STAGE_PERIOD;
        let pull = model.pull(next.airspeed, next.angle_of_attack, control.thrust);
        let level = |bank: f64| libm::cos(bank).max(0.3);
        let now = model.angle_for(next.airspeed, pull * level(next.bank) / level(bank));
        let then = model.angle_for(next.airspeed, pull);
        let attack = between(next.angle_of_attack + now - then, model.angle_of_attack);
        let wanted = SpaceControl {
            angle_of_attack_rate: (attack - state.angle_of_attack) / STAGE_PERIOD,
            ..wanted
        };
        limited(model, state, &wanted)
    });
    flown
}
