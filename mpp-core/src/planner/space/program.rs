//! The program of a candidate in space: its linearisation and its rows.

use super::candidate::SpacePlan;
use super::keep::Keep;
use crate::config::STAGES;
use crate::qp::Penalty;
use crate::qp::space::{
    Dynamics, Faces, INPUTS, MOTION, POSITION, Problem, STATES, Solution, StageState, Weights,
};
use crate::tuning::space_limits;
use crate::tuning::space_program::{CONTROL, COST_LIMIT, PRICE, TERMINAL};
use crate::vehicle::{SpaceControl, SpaceModel, SpacePath};
use nalgebra::SVector;

/// Change of a state or control for the derivatives.
const SMALL: f64 = 1e-5;
/// Greatest flight path angle and course of a plan \[rad\]: the lattice goes ahead.
const MOST_PATH: f64 = 0.5;
const MOST_COURSE: f64 = 1.0;

pub(super) const WEIGHTS: Weights = Weights {
    control: CONTROL,
    terminal: TERMINAL,
};

/// States and controls of programs are deviations from straight and level flight at this point.
pub(super) struct Frame<'a> {
    pub(super) model: &'a SpaceModel,
    pub(super) start: SpacePath,
}

impl Frame<'_> {
    /// The program's state at a knot: position from the start's, motion from level flight.
    fn deviation(&self, state: &SpacePath) -> StageState {
        let level = &self.model.trim.state;
        let [sx, sy, sz] = self.start.position;
        let origin = [
            sx,
            sy,
            sz,
            level.airspeed,
            level.angle_of_attack(),
            0.0,
            0.0,
            0.0,
        ];
        let numbers = state.numbers();
        core::array::from_fn(|index| numbers[index] - origin[index])
    }

    fn control(&self, control: &SpaceControl) -> [f64; INPUTS] {
        let level = self.model.trim.control.thrust;
        [
            control.bank_rate,
            control.angle_of_attack_rate,
            control.thrust - level,
        ]
    }

    /// Writes the dynamics of each stage about a plan, by differences of the stage's motion.
    pub(super) fn linearise(&self, plan: &SpacePlan, dynamics: &mut [Dynamics; STAGES]) {
        let knots = plan.knots.iter().zip(plan.knots.iter().skip(1));
        let stages = knots.zip(&plan.controls).enumerate();
        for (dynamics, (stage, ((knot, next), control))) in dynamics.iter_mut().zip(stages) {
            let period = plan.grid.period(stage);
            let base = next.numbers();
            let from = knot.numbers();
            let difference = |moved: &SpacePath| -> SVector<f64, STATES> {
                let moved = moved.numbers();
                SVector::from_fn(|row, _| (moved[row] - base[row]) / SMALL)
            };
            for column in 0..MOTION {
                let mut numbers = from;
                numbers[POSITION + column] += SMALL;
                let moved = SpacePath::of(numbers).after(self.model, control, period);
                dynamics.motion.set_column(column, &difference(&moved));
            }
            for (column, pushed) in pushed(control).into_iter().enumerate() {
                let moved = knot.after(self.model, &pushed, period);
                dynamics.b.set_column(column, &difference(&moved));
            }
            dynamics.offset = SVector::zeros();
            let after = dynamics.step(&self.deviation(knot), &self.control(control));
            let next = SVector::from(self.deviation(next));
            dynamics.offset = next - SVector::from(after);
        }
    }

    /// Writes the rows of a plan's program.
    pub(super) fn pose(&self, plan: &SpacePlan, faces: &Faces, keep: &Keep, problem: &mut Problem) {
        let model = self.model;
        let [.., last] = &plan.knots;
        let [sx, sy, sz] = self.start.position;
        problem.bounds.set_faces(faces, &[sx, sy, sz]);
        let level = model.trim.state.angle_of_attack();
        let [low, high] = model.angle_of_attack.map(|it| it - level);
        let bank = space_limits::BANK * model.bank;
        problem.bounds.set_attitudes(
            [high, bank, MOST_PATH, MOST_COURSE],
            [low, -bank, -MOST_PATH, -MOST_COURSE],
        );
        let (rate, attack) = (
            space_limits::RATE * model.bank_rate,
            model.angle_of_attack_rate,
        );
        let thrust = model.trim.control.thrust;
        problem.bounds.set_inputs(
            [rate, attack, model.thrust_max - thrust],
            [-rate, -attack, -thrust],
        );
        problem.initial = self.deviation(&self.start);
        // The candidate chose the side; the height it ends at moves half the way to the wanted one.
        let half = 0.5 * (last.position[2] + keep.altitude);
        problem.target = [
            0.0,
            last.position[1] - sy,
            half - sz,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        problem.penalty = Some(Penalty {
            linear: PRICE,
            quadratic: PRICE,
        });
        problem.cost_limit = COST_LIMIT;
    }

    /// The controls of a program's solution.
    pub(super) fn controls(&self, solution: &Solution) -> [SpaceControl; STAGES] {
        let level = self.model.trim.control.thrust;
        solution
            .controls
            .map(|[bank_rate, angle_of_attack_rate, thrust]| SpaceControl {
                bank_rate,
                angle_of_attack_rate,
                thrust: thrust + level,
            })
    }
}

/// The control with each of its numbers moved a little.
fn pushed(control: &SpaceControl) -> [SpaceControl; INPUTS] {
    let mut all = [*control; INPUTS];
    all[0].bank_rate += SMALL;
    all[1].angle_of_attack_rate += SMALL;
    all[2].thrust += SMALL;
    all
}
