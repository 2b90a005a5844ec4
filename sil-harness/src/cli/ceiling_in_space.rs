//! `ceiling --preset space`: which forests an aircraft that banks can pass at all.

use super::answer::{Failure, print};
use super::help::{CEILING_IN_SPACE, OUTPUT, RUN, WORLD};
use super::loudness::progress_bar;
use super::signals::Signals;
use super::stage::Stage;
use super::values::{Item, number, or_usual, seed, sight, threads, within};
use mpp_analysis::ceiling::{
    Feasibility, SpaceCeilingCell, SpaceCeilingReport, decide_in_space, fly_with_sight,
};
use mpp_sim::space::{SpaceFile, SpaceScenario};
use rayon::prelude::*;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = CEILING_IN_SPACE)]
pub(super) struct CeilingInSpace {
    #[command(flatten)]
    stage: Stage,
    /// Densities of the world, a list: each is a cell
    #[arg(long, help_heading = WORLD, value_delimiter = ',', value_parser = Item(number))]
    density: Vec<f64>,
    /// Sights of an oracle in metres, a list: each is a cell, and tells which worlds it passes with the trunks that it has seen.
    /// Without it worlds are decided by witnesses and proofs
    #[arg(long, help_heading = RUN, value_delimiter = ',', value_parser = Item(sight))]
    sight: Vec<f64>,
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
        let stage = self.stage.file()?;
        let densities = or_usual(&self.density);
        // What cannot be judged is refused before anything is.
        for density in &densities {
            let scenario = scenario(&stage, *density, self.seed)?;
            mpp_analysis::ceiling::check_in_space(&scenario).map_err(Failure::usage)?;
        }
        let signals = Signals::heed()?;
        let sights = or_usual(&self.sight);
        let all = (densities.len() * sights.len()) as u64 * u64::from(self.trials);
        let progress = progress_bar(all, "worlds");
        let mut report = SpaceCeilingReport::default();
        for (density, sight) in densities
            .iter()
            .flat_map(|it| sights.iter().map(move |sight| (*it, *sight)))
        {
            let seeds: Vec<u64> = (self.seed..).take(self.trials as usize).collect();
            let decide = |seed: &u64| {
                if let Some(code) = signals.raised() {
                    return Err(Failure::new(code, "interrupted"));
                }
                let scenario = scenario(&stage, density, *seed)?;
                let verdict = match sight {
                    None => decide_in_space(&scenario),
                    Some(sight) => fly_with_sight(&scenario, sight),
                };
                progress.inc(1);
                verdict.map_err(Failure::usage)
            };
            let verdicts = seeds.par_iter().map(decide);
            let verdicts: Vec<Feasibility> = verdicts.collect::<Result<_, Failure>>()?;
            let scenario = scenario(&stage, density, self.seed)?;
            (report.cells).push(SpaceCeilingCell::new(&scenario, sight, &verdicts));
        }
        progress.finish_and_clear();
        print(&report, self.json)?;
        Ok(0)
    }
}

fn scenario(stage: &SpaceFile, density: Option<f64>, seed: u64) -> Result<SpaceScenario, Failure> {
    let file = SpaceFile {
        density,
        seed: Some(seed),
        ..stage.clone()
    };
    file.build(None).map_err(Failure::usage)
}
