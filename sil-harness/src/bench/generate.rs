//! Programs from flights: real scans, real paths, feasible and not.

use super::Instance;
use crate::cycles::{planner, record, settings};
use crate::run::FlyError;
use crate::scenario::{Preset, Scenario};

/// Obstacles of the flights, in turn: from the paper's fields to ones that often cannot be passed.
const DENSITIES: [usize; 4] = [20, 30, 40, 60];

/// The first `count` programs that the planner meets in flights of a preset, from seed `seed` on.
///
/// # Errors
/// [`FlyError`].
pub fn generate(preset: Preset, count: usize, seed: u64) -> Result<Vec<Instance>, FlyError> {
    let mut instances = Vec::with_capacity(count);
    let mut flight = 0;
    while instances.len() < count {
        let scenario = Scenario {
            obstacles: DENSITIES[flight % DENSITIES.len()],
            ..Scenario::new(preset, seed + flight as u64)
        };
        collect(&scenario, count, &mut instances)?;
        flight += 1;
    }
    Ok(instances)
}

/// Flies a scenario, and plans again from every place where it was planned.
fn collect(
    scenario: &Scenario,
    count: usize,
    instances: &mut Vec<Instance>,
) -> Result<(), FlyError> {
    let mut settings = settings(scenario)?;
    // Rounds of linearisation have a model each; these programs share one, soft rows and all.
    settings.planner.iteration = None;
    let mut planner = planner(&settings)?;
    for inputs in record(scenario)? {
        planner.begin(inputs.time, &inputs.state, &inputs.conditions, &inputs.scan);
        let mut known = 0;
        while planner.advance() && instances.len() < count {
            let Some(problem) = planner.program() else {
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
                instances.push(Instance::of_program(
                    name,
                    planner.model(),
                    &settings.planner.weights,
                    problem,
                ));
            }
        }
    }
    Ok(())
}
