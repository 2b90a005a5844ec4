//! The convex program of a path (paper, section III-D): one linearisation about straight and level flight, hard faces, and a cost of
//! the controls and of the last state's deviations. The solver is that of the planner in space.
//!
//! States are `(x, y, z, v, alpha, bank, path, course)`, controls `(rate of the bank, angle of attack, thrust)`: with the rotation in
//! steady state an aileron gives a rate of the bank, and an elevator an angle of attack. The last three states are tangents, in
//! which a level turn is exact while the course is small.

use mpp_core::config::{STAGE_PERIOD, STAGES};
use mpp_core::planner::space::SpacePlan;
use mpp_core::qp::Status;
use mpp_core::qp::space::{
    Condensed, Dynamics, Faces, INPUTS, MOTION, POSITION, Problem, STATES, Solution, Solver,
    Weights,
};
use mpp_core::vehicle::{GRAVITY, SpaceControl, SpaceModel, SpacePath};
use nalgebra::SVector;

/// State with an angle of attack.
const ATTACK: usize = 4;
/// Change of a state or control for derivatives.
const SMALL: f64 = 1e-5;
/// Greatest angle whose tangent is a state \[rad\].
const MOST_ANGLE: f64 = 1.3;
/// Share of the rate of the bank that plans use [-]. Source: that of the planner in space.
const RATE: f64 = 0.9;
/// Weights of the squares of rate of the bank [s^2/rad^2], angle of attack [1/rad^2] and thrust [1/N^2]. Less of the first turns
/// later and harder. Source: the first the best of 1, 10 and 100 on other seeds; the paper, whose elevator balances 1/40 rad a radian.
const CONTROL: [f64; INPUTS] = [1.0, 1600.0, 3.0];
/// Weight of the squared deviations of the last state. Source: the paper.
const TERMINAL: f64 = 100.0;

/// The programs of a cycle.
pub(super) struct Program {
    shared: Box<Condensed>,
    solver: Box<Solver>,
    problem: Box<Problem>,
    solution: Solution,
    model: Option<SpaceModel>,
    start: SpacePath,
}

impl Program {
    pub(super) fn new() -> Self {
        Self {
            shared: Box::new(Condensed::new()),
            solver: Box::new(Solver::new()),
            problem: Box::new(Problem::EMPTY),
            solution: Solution::new(),
            model: None,
            start: SpacePath::default(),
        }
    }

    /// Begins a cycle that aims at the middle line and an altitude \[m\]. `None` if the model has no single optimum.
    pub(super) fn begin(
        &mut self,
        model: &SpaceModel,
        start: &SpacePath,
        altitude: f64,
    ) -> Option<()> {
        let dynamics = level_dynamics(model);
        let weights = Weights {
            control: CONTROL,
            terminal: [TERMINAL; STATES],
        };
        self.shared
            .condense_varying(&weights, |stages| stages.fill(dynamics))
            .ok()?;
        let trim = &model.trim;
        let (level, thrust) = (trim.state.angle_of_attack(), trim.control.thrust);
        let slope = |angle: f64| libm::tan(angle.clamp(-MOST_ANGLE, MOST_ANGLE));
        let [_, y, z] = start.position;
        let problem = &mut self.problem;
        problem.initial = [
            0.0,
            0.0,
            0.0,
            start.airspeed - trim.state.airspeed,
            start.angle_of_attack - level,
            slope(start.bank),
            slope(start.flight_path),
            slope(start.course),
        ];
        let ahead = STAGES as f64 * dynamics.offset[0];
        problem.target = [ahead, -y, altitude - z, 0.0, 0.0, 0.0, 0.0, 0.0];
        let speed = trim.state.airspeed;
        let turn = model.curvature() * speed * speed / GRAVITY;
        let [low, high] = model.angle_of_attack.map(|it| it - level);
        let free = f64::INFINITY;
        let rate = RATE * model.bank_rate;
        let bounds = &mut problem.bounds;
        bounds.set_attitudes([high, turn, free, free], [low, -turn, -free, -free]);
        bounds.set_inputs(
            [rate, high, model.thrust_max - thrust],
            [-rate, low, -thrust],
        );
        problem.cost_limit = free;
        (self.model, self.start) = (Some(*model), *start);
        Some(())
    }

    /// The trajectory of a corridor, if there is one and it costs less than those of the cycle so far.
    pub(super) fn better(&mut self, corridor: &Faces) -> Option<SpacePlan> {
        let model = self.model?;
        self.problem
            .bounds
            .set_faces(corridor, &self.start.position);
        self.shared.set_faces(corridor);
        let solved = self.solver.solve(&self.shared, &self.problem) == Status::Optimal
            && self.solver.solution(&self.shared, &mut self.solution) == Status::Optimal;
        (solved && self.solution.cost < self.problem.cost_limit).then(|| {
            self.problem.cost_limit = self.solution.cost;
            placed(&model, &self.start, &self.solution)
        })
    }
}

/// The dynamics of a stage about straight and level flight, by differences; the rotation in steady state.
fn level_dynamics(model: &SpaceModel) -> Dynamics {
    let trim = &model.trim;
    let level = SpacePath {
        airspeed: trim.state.airspeed,
        angle_of_attack: trim.state.angle_of_attack(),
        ..SpacePath::default()
    };
    let control = SpaceControl {
        thrust: trim.control.thrust,
        ..SpaceControl::default()
    };
    let after = |state: &SpacePath, control: &SpaceControl| -> SVector<f64, STATES> {
        state.after(model, control, STAGE_PERIOD).numbers().into()
    };
    let base = after(&level, &control);
    let mut dynamics = Dynamics::at_rest();
    for column in 0..MOTION {
        let mut numbers = level.numbers();
        numbers[POSITION + column] += SMALL;
        let moved = after(&SpacePath::of(numbers), &control);
        dynamics
            .motion
            .set_column(column, &((moved - base) / SMALL));
    }
    let mut pushed = [control; INPUTS];
    pushed[0].bank_rate += SMALL;
    pushed[2].thrust += SMALL;
    for (column, control) in pushed.iter().enumerate() {
        let moved = after(&level, control);
        dynamics.b.set_column(column, &((moved - base) / SMALL));
    }
    dynamics.motion.row_mut(ATTACK).fill(0.0);
    dynamics.b[(ATTACK, 1)] = 1.0;
    for axis in 0..POSITION {
        dynamics.offset[axis] = base[axis];
    }
    dynamics
}

/// A trajectory of the program as a plan. Its lift pulls as the trajectory turns.
fn placed(model: &SpaceModel, start: &SpacePath, solution: &Solution) -> SpacePlan {
    let (trim, states) = (&model.trim, &solution.states);
    let mut plan = SpacePlan::new();
    let [low, high] = model.angle_of_attack;
    for (stage, (knot, state)) in plan.knots.iter_mut().zip(states).enumerate() {
        let [x, y, z, speed, _, bank, path, course] = *state;
        let slope = |index: usize| states.get(index).map_or(0.0, |state| state[6]);
        let before = stage.saturating_sub(1);
        let after = (stage + 1).min(STAGES);
        let turn = (slope(after) - slope(before)) / (STAGE_PERIOD * (after - before) as f64);
        let airspeed = trim.state.airspeed + speed;
        let (up, right) = (GRAVITY + airspeed * turn, GRAVITY * bank);
        let position = [x, y, z];
        *knot = SpacePath {
            position: core::array::from_fn(|axis| start.position[axis] + position[axis]),
            airspeed,
            angle_of_attack: model
                .angle_for(airspeed, libm::hypot(up, right))
                .clamp(low, high),
            bank: libm::atan2(right, up.max(0.3 * GRAVITY)),
            flight_path: libm::atan(path),
            course: libm::atan(course),
        };
    }
    let [first, ..] = &mut plan.knots;
    *first = *start;
    let pairs = plan.knots.iter().zip(plan.knots.iter().skip(1));
    let stages = pairs.zip(&solution.controls).zip(states);
    for (control, (((from, to), [.., extra]), state)) in plan.controls.iter_mut().zip(stages) {
        // What the program does not know: the drag of a turn.
        let drag = |attack: f64| model.thrust_for(from.airspeed, attack, 0.0);
        let turns = drag(from.angle_of_attack) - drag(trim.state.angle_of_attack() + state[ATTACK]);
        let thrust = trim.control.thrust + extra + turns;
        *control = SpaceControl {
            bank_rate: (to.bank - from.bank) / STAGE_PERIOD,
            angle_of_attack_rate: (to.angle_of_attack - from.angle_of_attack) / STAGE_PERIOD,
            thrust: thrust.clamp(0.0, model.thrust_max),
        };
    }
    plan
}
