//! What every command that flies takes: a scenario file, and flags that go before it.

use super::{Failure, USAGE};
use crate::scenario::{AirframeName, ScenarioFile};
use crate::scene::Scene;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct ScenarioArgs {
    /// Scenario (TOML, as docs/scenarios/example.toml); the other flags go before it
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Challenge scene, alone unless --obstacles says otherwise
    #[arg(long, value_enum)]
    scene: Option<Scene>,
    /// Aircraft, as it is and as the core knows it [default: reference]
    #[arg(long, value_enum)]
    airframe: Option<AirframeName>,
    /// Simulated time from a scan until its plan is flown [ms], a multiple of 10 [default: 10]
    #[arg(long)]
    latency_ms: Option<u32>,
    /// Planner slices that run between two ticks [default: until the cycle is done]
    #[arg(long)]
    slices_per_tick: Option<u32>,
    /// Length of the flight [s] [default: 20]
    #[arg(long)]
    duration: Option<u32>,
}

impl ScenarioArgs {
    /// The file, with what these flags say put in its place.
    pub(super) fn file(&self) -> Result<ScenarioFile, Failure> {
        let mut file = match &self.scenario {
            Some(path) => ScenarioFile::read(path).map_err(|error| Failure::new(USAGE, error))?,
            None => ScenarioFile::default(),
        };
        replace(&mut file.scene, self.scene);
        replace(&mut file.airframe, self.airframe);
        replace(&mut file.latency_ms, self.latency_ms);
        replace(&mut file.slices_per_tick, self.slices_per_tick);
        replace(&mut file.duration, self.duration);
        Ok(file)
    }
}

/// Takes a flag's value if it was given.
pub(super) fn replace<T>(place: &mut Option<T>, flag: Option<T>) {
    if flag.is_some() {
        *place = flag;
    }
}
