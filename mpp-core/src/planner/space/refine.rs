//! Direct search about the best plan: its bank is moved for a while, its lift keeps the height, and the cheaper roll-out stays.
//! Past obstacles that are not upright each second round moves the lift.
//!
//! Programs hold faces and wing as the candidate has them; a roll-out is judged as it is flown.

use super::candidate::{SpacePlan, limited};
use super::judge::{Judge, SpaceJudgement, Tally};
use crate::config::{KNOTS, STAGES};
use crate::tuning::space_refinement::{LIFT, ROUNDS, SIZE, SIZES};
use crate::vehicle::{SpaceControl, SpaceModel, SpacePath, between};

/// First knots and numbers of knots of the moves.
const FIRST: [usize; 8] = [1, 2, 3, 4, 5, 6, 8, 10];
const WIDTHS: [usize; 3] = [1, 2, 3];
/// Number of different moves: both sides, and with and without the way back.
const MOVES: usize = FIRST.len() * WIDTHS.len() * 4;
/// A little below one, for sums whose terms are added in another order.
const ROUNDED: f64 = 1.0 - 1e-12;
/// Number of moves that a cycle tries.
pub(super) const TRIALS: usize = ROUNDS * MOVES;

/// A change of bank \[rad\] and lift upwards [m/s^2] at some knots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Move {
    side: [f64; 2],
    /// The first knot that is moved, and for how many knots.
    first: usize,
    width: usize,
    /// Whether as many knots go the other way then.
    back: bool,
}

impl Move {
    /// The move of a number: the bank goes to one side for some knots, and where the track shall only be displaced as far to
    /// the other side for the next ones. Each round halves the moves; after [`SIZES`] rounds they are as large as at first. Where
    /// it `climbs`, each second round moves the lift the same way.
    pub(super) fn of(number: usize, climbs: bool) -> Self {
        let round = number / MOVES;
        let (kinds, lifts) = if climbs {
            (2, round % 2 == 1)
        } else {
            (1, false)
        };
        let part = 1.0 / f64::from(1_u32 << (round / kinds % SIZES));
        let part = if number.is_multiple_of(2) {
            part
        } else {
            -part
        };
        let side = if lifts {
            [0.0, part * LIFT]
        } else {
            [part * SIZE, 0.0]
        };
        Self {
            side,
            first: FIRST[number / (4 * WIDTHS.len()) % FIRST.len()],
            width: WIDTHS[number / 4 % WIDTHS.len()],
            back: number / 2 % 2 == 1,
        }
    }

    /// The change at a knot.
    fn at(&self, knot: usize) -> [f64; 2] {
        let turn = self.first + self.width;
        if (self.first..turn).contains(&knot) {
            self.side
        } else if self.back && (turn..turn + self.width).contains(&knot) {
            self.side.map(|it| -it)
        } else {
            [0.0; 2]
        }
    }
}

/// The plan that is moved, flown by the rules of moves, with its costs and the sum of its efforts up to each knot: a move has
/// them up to its first stage.
#[derive(Clone, Debug)]
pub(super) struct Unmoved {
    plan: SpacePlan,
    tallies: heapless::Vec<(Tally, f64), KNOTS>,
    lifts: Lifts,
    /// Whether moves of the lift are tried, too.
    climbs: bool,
    /// The first move that was tried.
    since: usize,
}

/// For each stage of the best plan: its lift upwards [m/s^2], and the angle of attack of its whole lift \[rad\].
#[derive(Clone, Debug)]
struct Lifts([[f64; 2]; STAGES]);

impl Unmoved {
    /// Of the best plan, before a move.
    pub(super) fn of(judge: &Judge<'_>, best: &SpacePlan, since: usize) -> Self {
        let lifts = Lifts::of(judge.model, best);
        let (mut plan, mut tally) = (*best, judge.begin(best));
        let (mut tallies, mut efforts) = (heapless::Vec::new(), 0.0);
        for stage in 0..STAGES {
            // As many knots as places.
            let _ = tallies.push((tally, efforts));
            plan.fly_stage(stage, judge.model, |state| {
                let control = lifts.control(judge.model, best, stage, state, [0.0; 2]);
                efforts += judge.effort(&control);
                control
            });
            if let Some([from, to, ..]) = plan.knots.get(stage..) {
                judge.add([from, to], stage, &mut tally);
            }
        }
        let _ = tallies.push((tally, efforts));
        Self {
            plan,
            tallies,
            lifts,
            climbs: tally.climbs(),
            since,
        }
    }

    /// The move of a number; `None` if it was tried already: sizes come again.
    pub(super) fn next(&self, number: usize) -> Option<Move> {
        let kinds = if self.climbs { 2 } else { 1 };
        let known = number >= self.since + kinds * SIZES * MOVES;
        (!known).then(|| Move::of(number, self.climbs))
    }

    /// The best plan with its bank moved, and its worth; `None` where it is found before its end that it costs the `price` of
    /// the best plan. It counts its `work` as `MOST_WORK` does.
    pub(super) fn moved(
        &self,
        judge: &Judge<'_>,
        best: &SpacePlan,
        price: f64,
        by: &Move,
        work: &mut usize,
    ) -> Option<(SpacePlan, SpaceJudgement)> {
        // The first stage that the move changes.
        let first = by.first - 1;
        let (mut tally, mut efforts) = *self.tallies.get(first)?;
        let (known, limit) = (tally.least_price(), price / ROUNDED);
        // Bank and angle of attack, and so all controls, do not depend on forces.
        let mut state = *self.plan.knots.get(first)?;
        let mut controls = heapless::Vec::<_, STAGES>::new();
        for stage in first..STAGES {
            let control = (self.lifts).control(judge.model, best, stage, &state, by.at(stage + 1));
            // As many stages as places.
            let _ = controls.push(control);
            state = state.turned(&control, self.plan.grid.period(stage));
            efforts += judge.effort(&control);
            if known + efforts >= limit {
                return None;
            }
        }
        if !self.may_cost_less(judge, first, &controls, (efforts, limit), work) {
            return None;
        }
        let mut plan = self.plan;
        for (stage, control) in (first..).zip(&controls) {
            plan.fly_stage(stage, judge.model, |_| *control);
            *work += 3;
            if let Some([from, to, ..]) = plan.knots.get(stage..) {
                judge.add([from, to], stage, &mut tally);
            }
        }
        Some((plan, judge.end(&plan, &tally)))
    }

    /// Whether controls from a stage on cost less than a limit but for rounding: terms are added in another order than that of
    /// stages. Those that are free in the best plan are judged last, because the others and the end reject most moves.
    fn may_cost_less(
        &self,
        judge: &Judge<'_>,
        first: usize,
        controls: &[SpaceControl],
        (efforts, limit): (f64, f64),
        work: &mut usize,
    ) -> bool {
        let (Some(&(mut tally, _)), Some(start)) =
            (self.tallies.get(first), self.plan.knots.get(first))
        else {
            return false;
        };
        let mut state = *start;
        let mut free = heapless::Vec::<_, STAGES>::new();
        for (stage, control) in (first..).zip(controls) {
            let period = self.plan.grid.period(stage);
            let knots = [state, state.after(judge.model, control, period)];
            let [from, to] = &knots;
            let velocities = judge.pass([from, to], stage, &mut tally);
            *work += 1;
            if self.is_free(stage) {
                // As many stages as places.
                let _ = free.push((stage, knots, velocities));
            } else {
                judge.charge([from, to], &velocities, stage, &mut tally);
                *work += 2;
            }
            if tally.least_price() + efforts >= limit {
                return false;
            }
            state = *to;
        }
        let fixed = judge.end_cost(&state, &tally) + efforts;
        for (stage, [from, to], velocities) in &free {
            if tally.price() + fixed >= limit {
                return false;
            }
            judge.charge([from, to], velocities, *stage, &mut tally);
            *work += 2;
        }
        tally.price() + fixed < limit
    }

    /// Whether a stage of the best plan costs nothing but its control.
    fn is_free(&self, stage: usize) -> bool {
        let until = |knot: usize| self.tallies.get(knot).map(|(tally, _)| tally.price());
        until(stage) == until(stage + 1)
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

    /// The control of a stage that reaches the bank of the best plan and a change, and keeps the lift upwards but for a change.
    fn control(
        &self,
        model: &SpaceModel,
        best: &SpacePlan,
        stage: usize,
        state: &SpacePath,
        [change, more]: [f64; 2],
    ) -> SpaceControl {
        let (Some(next), Some(control), Some([lift, whole])) = (
            best.knots.get(stage + 1),
            best.controls.get(stage),
            self.0.get(stage),
        ) else {
            return SpaceControl::default();
        };
        let period = best.grid.period(stage);
        let wanted = SpaceControl {
            bank_rate: (next.bank + change - state.bank) / period,
            ..*control
        };
        let banked = limited(model, state, &wanted, period);
        let bank = state.bank + banked.bank_rate * period;
        let now = model.angle_for(next.airspeed, (lift + more) / upwards(bank));
        let attack = between(next.angle_of_attack + now - whole, model.angle_of_attack);
        let wanted = SpaceControl {
            angle_of_attack_rate: (attack - state.angle_of_attack) / period,
            ..wanted
        };
        limited(model, state, &wanted, period)
    }
}

/// The share of the lift that goes upwards at a bank \[rad\].
fn upwards(bank: f64) -> f64 {
    libm::cos(bank).max(0.3)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::SpacePlanner;
    use super::*;
    use crate::config::STAGE_PERIOD;
    use crate::planner::space::Keep;
    use crate::vehicle::Airframe;
    use std::boxed::Box;

    /// Of every move of a plan: the controls are those of its knots, the costs those of its flight, and a move that costs less
    /// than the best plan is found, by however little.
    #[test]
    fn a_move_is_what_its_controls_fly_and_no_cheaper_one_is_missed() {
        let model = SpaceModel::new(&Airframe::PAPER, 12.0, 0.45, 20.0, [0.96, 1.57]).unwrap();
        let mut planner = Box::new(SpacePlanner::new());
        planner.set_up(model, Keep::NONE);
        let judge = planner.judge();
        let level = SpacePath {
            airspeed: 12.0,
            angle_of_attack: model.trim.state.angle_of_attack(),
            ..SpacePath::ORIGIN
        };
        let mut best = SpacePlan::new();
        best.fly(&model, &level, |stage, state| {
            let wanted = SpaceControl {
                bank_rate: libm::sin(stage as f64),
                angle_of_attack_rate: 0.2 * libm::cos(2.0 * stage as f64),
                thrust: model.trim.control.thrust,
            };
            limited(&model, state, &wanted, STAGE_PERIOD)
        });
        let unmoved = Unmoved::of(&judge, &best, 0);
        let all = |climbs| (0..MOVES * SIZES * 2).map(move |number| Move::of(number, climbs));
        for by in all(false).take(MOVES * SIZES).chain(all(true)) {
            let at = |price: f64| unmoved.moved(&judge, &best, price, &by, &mut 0);
            let (moved, worth) = at(f64::INFINITY).unwrap();
            assert_eq!(judge.judge(&moved), worth);
            for (stage, control) in moved.controls.iter().enumerate() {
                let (knot, change) = (&moved.knots[stage], by.at(stage + 1));
                let chosen = unmoved.lifts.control(&model, &best, stage, knot, change);
                assert_eq!(chosen, *control);
            }
            assert!(at(worth.price).is_none_or(|found| found == (moved, worth)));
            assert_eq!(at(worth.price * (1.0 + 1e-9)), Some((moved, worth)));
        }
    }
}
