//! Programs in space against Clarabel: 54 inputs, faces with normals of their own, hard limits of the inputs.

use super::instances::Draw;
use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::NonnegativeConeT;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus};
use mpp_core::config::STAGES;
use mpp_core::qp::space::{
    Condensed, Dynamics, Faces, INPUTS, MOTION, POSITION, Problem, ROWS, RowKind, STATES, Solution,
    Solver, Weights,
};
use mpp_core::qp::{Penalty, Status};

const PROGRAMS: usize = 300;
const CONTROLS: usize = INPUTS * STAGES;
const PENALTY: Penalty = Penalty {
    linear: 200.0,
    quadratic: 400.0,
};

impl Draw {
    fn normal(&mut self) -> [f64; POSITION] {
        loop {
            let vector = [(); POSITION].map(|()| self.between(-1.0, 1.0));
            let square: f64 = vector.iter().map(|x| x * x).sum();
            if square > 0.1 && square < 1.0 {
                return vector.map(|x| x / square.sqrt());
            }
        }
    }

    /// A stage of a bank-to-turn aircraft in a random attitude, with some noise in every entry of the motion.
    fn stage(&mut self) -> Dynamics {
        let mut stage = Dynamics::at_rest();
        let (v, dt) = (self.between(8.0, 20.0), 0.25);
        let (sin_bank, cos_bank) = libm::sincos(self.between(-1.0, 1.0));
        let (sin_path, cos_path) = libm::sincos(self.between(-0.3, 0.3));
        let turn = 9.8 / v;
        // (v, alpha, bank, path, course) by themselves.
        let mut rate = [[0.0; MOTION]; MOTION];
        rate[0] = [-0.05, -2.0, 0.0, -9.8, 0.0];
        rate[3] = [0.02, 4.0 * cos_bank, -turn * sin_bank, 0.0, 0.0];
        rate[4] = [0.01, 4.0 * sin_bank, turn * cos_bank, 0.0, 0.0];
        for (row, rates) in rate.iter().enumerate() {
            for (col, rate) in rates.iter().enumerate() {
                let own = f64::from(u8::from(row == col));
                stage.motion[(POSITION + row, col)] = own + dt * rate + self.between(-0.01, 0.01);
            }
        }
        stage.motion[(0, 0)] = dt * cos_path;
        stage.motion[(2, 0)] = dt * sin_path;
        stage.motion[(1, 4)] = dt * v;
        stage.motion[(2, 3)] = dt * v;
        stage.b[(POSITION + 2, 0)] = dt;
        stage.b[(POSITION + 1, 1)] = dt;
        stage.b[(POSITION, 2)] = 0.3 * dt;
        stage.b[(1, 0)] = 0.05 * dt;
        for entry in &mut stage.offset {
            *entry = self.between(-0.05, 0.05);
        }
        stage
    }

    fn program(&mut self, penalty: Option<Penalty>) -> (Box<[Dynamics; STAGES]>, Faces, Problem) {
        let stages = Box::new([(); STAGES].map(|()| self.stage()));
        let mut faces = Faces::none();
        let mut problem = Problem {
            penalty,
            ..Problem::EMPTY
        };
        problem.initial = [(); STATES].map(|()| self.between(-0.3, 0.3));
        problem.target = [
            0.0,
            self.between(-6.0, 6.0),
            self.between(-3.0, 3.0),
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        let tight = self.between(0.0, 3.0);
        for boundary in 1..=STAGES {
            for _ in 0..(self.between(0.0, 6.0) as usize) {
                let bound = tight + self.between(0.0, 3.0);
                assert!(faces.push(boundary, self.normal(), bound));
            }
        }
        problem.bounds.set_faces(&faces, &[0.0; POSITION]);
        let (alpha, bank) = (self.between(0.1, 0.2), self.between(0.6, 1.0));
        problem
            .bounds
            .set_attitudes([alpha, bank, 0.5, 1.0], [-alpha, -bank, -0.5, -1.0]);
        problem
            .bounds
            .set_inputs([1.5, 1.0, 6.0], [-1.5, -1.0, -3.0]);
        (stages, faces, problem)
    }
}

fn weights() -> Weights {
    Weights {
        control: [0.3, 1.0, 0.02],
        terminal: [0.0, 0.05, 0.5, 1.0, 5.0, 10.0, 20.0, 10.0],
    }
}

/// States at all boundaries, from the model alone.
fn roll_out(
    stages: &[Dynamics; STAGES],
    initial: [f64; STATES],
    controls: &[[f64; INPUTS]; STAGES],
) -> Vec<[f64; STATES]> {
    let mut states = vec![initial];
    for (stage, control) in stages.iter().zip(controls) {
        let state = stage.step(&states[states.len() - 1], control);
        states.push(state);
    }
    states
}

/// Left-hand sides of all rows at some controls.
fn left_hand_sides(
    faces: &Faces,
    states: &[[f64; STATES]],
    controls: &[[f64; INPUTS]; STAGES],
) -> Vec<f64> {
    let side = |which: usize| if which.is_multiple_of(2) { 1.0 } else { -1.0 };
    let row = |row| match RowKind::of(row) {
        RowKind::Face(boundary, face) => faces.at(boundary).nth(face).map_or(0.0, |(normal, _)| {
            (0..POSITION)
                .map(|axis| normal[axis] * states[boundary][axis])
                .sum()
        }),
        RowKind::Attitude(boundary, which) => side(which) * states[boundary][4 + which / 2],
        RowKind::Input(stage, which) => side(which) * controls[stage][which / 2],
    };
    (0..ROWS).map(row).collect()
}

/// The program over its controls, as Clarabel takes it.
struct Dense {
    /// Effect of each control on the left-hand sides of the rows, and the left-hand sides without control.
    effects: Vec<Vec<f64>>,
    free: Vec<f64>,
    ends: Vec<[f64; STATES]>,
    end: [f64; STATES],
}

impl Dense {
    fn new(stages: &[Dynamics; STAGES], faces: &Faces, problem: &Problem) -> Self {
        let still = [[0.0; INPUTS]; STAGES];
        let states = roll_out(stages, problem.initial, &still);
        let (free, end) = (left_hand_sides(faces, &states, &still), states[STAGES]);
        let (mut effects, mut ends) = (Vec::new(), Vec::new());
        for control in 0..CONTROLS {
            let mut pushed = still;
            pushed[control / INPUTS][control % INPUTS] = 1.0;
            let states = roll_out(stages, problem.initial, &pushed);
            let rows = left_hand_sides(faces, &states, &pushed);
            effects.push(
                rows.iter()
                    .zip(&free)
                    .map(|(row, free)| row - free)
                    .collect(),
            );
            ends.push(core::array::from_fn(|state| {
                states[STAGES][state] - end[state]
            }));
        }
        Self {
            effects,
            free,
            ends,
            end,
        }
    }

    /// Clarabel's verdict, and its cost without the constant part.
    fn solve(&self, problem: &Problem) -> (SolverStatus, f64) {
        let weights = weights();
        let bounded: Vec<usize> = (0..ROWS)
            .filter(|row| problem.bounds.0[*row].is_finite())
            .collect();
        let soft: Vec<usize> = bounded
            .iter()
            .copied()
            .filter(|row| is_soft(problem, *row))
            .collect();
        let size = CONTROLS + soft.len();
        let (mut quadratic, mut linear) = (vec![vec![0.0; size]; size], vec![0.0; size]);
        for one in 0..CONTROLS {
            quadratic[one][one] = weights.control[one % INPUTS];
            for state in 0..STATES {
                let weight = weights.terminal[state];
                linear[one] +=
                    weight * self.ends[one][state] * (self.end[state] - problem.target[state]);
                for other in 0..CONTROLS {
                    quadratic[one][other] +=
                        weight * self.ends[one][state] * self.ends[other][state];
                }
            }
        }
        for (index, _) in soft.iter().enumerate() {
            quadratic[CONTROLS + index][CONTROLS + index] = PENALTY.quadratic;
            linear[CONTROLS + index] = PENALTY.linear;
        }
        let mut rows: Vec<Vec<f64>> = Vec::new();
        let mut right = Vec::new();
        for row in &bounded {
            let mut terms: Vec<f64> = self.effects.iter().map(|effect| effect[*row]).collect();
            terms.resize(size, 0.0);
            if let Some(index) = soft.iter().position(|other| other == row) {
                terms[CONTROLS + index] = -1.0;
            }
            rows.push(terms);
            right.push(problem.bounds.0[*row] - self.free[*row]);
        }
        for slack in CONTROLS..size {
            let mut terms = vec![0.0; size];
            terms[slack] = -1.0;
            rows.push(terms);
            right.push(0.0);
        }
        for (row, terms) in quadratic.iter_mut().enumerate() {
            terms[..row].fill(0.0);
        }
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .tol_feas(1e-10)
            .tol_gap_abs(1e-10)
            .tol_gap_rel(1e-10)
            .build()
            .unwrap();
        let mut solver = DefaultSolver::new(
            &CscMatrix::from(&quadratic),
            &linear,
            &CscMatrix::from(&rows),
            &right,
            &[NonnegativeConeT(right.len())],
            settings,
        )
        .unwrap();
        solver.solve();
        let misses = (0..STATES).map(|state| {
            weights.terminal[state] * (self.end[state] - problem.target[state]).powi(2)
        });
        (
            solver.solution.status,
            solver.solution.obj_val + 0.5 * misses.sum::<f64>(),
        )
    }
}

fn is_soft(problem: &Problem, row: usize) -> bool {
    problem.penalty.is_some() && !matches!(RowKind::of(row), RowKind::Input(..))
}

/// Cost with penalties, and the worst violation of a hard row, of one of our solutions by the model alone.
fn priced(
    stages: &[Dynamics; STAGES],
    faces: &Faces,
    problem: &Problem,
    solution: &Solution,
) -> (f64, f64) {
    let states = roll_out(stages, problem.initial, &solution.controls);
    let sides = left_hand_sides(faces, &states, &solution.controls);
    let weights = weights();
    let mut cost = 0.0;
    for control in &solution.controls {
        cost += (0..INPUTS)
            .map(|input| 0.5 * weights.control[input] * control[input].powi(2))
            .sum::<f64>();
    }
    for state in 0..STATES {
        cost +=
            0.5 * weights.terminal[state] * (states[STAGES][state] - problem.target[state]).powi(2);
    }
    let mut worst = 0.0_f64;
    for (row, side) in sides.iter().enumerate() {
        let excess = (side - problem.bounds.0[row]).max(0.0);
        if is_soft(problem, row) {
            cost += PENALTY.linear * excess + 0.5 * PENALTY.quadratic * excess * excess;
        } else {
            worst = worst.max(excess);
        }
    }
    (cost, worst)
}

fn compare(seed: u64, penalty: Option<Penalty>) -> [usize; 3] {
    let mut draw = Draw::new(seed);
    let (mut solver, mut shared) = (Box::new(Solver::new()), Box::new(Condensed::new()));
    let mut solution = Box::new(Solution::new());
    let (mut optimal, mut infeasible, mut steps) = (0, 0, 0);
    for program in 0..PROGRAMS {
        let (stages, faces, problem) = draw.program(penalty);
        shared
            .condense_varying(&weights(), |out| *out = *stages)
            .unwrap();
        shared.set_faces(&faces);
        let _ = solver.solve(&shared, &problem);
        let status = solver.solution(&shared, &mut solution);
        steps = steps.max(solver.iterations());
        let (verdict, cost) = Dense::new(&stages, &faces, &problem).solve(&problem);
        match status {
            Status::Optimal => {
                let (ours, worst) = priced(&stages, &faces, &problem, &solution);
                assert!(
                    worst < 1e-6,
                    "program {program}: a hard row is violated by {worst}"
                );
                assert_eq!(verdict, SolverStatus::Solved, "program {program}");
                let error = (ours - cost).abs() / cost.abs().max(1.0);
                assert!(error < 1e-6, "program {program}: {ours} against {cost}");
                optimal += 1;
            }
            Status::Infeasible | Status::TooDear => {
                assert!(
                    penalty.is_none(),
                    "program {program}: soft rows always hold"
                );
                assert_eq!(verdict, SolverStatus::PrimalInfeasible, "program {program}");
                infeasible += 1;
            }
            other => assert_eq!(other, Status::Optimal, "program {program}: {verdict:?}"),
        }
    }
    [optimal, infeasible, steps]
}

#[test]
fn soft_programs_in_space_agree_with_clarabel() {
    let [optimal, _, steps] = compare(3, Some(PENALTY));
    println!("{optimal} optimal, {steps} steps at most");
    assert_eq!(optimal, PROGRAMS);
}

#[test]
fn hard_programs_in_space_agree_with_clarabel() {
    let [optimal, infeasible, steps] = compare(4, None);
    println!("{optimal} optimal, {infeasible} infeasible, {steps} steps at most");
    assert!(optimal > PROGRAMS / 10 && infeasible > PROGRAMS / 10);
}
