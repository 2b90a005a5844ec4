//! Small programs against the obvious way to solve them: every way in which rows can take part is
//! tried.

use crate::dense::{
    CONTROLS, DenseProgram, Stages, Vector, cost, flat, largest, solve_equations, staged,
};
use crate::programs::{Draw, Setup, left_hand_side, softens};
use mpp_core::config::STAGES;
use mpp_core::qp::{
    Bounds, Penalty, Problem, ROWS, RowKind, Solution, Solver, StageControl, Status,
};

/// Programs of each comparison.
const PROGRAMS: usize = 240;
/// Error of costs, relative, and of controls: rounding leaves 1e-12.
const SAME: f64 = 1e-9;
/// What brute force takes for zero: violations [m, rad, N], and multipliers and slopes relative to
/// their size.
const ZERO: f64 = 1e-9;

/// How a row takes part.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Inactive,
    Tight,
    Yielding,
}

/// The point at which cost and rows balance in given roles, and the rows' multipliers; none where
/// the rows depend on each other.
fn balance(
    program: &DenseProgram,
    roles: &[Role],
    penalty: Option<Penalty>,
) -> Option<(Vector, Vec<f64>)> {
    let active: Vec<usize> = (0..roles.len())
        .filter(|index| roles[*index] != Role::Inactive)
        .collect();
    let mut equations = Vec::new();
    for control in 0..CONTROLS {
        let mut equation = program.hessian[control].to_vec();
        equation.extend(
            active
                .iter()
                .map(|index| program.rows[*index].normal[control]),
        );
        equation.push(-program.gradient[control]);
        equations.push(equation);
    }
    for (place, index) in active.iter().enumerate() {
        let row = &program.rows[*index];
        let mut equation = row.normal.to_vec();
        equation.resize(CONTROLS + active.len(), 0.0);
        let mut right = row.bound;
        if let (Role::Yielding, Some(Penalty { linear, quadratic })) = (roles[*index], penalty) {
            // `normal . u = bound + (multiplier - linear) / quadratic`
            equation[CONTROLS + place] = -1.0 / quadratic;
            right -= linear / quadratic;
        }
        equation.push(right);
        equations.push(equation);
    }
    let solution = solve_equations(equations)?;
    let (controls, found) = solution.split_at(CONTROLS);
    let mut multipliers = vec![0.0; roles.len()];
    for (index, multiplier) in active.into_iter().zip(found) {
        multipliers[index] = *multiplier;
    }
    Some((controls.try_into().ok()?, multipliers))
}

/// Whether every row keeps its role, and nothing is left of the slope.
fn is_optimal(
    program: &DenseProgram,
    roles: &[Role],
    penalty: Option<Penalty>,
    controls: &Vector,
    multipliers: &[f64],
) -> bool {
    let mut slope = program.slope(controls);
    let scale = largest(&slope).max(1.0);
    for ((row, role), multiplier) in program.rows.iter().zip(roles).zip(multipliers) {
        let excess = row.excess(controls);
        let price = match penalty {
            Some(penalty) if softens(row.number) => penalty.linear,
            _ => f64::INFINITY,
        };
        let keeps = match role {
            Role::Inactive => excess <= ZERO,
            Role::Tight => {
                excess.abs() <= ZERO && (-ZERO * scale..=price + ZERO * scale).contains(multiplier)
            }
            Role::Yielding => excess >= -ZERO,
        };
        if !keeps {
            return false;
        }
        for (sum, entry) in slope.iter_mut().zip(&row.normal) {
            *sum += multiplier * entry;
        }
    }
    largest(&slope) <= ZERO * scale
}

/// The optimum, and the roles of the rows in it; none if rows contradict each other.
fn try_everything(program: &DenseProgram, penalty: Option<Penalty>) -> Option<(Vector, Vec<Role>)> {
    let choices = if penalty.is_some() { 3 } else { 2_usize };
    let rows = &program.rows;
    (0..choices.pow(rows.len() as u32)).find_map(|mut number| {
        let mut roles = Vec::new();
        for row in rows {
            let role = [Role::Inactive, Role::Tight, Role::Yielding][number % choices];
            number /= choices;
            if role == Role::Yielding && !softens(row.number) {
                return None;
            }
            roles.push(role);
        }
        let (controls, multipliers) = balance(program, &roles, penalty)?;
        is_optimal(program, &roles, penalty, &controls, &multipliers).then_some((controls, roles))
    })
}

/// A row that controls can change.
fn any_row(draw: &mut Draw) -> usize {
    let kind = match draw.below(3) {
        0 => RowKind::Position(2 + draw.below(STAGES - 1), draw.below(8)),
        1 => RowKind::Attitude(1 + draw.below(STAGES), draw.below(4)),
        _ => RowKind::Thrust(draw.below(STAGES)),
    };
    number(kind)
}

fn number(kind: RowKind) -> usize {
    (0..ROWS).find(|row| RowKind::of(*row) == kind).unwrap()
}

/// Rows that leave no room together, with the weights in which they cancel: opposite faces, three
/// faces around a point, opposite attitudes, and a climb from below that its flight path forbids.
fn opposed_rows(setup: &Setup, draw: &mut Draw) -> Vec<(usize, f64)> {
    let knot = 2 + draw.below(STAGES - 1);
    let position = |knot, direction: usize| number(RowKind::Position(knot, direction % 8));
    let attitude = |which| number(RowKind::Attitude(knot, which));
    let (face, which) = (draw.below(8), draw.below(2));
    match draw.below(4) {
        0 => vec![(position(knot, face), 1.0), (position(knot, face + 4), 1.0)],
        1 => vec![
            (position(knot, face), libm::sqrt(2.0)),
            (position(knot, face + 3), 1.0),
            (position(knot, face + 5), 1.0),
        ],
        2 => vec![(attitude(which), 1.0), (attitude(which + 2), 1.0)],
        _ => {
            let knot = knot.min(STAGES - 1);
            let climb = setup.model.a[(1, 5)];
            vec![
                (position(knot, 0), 1.0),
                (number(RowKind::Attitude(knot, 1)), climb),
                (position(knot + 1, 4), 1.0),
            ]
        }
    }
}

/// What a program was made to be.
#[derive(Clone, Copy, PartialEq)]
enum Made {
    Feasible,
    Infeasible,
    Either,
}

/// A program of few rows about random controls, which keep them all, miss some that contradict each
/// other, or neither.
fn program(setup: &Setup, most_rows: usize, made: Made, draw: &mut Draw) -> Problem {
    let spread = [0.0, 0.0, 1.5, 0.2, 0.4, 0.2];
    let initial = spread.map(|spread| draw.between(-spread, spread));
    let controls: [StageControl; STAGES] =
        core::array::from_fn(|_| [draw.between(-2.0, 2.0), draw.between(-1.0, 1.0)]);
    let states = setup.roll_out(&initial, &controls);
    let value = |row: usize| left_hand_side(row, &states, &controls);
    let opposed = opposed_rows(setup, draw);
    let mut bounds = Bounds::none();
    if made == Made::Infeasible {
        let missed = draw.between(0.01, 0.5);
        for (row, weight) in &opposed {
            bounds.0[*row] = value(*row) - missed / weight / opposed.len() as f64;
        }
    }
    let spare = if made == Made::Either {
        if draw.unit() < 0.5 {
            for (row, _) in &opposed {
                bounds.0[*row] = value(*row) + draw.between(-0.1, 0.1);
            }
        }
        draw.between(-1.0, 0.0)
    } else {
        0.0
    };
    while bounds.0.iter().filter(|bound| bound.is_finite()).count() < most_rows {
        let row = any_row(draw);
        if bounds.0[row].is_infinite() {
            bounds.0[row] = value(row) + draw.between(spare, 0.3);
        }
    }
    Problem {
        initial,
        target: [0.0, draw.between(-8.0, 8.0), 0.0, 0.0, 0.0, 0.0],
        bounds,
        penalty: None,
        cost_limit: f64::INFINITY,
    }
}

/// Calls `check` with programs of all presets and makes in turn.
fn for_each_program(
    seed: u64,
    most_rows: usize,
    mut check: impl FnMut(&Setup, &Problem, Made, &mut Draw),
) {
    let mut draw = Draw::new(seed);
    let setups = Setup::all();
    for index in 0..PROGRAMS {
        let made = [Made::Feasible, Made::Infeasible, Made::Either, Made::Either][index % 4];
        let setup = &setups[draw.below(setups.len())];
        let rows = most_rows - draw.below(3);
        let problem = program(setup, rows, made, &mut draw);
        check(setup, &problem, made, &mut draw);
    }
}

fn stages(setup: &Setup) -> Stages {
    [setup.model.dynamics(); STAGES]
}

fn difference(a: &[StageControl; STAGES], b: &[StageControl; STAGES]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn hard_verdicts_and_costs_are_those_of_trying_everything() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let (mut feasible, mut infeasible, mut searched, mut several_tight) = (0, 0, 0, 0);
    for_each_program(40, 9, |setup, problem, made, _| {
        let stages = stages(setup);
        let dense = DenseProgram::new(&stages, &setup.weights, problem);
        let expected = try_everything(&dense, None);
        assert!(made == Made::Either || (made == Made::Feasible) == expected.is_some());
        let status = solver.solve(&setup.shared, problem);
        let Some((controls, roles)) = expected else {
            assert_eq!(status, Status::Infeasible);
            infeasible += 1;
            searched += usize::from(solver.iterations() > 0);
            return;
        };
        assert_eq!(status, Status::Optimal);
        assert_eq!(
            solver.solution(&setup.shared, &mut solution),
            Status::Optimal
        );
        let controls = staged(&controls);
        let best = cost(&stages, &setup.weights, problem, &controls);
        assert!((solution.cost - best).abs() <= SAME * best);
        assert!(difference(&solution.controls, &controls) <= SAME);
        feasible += 1;
        let tight = roles.iter().filter(|role| **role == Role::Tight).count();
        several_tight += usize::from(tight >= 2);
    });
    println!("{feasible} feasible, {several_tight} with several tight rows");
    println!("{infeasible} infeasible, {searched} of them not at once");
    assert!(feasible >= 100 && several_tight >= 80);
    assert!(infeasible >= 80 && searched >= 60);
}

/// Cost with the price of every violation.
fn priced(
    setup: &Setup,
    problem: &Problem,
    dense: &DenseProgram,
    controls: &Vector,
    penalty: &Penalty,
) -> f64 {
    let price: f64 = dense
        .rows
        .iter()
        .filter(|row| softens(row.number))
        .map(|row| row.excess(controls).max(0.0))
        .map(|slack| penalty.linear * slack + 0.5 * penalty.quadratic * slack * slack)
        .sum();
    cost(&stages(setup), &setup.weights, problem, &staged(controls)) + price
}

#[test]
fn soft_optima_are_those_of_trying_everything() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let (mut yielding, mut both, mut holding) = (0, 0, 0);
    for_each_program(41, 6, |setup, problem, _, draw| {
        let penalty = Penalty {
            linear: libm::exp10(draw.between(-1.0, 4.0)),
            quadratic: libm::exp10(draw.between(0.0, 4.0)),
        };
        let problem = Problem {
            penalty: Some(penalty),
            ..*problem
        };
        let dense = DenseProgram::new(&stages(setup), &setup.weights, &problem);
        let (controls, roles) = try_everything(&dense, Some(penalty)).unwrap();
        assert_eq!(solver.solve(&setup.shared, &problem), Status::Optimal);
        assert_eq!(
            solver.solution(&setup.shared, &mut solution),
            Status::Optimal
        );
        let best = priced(setup, &problem, &dense, &controls, &penalty);
        let found = priced(setup, &problem, &dense, &flat(&solution.controls), &penalty);
        assert!((found - best).abs() <= SAME * best);
        assert!(difference(&solution.controls, &staged(&controls)) <= SAME);
        let [tight, yields] = [Role::Tight, Role::Yielding].map(|role| roles.contains(&role));
        assert_eq!(solution.violation > SAME, yields);
        yielding += usize::from(yields);
        both += usize::from(tight && yields);
        holding += usize::from(!yields);
    });
    println!("{yielding} with yielding rows, {both} of them with tight ones, {holding} without");
    assert!(yielding >= 100 && both >= 60 && holding >= 60);
}
