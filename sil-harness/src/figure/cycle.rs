//! One planning cycle of a flight, looked at from outside.

use super::FigureError;
use crate::cycles::{Inputs, planner, record, settings};
use crate::scenario::Scenario;
use crate::world::{ObstacleField, Point};
use mpp_core::config::{ORIGIN_COL, ORIGIN_ROW, STAGE_PERIOD};
use mpp_core::map::{GridPoint, OccupancyGrid};
use mpp_core::plan::CollocationPoints;
use mpp_core::qp::{Condensed, Problem, Solution, Solver, Status};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::VehicleState;

/// One candidate path, and what became of it.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its collocation points.
    pub points: CollocationPoints,
    /// The trajectory that it was refined into, as world positions [m]; none if there is none that
    /// keeps every row.
    pub refined: Option<Vec<Point>>,
}

/// A planning cycle: what it saw, what it considered, what it chose.
#[derive(Clone, Debug)]
pub struct Cycle {
    /// The aircraft.
    pub state: VehicleState,
    /// The true obstacles.
    pub field: ObstacleField,
    /// Where each beam with a return ended [m].
    pub hits: Vec<Point>,
    /// Angle of the lowest and of the highest beam in the world [rad].
    pub fan: (f64, f64),
    /// Greatest range of the lidar [m].
    pub range_max: f64,
    /// The padded grid.
    pub grid: OccupancyGrid,
    /// The candidates in their order.
    pub candidates: Vec<Candidate>,
    /// The trajectory that is flown.
    pub chosen: Trajectory,
}

impl Cycle {
    /// The cycle that begins at a tick of a flight.
    ///
    /// # Errors
    /// [`FigureError::Cycle`] when the flight does not get there, or nothing can be planned.
    pub fn of_flight(scenario: &Scenario, tick: u32) -> Result<Self, FigureError> {
        let until = Scenario {
            ticks: tick + 1,
            ..scenario.clone()
        };
        let mut earlier = record(&until).map_err(failed)?;
        let last = earlier.pop();
        let Some(inputs) = last.filter(|last| last.time > Scenario::time(tick) - 1e-9) else {
            let why = "no cycle of the flight begins at the tick";
            return Err(FigureError::Cycle(why.to_owned()));
        };
        let (grid, candidates, chosen) = plan(scenario, &earlier, &inputs)?;
        let Inputs {
            truth, state, scan, ..
        } = inputs;
        let ends =
            |beam: usize| truth.air.pitch + scan.angle_min + scan.angle_increment * beam as f64;
        let hit = |(beam, range): (usize, &f32)| {
            let (up, ahead) = libm::sincos(ends(beam));
            let range = f64::from(*range);
            (range > 0.0).then_some((truth.x + range * ahead, truth.z + range * up))
        };
        Ok(Self {
            hits: scan.ranges.iter().enumerate().filter_map(hit).collect(),
            fan: (ends(0), ends(scan.ranges.len().saturating_sub(1))),
            range_max: scenario.lidar.range_max,
            state,
            field: scenario.field(),
            grid,
            candidates,
            chosen,
        })
    }

    /// A grid point in the world [m].
    #[must_use]
    pub fn world(&self, point: &GridPoint) -> Point {
        world(&self.state, point)
    }
}

fn world(state: &VehicleState, point: &GridPoint) -> Point {
    let aircraft = (ORIGIN_COL as f64, ORIGIN_ROW as f64);
    (
        state.x + point.col - aircraft.0,
        state.z + point.row - aircraft.1,
    )
}

fn failed(error: impl std::fmt::Display) -> FigureError {
    FigureError::Cycle(error.to_string())
}

/// Plans as in flight, and refines every candidate to its end, however dear: the planner itself stops at
/// the cost of the best one.
fn plan(
    scenario: &Scenario,
    earlier: &[Inputs],
    inputs: &Inputs,
) -> Result<(OccupancyGrid, Vec<Candidate>, Trajectory), FigureError> {
    let settings = settings(scenario).map_err(failed)?;
    let mut planner = planner(&settings).map_err(failed)?;
    let mut shared = Box::new(Condensed::new());
    shared
        .condense(planner.model(), &settings.planner.weights)
        .map_err(|error| FigureError::Cycle(format!("{error:?}")))?;
    // The planner's random numbers go on from cycle to cycle.
    for inputs in earlier {
        planner.begin(inputs.time, &inputs.state, &inputs.conditions, &inputs.scan);
        while planner.advance() {}
        planner.finish();
    }
    let mut candidates = Vec::new();
    let mut solver = Box::new(Solver::new());
    planner.begin(inputs.time, &inputs.state, &inputs.conditions, &inputs.scan);
    while planner.advance() {
        let Some(problem) = planner.program() else {
            continue;
        };
        if planner.summary().candidates == candidates.len() {
            let cruise = planner.trim().state.airspeed;
            candidates.push(Candidate {
                points: *planner.points(),
                refined: refined(&mut solver, &shared, problem, &inputs.state, cruise),
            });
        }
    }
    planner.finish();
    Ok((planner.grid().clone(), candidates, planner.best().clone()))
}

/// World positions of a candidate's trajectory, if it keeps every row.
fn refined(
    solver: &mut Solver,
    shared: &Condensed,
    problem: &Problem,
    state: &VehicleState,
    cruise: f64,
) -> Option<Vec<Point>> {
    let problem = Problem {
        cost_limit: f64::INFINITY,
        ..*problem
    };
    let mut solution = Solution::new();
    let solved = solver.solve(shared, &problem) == Status::Optimal
        && solver.solution(shared, &mut solution) == Status::Optimal
        && solution.violation < 1e-6;
    let place = |(stage, knot): (usize, &[f64; 6])| {
        let level = cruise * STAGE_PERIOD * stage as f64;
        (state.x + level + knot[0], state.z + knot[1])
    };
    solved.then(|| solution.states.iter().enumerate().map(place).collect())
}
