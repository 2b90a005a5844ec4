//! `ceiling --preset space`: which forests an aircraft that banks can pass at all.

use super::answer::{Failure, print};
use super::help::{CEILING_IN_SPACE, OUTPUT, PLANNER, RUN, WORLD};
use super::loudness::progress_bar;
use super::signals::Signals;
use super::values::{Item, densities, number, seed, threads, within, world};
use crate::files::read_aircraft;
use mpp_analysis::ceiling::{Feasibility, SpaceCeilingCell, SpaceCeilingReport, decide_in_space};
use mpp_sim::aircraft_file::AircraftFile;
use mpp_sim::space::world::WorldName;
use mpp_sim::space::{SPACE, SpaceFile, SpaceScenario};
use rayon::prelude::*;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = CEILING_IN_SPACE)]
pub(super) struct CeilingInSpace {
    /// The aircraft banks, among trunks
    #[arg(long, help_heading = PLANNER, value_parser = [SPACE])]
    preset: Option<String>,
    /// Aircraft with a lateral table: a name or a file [default: ultrastick at 13 m/s]
    #[arg(long, help_heading = WORLD, value_name = "NAME|FILE")]
    aircraft: Option<String>,
    /// Airspeed of level flight [m/s] [default: that of the aircraft's file]
    #[arg(long, help_heading = WORLD, value_name = "M/S", value_parser = number)]
    airspeed: Option<f64>,
    /// World of trunks, 240 m long, drawn from the seed [default: forest]
    #[arg(long, help_heading = WORLD, value_parser = world())]
    world: Option<WorldName>,
    /// Densities of the world, a list: each is a cell
    #[arg(long, help_heading = WORLD, value_delimiter = ',', value_parser = Item(number))]
    density: Vec<f64>,
    /// Radius of a sphere that stands for wing and fuselage \[m\]
    #[arg(long, help_heading = WORLD, value_name = "M", value_parser = number)]
    sphere: Option<f64>,
    /// Number of worlds in each cell
    #[arg(long, help_heading = RUN, default_value_t = 100, value_parser = within(1, u32::MAX))]
    trials: u32,
    /// Seed of the first world; the next ones take the next seeds
    #[arg(long, help_heading = RUN, default_value_t = 1, value_parser = seed)]
    seed: u64,
    /// Number of threads, at most 1024 and no more than there is work for; 0 takes every core
    #[arg(long, help_heading = RUN, default_value_t = 0, value_parser = threads())]
    pub(super) threads: usize,
    /// Print the report as one JSON object
    #[arg(long, help_heading = OUTPUT)]
    json: bool,
}

impl CeilingInSpace {
    pub(super) fn run(&self) -> Result<u8, Failure> {
        let aircraft = self.aircraft.as_ref().map(|name| read_aircraft(name));
        let aircraft = aircraft.transpose().map_err(Failure::usage)?;
        let densities = densities(&self.density);
        // What cannot be judged is refused before anything is.
        for density in &densities {
            let scenario = self.scenario(aircraft.as_ref(), *density, self.seed)?;
            mpp_analysis::ceiling::check_in_space(&scenario).map_err(Failure::usage)?;
        }
        let signals = Signals::heed()?;
        let all = densities.len() as u64 * u64::from(self.trials);
        let progress = progress_bar(all, "worlds");
        let mut report = SpaceCeilingReport::default();
        for density in densities {
            let seeds: Vec<u64> = (self.seed..).take(self.trials as usize).collect();
            let decide = |seed: &u64| {
                if let Some(code) = signals.raised() {
                    return Err(Failure::new(code, "interrupted"));
                }
                let scenario = self.scenario(aircraft.as_ref(), density, *seed)?;
                let verdict = decide_in_space(&scenario).map_err(Failure::usage);
                progress.inc(1);
                verdict
            };
            let verdicts = seeds.par_iter().map(decide);
            let verdicts: Vec<Feasibility> = verdicts.collect::<Result<_, Failure>>()?;
            let scenario = self.scenario(aircraft.as_ref(), density, self.seed)?;
            (report.cells).push(SpaceCeilingCell::new(&scenario, &verdicts));
        }
        progress.finish_and_clear();
        print(&report, self.json)?;
        Ok(0)
    }

    fn scenario(
        &self,
        aircraft: Option<&AircraftFile>,
        density: Option<f64>,
        seed: u64,
    ) -> Result<SpaceScenario, Failure> {
        let file = SpaceFile {
            aircraft: aircraft.cloned(),
            airspeed: self.airspeed,
            world: self.world.map(|world| world.name().to_owned()),
            density,
            sphere: self.sphere,
            seed: Some(seed),
            ..SpaceFile::default()
        };
        file.build(None).map_err(Failure::usage)
    }
}
