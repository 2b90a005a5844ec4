//! `space --flights`: the planner of the vertical plane on the plant in six degrees of freedom, with the course held.

use super::answer::{Failure, data};
use crate::files::read_aircraft;
use mpp_analysis::aircraft::flown_cells;
use mpp_analysis::campaign::wilson;
use mpp_sim::aircraft_file::AircraftModel;
use mpp_sim::flight::{fly, fly_in};
use mpp_sim::orders::Ground;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Scenario, ScenarioFile};
use mpp_sim::space::CourseHold;
use mpp_sim::world::World;
use std::fmt::Display;

/// A ground that gives no orders.
struct Nobody;

impl Ground for Nobody {}

fn usage(error: impl Display) -> Failure {
    Failure::usage(error)
}

fn failure(error: impl Display) -> Failure {
    Failure::failed(error)
}

/// Flies the same fields in the plane and in space, past 20 and 40 obstacles that are scaled to the aircraft, and prints both
/// rates of strict success.
pub(super) fn courses(
    aircraft: &str,
    flights: u32,
    first_seed: u64,
    gusts: f64,
) -> Result<u8, Failure> {
    let file = read_aircraft(aircraft)?;
    let model = AircraftModel::new(file.clone()).map_err(usage)?;
    for (obstacles, replan_hz) in flown_cells(&[20, 40], model.units().time) {
        let mut strict = [0; 2];
        for seed in (first_seed..).take(flights as usize) {
            let scenario = ScenarioFile {
                aircraft: Some(file.clone()),
                obstacles: Some(obstacles),
                replan_hz: Some(replan_hz),
                seed: Some(seed),
                ..ScenarioFile::default()
            };
            let mut scenario = scenario.build().map_err(usage)?;
            scenario.faults.gusts.intensity = gusts;
            let [plane, space] = &mut strict;
            *plane += u32::from(in_plane(&scenario)?);
            *space += u32::from(in_space(&scenario, &model)?);
        }
        let told = strict.map(|strict| {
            let (low, high) = wilson(strict, flights);
            format!("{strict} [{:.1}, {:.1} %]", 100.0 * low, 100.0 * high)
        });
        let [plane, space] = told;
        data(format_args!(
            "{aircraft}: {obstacles} obstacles at {replan_hz} Hz: strict successes of {flights} in the plane {plane}, in space {space}"
        ))?;
    }
    Ok(0)
}

fn in_plane(scenario: &Scenario) -> Result<bool, Failure> {
    let log = fly(scenario, &mut PipeLink::of(scenario), |_| {}).map_err(failure)?;
    Ok(log.summary.strict)
}

fn in_space(scenario: &Scenario, model: &AircraftModel) -> Result<bool, Failure> {
    let mut world = World::of(scenario).map_err(usage)?;
    // The scenario has the aircraft's part in the plane alone.
    let whole = Scenario {
        aircraft: model.clone(),
        ..scenario.clone()
    };
    world.plant = Box::new(CourseHold::new(&whole).map_err(usage)?);
    let mut link = PipeLink::of(scenario);
    let log = fly_in(&mut world, scenario, &mut link, &mut Nobody).map_err(failure)?;
    Ok(log.summary.strict)
}
