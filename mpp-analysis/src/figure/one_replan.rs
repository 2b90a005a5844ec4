//! One planning cycle of a flight, seen from outside.

use super::error::FigureError;
use crate::recording::{Inputs, planner, record, settings};
use mpp_core::config::STAGE_PERIOD;
use mpp_core::paper::config::{ORIGIN_COL, ORIGIN_ROW};
use mpp_core::paper::{CollocationPoints, GridPoint, OccupancyGrid};
use mpp_core::qp::{Condensed, Problem, Solution, Solver, Status};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::VehicleState;
use mpp_sim::field::{ObstacleField, Point};
use mpp_sim::scenario::Scenario;

/// One candidate path and its trajectory.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its collocation points.
    pub points: CollocationPoints,
    /// The refined trajectory as world positions \[m\]; `None` if no trajectory keeps every row.
    pub refined: Option<Vec<Point>>,
}

/// A planning cycle: its scan and grid, its candidates, and its choice.
#[derive(Clone, Debug)]
pub struct OneReplan {
    /// State of the aircraft.
    pub state: VehicleState,
    /// The true obstacles.
    pub field: ObstacleField,
    /// Positions where the beams with a return ended \[m\].
    pub hits: Vec<Point>,
    /// Angle of the lowest and of the highest beam in the world \[rad\].
    pub fan: (f64, f64),
    /// Greatest range of the lidar \[m\].
    pub range_max: f64,
    /// The padded grid.
    pub grid: OccupancyGrid,
    /// The candidates in their order.
    pub candidates: Vec<Candidate>,
    /// The trajectory that is flown.
    pub chosen: Trajectory,
}

impl OneReplan {
    /// The cycle that begins at a tick of a flight.
    ///
    /// # Errors
    /// [`FigureError`] when the flight does not reach the tick, or when nothing can be planned.
    pub fn of_flight(scenario: &Scenario, tick: u32) -> Result<Self, FigureError> {
        let until = Scenario {
            ticks: tick + 1,
            ..scenario.clone()
        };
        let mut earlier = record(&until).map_err(FigureError::Flight)?;
        let last = earlier.pop();
        let Some(inputs) = last.filter(|last| last.time > Scenario::time(tick) - 1e-9) else {
            return Err(FigureError::NoCycle(tick));
        };
        let (grid, candidates, chosen) = plan(scenario, &earlier, &inputs)?;
        let Inputs {
            truth, state, scan, ..
        } = inputs;
        let ends = |beam: usize| truth.air.pitch + scan.beam_angle(beam);
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

    /// A grid point in the world \[m\].
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

/// Plans as in flight, and refines every candidate to its end, whatever it costs. The planner
/// itself stops at the cost of the best candidate.
fn plan(
    scenario: &Scenario,
    earlier: &[Inputs],
    inputs: &Inputs,
) -> Result<(OccupancyGrid, Vec<Candidate>, Trajectory), FigureError> {
    let settings = settings(scenario).map_err(FigureError::Flight)?;
    let mut planner = planner(&settings).map_err(FigureError::Flight)?;
    let model = *planner.paper().ok_or(FigureError::NotPapers)?.model();
    let mut shared = Box::new(Condensed::new());
    shared
        .condense(&model.dynamics(), &settings.planner.weights)
        .map_err(FigureError::Condense)?;
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
        let paper = planner.paper().ok_or(FigureError::NotPapers)?;
        let Some(problem) = paper.program() else {
            continue;
        };
        if planner.summary().candidates == candidates.len() {
            let cruise = planner.trim().state.airspeed;
            candidates.push(Candidate {
                points: *paper.points(),
                refined: refined(&mut solver, &shared, problem, &inputs.state, cruise),
            });
        }
    }
    planner.finish();
    let grid = planner
        .paper()
        .ok_or(FigureError::NotPapers)?
        .grid()
        .clone();
    Ok((grid, candidates, planner.best().clone()))
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
