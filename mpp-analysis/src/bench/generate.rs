//! Programs from flights, with real scans and real paths. Some are feasible and some are not.

use crate::instance::Instance;
use crate::recording::{planner, record, settings};
use mpp_core::planner::Planner;
use mpp_core::planner::plane::PlanePlanner;
use mpp_core::qp::Dynamics;
use mpp_sim::flight::FlyError;
use mpp_sim::scenario::{Preset, Scenario};

/// Numbers of obstacles in the flights, used in turn. They go from the paper's fields to fields
/// that often cannot be passed.
pub const SPARSE: [usize; 4] = [20, 30, 40, 60];

/// The same for dense fields, whose programs take many more steps.
pub const DENSE: [usize; 4] = [120, 160, 200, 240];

/// The first `count` programs that the planner meets in flights of a preset past these numbers of obstacles, from seed `seed`
/// on.
///
/// # Errors
/// [`FlyError`].
pub fn generate(
    preset: Preset,
    obstacles: [usize; 4],
    count: usize,
    seed: u64,
) -> Result<Vec<Instance>, FlyError> {
    let mut instances = Vec::with_capacity(count);
    let mut flight = 0;
    while instances.len() < count {
        let scenario = Scenario {
            obstacles: obstacles[flight % obstacles.len()],
            ..Scenario::new(preset, seed + flight as u64)
        };
        collect(&scenario, count, &mut instances)?;
        flight += 1;
    }
    Ok(instances)
}

/// Flies a scenario, and repeats every planning cycle of the flight.
fn collect(
    scenario: &Scenario,
    count: usize,
    instances: &mut Vec<Instance>,
) -> Result<(), FlyError> {
    let settings = settings(scenario)?;
    let mut planner = planner(&settings)?;
    for inputs in record(scenario)? {
        planner.begin(inputs.time, &inputs.state, &inputs.conditions, &inputs.scan);
        let mut known = 0;
        while planner.advance() && instances.len() < count {
            let Some((_, problem)) = planner.candidate() else {
                continue;
            };
            let candidate = planner.summary().candidates + 1;
            if candidate != known {
                known = candidate;
                let name = format!(
                    "{}-seed{}-t{:.0}-{candidate}",
                    scenario.preset.name(),
                    scenario.seed,
                    inputs.time
                );
                let weights = &settings.planner.weights;
                let stages = stages(&planner);
                instances.push(Instance::of_program(name, &stages, weights, &problem));
            }
        }
    }
    Ok(())
}

/// The dynamics of the present candidate. The paper's method has one for all stages, and the flight
/// planner has one for each stage.
fn stages(planner: &Planner) -> Vec<Dynamics> {
    let flight = || {
        let flight = planner.plane().and_then(PlanePlanner::stages);
        flight.map_or_else(Vec::new, |stages| stages.to_vec())
    };
    planner
        .paper()
        .map_or_else(flight, |paper| vec![paper.model().dynamics()])
}
