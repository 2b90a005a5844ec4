//! A program of one candidate, in the words of the paper, and its files.
//!
//! Two kinds of file hold programs: the recorded `case_*.json` of the reference data, and lists of
//! [`Instance`] as JSON lines, which `bench qp --export` writes and other solvers read.

use crate::check_reference::recorded_instances;
use mpp_core::config::{DIRECTIONS, KNOTS};
use mpp_core::corridor::{Corridor, DIRECTION_VECTORS};
use mpp_core::qp::{
    Bounds, CondenseError, Condensed, Penalty, Problem, RowKind, StageModel, Weights,
};
use nalgebra::{Matrix6, Matrix6x2};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};

/// One program: everything that a solver needs.
///
/// States are `(x, z, v, theta, theta', gamma)` and controls `(elevator, thrust)`, deviations from
/// level flight; SI units and radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instance {
    /// Where it comes from.
    pub name: String,
    /// `x_{k+1} = a x_k + b u_k`: 6 x 6, rows.
    pub a: [[f64; 6]; 6],
    /// 6 x 2, rows.
    pub b: [[f64; 2]; 6],
    /// Weights of squared controls.
    pub control_weight: [f64; 2],
    /// Weight of the squared distance from the target.
    pub terminal_weight: f64,
    /// First state.
    pub initial: [f64; 6],
    /// Where the last state should be.
    pub target: [f64; 6],
    /// Unit vectors `(x, z)` of the half-planes.
    pub directions: [[f64; 2]; DIRECTIONS],
    /// `directions[i] . (x_k, z_k) <= position_bounds[k][i]`.
    pub position_bounds: Vec<[f64; DIRECTIONS]>,
    /// Thrust may fall by at most this much.
    pub thrust_reserve: f64,
    /// `(angle of attack, flight path)`, upper then lower limits, if bounded.
    pub attitude: Option<[[f64; 2]; 2]>,
    /// `(linear, quadratic)` price of violating position and attitude rows; none makes them hard.
    pub penalty: Option<[f64; 2]>,
    /// The least uniform relaxation of all rows that makes the program feasible, where recorded.
    pub margin: Option<f64>,
    /// The optimal cost, where recorded.
    pub cost: Option<f64>,
}

impl Instance {
    /// A program as the planner has it; its bounds are read back from the rows.
    #[must_use]
    pub fn of_program(
        name: String,
        model: &StageModel,
        weights: &Weights,
        problem: &Problem,
    ) -> Self {
        let mut position_bounds = vec![[f64::INFINITY; DIRECTIONS]; KNOTS];
        let mut limits = [f64::INFINITY; 4];
        let mut thrust_reserve = f64::INFINITY;
        for (row, bound) in problem.bounds.0.iter().enumerate() {
            match RowKind::of(row) {
                RowKind::Position(knot, direction) => position_bounds[knot][direction] = *bound,
                RowKind::Attitude(_, side) => limits[side] = *bound,
                RowKind::Thrust(_) => thrust_reserve = *bound,
            }
        }
        let [attack, path, minus_attack, minus_path] = limits;
        let bounded = limits.iter().all(|limit| limit.is_finite());
        Self {
            name,
            a: core::array::from_fn(|row| core::array::from_fn(|col| model.a[(row, col)])),
            b: core::array::from_fn(|row| core::array::from_fn(|col| model.b[(row, col)])),
            control_weight: weights.control,
            terminal_weight: weights.terminal,
            initial: problem.initial,
            target: problem.target,
            directions: DIRECTION_VECTORS.map(|[up, forward]| [forward, up]),
            position_bounds,
            thrust_reserve,
            attitude: bounded.then_some([[attack, path], [-minus_attack, -minus_path]]),
            penalty: problem
                .penalty
                .map(|penalty| [penalty.linear, penalty.quadratic]),
            margin: None,
            cost: None,
        }
    }

    /// The model that all programs of a cycle share.
    #[must_use]
    pub fn model(&self) -> StageModel {
        StageModel {
            a: Matrix6::from_fn(|row, col| self.a[row][col]),
            b: Matrix6x2::from_fn(|row, col| self.b[row][col]),
            initial: Matrix6::identity(),
        }
    }

    /// Its weights.
    #[must_use]
    pub fn weights(&self) -> Weights {
        Weights {
            control: self.control_weight,
            terminal: self.terminal_weight,
        }
    }

    /// Model and weights, condensed.
    ///
    /// # Errors
    /// [`CondenseError`] when the Hessian is not positive definite.
    pub fn condense(&self) -> Result<Box<Condensed>, CondenseError> {
        let mut shared = Box::new(Condensed::new());
        shared.condense(&self.model(), &self.weights())?;
        Ok(shared)
    }

    /// Whether two programs share model and weights.
    #[must_use]
    pub fn shares_model(&self, other: &Self) -> bool {
        let bits = |instance: &Self| {
            let model = instance
                .a
                .as_flattened()
                .iter()
                .chain(instance.b.as_flattened());
            let weights = instance
                .control_weight
                .iter()
                .chain([&instance.terminal_weight]);
            model
                .chain(weights)
                .map(|value| value.to_bits())
                .collect::<Vec<_>>()
        };
        bits(self) == bits(other)
    }

    /// The program as the core takes it.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let mut corridor = Corridor::new();
        for (ours, theirs) in corridor.bounds.iter_mut().zip(&self.position_bounds) {
            *ours = *theirs;
        }
        let mut bounds = Bounds::none();
        bounds.set_corridor(&corridor);
        bounds.set_thrust(self.thrust_reserve);
        if let Some([upper, lower]) = self.attitude {
            bounds.set_attitude(upper, lower);
        }
        Problem {
            initial: self.initial,
            target: self.target,
            bounds,
            penalty: self
                .penalty
                .map(|[linear, quadratic]| Penalty { linear, quadratic }),
            cost_limit: f64::INFINITY,
        }
    }

    fn check(&self) -> Result<(), String> {
        if self.position_bounds.len() != KNOTS {
            let found = self.position_bounds.len();
            return Err(format!(
                "position_bounds has {found} stages instead of {KNOTS}"
            ));
        }
        let vectors = DIRECTION_VECTORS.map(|[up, forward]| [forward, up]);
        let far = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > 1e-9;
        if self.directions.iter().zip(&vectors).any(|(a, b)| far(a, b)) {
            return Err("directions are not the eight of this crate".to_owned());
        }
        Ok(())
    }
}

/// Programs that cannot be read or written.
#[derive(Debug)]
pub enum InstanceError {
    /// A file or directory cannot be read or written.
    Io(PathBuf, std::io::Error),
    /// A file does not hold what it should.
    Content(PathBuf, String),
}

impl fmt::Display for InstanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Content(path, why) => write!(f, "{}: {why}", path.display()),
        }
    }
}

impl std::error::Error for InstanceError {}

/// Reads programs: a directory's recorded cases (`case_*.json`), one such file, or a file of
/// instances, a JSON object a line.
///
/// # Errors
/// [`InstanceError`]; also when there is nothing to read.
pub fn read_instances(path: &Path) -> Result<Vec<Instance>, InstanceError> {
    let io = |error| InstanceError::Io(path.to_owned(), error);
    let mut files = Vec::new();
    if path.is_dir() {
        for entry in std::fs::read_dir(path).map_err(io)? {
            let file = entry.map_err(io)?.path();
            if is_recorded_case(&file) {
                files.push(file);
            }
        }
        files.sort();
    } else {
        files.push(path.to_owned());
    }
    let mut instances = Vec::new();
    for file in files {
        instances.extend(read_file(&file)?);
    }
    if instances.is_empty() {
        let why = "no programs: give a file of instances or a directory with case_*.json";
        return Err(InstanceError::Content(path.to_owned(), why.to_owned()));
    }
    Ok(instances)
}

fn is_recorded_case(path: &Path) -> bool {
    let name = path
        .file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default();
    name.starts_with("case_") && name.ends_with(".json")
}

fn read_file(path: &Path) -> Result<Vec<Instance>, InstanceError> {
    let content = |why| InstanceError::Content(path.to_owned(), why);
    let text =
        std::fs::read_to_string(path).map_err(|error| InstanceError::Io(path.to_owned(), error))?;
    let instances = if is_recorded_case(path) {
        recorded_instances(
            &path.file_stem().unwrap_or_default().to_string_lossy(),
            &text,
        )
    } else {
        text.lines()
            .filter(|line| !line.trim().is_empty())
            .map(serde_json::from_str)
            .collect()
    };
    let instances: Vec<Instance> = instances.map_err(|error| content(error.to_string()))?;
    for instance in &instances {
        instance
            .check()
            .map_err(|why| content(format!("{}: {why}", instance.name)))?;
    }
    Ok(instances)
}

/// Writes programs, a JSON object a line.
///
/// # Errors
/// [`InstanceError`].
pub fn write_instances(path: &Path, instances: &[Instance]) -> Result<(), InstanceError> {
    let io = |error| InstanceError::Io(path.to_owned(), error);
    let mut file = std::io::BufWriter::new(std::fs::File::create(path).map_err(io)?);
    for instance in instances {
        let line = serde_json::to_string(instance)
            .map_err(|error| InstanceError::Content(path.to_owned(), error.to_string()))?;
        writeln!(file, "{line}").map_err(io)?;
    }
    file.flush().map_err(io)
}
