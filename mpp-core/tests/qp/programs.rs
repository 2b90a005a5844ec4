//! Random programs about random tubes, with their rows and costs evaluated with the model alone.

pub(crate) use crate::common::draw::Draw;
use mpp_core::config::{KNOTS, STAGES};
use mpp_core::corridor::{Corridor, DIRECTION_VECTORS};
use mpp_core::paper::StageModel;
use mpp_core::qp::{
    Bounds, Condensed, Penalty, Problem, ROWS, RowKind, Solution, Solver, StageControl, StageState,
    Status, Weights,
};
use mpp_core::settings::Settings;

/// The model of a preset, and its condensed form.
pub(crate) struct Setup {
    pub(crate) model: StageModel,
    pub(crate) weights: Weights,
    pub(crate) shared: Box<Condensed>,
    pub(crate) thrust: f64,
}

impl Setup {
    fn new(settings: &Settings, weights: Weights) -> Self {
        let own = settings.planner.paper().unwrap();
        let trim = settings.cruise.trim(&settings.airframe).unwrap();
        let model = StageModel::new(&settings.airframe, &trim, own.jacobian, own.initial).unwrap();
        let mut shared = Box::new(Condensed::new());
        shared.condense(&model.dynamics(), &weights).unwrap();
        Self {
            model,
            weights,
            shared,
            thrust: trim.control.thrust,
        }
    }

    /// Preset `paper`.
    pub(crate) fn paper() -> Self {
        let paper = Settings::paper();
        Self::new(&paper, paper.planner.weights)
    }

    /// The paper's model with the flight planner's weights. (The flight planner has a model of its
    /// own for each stage: `varying.rs`.)
    pub(crate) fn flight() -> Self {
        Self::new(&Settings::paper(), Settings::flight().planner.weights)
    }

    pub(crate) fn all() -> [Self; 3] {
        let reference = Settings::reference();
        let reference = Self::new(&reference, reference.planner.weights);
        [reference, Self::paper(), Self::flight()]
    }

    /// A random program: half-planes about a random smooth line. The half-planes are narrow now and
    /// then.
    pub(crate) fn program(&self, draw: &mut Draw) -> Problem {
        let mut corridor = Corridor::new();
        let (climb, wave, phase) = (
            draw.between(-4.0, 4.0),
            draw.between(0.0, 3.0),
            draw.between(0.0, 6.0),
        );
        for (knot, bounds) in corridor.bounds.iter_mut().enumerate() {
            let share = knot as f64 / STAGES as f64;
            let height = climb * share + wave * (libm::sin(phase + 5.0 * share) - libm::sin(phase));
            for (bound, [up, _]) in bounds.iter_mut().zip(&DIRECTION_VECTORS) {
                *bound = up * height + draw.between(0.5, 6.0);
            }
        }
        let mut bounds = Bounds::none();
        bounds.set_corridor(&corridor);
        let rise = if draw.unit() < 0.5 {
            draw.between(2.0, 6.0)
        } else {
            f64::INFINITY
        };
        bounds.set_thrust([rise, self.thrust]);
        if draw.unit() < 0.5 {
            let (attack, path) = (draw.between(0.05, 0.3), draw.between(0.2, 0.6));
            bounds.set_attitude([attack, path], [-attack, -path]);
        }
        let spread = [0.0, 0.0, 1.5, 0.2, 0.4, 0.2];
        Problem {
            initial: spread.map(|spread| draw.between(-spread, spread)),
            target: [0.0, draw.between(-8.0, 8.0), 0.0, 0.0, 0.0, 0.0],
            bounds,
            hard_angle_of_attack: [0; 2].map(|_| draw.unit() < 0.5),
            ..Problem::EMPTY
        }
    }

    /// The optimum of a program, if it has one.
    pub(crate) fn optimum(&self, solver: &mut Solver, problem: &Problem) -> Option<Solution> {
        let mut solution = Solution::new();
        (solver.solve(&self.shared, problem) == Status::Optimal
            && solver.solution(&self.shared, &mut solution) == Status::Optimal)
            .then_some(solution)
    }

    pub(crate) fn roll_out(
        &self,
        initial: &StageState,
        controls: &[StageControl; STAGES],
    ) -> [StageState; KNOTS] {
        let mut states = [*initial; KNOTS];
        for stage in 0..STAGES {
            states[stage + 1] = self.model.step(&states[stage], &controls[stage]);
        }
        states
    }

    /// Cost without penalties.
    pub(crate) fn cost(&self, problem: &Problem, controls: &[StageControl; STAGES]) -> f64 {
        let states = self.roll_out(&problem.initial, controls);
        let effort: f64 = controls
            .iter()
            .flat_map(|control| control.iter().zip(&self.weights.control))
            .map(|(value, weight)| weight * value * value)
            .sum();
        let missing: f64 = states[STAGES]
            .iter()
            .zip(&problem.target)
            .map(|(x, goal)| (x - goal) * (x - goal))
            .sum();
        0.5 * (effort + self.weights.terminal * missing)
    }

    /// Gradient of a function of the controls that is at most quadratic. Central differences are
    /// exact except for rounding, and the step is large to keep the rounding small.
    pub(crate) fn gradient(
        &self,
        controls: &[StageControl; STAGES],
        function: impl Fn(&[StageControl; STAGES]) -> f64,
    ) -> [f64; 2 * STAGES] {
        core::array::from_fn(|index| {
            let at = |step: f64| {
                let mut moved = *controls;
                moved[index / 2][index % 2] += step;
                function(&moved)
            };
            (at(1.0) - at(-1.0)) / 2.0
        })
    }
}

/// A row's left-hand side.
pub(crate) fn left_hand_side(
    row: usize,
    states: &[StageState; KNOTS],
    controls: &[StageControl; STAGES],
) -> f64 {
    match RowKind::of(row) {
        RowKind::Position(knot, direction) => {
            let [up, forward] = DIRECTION_VECTORS[direction];
            up * states[knot][1] + forward * states[knot][0]
        }
        RowKind::Attitude(knot, 0) => states[knot][3] - states[knot][5],
        RowKind::Attitude(knot, 1) => states[knot][5],
        RowKind::Attitude(knot, 2) => states[knot][5] - states[knot][3],
        RowKind::Attitude(knot, _) => -states[knot][5],
        RowKind::Thrust(stage, 0) => controls[stage][1],
        RowKind::Thrust(stage, _) => -controls[stage][1],
    }
}

/// Violation of each row; negative where it has room.
pub(crate) fn violations(problem: &Problem, solution: &Solution) -> [f64; ROWS] {
    core::array::from_fn(|row| {
        left_hand_side(row, &solution.states, &solution.controls) - problem.bounds.0[row]
    })
}

/// Whether a penalty softens a row of this program.
pub(crate) fn softens(problem: &Problem, row: usize) -> bool {
    match RowKind::of(row) {
        RowKind::Attitude(_, 0) => !problem.hard_angle_of_attack[0],
        RowKind::Attitude(_, 2) => !problem.hard_angle_of_attack[1],
        RowKind::Position(..) | RowKind::Attitude(..) => true,
        RowKind::Thrust(..) => false,
    }
}

/// Whether no control can change a row. Positions follow the controls two stages later.
pub(crate) fn is_constant(row: usize) -> bool {
    matches!(RowKind::of(row), RowKind::Position(0 | 1, _))
}

/// Cost with the price of every row that the controls can change.
pub(crate) fn priced(problem: &Problem, solution: &Solution, penalty: &Penalty) -> f64 {
    let price: f64 = violations(problem, solution)
        .iter()
        .enumerate()
        .filter(|(row, _)| softens(problem, *row) && !is_constant(*row))
        .map(|(_, violation)| violation.max(0.0))
        .map(|slack| penalty.linear * slack + 0.5 * penalty.quadratic * slack * slack)
        .sum();
    solution.cost + price
}

impl Draw {
    /// A uniform random whole number below a number.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }
}
