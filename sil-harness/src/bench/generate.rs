//! Programs from flights: real scans, real paths, feasible and not.

use super::Instance;
use crate::lidar::Lidar;
use crate::link::PipeLink;
use crate::run::{FlyError, fly, wire_scan};
use crate::scenario::{Preset, Scenario};
use mpp_core::planner::{Planner, SetupError};
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{AirState, VehicleState};
use std::fmt;

/// Obstacles of the flights, in turn: from the paper's fields to ones that often cannot be passed.
const DENSITIES: [usize; 4] = [20, 30, 40, 60];

/// Why programs could not be generated.
#[derive(Debug)]
pub enum GenerateError {
    /// A flight failed.
    Fly(FlyError),
    /// The planner could not be set up.
    SetUp(SetupError),
}

impl fmt::Display for GenerateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fly(error) => write!(f, "{error}"),
            Self::SetUp(error) => write!(f, "the planner cannot be set up: {error:?}"),
        }
    }
}

impl std::error::Error for GenerateError {}

/// The first `count` programs that the planner meets in flights of a preset, from seed `seed` on.
///
/// # Errors
/// [`GenerateError`].
pub fn generate(preset: Preset, count: usize, seed: u64) -> Result<Vec<Instance>, GenerateError> {
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
) -> Result<(), GenerateError> {
    let mut moments: Vec<(f64, VehicleState, AirState)> = Vec::new();
    let mut number = 0;
    fly(scenario, &mut PipeLink::new(), |moment| {
        if number % scenario.replan_ticks == 0 {
            moments.push((moment.tick.t, moment.tick.state, moment.tick.estimate));
        }
        number += 1;
    })
    .map_err(GenerateError::Fly)?;

    let field = scenario.field();
    let mut lidar = Lidar::new(scenario.seed, scenario.lidar);
    let mut settings = match scenario.preset {
        Preset::Reference => Settings::reference(),
        Preset::Paper => Settings::paper(),
        Preset::Flight => Settings::flight(),
    };
    // Rounds of linearisation have a model each; these programs share one, soft rows and all.
    settings.planner.iteration = None;
    settings.planner.seed = scenario.seed;
    let mut planner = Box::new(Planner::new());
    planner.set_up(&settings).map_err(GenerateError::SetUp)?;
    for (time, truth, estimate) in moments {
        let wire = wire_scan(scenario, 0, &lidar.scan(&truth, &field));
        let scan = LidarScan {
            angle_min: f64::from(wire.angle_min),
            angle_increment: f64::from(wire.angle_increment),
            ranges: wire.ranges,
        };
        let state = VehicleState {
            air: estimate,
            ..truth
        };
        planner.begin(time, &state, &scan);
        let mut known = 0;
        while planner.advance() && instances.len() < count {
            let Some(problem) = planner.program() else {
                continue;
            };
            let candidate = planner.summary().candidates + 1;
            if candidate != known {
                known = candidate;
                let name = format!(
                    "{}-seed{}-t{time:.0}-{candidate}",
                    scenario.preset.name(),
                    scenario.seed
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
