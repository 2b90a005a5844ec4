//! Direct search about the best plan: its bank is moved for a while, its lift keeps the height, and the cheaper roll-out stays.
//!
//! Programs hold faces and wing as the candidate has them; a roll-out is judged as it is flown.

use super::candidate::{SpacePlan, limited};
use super::judge::{Judge, SpaceJudgement, Tally};
use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
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

/// The plan that is moved, flown by the rules of moves, with its costs before each stage: a move has them up to its first
/// stage.
#[derive(Clone, Debug)]
pub(super) struct Unmoved {
    plan: SpacePlan,
    tallies: heapless::Vec<Tally, STAGES>,
    lifts: Lifts,
}

/// For each stage of the best plan: its lift upwards [m/s^2], and the angle of attack of its whole lift \[rad\].
#[derive(Clone, Debug)]
struct Lifts([[f64; 2]; STAGES]);

impl Unmoved {
    /// Of the best plan.
    pub(super) fn of(judge: &Judge<'_>, best: &SpacePlan) -> Self {
        let lifts = Lifts::of(judge.model, best);
        let (mut plan, mut tally) = (*best, judge.begin(best));
        let mut tallies = heapless::Vec::new();
        for stage in 0..STAGES {
            // As many stages as places.
            let _ = tallies.push(tally);
            plan.fly_stage(stage, judge.model, |state| {
                lifts.control(judge.model, best, stage, state, 0.0)
            });
            judge.add(&plan, stage, &mut tally);
        }
        Self {
            plan,
            tallies,
            lifts,
        }
    }

    /// The best plan with its bank moved, and its worth; `None` where the costs of its beginning are a `price` already.
    pub(super) fn moved(
        &self,
        judge: &Judge<'_>,
        best: &SpacePlan,
        price: f64,
        by: &Move,
    ) -> Option<(SpacePlan, SpaceJudgement)> {
        // The first stage that the move changes.
        let first = by.0.iter().skip(1).position(|change| *change != 0.0)?;
        let (mut plan, mut tally) = (self.plan, *self.tallies.get(first)?);
        for stage in first..STAGES {
            let change = by.0.get(stage + 1).copied().unwrap_or(0.0);
            plan.fly_stage(stage, judge.model, |state| {
                self.lifts.control(judge.model, best, stage, state, change)
            });
            judge.add(&plan, stage, &mut tally);
            if tally.least_price() >= price {
                return None;
            }
        }
        Some((plan, judge.end(&plan, &tally)))
    }
}

impl Lifts {
    fn of(model: &SpaceModel, best: &SpacePlan) -> Self {
        Self(core::array::from_fn(|stage| {
            let (Some(next), Some(control)) = (best.knots.get(stage + 1), best.controls.get(stage))
            else {
                return [0.0; 2];
            };
            let pull = model.pull(next.airspeed, next.angle_of_attack, control.thrust);
            [
                pull * upwards(next.bank),
                model.angle_for(next.airspeed, pull),
            ]
        }))
    }

    /// The control of a stage that reaches the bank of the best plan and a change, and keeps the lift upwards.
    fn control(
        &self,
        model: &SpaceModel,
        best: &SpacePlan,
        stage: usize,
        state: &SpacePath,
        change: f64,
    ) -> SpaceControl {
        let (Some(next), Some(control), Some([lift, whole])) = (
            best.knots.get(stage + 1),
            best.controls.get(stage),
            self.0.get(stage),
        ) else {
            return SpaceControl::default();
        };
        let wanted = SpaceControl {
            bank_rate: (next.bank + change - state.bank) / STAGE_PERIOD,
            ..*control
        };
        let banked = limited(model, state, &wanted);
        let bank = state.bank + banked.bank_rate * STAGE_PERIOD;
        let now = model.angle_for(next.airspeed, lift / upwards(bank));
        let attack = between(next.angle_of_attack + now - whole, model.angle_of_attack);
        let wanted = SpaceControl {
            angle_of_attack_rate: (attack - state.angle_of_attack) / STAGE_PERIOD,
            ..wanted
        };
        limited(model, state, &wanted)
    }
}

/// The share of the lift that goes upwards at a bank \[rad\].
fn upwards(bank: f64) -> f64 {
    libm::cos(bank).max(0.3)
}
