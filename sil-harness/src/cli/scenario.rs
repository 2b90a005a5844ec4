//! The arguments of every command that flies: a scenario file, and flags that take precedence over
//! it.

use super::answer::Failure;
use super::help::{PLANNER, WORLD};
use super::values::{Item, generator, navigation, number, scene, whole};
use crate::files::{read_aircraft, read_field, read_lidar, read_scenario};
use mpp_analysis::campaign::{Lists, NamedField};
use mpp_sim::aircraft_file::AircraftModel;
use mpp_sim::generator::GeneratorName;
use mpp_sim::scenario::{LidarTable, NavigationSource, Scenario, ScenarioFile, TICK_MS};
use mpp_sim::scene::Scene;
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct ScenarioArgs {
    /// Scenario (TOML, as docs/scenarios/example.toml); the other flags take precedence over it
    #[arg(long, help_heading = WORLD, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Challenge scene; it stands alone unless --obstacles is given
    #[arg(long, help_heading = WORLD, value_parser = scene())]
    scene: Option<Scene>,
    /// Aircraft, of plant and core: reference, paper, example, aerosonde, zagi, cessna182, aerosonde2, x8, ultrastick,
    /// rascal, delta, or a file (TOML, as docs/aircraft.md describes) [default: reference]
    #[arg(long, help_heading = WORLD, value_name = "NAME|FILE")]
    aircraft: Option<String>,
    /// Factor on the lengths of random field, scene, lidar and strict band [default: that of the aircraft's
    /// speed squared]
    #[arg(long, help_heading = WORLD, value_name = "FACTOR", value_parser = number)]
    world_scale: Option<f64>,
    /// Lidar (TOML, as docs/lidars/example.toml); its keys take precedence over the scenario's
    #[arg(long, help_heading = WORLD, value_name = "FILE")]
    lidar: Option<PathBuf>,
    /// Source of positions: their rate, errors and delay [default: rtk; of presets paper and reference: ideal]
    #[arg(long, help_heading = WORLD, value_parser = navigation())]
    navigation: Option<NavigationSource>,
    /// Simulated time from the start of a planning cycle until its plan is flown [ms], a multiple of 10 [default: 10]
    #[arg(long, help_heading = PLANNER, value_parser = whole::<u32>())]
    latency_ms: Option<u32>,
    /// Planner slices that run between two ticks [default: all that the cycle needs]
    #[arg(long, help_heading = PLANNER, value_parser = whole::<u32>())]
    slices_per_tick: Option<u32>,
    /// Length of the flight [s], a multiple of 0.01 [default: 20]
    #[arg(long, help_heading = WORLD, value_parser = number)]
    duration: Option<f64>,
}

impl ScenarioArgs {
    /// Reads the scenario file. The flags replace its values.
    pub(super) fn file(&self) -> Result<ScenarioFile, Failure> {
        let mut file = match &self.scenario {
            Some(path) => read_scenario(path)?,
            None => ScenarioFile::default(),
        };
        if let Some(lidar) = self.lidar()? {
            file.lidar = lidar.before(&file.lidar);
        }
        replace(&mut file.scene, self.scene);
        if let Some(aircraft) = &self.aircraft {
            file.aircraft = Some(read_aircraft(aircraft)?);
        }
        replace(&mut file.world_scale, self.world_scale);
        replace(&mut file.navigation.source, self.navigation);
        replace(&mut file.latency_ms, self.latency_ms);
        replace(&mut file.slices_per_tick, self.slices_per_tick);
        replace(&mut file.duration, self.duration);
        Ok(file)
    }

    /// Reads the lidar's file, if there is one.
    fn lidar(&self) -> Result<Option<LidarTable>, Failure> {
        let read = |path: &PathBuf| Ok(read_lidar(path)?);
        self.lidar.as_ref().map(read).transpose()
    }

    /// These flags, each with whether it asks for something else than this scenario.
    ///
    /// # Errors
    /// A [`Failure`] when a file cannot be read.
    pub(super) fn other_than(
        &self,
        flown: &Scenario,
    ) -> Result<[(&'static str, bool); 8], Failure> {
        let lidar = self.lidar()?;
        let other_lidar = lidar.is_some_and(|table| table.over(flown.lidar) != flown.lidar);
        let aircraft = self.aircraft.as_ref().is_some_and(|asked| {
            let asked = read_aircraft(asked)
                .ok()
                .and_then(|file| AircraftModel::new(file).ok());
            asked.is_none_or(|asked| asked.plane() != flown.aircraft)
        });
        let seconds = (self.duration).is_some_and(|asked| (asked - flown.duration()).abs() > 1e-6);
        let navigation = self.navigation.map(NavigationSource::config);
        let latency_ms = flown.latency_ticks * TICK_MS;
        Ok([
            ("--lidar", other_lidar),
            ("--scene", self.scene.is_some() && self.scene != flown.scene),
            ("--aircraft", aircraft),
            ("--world-scale", other(self.world_scale, flown.world_scale)),
            ("--navigation", other(navigation, flown.navigation)),
            ("--latency-ms", other(self.latency_ms, latency_ms)),
            (
                "--slices-per-tick",
                other(self.slices_per_tick, flown.slices_per_tick),
            ),
            ("--duration", seconds),
        ])
    }

    /// Whether a file was given.
    pub(super) fn has_file(&self) -> bool {
        self.scenario.is_some()
    }
}

/// The fields of a grid of cells. Each list that is given takes precedence over the scenario.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct FieldArgs {
    /// Field of obstacles (TOML, as docs/fields.md); given again, each is a cell. It stands alone unless
    /// --obstacles is given
    #[arg(long, help_heading = WORLD, value_name = "FILE")]
    field: Vec<PathBuf>,
    /// Generators of random obstacles, a list [default: the scenario's, else paper]
    #[arg(long, help_heading = WORLD, value_delimiter = ',', value_parser = Item(generator()))]
    generator: Vec<GeneratorName>,
    /// Numbers of random obstacles, a list such as 20,40 [default: the scenario's]
    #[arg(long, help_heading = WORLD, value_delimiter = ',', value_parser = Item(whole::<usize>()))]
    obstacles: Vec<usize>,
}

impl FieldArgs {
    /// The lists of a campaign that has no others.
    pub(super) fn lists(&self) -> Result<Lists, Failure> {
        let named = |path: &PathBuf| {
            Ok::<_, Failure>(NamedField {
                name: path.display().to_string(),
                content: read_field(path)?,
            })
        };
        Ok(Lists {
            field: self.field.iter().map(named).collect::<Result<_, _>>()?,
            generator: self.generator.clone(),
            obstacles: self.obstacles.clone(),
            ..Lists::default()
        })
    }
}

/// Whether a flag asks for another value than this one.
pub(super) fn other<T: Copy + PartialEq>(flag: Option<T>, flown: T) -> bool {
    flag.is_some_and(|asked| asked != flown)
}

/// Takes a flag's value if it was given.
pub(super) fn replace<T>(place: &mut Option<T>, flag: Option<T>) {
    if flag.is_some() {
        *place = flag;
    }
}
