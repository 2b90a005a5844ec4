//! `bench qp`: our solver and Clarabel on the same programs, timed and checked.
//!
//! Times are the best of several runs of one program, so that the machine's other work drops out.
//! Our times hold everything that a candidate costs (start, solve, trajectory). The model is
//! condensed before, as it is once in a cycle. Clarabel's times hold its `solve` alone; its set-up
//! is done before.

use super::error::QpBenchError;
use super::full_form::{Form, FullForm};
use super::percentile::percentile;
use crate::instance::Instance;
use clarabel::solver::{IPSolver, SolverStatus};
use mpp_core::qp::{Condensed, Solution, Solver, Status};
use serde::Serialize;
use std::fmt;
use std::time::Instant;

/// A margin nearer to zero than this is a tie: neither verdict is wrong.
const TIE: f64 = 1e-7;
/// Greatest row error of a solution whose cost is a measure for the other solver [m, rad, N].
const MEASURE: f64 = 1e-7;
/// Runs of one program, ours and Clarabel's.
const RUNS: (usize, usize) = (50, 3);

/// One solver's figures.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SolverReport {
    /// Name of the solver; ours is `mpp`.
    pub name: String,
    /// Median time \[us\].
    pub median_us: f64,
    /// 99th percentile of the time \[us\].
    pub p99_us: f64,
    /// Longest time \[us\].
    pub max_us: f64,
    /// Median of the iterations.
    pub iterations_median: usize,
    /// Mean of the iterations.
    pub iterations_mean: f64,
    /// Greatest number of iterations.
    pub iterations_max: usize,
    /// Number of programs on whose feasibility the solver is wrong; ties do not count.
    pub verdict_errors: usize,
    /// Worst relative error of the cost, on feasible programs.
    pub worst_objective_error: f64,
    /// Worst violation of a hard row [m, rad, N] or of the dynamics.
    pub worst_row_error: f64,
}

/// The benchmark's figures.
#[derive(Clone, Debug, Serialize)]
pub struct QpReport {
    /// Number of programs.
    pub instances: usize,
    /// Number of feasible programs.
    pub feasible: usize,
    /// Number of programs within 1e-7 of the boundary of feasibility. No verdict counts on them.
    pub ties: usize,
    /// Time to condense a model, which all programs of a cycle share \[us\]. It is that of the
    /// slowest model.
    pub condense_us: f64,
    /// The solvers.
    pub solvers: Vec<SolverReport>,
}

impl fmt::Display for QpReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            instances,
            feasible,
            ties,
            condense_us,
            solvers,
        } = self;
        writeln!(
            f,
            "{instances} programs, {feasible} feasible, {ties} ties; condensing a model: \
             {condense_us:.1} us"
        )?;
        writeln!(
            f,
            "{:<10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>9} {:>15} {:>15} {:>10}",
            "solver",
            "median us",
            "p99 us",
            "max us",
            "iter. med",
            "iter. mean",
            "iter. max",
            "verdict errors",
            "cost error",
            "row error"
        )?;
        for s in solvers {
            writeln!(
                f,
                "{:<10} {:>10.2} {:>10.2} {:>10.2} {:>10} {:>10.1} {:>9} {:>15} {:>15.1e} {:>10.1e}",
                s.name,
                s.median_us,
                s.p99_us,
                s.max_us,
                s.iterations_median,
                s.iterations_mean,
                s.iterations_max,
                s.verdict_errors,
                s.worst_objective_error,
                s.worst_row_error
            )?;
        }
        if let [ours, theirs, ..] = solvers.as_slice() {
            writeln!(
                f,
                "{} is {:.0} times faster than {} in the median, {:.0} times at the 99th percentile",
                ours.name,
                theirs.median_us / ours.median_us,
                theirs.name,
                theirs.p99_us / ours.p99_us
            )?;
        }
        Ok(())
    }
}

/// One solver's run on one program.
struct SolverRun {
    time_us: f64,
    iterations: usize,
    /// Whether the solver calls the program feasible; `None` if it has no verdict.
    feasible: Option<bool>,
    /// Cost with penalties, if the solver gave a solution.
    cost: Option<f64>,
    row_error: f64,
}

/// Runs both solvers on every program, one after the other; `progress` is called after each.
///
/// # Errors
/// [`QpBenchError`], when a program cannot be set up.
pub fn run_qp(
    instances: &[Instance],
    mut progress: impl FnMut(),
) -> Result<QpReport, QpBenchError> {
    let mut shared: Option<(usize, Box<Condensed>)> = None;
    let (mut ours, mut theirs) = (Tally::new("mpp"), Tally::new("clarabel"));
    let (mut feasible, mut ties, mut condense_us) = (0, 0, 0.0_f64);
    for (index, instance) in instances.iter().enumerate() {
        let fits = shared
            .as_ref()
            .is_some_and(|(at, _)| instances[*at].shares_model(instance));
        if !fits {
            let (condensed, time_us) = ask_condense(instance)?;
            condense_us = condense_us.max(time_us);
            shared = Some((index, condensed));
        }
        let Some((_, condensed)) = &shared else {
            continue;
        };
        let full = FullForm::new(instance, Form::Optimum);
        let truth = match margin(instance)? {
            margin if margin.abs() <= TIE => None,
            margin => Some(margin < 0.0),
        };
        feasible += usize::from(truth == Some(true));
        ties += usize::from(truth.is_none());
        let own = ask_mpp(instance, condensed, &full);
        let other = ask_clarabel(instance, &full)?;
        // A solution that breaks rows costs less than it should, so it is no measure for the other
        // solver.
        let cost = |run: &SolverRun| {
            let keeps_rows = run.row_error <= MEASURE;
            instance.cost.or(run.cost.filter(|_| keeps_rows))
        };
        ours.add(&own, truth, cost(&other));
        theirs.add(&other, truth, cost(&own));
        progress();
    }
    Ok(QpReport {
        instances: instances.len(),
        feasible,
        ties,
        condense_us,
        solvers: vec![ours.report(), theirs.report()],
    })
}

/// The margin: the recorded one, or else Clarabel's. Programs with soft rows have room.
fn margin(instance: &Instance) -> Result<f64, QpBenchError> {
    match (instance.penalty, instance.margin) {
        (Some(_), _) => Ok(-1.0),
        (None, Some(margin)) => Ok(margin),
        (None, None) => {
            let mut solver = clarabel(instance, &FullForm::new(instance, Form::Margin))?;
            solver.solve();
            match solver.solution.status {
                SolverStatus::Solved => Ok(solver.solution.obj_val),
                status => Err(QpBenchError::NoMargin(instance.name.clone(), status)),
            }
        }
    }
}

fn clarabel(
    instance: &Instance,
    full: &FullForm,
) -> Result<clarabel::solver::DefaultSolver<f64>, QpBenchError> {
    full.clarabel()
        .map_err(|error| QpBenchError::Clarabel(instance.name.clone(), error))
}

/// Condenses a program's model. Returns it with the best time of several runs \[us\].
fn ask_condense(instance: &Instance) -> Result<(Box<Condensed>, f64), QpBenchError> {
    let mut condensed = instance
        .condense()
        .map_err(|_| QpBenchError::NotPositiveDefinite(instance.name.clone()))?;
    let mut best = f64::INFINITY;
    for _ in 0..RUNS.0 {
        let begin = Instant::now();
        let again = instance.condense_to(&mut condensed);
        best = best.min(begin.elapsed().as_secs_f64());
        again.map_err(|_| QpBenchError::NotPositiveDefinite(instance.name.clone()))?;
    }
    Ok((condensed, best * 1e6))
}

fn ask_mpp(instance: &Instance, shared: &Condensed, full: &FullForm) -> SolverRun {
    let problem = instance.problem();
    let mut solver = Box::new(Solver::new());
    let mut solution = Box::new(Solution::new());
    let mut best = f64::INFINITY;
    let mut status = Status::NumericalFailure;
    for _ in 0..RUNS.0 {
        let begin = Instant::now();
        status = solver.solve(shared, &problem);
        if status == Status::Optimal {
            status = solver.solution(shared, &mut solution);
        }
        best = best.min(begin.elapsed().as_secs_f64());
    }
    let (cost, row_error) = full.evaluate(&solution);
    let solved = status == Status::Optimal;
    SolverRun {
        time_us: best * 1e6,
        iterations: solver.iterations(),
        feasible: match status {
            Status::Optimal => Some(true),
            Status::Infeasible | Status::TooDear => Some(false),
            Status::Dominated | Status::IterationLimit | Status::NumericalFailure => None,
        },
        cost: solved.then_some(cost),
        row_error: if solved { row_error } else { 0.0 },
    }
}

fn ask_clarabel(instance: &Instance, full: &FullForm) -> Result<SolverRun, QpBenchError> {
    let timed = || -> Result<_, QpBenchError> {
        let mut solver = clarabel(instance, full)?;
        let begin = Instant::now();
        solver.solve();
        Ok((begin.elapsed().as_secs_f64(), solver))
    };
    let (mut best, mut solver) = timed()?;
    for _ in 1..RUNS.1 {
        let (time, last) = timed()?;
        best = best.min(time);
        solver = last;
    }
    let solution = &solver.solution;
    let solved = matches!(
        solution.status,
        SolverStatus::Solved | SolverStatus::AlmostSolved
    );
    let infeasible = matches!(
        solution.status,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible
    );
    Ok(SolverRun {
        time_us: best * 1e6,
        iterations: solution.iterations as usize,
        feasible: (solved || infeasible).then_some(solved),
        cost: solved.then_some(solution.obj_val + full.constant),
        row_error: if solved {
            full.row_error(&solution.x)
        } else {
            0.0
        },
    })
}

/// Collects one solver's runs.
struct Tally {
    report: SolverReport,
    times: Vec<f64>,
    iterations: Vec<usize>,
}

impl Tally {
    fn new(name: &str) -> Self {
        Self {
            report: SolverReport {
                name: name.to_owned(),
                ..SolverReport::default()
            },
            times: Vec::new(),
            iterations: Vec::new(),
        }
    }

    fn add(&mut self, run: &SolverRun, truth: Option<bool>, cost: Option<f64>) {
        self.times.push(run.time_us);
        self.iterations.push(run.iterations);
        let report = &mut self.report;
        report.verdict_errors += usize::from(truth.is_some() && run.feasible != truth);
        if truth == Some(true)
            && let (Some(own), Some(best)) = (run.cost, cost)
        {
            let error = (own - best).abs() / best.abs().max(1.0);
            report.worst_objective_error = report.worst_objective_error.max(error);
            report.worst_row_error = report.worst_row_error.max(run.row_error);
        }
    }

    fn report(mut self) -> SolverReport {
        self.times.sort_by(f64::total_cmp);
        self.iterations.sort_unstable();
        self.report.median_us = percentile(&self.times, 50).unwrap_or(f64::NAN);
        self.report.p99_us = percentile(&self.times, 99).unwrap_or(f64::NAN);
        self.report.max_us = self.times.last().copied().unwrap_or(f64::NAN);
        self.report.iterations_median = percentile(&self.iterations, 50).unwrap_or(0);
        let total: usize = self.iterations.iter().sum();
        self.report.iterations_mean = total as f64 / self.iterations.len() as f64;
        self.report.iterations_max = self.iterations.last().copied().unwrap_or(0);
        self.report
    }
}
