//! Tests small programs against the simple way to solve them: all combinations of active rows are
//! tried.

use super::dense::{
    CONTROLS, DenseProgram, Stages, Vector, cost, flat, largest, solve_equations, staged,
};
use super::programs::Setup;
use super::small_programs::{Made, difference, for_each_program};
use mpp_core::config::STAGES;
use mpp_core::qp::{Penalty, Problem, Solution, Solver, Status};

/// Error of costs, relative, and of controls: rounding leaves 1e-12.
const SAME: f64 = 1e-9;
/// Limit below which brute force takes a value for zero: violations [m, rad, N], and multipliers
/// and slopes relative to their size.
const ZERO: f64 = 1e-9;

/// The role of a row.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Inactive,
    Tight,
    Yielding,
}

/// The point at which cost and rows balance in given roles, and the rows' multipliers. Returns
/// `None` if the rows depend on each other.
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

/// Whether every row keeps its role, and the slope vanishes.
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
            Some(penalty) if row.softens => penalty.linear,
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

/// The optimum, and the roles of the rows in it. Returns `None` if rows contradict each other.
fn try_everything(program: &DenseProgram, penalty: Option<Penalty>) -> Option<(Vector, Vec<Role>)> {
    let choices = if penalty.is_some() { 3 } else { 2_usize };
    let rows = &program.rows;
    (0..choices.pow(rows.len() as u32)).find_map(|mut number| {
        let mut roles = Vec::new();
        for row in rows {
            let role = [Role::Inactive, Role::Tight, Role::Yielding][number % choices];
            number /= choices;
            if role == Role::Yielding && !row.softens {
                return None;
            }
            roles.push(role);
        }
        let (controls, multipliers) = balance(program, &roles, penalty)?;
        is_optimal(program, &roles, penalty, &controls, &multipliers).then_some((controls, roles))
    })
}

fn stages(setup: &Setup) -> Stages {
    [setup.model.dynamics(); STAGES]
}

#[test]
fn hard_verdicts_and_costs_are_those_of_trying_everything() {
    let mut solver = Box::new(Solver::new());
    let mut solution = Solution::new();
    let (mut feasible, mut infeasible, mut searched, mut several_tight) = (0, 0, 0, 0);
    for_each_program(40, 240, 9, |setup, problem, made, _| {
        let stages = stages(setup);
        let dense = DenseProgram::new(&stages, &setup.weights, problem);
        let expected = try_everything(&dense, None);
        assert!(made == Made::Either || (made == Made::Feasible) == expected.is_some());
        let status = solver.solve(&setup.shared, problem);
        let Some((controls, roles)) = expected else {
            assert!(matches!(status, Status::Infeasible | Status::TooDear));
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
        .filter(|row| row.softens)
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
    for_each_program(41, 720, 6, |setup, problem, _, draw| {
        let penalty = Penalty {
            linear: libm::exp10(draw.between(-2.0, 3.0)),
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
    assert!(yielding >= 400 && both >= 200 && holding >= 100);
}
